"""What WN say about the stiffness of one drive, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Claim
from hapticd.experiments.stiffness_curve import Curve

GRID_HZ = np.geomspace(1e-3, 1e6, 2000)
"""Where closed forms are compared."""


def claims(curves: Sequence[Curve], pd: SpringDrive, results: Mapping[str, Any]) -> tuple[Claim, ...]:
    """Every statement of WN §II–IV that a number can decide."""
    by_name = {curve.name: curve for curve in curves}
    p = by_name["p"].drive
    return (
        *_algebra(pd),
        _corner(by_name),
        _roll_off(by_name["spring_drive"]),
        _static(by_name["p"]),
        _fast(by_name["spring_drive"]),
        _middle(by_name, pd),
        _rendered(by_name["p"], "at the fast rate"),
        _rendered(by_name["p_servo"], "at the servo's rate"),
        _passive(p, "with P"),
        _passive(pd, "with PD"),
        _identity(p),
        *_beside(results),
        _lead(),
    )


def _algebra(pd: SpringDrive) -> tuple[Claim, Claim, Claim]:
    difference = float(np.max(np.abs(pd.printed(GRID_HZ) / -pd.stiffness(GRID_HZ) - 1)))
    ends = pd.printed(np.array([1e-9, 1e12])).real
    sizes_hold = np.allclose(np.abs(ends), [pd.k_dc, pd.k_hf], rtol=1e-3)
    return (
        judged(
            "Substituting the compensation (10) into the motor (11) gives (12)",
            "WN eq. 10–12",
            "the same at every frequency for a resting set-point",
            f"largest relative difference {difference:.0e}",
            holds=difference < 1e-9,
        ),
        judged(
            "(13) and (14) are the magnitudes of (12) at its two ends",
            "WN eq. 12–14",
            f"{pd.k_dc:.3f} and {pd.k_hf:.3f} N·m/rad",
            f"{abs(ends[0]):.3f} and {abs(ends[1]):.3f} N·m/rad",
            holds=sizes_hold,
        ),
        judged(
            "(13) and (14) are the values of (12) at its two ends, sign included",
            "WN eq. 12–14",
            "positive, as in (13), (14) and (19)",
            f"{ends[0]:.3f} and {ends[1]:.3f} N·m/rad: (12) is torque on the rotor, the others resist",
            holds=bool(np.all(ends > 0)),
        ),
    )


def _corner(by_name: Mapping[str, Curve]) -> Claim:
    motor, drive = by_name["motor"], by_name["spring_drive"]
    expected = np.array([motor.drive.corner_hz, drive.drive.corner_hz])
    found = np.array([_corner_hz(motor), _corner_hz(drive)])
    return judged(
        "The spring drive lowers the corner frequency from R/L to dR/L",
        "WN §III, Fig. 2",
        f"{expected[0]:.0f} Hz to {expected[1]:.1f} Hz",
        f"{found[0]:.0f} Hz to {found[1]:.1f} Hz on the twin",
        holds=bool(np.all(np.abs(found / expected - 1) < 0.05)),
    )


def _corner_hz(curve: Curve) -> float:
    """The corner f_c of K = K_L jf/(jf + f_c), from |K_L/K|² − 1 = (f_c/f)² below the corner, Hz."""
    low = curve.frequency_hz <= max(curve.drive.corner_hz, curve.frequency_hz[0])
    excess = np.abs(curve.drive.k_hf / curve.stiffness[low]) ** 2 - 1
    return float(np.exp(np.mean(np.log(curve.frequency_hz[low] * np.sqrt(np.maximum(excess, 1e-12))))))


def _roll_off(curve: Curve) -> Claim:
    slope, expected = (_first_slope(curve, values) for values in (curve.stiffness, curve.closed_form()))
    return judged(
        "Without compensation the residual damper B_dR rolls the stiffness off towards low frequency",
        "WN §III, eq. 8",
        f"20 dB a decade well below dR/L; {expected:.1f} between the two lowest frequencies",
        f"{slope:.1f} dB a decade on the twin",
        holds=abs(slope - expected) < 1 and slope > 10,
    )


def _first_slope(curve: Curve, stiffness: NDArray[np.complex128]) -> float:
    """Between the two lowest frequencies, dB a decade."""
    rise = 20 * np.log10(np.abs(stiffness[1] / stiffness[0]))
    return float(rise / np.log10(curve.frequency_hz[1] / curve.frequency_hz[0]))


def _static(curve: Curve) -> Claim:
    found = float(np.abs(curve.stiffness[0]))
    return judged(
        "K_P raises the low end to K_DC = k_T K_P/dR",
        "WN eq. 13",
        f"{curve.drive.k_dc:.3f} N·m/rad",
        f"{found:.3f} N·m/rad at {curve.frequency_hz[0]:.2g} Hz on the twin",
        holds=abs(found / curve.drive.k_dc - 1) < 0.03,
    )


def _fast(curve: Curve) -> Claim:
    found = float(np.abs(curve.stiffness[-1]))
    return judged(
        "The high end is K_HF = K_L = k_T²/L",
        "WN eq. 4, 14",
        f"{curve.drive.k_hf:.3f} N·m/rad",
        f"{found:.3f} N·m/rad at {curve.frequency_hz[-1]:.4g} Hz on the twin",
        holds=abs(found / curve.drive.k_hf - 1) < 0.03,
    )


def _middle(by_name: Mapping[str, Curve], pd: SpringDrive) -> Claim:
    expected = float(np.max(np.abs(pd.stiffness(GRID_HZ))))
    found = float(np.max(np.abs(by_name["pd"].stiffness)))
    return judged(
        "K_D raises the middle before the filter rolls it off to K_HF",
        "WN §III, Fig. 2",
        f"a maximum of {expected:.2f} above K_HF = {pd.k_hf:.2f} N·m/rad",
        f"maximum {found:.2f} N·m/rad on the twin",
        holds=found > 1.05 * pd.k_hf,
    )


def _rendered(curve: Curve, where: str) -> Claim:
    return judged(
        f"(12) is the stiffness that is rendered, {where}",
        "WN eq. 12",
        "within 1 dB up to half the rate",
        f"{curve.deviation_db():.1f} dB off at worst at {curve.rate_hz:g} Hz; "
        f"{100 * curve.deviation():.1f} % off (12) with the tick's hold and delay",
        holds=curve.deviation_db() < 1,
    )


def _passive(drive: SpringDrive, which: str) -> Claim:
    lag = np.degrees(np.angle(drive.stiffness(GRID_HZ)))
    return judged(
        f"The coupling stiffness is a passive coupling, {which}",
        "WN §III, end",
        "phase of K_θ(jω) never negative: K_P + λ K_D ≤ k_T dR/L",
        f"smallest phase {lag.min():.1f}°; K_P + λ K_D is {1 - drive.passivity_margin:.2f} k_T dR/L",
        holds=drive.passivity_margin >= 0,
    )


def _identity(p: SpringDrive) -> Claim:
    flat = p.compensated(p.k_p_flat, 0.0).stiffness(GRID_HZ)
    spread = float(np.max(np.abs(flat / p.k_hf - 1)))
    return judged(
        "K_P and K_D can be chosen for the highest stiffness at all frequencies",
        "WN §III, after eq. 14",
        "K_P = k_T dR/L and K_D = 0 make K_θ(s) = k_T²/L at every frequency",
        f"off by {spread:.0e} of it at most for K_P = {p.k_p_flat:.2f} V/rad",
        holds=spread < 1e-9,
    )


def _beside(results: Mapping[str, Any]) -> tuple[Claim, ...]:
    return (_drift(results["drift"]), *_compliant(results["compliant"]), *_free(results["free_space"]))


def _drift(drift: Mapping[str, float]) -> Claim:
    damper, residual = drift["damping_n_s_per_m"], drift["residual_damper_n_s_per_m"]
    return judged(
        "Without compensation a steady load makes the contact drift like a damper",
        "WN §III, eq. 8",
        f"B_dR = {residual:.2f} N·s/m at the tip",
        f"{damper:.2f} N·s/m: {1e3 * drift['speed_m_per_s']:.0f} mm/s under {drift['force_n']:.2f} N",
        holds=abs(damper / residual - 1) < 0.1,
    )


def _compliant(compliant: Mapping[str, float]) -> tuple[Claim, Claim]:
    eta, share = compliant["eta"], compliant["share_of_rigid"]
    return (
        judged(
            "A wall of η has the static stiffness of a rigid one times 1 − η",
            "WN eq. 17",
            f"{1 - eta:.3f} for η = {eta:g}",
            f"{share:.3f} on the twin",
            holds=abs(share - (1 - eta)) < 0.02,
        ),
        judged(
            "The static stiffness is reduced by the factor η, read as multiplied by η",
            "WN §IV, after eq. 17",
            f"{eta:.3f} for η = {eta:g}",
            f"{share:.3f} on the twin; (17) itself gives 1 − η",
            holds=abs(share - eta) < 0.02,
        ),
    )


def _free(free: Mapping[str, float]) -> tuple[Claim, Claim]:
    by_filter_g, sampled_g = 1e3 * free["closed_form_kg"], 1e3 * free["sampled_form_kg"]
    added_g, device_g = 1e3 * free["added_mass_kg"], 1e3 * free["device_mass_kg"]
    return (
        judged(
            "The filter's lag in free space is felt as an added mass",
            "WN §IV, after eq. 16",
            f"{by_filter_g:.1f} g by k_T²/(dR λ), {sampled_g:.1f} g with hold and delay",
            f"{added_g:.1f} g on the twin",
            holds=abs(added_g / sampled_g - 1) < 0.05,
        ),
        undecidable(
            "The added mass falls far below perceptible levels",
            "WN §IV, after eq. 16",
            "a threshold",
            f"{added_g:.1f} g beside the {device_g:.0f} g of the device",
            "the text names neither a threshold nor λ and dR, and the mass is k_T²/(dR λ)",
        ),
    )


def _lead() -> Claim:
    return undecidable(
        "Lead compensation in place of R̂ raises K_L by reducing L",
        "WN §III, after eq. 14",
        "K_L above k_T²/L",
        "not tried",
        "the text gives no compensator, and the twin's amplifier cancels resistance alone",
    )
