"""Types of the Rust core. One section per binding file in hapticd/core/py/src."""

from collections.abc import Sequence
from typing import Any, Protocol, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

# ---------------------------------------------------------------------------------------------
# front.rs: the front's end of a servo's shared memory
# ---------------------------------------------------------------------------------------------

class RegionError(RuntimeError):
    """The shared memory is not what this build can use: layout, schema, size, owner."""

class ServoInfo(TypedDict):
    """The header of the region: fixed from the servo's start to its end."""

    device_id: str
    rate_hz: float
    pid: int
    started_utc_ns: int
    started_mono_ns: int
    boot_id: str
    is_twin: bool
    layout_version: int
    schema_hash: int
    tick_capacity: int

class Ack(TypedDict):
    """What became of one request."""

    id: int
    tick: int
    t_mono_ns: int
    result: str
    """`applied`, `refused` (interlocks), `epoch` (stale lease), `malformed`, `unsupported` (not a twin)."""
    interlocks: int
    state: str

class ServoEvent(TypedDict):
    """Something worth telling; `details` depends on `kind`.

    `started` · `state` {from, to} · `faults` {raised, latched} ·
    `miss` {skipped, phase: wake|exchange|compute|rest, lateness_ns, exchange_ns, compute_ns} ·
    `device` {link: fresh|down} · `front` {alive} ·
    `passivity` {wall: index in the scene, acting, energy_j, damping_n_s_per_m} ·
    `garbled` (a broken request queue was emptied) ·
    `overflow` {lost} (events that were overwritten before they were read) ·
    `stopped` {reason: requested|orphaned}
    """

    seq: int
    kind: str
    tick: int
    t_mono_ns: int
    details: dict[str, Any]

class HistogramStatus(TypedDict):
    """Durations since the servo started, in logarithmic buckets of at most 12.5 %."""

    count: int
    sum_ns: int
    max_ns: int
    p50_ns: int
    p99_ns: int
    p999_ns: int
    edges_ns: list[int]
    """Lower edge of each bucket; one longer than `counts`."""
    counts: list[int]

class SchedulingStatus(TypedDict):
    """What the servo asked for and what it really obtained, read back from the kernel."""

    realtime: str
    realtime_ok: bool
    policy: str
    priority: int
    cpu: int | None
    memory_locked: bool
    problems: list[str]
    selftest_samples: int
    selftest_median_ns: int
    selftest_p99_ns: int
    selftest_max_ns: int

class ServoStatus(TypedDict):
    """Written by the loop about ten times a second."""

    tick: int
    t_mono_ns: int
    state: str
    interlocks: int
    phase: str
    """`starting`, `running`, `stopping`, `stopped`."""
    missed_ticks: int
    requests_applied: int
    identity: str
    scheduling: SchedulingStatus
    lateness: HistogramStatus
    exchange: HistogramStatus
    compute: HistogramStatus

class Front:
    """One servo's shared memory, as its front. `observe=True` reads only and claims nothing.

    OSError when the file cannot be opened, RegionError when it is of another layout or schema,
    or when another front holds it.
    """

    def __init__(self, path: str, *, observe: bool = False) -> None: ...
    def info(self) -> ServoInfo: ...
    def heartbeat(self) -> None: ...
    def send(self, request_json: str) -> int:
        """Queues one request and returns its id. ValueError: not a request; BlockingIOError: queue full."""
    def acks(self) -> list[Ack]:
        """Acks since the last call, oldest first."""
    def events(self) -> list[ServoEvent]:
        """Events since the last call, oldest first; the first call starts at the oldest kept."""
    def head(self) -> int:
        """Ticks published so far; the newest has number head() - 1."""
    def read(self, since: int, max_ticks: int) -> tuple[bytes, int, int]:
        """Records of ticks `since`…, their first tick, and how many were lost before it."""
    def latest(self) -> bytes:
        """Newest record; empty before the first tick."""
    def status(self) -> ServoStatus | None:
        """Newest status; None before the first."""
    def servo_alive(self) -> bool:
        """Whether the servo's heartbeat is younger than 0.5 s and of this boot."""
    def close(self) -> None:
        """Gives up the claim and the mapping; every later call raises RegionError."""

# ---------------------------------------------------------------------------------------------
# servo.rs: the real-time loop
# ---------------------------------------------------------------------------------------------

class Driver(Protocol):
    """A device driver written in Python. After start, only the real-time thread calls `exchange`."""

    @property
    def identity(self) -> str: ...
    def connect(self) -> None: ...
    def exchange(self, command: memoryview, observation: memoryview) -> int: ...
    def close(self) -> None: ...

class Servo:
    """One device's real-time loop. ValueError: bad configuration; OSError, RegionError: no region."""

    def __init__(self, config_json: str, driver: Driver | None) -> None: ...
    def start(self) -> None: ...
    def wait(self) -> str:
        """Blocks without the GIL until `stopped`, `orphaned`, `down` or `failed: <why>`; handles signals."""
    def driver_ready(self) -> None:
        """The driver is connected: the loop may call it from the next tick on."""
    def request_stop(self) -> None:
        """Fade to zero, then stop. Returns at once."""
    def driver_error(self) -> str | None:
        """What the driver's last `exchange` raised."""
    def wake_fd(self) -> int:
        """Write end of the pipe `wait` listens on, for `signal.set_wakeup_fd`."""

# ---------------------------------------------------------------------------------------------
# schema.rs: the core's tables
# ---------------------------------------------------------------------------------------------

class FieldInfo(TypedDict):
    """One field of a tick record, in memory order."""

    name: str
    kind: str
    """`float` or `unsigned`."""
    words: int
    """8-byte words: 1 or 3."""
    unit: str
    meaning: str

class FaultInfo(TypedDict):
    """One fault; its bit is its place in the table."""

    slug: str
    severity: str
    """`stop_now`, `soft_stop` or `blocks_enabling`."""
    cause: str
    cure: str

class InterlockInfo(TypedDict):
    """One interlock; its bit is its place in the table."""

    slug: str
    why: str
    cure: str

class BuildInfo(TypedDict):
    """How the core was built."""

    version: str
    profile: str
    platform: str

def tick_schema() -> list[FieldInfo]: ...
def fault_table() -> list[FaultInfo]: ...
def interlock_table() -> list[InterlockInfo]: ...
def build_info() -> BuildInfo: ...

# ---------------------------------------------------------------------------------------------
# twin.rs: a plant alone, and the loop closed over one
# ---------------------------------------------------------------------------------------------

class TwinTruth(TypedDict):
    """The plant's true state at the latch of the last observation."""

    hand_position_m: list[float]
    hand_force_n: list[float]
    joint_position_rad: list[float]
    joint_velocity_rad_per_s: list[float]
    tip_position_m: list[float]
    tip_velocity_m_per_s: list[float]
    motor_current_a: list[float]
    motor_torque_nm: list[float]
    brake_torque_nm: list[float]
    winding_c: list[float]

def check_model(device_json: str, twin_json: str) -> None:
    """ValueError naming the key that is unknown or makes no sense. `twin_json` may be `null`."""

class Plant:
    """A twin as a board sees it. ValueError: the models do not fit."""

    def __init__(self, device_json: str, twin_json: str, rate_hz: float, seed: int) -> None: ...
    def step(self, command: bytes | bytearray | memoryview) -> bytes:
        """One tick under a command (10 float64: enable, motor_v, motor_torque_nm, brake_torque_nm).

        Returns the observation latched at its start, `struct` format `<QQ3q3dd3dQ`.
        """
    def hand(self, script_json: str) -> None: ...
    def truth(self) -> TwinTruth: ...

class Simulation:
    """Controller and twin in closed loop. ValueError: the models do not fit."""

    def __init__(self, device_json: str, twin_json: str, rate_hz: float, seed: int) -> None: ...
    def request(self, request_json: str) -> int:
        """Carries out what `Front.send` takes; returns the open interlocks that refuse it, 0 when applied."""
    def run(self, ticks: int) -> bytes:
        """Records of the next ticks, one after the other."""
    def truth(self) -> TwinTruth: ...

# ---------------------------------------------------------------------------------------------
# linkage.rs: the twins' linkages
# ---------------------------------------------------------------------------------------------

def mass_matrix(device_json: str, twin_json: str, q: Sequence[float]) -> Sequence[Sequence[float]]:
    """M(q), kg·m² by rows, rotors included; an unused joint has its own mass. ValueError: no such twin."""

# ---------------------------------------------------------------------------------------------
# safety.rs: formulas of the safety layer; shapes are (3,), or (3, 3) by rows
# ---------------------------------------------------------------------------------------------

class Ledger:
    """Energy that the motors of a device took from the hand, J."""

    def __init__(self, period_s: float) -> None: ...
    def advance(self, before_nm: _Axes, after_nm: _Axes, retain: _Axes, measured: bool) -> None:
        """One period between two joint torques; `measured` ones need not be delayed."""
    def book(self, step_rad: _Axes) -> float:
        """Books what the joints moved since the last frame; the device's energy after it."""

class Thermal:
    """Winding temperatures of a device. ValueError: not a model, or torque drives."""

    def __init__(self, device_json: str, period_s: float) -> None: ...
    def step(self, current_a: _Axes) -> tuple[list[float], list[float]]:
        """One period; then temperatures in °C and residual resistances in Ω."""

class Budget:
    """I²t budget of motors whose loads come in A or N·m."""

    def __init__(self, *, peak: _Axes, continuous: _Axes, peak_time_s: float, period_s: float) -> None: ...
    def step(self, load: _Axes) -> tuple[list[float], list[float]]:
        """One period; then the budget used and the largest load allowed."""

class Brakes:
    """Brake model of a device. ValueError: not a model, or no brakes."""

    def __init__(self, device_json: str, period_s: float) -> None: ...
    def step(self, asked_nm: _Axes) -> list[float]:
        """One period; then the torques built up, without drag."""

class Allocator:
    """Motor and brake allocation of a device. ValueError: not a model, or no brakes."""

    def __init__(self, device_json: str, period_s: float) -> None: ...
    def split(
        self,
        mode: str,
        *,
        jacobian_inverse: _Rows,
        force_n: _Axes,
        torque_nm: _Axes,
        qd: _Axes,
        hand_force_n: _Axes,
        hand_torque_nm: _Axes,
        brake_nm: _Axes,
    ) -> tuple[list[float], list[float], list[bool]]:
        """Motor torques, brake torques, and which brakes are usable. ValueError: not a mode."""

def bound_motor(
    device_json: str,
    asked_nm: _Axes,
    *,
    period_s: float,
    fade: float,
    jacobian_inverse: _Rows,
    peak_nm: _Axes,
    present_nm: _Axes,
    retain: _Axes,
    supply: _Rows | None = None,
) -> tuple[list[float], int]:
    """Bounded joint torque and the limits that acted; supply is k_T θ̇, V per N·m and largest V."""

def bound_brake(
    *,
    asked_nm: float,
    before_nm: float,
    wanted_nm: float,
    qd: float,
    max_nm: float,
    rise_nm: float,
    omega_off: float,
) -> float:
    """Bounded torque of one brake, N·m."""

def singularity_fade(margin: float, margin_limit: float) -> float:
    """Factor on the outputs near a singularity."""

# ---------------------------------------------------------------------------------------------
# control.rs: pure functions of the control core; shapes are (3,), or (3, 3) by rows
# ---------------------------------------------------------------------------------------------

_Axes: TypeAlias = Sequence[float] | NDArray[np.float64]
_Rows: TypeAlias = Sequence[Sequence[float]] | NDArray[np.float64]
_WallRow: TypeAlias = tuple[_Axes, float, float]
"""Unit normal, offset in m, η."""

class Proxy:
    """The proxy of a tip among walls, given as a JSON list of flat walls. ValueError: not walls."""

    def __init__(self, walls_json: str) -> None: ...
    def edit(self, walls_json: str) -> None:
        """Other walls; history follows their keys. ValueError: not walls."""
    def follow(self, x: _Axes) -> tuple[list[float], list[tuple[int, list[float], float]]]:
        """Proxy of the tip at x, m, and its facings: wall, unit normal, offset in m."""

class Friction:
    """Friction of a device on the walls it touches, with its memory. ValueError: not a model.

    ``walls`` are rows of key, normal, rendered normal force, μ_s, μ_k, ``motor`` or ``brake``.
    """

    def __init__(self, device_json: str, period_s: float) -> None: ...
    def force(
        self,
        walls: Sequence[tuple[int, _Axes, float, float, float, str]],
        *,
        q: _Axes,
        x: _Axes,
        xd: _Axes,
        hand_force_n: _Axes | None = None,
    ) -> tuple[list[float], list[float], int]:
        """Force for the motors and for the brakes, N; 0 no friction, 1 sticks, 2 slips."""
    def energy_j(self) -> float:
        """Energy in the springs of the anchors, J."""

class Law:
    """One wall's law on a device ticked every ``period_s``. ValueError: not a model, not a law."""

    def __init__(self, device_json: str, law_json: str, period_s: float) -> None: ...
    def spring(self, rigid_n_per_m: float, rigid_n_s_per_m: float) -> tuple[float, float]:
        """K and B of the wall's spring, N/m and N·s/m, where a rigid wall has the given ones."""
    def eta(self, rigid_n_per_m: float, reference_n_per_m: float) -> float:
        """Share of the penetration that the wall lets pass, where the stiffest wall has the reference."""
    def damper_force(self, closing_m_per_s: float) -> float:
        """Force of a wall without spring, N, on a tip that goes in."""

class Kinematics:
    """Geometry of one device model. ValueError: not a model."""

    def __init__(self, device_json: str) -> None: ...
    def forward(self, q: _Axes) -> list[float]: ...
    def inverse(self, x: _Axes) -> list[float] | None:
        """Joint angles; None where the linkage does not reach."""
    def jacobian(self, q: _Axes) -> list[list[float]]: ...
    def jacobian_inverse(self, q: _Axes) -> list[list[float]] | None:
        """Zero in the unused row and column; None at a singularity."""
    def singularity_margin(self, q: _Axes) -> float:
        """sin of the angle to the nearest singularity."""
    def inside(self, q: _Axes, margin_rad: float) -> bool: ...
    def workspace_stiffness(self, k_q: _Axes) -> float:
        """Smallest isotropic stiffness over the workspace, N/m."""
    def joint_set_point(
        self, mapping: str, *, q: _Axes, qd: _Axes, x_sd: _Axes, xd_sd: _Axes, k_q: _Axes, k_c: float
    ) -> tuple[list[float], list[float]]:
        """q_Sd and q̇_Sd by `transpose` or `inverse` mapping."""

class SpringDrive:
    """Spring drives of one device model. ValueError: not a model, or torque drives."""

    def __init__(self, device_json: str) -> None: ...
    def demand(self, *, q: _Axes, qd: _Axes, q_sd: _Axes, qd_sd: _Axes, dr_ohm: _Axes) -> list[list[float]]:
        """Static joint torque N·m, tip force N, and e_W V."""
    def dc_stiffness(self, dr_ohm: _Axes) -> list[float]:
        """K_DC at the joints, N·m/rad."""

class TorqueDrive:
    """Torque drives of one device model. ValueError: not a model, or spring drives."""

    def __init__(self, device_json: str) -> None: ...
    def demand(self, *, q: _Axes, qd: _Axes, x_sd: _Axes, xd_sd: _Axes) -> list[list[float]]:
        """Joint torque N·m and tip force N."""

class Estimator:
    """Velocity estimate of one device model. ValueError: not a model."""

    def __init__(self, device_json: str) -> None: ...
    def reset(self, counts: Sequence[int]) -> None: ...
    def update(self, counts: Sequence[int], dt_s: float) -> list[list[float]]:
        """q, q̇, x, ẋ after one more frame."""

def lambda_max_sym(matrix: _Rows) -> float:
    """Largest eigenvalue of a symmetric matrix."""

def contact(walls: Sequence[_WallRow], x: _Axes) -> tuple[int, int | None, float, list[float]]:
    """Walls in contact, index of the deepest, its depth in m and its normal."""

def set_point(walls: Sequence[_WallRow], x: _Axes, xd: _Axes) -> tuple[list[float], list[float]]:
    """x_Sd and ẋ_Sd of the Moreau envelope."""

def isotropic_stiffness(jacobian: _Rows, k_q: _Axes) -> float:
    """Largest k_c, N/m, within the joint stiffnesses k_q, N·m/rad."""
