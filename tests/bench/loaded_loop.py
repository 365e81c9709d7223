"""Both loops on twins while the API is hammered, beside cyclictest in the same run."""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from tests.bench.cyclictest import Cyclictest
from tests.bench.durations import HEADER, between
from tests.bench.hammer import REST_CLIENTS, STREAM_CLIENTS
from tests.system.daemon_process import FLOOR, HHD, PHANTOM, DaemonProcess

PRIORITY = 80
STROKE = {
    "type": "stroke",
    "center_m": [0.19, 0.0, 0.0],
    "axis": [0, 0, 1],
    "amplitude_m": 0.03,
    "frequency_hz": 1.0,
}


def measure(rate_hz: int, seconds: int) -> str:
    """The page's section for one rate."""
    with tempfile.TemporaryDirectory() as directory:
        devices = [{**PHANTOM, "rate_hz": rate_hz}, {**HHD, "rate_hz": rate_hz}]
        daemon = DaemonProcess(Path(directory), devices).start()
        try:
            return _measured(daemon, rate_hz, seconds)
        finally:
            daemon.stop()


def _measured(daemon: DaemonProcess, rate_hz: int, seconds: int) -> str:
    daemon.put("phantom/scene/walls/floor", FLOOR)
    daemon.put("phantom/twin/hand", STROKE)
    for device_id in ("phantom", "hhd"):
        daemon.put(f"{device_id}/state", {"desired": "enabled"})
    yardstick = Cyclictest(rate_hz, seconds, PRIORITY)
    before = _realtime(daemon)
    with yardstick.running():
        got = _hammered(daemon, seconds + 1)
    after = _realtime(daemon)
    lines = [f"{rate_hz} Hz for {seconds} s: {REST_CLIENTS} REST and {STREAM_CLIENTS} stream clients", HEADER]
    for device_id, report in after.items():
        lines += _rows(device_id, before[device_id], report)
    lines.append(yardstick.row())
    lines.append(
        f"  REST: {got['requests']} requests, p50 {got['p50_ms']:.1f} ms, p99 {got['p99_ms']:.1f} ms; "
        f"streams: {got['ticks']} ticks, {got['dropped']} dropped"
    )
    return "\n".join(lines)


def _rows(device_id: str, before: dict[str, Any], after: dict[str, Any]) -> list[str]:
    missed = after["missed_ticks"] - before["missed_ticks"]
    ticks = after["tick"] - before["tick"]
    policy = after["scheduling"]["policy"]
    return [
        between(before["lateness"], after["lateness"]).row(
            f"{device_id} lateness ({policy})", f"{missed} missed of {ticks}"
        ),
        between(before["compute"], after["compute"]).row(f"{device_id} control core"),
        between(before["exchange"], after["exchange"]).row(f"{device_id} exchange with the twin"),
    ]


def _realtime(daemon: DaemonProcess) -> dict[str, dict[str, Any]]:
    return dict(daemon.http.get("/api/v1/system/realtime").json()["devices"])


def _hammered(daemon: DaemonProcess, seconds: int) -> dict[str, float]:
    command = [sys.executable, "-m", "tests.bench.hammer", str(daemon.http.base_url), str(seconds)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=seconds + 60)
    return dict(json.loads(done.stdout))
