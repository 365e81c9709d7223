"""The documents of the API, as types. The daemon may send more members than are named here.

Units are in the names, SI; vectors have as many numbers as the device has coordinates.
"""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

from hapticd_client.walls import Wall

State = Literal["offline", "disabled", "enabled", "paused", "fault"]
Desired = Literal["enabled", "disabled", "paused"]
Mapping = Literal["transpose", "inverse"]
Stiffness = Literal["pose", "workspace"]
Allocation = Literal["motor_only", "motor_and_brake", "brake_only"]


class Applied(TypedDict):
    """When a write took effect in the loop, and which limits acted on it."""

    tick: int
    t_mono_ns: int
    fade_s: float
    clamped: list[str]


class Flags(TypedDict):
    """Flags beside the state."""

    homed: bool
    busy: bool
    estop: bool
    fading: bool
    contact: bool


class Fault(TypedDict):
    """A latched reason for not rendering."""

    id: str
    severity: str
    cause: str
    cure: str


class Interlock(TypedDict):
    """A condition for enabling; open while ``ok`` is false."""

    id: str
    ok: bool
    why: str
    cure: str


class Health(TypedDict):
    """Whether the device's servo lives, and why not."""

    online: bool
    why: str | None
    restarts: int
    realtime_ok: bool | None
    scheduling: str | None
    missed_ticks: int


class Device(TypedDict):
    """Everything about one device at one instant."""

    id: str
    model: str
    driver: str
    twin: bool
    dof: int
    rate_hz: float
    state: State
    flags: Flags
    faults: list[Fault]
    interlocks: list[Interlock]
    tick: int | None
    tip_position_m: list[float] | None
    tip_force_n: list[float] | None
    stiffness_n_per_m: float | None
    contact_wall: str | None
    walls: int
    health: Health


class StateReport(TypedDict):
    """The state of a device, and the interlocks that are open."""

    device_id: str
    state: State
    flags: Flags
    faults: list[Fault]
    interlocks: list[Interlock]
    applied: Applied | None


class EstopReport(TypedDict):
    """Whether the emergency stop of a device is latched."""

    device_id: str
    engaged: bool
    state: State
    applied: Applied | None


class Scene(TypedDict):
    """Everything a device renders."""

    walls: list[Wall]
    mapping: NotRequired[Mapping]
    stiffness: NotRequired[Stiffness]
    allocation: NotRequired[Allocation]
    note: NotRequired[str | None]


class Granted(TypedDict):
    """What a wall comes to at the present pose, and why; null is what cannot be said.

    ``budget`` is the stability budget of a wall that had to be let in.
    """

    stiffness_n_per_m: float | None
    stiffness_fraction: float | None
    damping_n_s_per_m: float | None
    brake: bool
    passivity: bool
    friction_actuator: Literal["motor", "brake"] | None
    forced: bool
    why: list[str]
    budget: dict[str, Any] | None


class GrantedWall(TypedDict):
    """What one wall of a scene was granted."""

    id: str
    stiffness_n_per_m: float | None
    granted: Granted


class SceneResult(TypedDict):
    """The outcome of an edit. ``applied`` is null when nothing reached a loop; ``note`` says why."""

    scene: Scene
    etag: str
    revision: int
    applied: Applied | None
    dry_run: bool
    note: str | None
    walls: list[GrantedWall]


class WallResult(TypedDict):
    """The outcome of an edit of one wall; ``wall`` is null once it is gone, ``granted`` while it is off."""

    wall: Wall | None
    stiffness_n_per_m: float | None
    granted: Granted | None
    etag: str
    revision: int
    applied: Applied | None
    dry_run: bool
    note: str | None


class Event(TypedDict):
    """Something that happened."""

    id: int
    t_utc: str
    kind: str
    message: str
    device_id: str | None
    tick: int | None
    details: dict[str, Any]
