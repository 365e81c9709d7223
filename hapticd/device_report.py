"""The snapshot of a device, put together from its model, its newest tick and its servo's status."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING

from hapticd.config import DeviceConfig
from hapticd.model import Model
from hapticd.reading import Reading
from hapticd.reasons import OFFLINE, faults, interlocks
from hapticd.scene_editor import SceneEditor
from hapticd.snapshot import DeviceSnapshot, Flags, Health, Limits

if TYPE_CHECKING:
    from hapticd._core import ServoStatus

NO_WALL = 2**64 - 1
"""The record's contact_wall when nothing is touched."""


@dataclass(frozen=True)
class Attachment:
    """How the device stands with its servo. ``why`` says what keeps it offline; None when nothing does."""

    why: str | None
    count: int
    pid: int | None = None


class DeviceReporter:
    """Makes the snapshots of one device."""

    def __init__(self, config: DeviceConfig, model: Model) -> None:
        device = json.loads(model.device_json)
        self._config = config
        self._model = model
        self.limits = Limits(**{name: device["limits"][name] for name in Limits.model_fields})
        self._traits = _traits(device)

    def snapshot(
        self,
        editor: SceneEditor,
        attachment: Attachment,
        reading: Reading | None,
        status: ServoStatus | None,
        *,
        estop: bool,
    ) -> DeviceSnapshot:
        """Everything about the device, from what is known of it now."""
        dof = self._model.dof
        return DeviceSnapshot(
            id=self._config.id,
            model=self._model.name,
            driver=self._config.driver,
            twin=self._config.is_twin,
            dof=dof,
            rate_hz=self._config.rate_hz,
            traits=self._traits,
            state=reading.state if reading else "offline",
            flags=_flags(editor, reading, estop=estop),
            faults=faults(reading.integer("faults")) if reading else [],
            interlocks=interlocks(status["interlocks"] if reading and status else OFFLINE),
            tick=reading.integer("tick") if reading else None,
            t_mono_ns=reading.integer("t_mono_ns") if reading else None,
            tip_position_m=reading.vector("tip_position_m", dof) if reading else None,
            tip_force_n=reading.vector("tip_force_n", dof) if reading else None,
            stiffness_n_per_m=reading.number("stiffness_n_per_m") if reading else None,
            contact_wall=_touched(editor, reading) if reading else None,
            scene_revision=editor.revision,
            scene_in_force=in_force(editor, reading),
            walls=len(editor.scene.walls),
            limits=self.limits,
            health=_health(attachment, reading, status),
        )


def _flags(editor: SceneEditor, reading: Reading | None, *, estop: bool) -> Flags:
    flags = reading.flags if reading else Flags()
    return flags.model_copy(update={"estop": estop, "busy": flags.busy or editor.is_lent})


def in_force(editor: SceneEditor, reading: Reading | None) -> bool:
    """Whether the loop renders the present revision of the scene."""
    return reading is not None and reading.integer("scene_revision") == editor.revision


def _touched(editor: SceneEditor, reading: Reading) -> str | None:
    index = reading.integer("contact_wall")
    return editor.wall_id(index) if index != NO_WALL and in_force(editor, reading) else None


def _health(attachment: Attachment, reading: Reading | None, status: ServoStatus | None) -> Health:
    restarts = max(0, attachment.count - 1)
    if status is None:
        return Health(online=False, why=attachment.why or "Its servo is starting.", restarts=restarts)
    scheduling = status["scheduling"]
    return Health(
        online=True,
        why=attachment.why if reading is None or reading.state == "offline" else None,
        restarts=restarts,
        pid=attachment.pid,
        identity=status["identity"] or None,
        realtime_ok=scheduling["realtime_ok"],
        scheduling=scheduling["policy"],
        missed_ticks=status["missed_ticks"],
    )


def _traits(device: dict[str, dict[str, object]]) -> list[str]:
    sensor_n = device["limits"]["sensor_force_n"]
    optional = {"brakes": device.get("brakes") is not None, "force_sensor": sensor_n != 0.0}
    present = [name for name, is_there in optional.items() if is_there]
    return [str(device["kinematics"]["type"]), f"{device['drive']['type']}_drive", *present]
