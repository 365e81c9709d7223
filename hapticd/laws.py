"""How walls answer penetration, as people write it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from hapticd.document import Document

STIFFNESS_MAX_N_PER_M = 1e6
DAMPING_MAX_N_S_PER_M = 1e4
COEFFICIENT_MAX_N_S3_PER_M3 = 1e9

DEFAULT_COEFFICIENT_N_S3_PER_M3 = {"explicit": 1.6e6, "implicit": 1.28e7}
"""C as printed (KS §4), and eight times that for the implicit form, whose slope is bounded: a weak push (27 N
at 0.25 m/s) on the HHD's twin ends 2.8 mm deep, 3.0 mm with the printed C, 2.6 mm with eight times more, at
which a single encoder count would meet the full slope (docs/laws.md)."""

Damping = Annotated[float, Field(ge=0.0, le=DAMPING_MAX_N_S_PER_M)]


class ContactLaw(Document):
    """What every law can be asked for."""

    type: str
    passivity: bool = Field(False, description="Watched so that it never returns more energy than it took")
    brake: bool | None = Field(
        None, description="Whether brakes may take part; null is wherever the device has any"
    )


class Motion(ContactLaw):
    """The tip's set-point penetrates by η times the depth of the hand (WN eq. 17, 30)."""

    type: Literal["motion"]
    eta: float = Field(ge=0.0, le=1.0, description="0 is rigid, 1 is free")


class Spring(ContactLaw):
    """A spring, and a damper that never pulls."""

    type: Literal["spring"]
    stiffness_n_per_m: float = Field(gt=0.0, le=STIFFNESS_MAX_N_PER_M, description="K, N/m", examples=[800])
    damping_n_s_per_m: Damping = Field(0.0, description="B, N·s/m")


class Damper(ContactLaw):
    """A damper that never pulls: it slows what goes in, and holds nothing."""

    type: Literal["damper"]
    damping_n_s_per_m: float = Field(gt=0.0, le=DAMPING_MAX_N_S_PER_M, description="B, N·s/m", examples=[10])


class CubicDamper(ContactLaw):
    """F = C v³ against penetration (KS §4), up to the device's limits.

    ``implicit`` solves the force with the speed it leads to, and does not chatter; ``explicit`` is the law as
    printed, which chatters between 14 and 41 mm/s.
    """

    type: Literal["cubic_damper"]
    form: Literal["implicit", "explicit"] = "implicit"
    coefficient_n_s3_per_m3: Annotated[float, Field(gt=0.0, le=COEFFICIENT_MAX_N_S3_PER_M3)] | None = Field(
        None,
        description="C, N·s³/m³; null is the form's own: "
        + ", ".join(f"{form} {c:g}" for form, c in DEFAULT_COEFFICIENT_N_S3_PER_M3.items()),
    )

    @property
    def coefficient(self) -> float:
        """C in force, N·s³/m³."""
        return self.coefficient_n_s3_per_m3 or DEFAULT_COEFFICIENT_N_S3_PER_M3[self.form]


Law = Annotated[Motion | Spring | Damper | CubicDamper, Field(discriminator="type")]
"""``type`` says which."""
