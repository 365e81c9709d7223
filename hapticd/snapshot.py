"""What the daemon says about a device: plain documents, ready to be sent."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict

DeviceState = Literal["offline", "disabled", "enabled", "paused", "fault"]
DESIRED_STATES = ("enabled", "disabled", "paused")


class Report(BaseModel):
    """Something the daemon says. Numbers that are not finite are sent as null."""

    model_config = ConfigDict(frozen=True, ser_json_inf_nan="null")


class Applied(Report):
    """When a write took effect in the loop, over which time, and which limits acted on it."""

    tick: int
    t_mono_ns: int
    fade_s: float = 0.0
    clamped: list[str] = []


class Flags(Report):
    """The flags beside the state."""

    homed: bool = False
    busy: bool = False
    estop: bool = False
    fading: bool = False
    contact: bool = False


class FaultReport(Report):
    """A latched fault. ``severity`` is one of stop_now, soft_stop, blocks_enabling."""

    id: str
    severity: str
    cause: str
    cure: str


class InterlockReport(Report):
    """A condition for enabling. ``ok`` is false while it keeps the device from it."""

    id: str
    ok: bool
    why: str
    cure: str


class Limits(Report):
    """The limits in force."""

    tip_force_n: float
    tip_slew_n_per_s: float
    tip_speed_m_per_s: float
    ramp_s: float
    fade_s: float
    heartbeat_s: float


class Health(Report):
    """Whether the servo lives, and how well it keeps time.

    ``why`` says what keeps the device offline: a dead servo, or hardware that does not answer a living one.
    ``restarts`` counts the returns of the servo.
    """

    online: bool
    why: str | None = None
    restarts: int = 0
    pid: int | None = None
    identity: str | None = None
    realtime_ok: bool | None = None
    scheduling: str | None = None
    missed_ticks: int = 0


class DeviceSnapshot(Report):
    """Everything about one device at one instant."""

    id: str
    model: str
    driver: str
    twin: bool
    dof: int
    rate_hz: float
    traits: list[str]
    state: DeviceState
    flags: Flags
    faults: list[FaultReport]
    interlocks: list[InterlockReport]
    tick: int | None
    t_mono_ns: int | None
    tip_position_m: list[float] | None
    tip_force_n: list[float] | None
    stiffness_n_per_m: float | None
    contact_wall: str | None
    scene_revision: int
    scene_in_force: bool
    walls: int
    limits: Limits
    health: Health
