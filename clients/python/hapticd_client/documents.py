"""The documents of the API, as types. The daemon may send more members than are named here.

Units are in the names, SI; vectors have as many numbers as the device has coordinates.
"""

from __future__ import annotations

from typing import Any, Literal, NotRequired, TypedDict

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


class Plane(TypedDict):
    """A half-space; the unit normal points into free space."""

    type: Literal["plane"]
    point_m: list[float]
    normal: list[float]


class MotionLaw(TypedDict):
    """Motion law: 0 is rigid, 1 is free."""

    type: Literal["motion"]
    eta: float


class Wall(TypedDict):
    """One wall."""

    id: str
    shape: Plane
    law: MotionLaw
    enabled: NotRequired[bool]
    fade_s: NotRequired[float]


class Scene(TypedDict):
    """Everything a device renders."""

    walls: list[Wall]
    mapping: NotRequired[Mapping]
    stiffness: NotRequired[Stiffness]
    allocation: NotRequired[Allocation]
    note: NotRequired[str | None]


class GrantedWall(TypedDict):
    """What a wall comes to at the present pose."""

    id: str
    stiffness_n_per_m: float | None


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
    """The outcome of an edit of one wall; ``wall`` is null once it is gone."""

    wall: Wall | None
    stiffness_n_per_m: float | None
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


def plane(
    wall_id: str,
    *,
    point_m: list[float],
    normal: list[float],
    eta: float = 0.0,
    fade_s: float = 0.2,
    enabled: bool = True,
) -> Wall:
    """A plane wall: solid behind ``point_m``, free where the unit ``normal`` points; eta 0 is rigid."""
    return {
        "id": wall_id,
        "shape": {"type": "plane", "point_m": point_m, "normal": normal},
        "law": {"type": "motion", "eta": eta},
        "enabled": enabled,
        "fade_s": fade_s,
    }
