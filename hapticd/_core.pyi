"""Types of the Rust core. One section per binding file in hapticd/core/py/src."""

from typing import Any, Protocol, TypedDict

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
    """`applied`, `refused` (see interlocks), `epoch` (stale lease), `malformed`, `unsupported` (not a twin)."""
    interlocks: int
    state: str

class ServoEvent(TypedDict):
    """Something worth telling; `details` depends on `kind`, integers and strings only.

    `started` · `state` {from, to} · `faults` {raised, latched} ·
    `miss` {skipped, phase: wake|exchange|compute|publish, lateness_ns, exchange_ns, compute_ns} ·
    `device` {link: fresh|missing|down} · `front` {alive} · `overflow` · `stopped` {reason}
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
        """Blocks without the GIL until `stopped`, `orphaned`, `down` or `failed: <why>`; signals are handled."""
    def driver_ready(self) -> None:
        """The driver is connected: the loop may call it from the next tick on."""
    def request_stop(self) -> None:
        """Fade to zero, then stop. Returns at once."""
    def driver_error(self) -> str | None:
        """What the driver's last `exchange` raised."""
    def wake_fd(self) -> int:
        """Write end of the pipe `wait` listens on, for `signal.set_wakeup_fd`."""
