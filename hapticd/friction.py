"""Friction on a wall's surface, as people write it."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, ValidationInfo, field_validator

from hapticd.document import Document

COEFFICIENT_MAX = 5.0
"""Largest coefficient: past it nothing slips."""

Coefficient = Annotated[float, Field(ge=0.0, le=COEFFICIENT_MAX)]


class Friction(Document):
    """Coulomb friction with stick, in proportion to the normal force."""

    static: Coefficient = Field(description="μ_s: what it takes to slip", examples=[0.4])
    kinetic: Coefficient = Field(description="μ_k while slipping", examples=[0.3])
    actuator: Literal["auto", "motor", "brake"] = Field(
        "auto", description="What renders it; auto is brakes where the device has any, else motors"
    )

    @field_validator("kinetic")
    @classmethod
    def _not_above_static(cls, kinetic: float, info: ValidationInfo) -> float:
        static = info.data.get("static", kinetic)
        if kinetic > static:
            raise ValueError(f"kinetic is above static: {kinetic:g} > {static:g}; write at most {static:g}.")
        return kinetic
