"""What a device model asks of the board."""

from __future__ import annotations

import json
from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Needs:
    """Axes and largest actuator values of a model, joint side."""

    axes: int
    spring_drive: bool
    """Motors take volts e_W (spring drive); otherwise joint torque."""
    motor_max: tuple[float, ...]
    """Per axis, V or N·m."""
    brake_max_nm: tuple[float, ...]
    """Per axis; empty without brakes."""
    sensor_force_n: float
    """Range of the force sensor; 0 without one."""

    @classmethod
    def of(cls, device_json: str) -> Needs:
        """Reads the model as the control core gets it."""
        device = json.loads(device_json)
        axes, drive, brakes = device["dof"], device["drive"], device.get("brakes")
        spring = drive["type"] == "spring"
        motor_max = drive["voltage_max_v"] if spring else drive["torque_max_nm"]
        brake_max = brakes["torque_max_nm"][:axes] if brakes else ()
        return cls(
            axes, spring, tuple(motor_max[:axes]), tuple(brake_max), device["limits"]["sensor_force_n"]
        )
