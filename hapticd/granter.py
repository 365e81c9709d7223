"""What walls come to on one device: how stiff and damped, by which actuators, and why."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from hapticd.admission import Admission
from hapticd.laws import CubicDamper, Damper, Law, Motion, Spring
from hapticd.model import Model
from hapticd.scene import Scene
from hapticd.scene_result import Granted, GrantedWall
from hapticd.wall import Wall

UNKNOWN = "The device is offline: how stiff it can be at its pose is not known."
NO_BRAKES = "The device has no brakes; motors render the wall."
MOTORS_ALONE = "The scene's allocation is motor_only; brakes take no part."
FORCED = "It is over its stability budget and was let in by force: passivity is on and bounds it."
PASSIVE = "Passivity is on: energy that would be returned in excess is damped away."
FORBIDDEN = "The wall's law says brake: false; motors render it."

NO_ADMISSIONS: Mapping[str, Admission] = {}


@dataclass(frozen=True)
class Stiffness:
    """N/m; the share of what the device gives a rigid wall; N·s/m; why. None is what cannot be said."""

    n_per_m: float | None
    fraction: float | None
    damping_n_s_per_m: float | None
    why: str | None = None


@dataclass(frozen=True)
class Granter:
    """One device. ``coupling`` holds the virtual coupling's N/m and N·s/m; a spring drive has none."""

    coupling: tuple[float, float] | None
    has_brakes: bool

    @classmethod
    def of_model(cls, model: Model) -> Granter:
        """The granter of a device model."""
        drive = json.loads(model.device_json)["drive"]
        is_spring = drive["type"] == "spring"
        coupling = None if is_spring else (drive["stiffness_n_per_m"], drive["damping_n_s_per_m"])
        return cls(coupling, model.has_brakes)

    def walls(
        self, scene: Scene, k_c: float | None, admissions: Mapping[str, Admission] = NO_ADMISSIONS
    ) -> list[GrantedWall]:
        """What each enabled wall of ``scene`` comes to, with the admissions there are by wall.

        ``k_c``, N/m, is what the device gives a rigid wall at its pose; None when that is not known.
        """
        granted = [
            (wall.id, self.wall(wall, scene, k_c, admissions.get(wall.id)))
            for wall in scene.walls
            if wall.enabled
        ]
        return [
            GrantedWall(id=wall_id, stiffness_n_per_m=each.stiffness_n_per_m, granted=each)
            for wall_id, each in granted
        ]

    def wall(
        self, wall: Wall, scene: Scene, k_c: float | None, admission: Admission | None = None
    ) -> Granted:
        """What one wall comes to."""
        forced = admission is not None and admission.forced
        stiffness = self._stiffness(wall.law, k_c)
        brake, why_brake = self._brake(wall.law, scene)
        why = [stiffness.why, why_brake, FORCED if forced else PASSIVE if wall.law.passivity else None]
        return Granted(
            stiffness_n_per_m=stiffness.n_per_m,
            stiffness_fraction=stiffness.fraction,
            damping_n_s_per_m=stiffness.damping_n_s_per_m,
            brake=brake,
            passivity=wall.law.passivity,
            friction_actuator=self._friction_actuator(wall, scene),
            forced=forced,
            budget=admission.budget if admission else None,
            why=[sentence for sentence in why if sentence],
        )

    def _stiffness(self, law: Law, k_c: float | None) -> Stiffness:
        match law:
            case Motion(eta=eta):
                return self._motion(eta, k_c)
            case Spring(stiffness_n_per_m=k, damping_n_s_per_m=b):
                return self._spring(k, b, k_c)
            case Damper(damping_n_s_per_m=b):
                return Stiffness(0.0, None, b, "A damper slows what goes in; it holds nothing.")
            case CubicDamper(coefficient=c):
                why = f"F = {c:.3g} v³ slows what goes in; it holds nothing once at rest."
                return Stiffness(0.0, None, None, why)

    def _motion(self, eta: float, k_c: float | None) -> Stiffness:
        """(1 − η) k_c on a spring drive (WN eq. 17, 29), the coupling times 1 − η on torques."""
        rigid = 1.0 - eta
        if self.coupling is not None:
            k, b = self.coupling
            why = f"The virtual coupling has {k:.0f} N/m and {b:.0f} N·s/m; {rigid:.0%} of it is the wall."
            return Stiffness(rigid * k, rigid, rigid * b, why)
        if k_c is None:
            return Stiffness(None, rigid, None, UNKNOWN)
        why = f"The spring drive gives at most {k_c:.0f} N/m at this pose; {rigid:.0%} of it is the wall."
        return Stiffness(rigid * k_c, rigid, None, why)

    def _spring(self, k: float, b: float, k_c: float | None) -> Stiffness:
        if self.coupling is not None:
            return Stiffness(k, None, b, "Motors render any stiffness within the stability budget.")
        if k_c is None:
            return Stiffness(None, None, b, UNKNOWN)
        fraction = min(1.0, k / k_c)
        why = f"{k:.0f} N/m is {fraction:.0%} of the {k_c:.0f} N/m that the spring drive gives at this pose."
        if k > k_c:
            why = f"The spring drive can give at most {k_c:.0f} N/m at this pose, not {k:.0f} N/m."
        return Stiffness(min(k, k_c), fraction, b, why)

    def _brake(self, law: Law, scene: Scene) -> tuple[bool, str | None]:
        if not self.has_brakes:
            return False, None if law.brake is None else NO_BRAKES
        if law.brake is False:
            return False, FORBIDDEN
        if scene.allocation == "motor_only":
            return False, MOTORS_ALONE
        return True, "Brakes take what they can dissipate, motors the rest."

    def _friction_actuator(self, wall: Wall, scene: Scene) -> Literal["motor", "brake"] | None:
        if wall.friction is None:
            return None
        brakes = self.has_brakes and scene.allocation != "motor_only"
        return "brake" if brakes and wall.friction.actuator != "motor" else "motor"
