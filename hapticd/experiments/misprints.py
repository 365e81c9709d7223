"""What the two papers print wrongly, leave out or leave open, and what is done about it here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal


@dataclass(frozen=True, slots=True)
class Misprint:
    """One place: wrong as printed, missing, or with two readings, and what is done about it."""

    where: str
    kind: Literal["misprint", "gap", "ambiguity"]
    printed: str
    here: str


MISPRINTS: tuple[Misprint, ...] = (
    Misprint(
        "WN eq. 12",
        "misprint",
        "K_θ, torque over angle, is negative, while eqs. 13, 14 and 19 use it as a positive stiffness",
        "τ = +K_θ (θ_Sd − θ) throughout; K_DC and K_HF are magnitudes",
    ),
    Misprint(
        "WN eq. 12",
        "gap",
        "holds for a set-point at rest: eq. 10 filters the measured velocity, not the set-point's",
        "the same form, compared with eq. 12 at rest alone",
    ),
    Misprint(
        "WN §IV, eq. 17",
        "misprint",
        "“the low-frequency output stiffness is reduced by the factor η”",
        "it is multiplied by 1 − η: η = 0 is rigid, 1 is free",
    ),
    Misprint(
        "WN eqs. 21, 27",
        "misprint",
        "take K_θ for the stiffness of the joint",
        "the motor's stiffness is multiplied by the square of the transmission ratio",
    ),
    Misprint(
        "WN eq. 20",
        "gap",
        "all joints are assumed to be equally stiff; scaling between them is left out",
        "the base joint of a PHANTOM 1.0 is 1.20 times as stiff (ratios 7.67 and 7.0): the general form",
    ),
    Misprint(
        "WN",
        "gap",
        "R̂ and the residual, K_P, K_D, λ, sampling period, supply, pose of Figs. 3, 4, motion of Fig. 6",
        "R̂ = 0.95 R, λ = 2π·200 Hz, 1 kHz, ±24 V assumed; every one of them can be set",
    ),
    Misprint(
        "WN eq. 24",
        "gap",
        "leaves out the derivative of the Jacobian, and the velocity it feeds forward is filtered",
        "above λ free directions feel an added mass k_T²/(dR λ), up to 100 g for a slow filter",
    ),
    Misprint(
        "WN §VI",
        "misprint",
        "“a radial spacing of 15°”",
        "the 24 walls are turned by 15° each: an angular spacing",
    ),
    Misprint(
        "KS §2.2",
        "ambiguity",
        "brakes of 4 N·m give 36 N everywhere",
        "4 N·m at the joint gives 14 N, before the 5:1 stage 73 N: neither reading of Fig. 4 gives 36 N; "
        "that takes 10 N·m, the default, where 20 N·m is the other reading",
    ),
    Misprint(
        "KS §2.2, Fig. 2",
        "ambiguity",
        "more than 80 N everywhere",
        "true for the norm of both motors' torques (22.2 N·m); each motor by itself would allow 111 N",
    ),
    Misprint(
        "KS §2.1",
        "misprint",
        "“no singularity” in the workspace",
        "true within the 380 × 230 mm rectangle; the joint ranges hold two singular poses, kept off by stops",
    ),
    Misprint(
        "KS §2.1",
        "misprint",
        "the tip's position “by the Jacobian relation”",
        "by the forward kinematics; the Jacobian relates velocities",
    ),
    Misprint("KS §1", "misprint", "“energy bounding … by Hannaford and Ryu [4, 5]”", "[5] is by Kim and Ryu"),
    Misprint(
        "KS §2.2",
        "ambiguity",
        "the brake's 50 ms are “much slower than that of the motor, 7 ms”: a time constant of what?",
        "no torque lag: with 7 ms no hand lets Fig. 8(a) settle; 0.5 ms is the default, to be set",
    ),
    Misprint("KS §5", "misprint", "“Fig. 10(b)” in the text on the friction results", "Fig. 11 is meant"),
    Misprint(
        "KS §3",
        "ambiguity",
        "the brake's direction by “a desired direction of a force measured by the F/T sensor”",
        "desired force against motion while the joint moves, against the hand's torque while it rests",
    ),
    Misprint(
        "KS §5",
        "misprint",
        "friction is limited to the hand's own tangential force",
        "right in stick alone: in slip it would vanish with the hand's force, so it is μ_k N against motion",
    ),
    Misprint(
        "KS",
        "gap",
        "rate, encoders, force sensor, gear ratio, masses, tuning of PO/PC, the brakes' command",
        "assumed values in the device model, each with its source and, where known, range",
    ),
    Misprint(
        "KS Fig. 8",
        "ambiguity",
        "0.11 s of transient and 0.12 s until the velocity drops: since when?",
        "counted from first contact",
    ),
    Misprint(
        "KS §4",
        "gap",
        "how a brake that has engaged lets the hand withdraw from the wall",
        "released by motion and by the hand's force, while the motors cover the decay",
    ),
)
"""In the order of the papers: Wilson & Niemeyer (WN), Kwon & Song (KS)."""
