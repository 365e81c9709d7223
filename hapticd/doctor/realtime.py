"""Real-time rights of the user who runs the servos, and what the machine does to latency.

Rights are tried, not read from tables: limits, capabilities, cgroups and containers all have a say.
"""

from __future__ import annotations

import ctypes
import getpass
import os
from collections.abc import Iterator
from pathlib import Path

from hapticd.config import Config
from hapticd.doctor.finding import Finding, Verdict, ok, warn

MCL_CURRENT = 1
"""mlockall(2): lock what is mapped now."""

RT_RUNTIME = Path("/proc/sys/kernel/sched_rt_runtime_us")
RT_PERIOD = Path("/proc/sys/kernel/sched_rt_period_us")
GOVERNORS = "devices/system/cpu/cpu[0-9]*/cpufreq/scaling_governor"

RT_SHARE_MIN = 0.9
"""Share of a processor that real-time threads must be granted; the kernel's default is 0.95."""


def examine(config: Config) -> Iterator[Finding]:
    """Rights and settings, graver where a device requires real-time scheduling."""
    wanted = [device for device in config.devices if device.realtime != "off"]
    if not wanted:
        yield ok("real time", "No device asks for it.")
        return
    required = any(device.realtime == "required" for device in wanted)
    yield _graver(scheduling(max(device.priority for device in wanted)), required)
    yield _graver(memory(), required)
    yield throttling(RT_RUNTIME, RT_PERIOD)
    yield governor(Path("/sys"))


def _graver(finding: Finding, required: bool) -> Finding:
    if finding.verdict is Verdict.WARN and required:
        return Finding(finding.subject, Verdict.FAIL, finding.detail, finding.cure)
    return finding


def scheduling(priority: int) -> Finding:
    """Tries SCHED_FIFO at ``priority`` on this thread, for an instant."""
    policy, param = os.sched_getscheduler(0), os.sched_getparam(0)
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))
    except PermissionError:
        detail = f"SCHED_FIFO {priority} is refused: ticks will be late whenever the machine is busy."
        return warn("scheduling", detail, _limits_cure())
    os.sched_setscheduler(0, policy, param)
    return ok("scheduling", f"SCHED_FIFO {priority} is granted.")


def memory() -> Finding:
    """Tries to lock this process's memory, for an instant."""
    libc = ctypes.CDLL(None, use_errno=True)
    if libc.mlockall(MCL_CURRENT) != 0:
        why = os.strerror(ctypes.get_errno())
        return warn(
            "memory lock", f"Memory cannot be locked ({why}): a page fault can delay a tick.", _limits_cure()
        )
    libc.munlockall()
    return ok("memory lock", "Memory can be locked.")


def _limits_cure() -> str:
    user = getpass.getuser()
    lines = f"{user} - rtprio 98\\n{user} - memlock unlimited\\n"
    return f"printf '{lines}' | sudo tee /etc/security/limits.d/hapticd.conf, then log in again"


def throttling(runtime: Path, period: Path) -> Finding:
    """The share of a processor that the kernel grants to real-time threads."""
    if not runtime.exists():
        return ok("throttling", "The kernel has no limit for real-time threads.")
    runtime_us, period_us = int(runtime.read_text()), int(period.read_text())
    share = 1.0 if runtime_us < 0 else runtime_us / period_us
    if share < RT_SHARE_MIN:
        detail = f"The kernel stops real-time threads after {share:.0%} of the time."
        return warn("throttling", detail, "sudo sysctl -w kernel.sched_rt_runtime_us=950000")
    return ok("throttling", f"Real-time threads may use {share:.0%} of a processor.")


def governor(sys: Path) -> Finding:
    """Whether processors are slowed down when idle, which makes waking up late."""
    found = {file.read_text(encoding="ascii").strip() for file in sys.glob(GOVERNORS)}
    if not found:
        return ok("processor clock", "No frequency scaling is visible here.")
    if found != {"performance"}:
        detail = f"The frequency governor is {', '.join(sorted(found))}: a slowed processor wakes up late."
        return warn("processor clock", detail, "sudo cpupower frequency-set -g performance")
    return ok("processor clock", "The frequency governor is performance.")
