"""Laws of walls as slopes: how stiff and how damped each is where it is steepest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from hapticd.analysis.device_loop import Coupling
from hapticd.laws import CubicDamper, Damper, Law, Motion, Spring

LawType = Literal["motion", "spring", "damper", "cubic_damper"]


@dataclass(frozen=True, slots=True)
class WallLaw:
    """What a wall asks for. ``bounded``: the law keeps its own slope below what sampling bears."""

    type: LawType
    stiffness_n_per_m: float = 0.0
    damping_n_s_per_m: float = 0.0
    bounded: bool = False


def motion(eta: float, coupling: Coupling) -> WallLaw:
    """The coupling's share 1 − η (WN eq. 17, 30)."""
    share = 1.0 - eta
    return WallLaw("motion", share * coupling.stiffness_n_per_m, share * coupling.damping_n_s_per_m)


def spring(stiffness_n_per_m: float, damping_n_s_per_m: float = 0.0) -> WallLaw:
    """A spring with a damper."""
    return WallLaw("spring", stiffness_n_per_m, damping_n_s_per_m)


def damper(damping_n_s_per_m: float) -> WallLaw:
    """A damper alone."""
    return WallLaw("damper", 0.0, damping_n_s_per_m)


def cubic_damper(
    coefficient_n_s3_per_m3: float, form: Literal["implicit", "explicit"], force_max_n: float
) -> WallLaw:
    """F = C v³ up to the largest force: slope 3Cv² where it saturates, 3 C^⅓ F^⅔ (physics §6).

    The implicit form is solved with the tip's mass and cannot be steeper than m/T_e.
    """
    slope = 3.0 * coefficient_n_s3_per_m3 ** (1 / 3) * force_max_n ** (2 / 3)
    return WallLaw("cubic_damper", 0.0, slope, bounded=form == "implicit")


def slopes_of(law: Law, coupling: Coupling, force_max_n: float) -> WallLaw:
    """The slopes of a law as people write it, on a device with this coupling and largest tip force."""
    match law:
        case Motion():
            return motion(law.eta, coupling)
        case Spring():
            return spring(law.stiffness_n_per_m, law.damping_n_s_per_m)
        case Damper():
            return damper(law.damping_n_s_per_m)
        case CubicDamper():
            return cubic_damper(law.coefficient, law.form, force_max_n)
