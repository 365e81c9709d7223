"""The servo process: how it starts, what it says about itself, how it ends."""

from __future__ import annotations

import json
import re
import signal
from pathlib import Path
from typing import Any

import pytest

from hapticd.servo import ConfigError, create_driver, main, read_config
from tests.servo.rig import PATIENCE_S, ServoRig, ask, enable, records, servo_config, until


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_fades_a_live_device_out_and_ends_the_process(rig: ServoRig, number: signal.Signals) -> None:
    servo = rig.start()
    front = rig.front()
    enable(front)

    def full() -> bool:
        front.heartbeat()
        return bool(records(front.latest())["gain"][0] == 1.0)

    until(full, "the ramp to end")
    servo.send_signal(number)
    assert servo.wait(PATIENCE_S) == 0
    assert records(front.latest())["gain"][0] == 0.0
    assert front.events()[-1]["details"] == {"reason": "requested"}
    assert not front.servo_alive()


def test_a_stop_request_ends_the_process(rig: ServoRig) -> None:
    servo = rig.start()
    assert ask(rig.front(), type="stop")["result"] == "applied"
    assert servo.wait(PATIENCE_S) == 0


def test_a_servo_without_a_front_ends_by_itself(rig: ServoRig) -> None:
    servo = rig.start(orphan_exit_s=0.3)
    observer = rig.observer()
    assert servo.wait(PATIENCE_S) == 0
    assert observer.events()[-1]["details"] == {"reason": "orphaned"}


def test_the_status_tells_scheduling_and_every_tick_in_its_histograms(rig: ServoRig) -> None:
    rig.start()
    observer = rig.observer()
    until(lambda: observer.head() > 300, "some ticks")
    status = observer.status()
    assert status is not None
    assert status["phase"] == "running"
    assert status["identity"] == "twin of phantom-1.0"
    assert status["scheduling"]["realtime"] == "off"
    assert status["scheduling"]["policy"] == "SCHED_OTHER"
    assert status["scheduling"]["problems"] == []
    assert status["scheduling"]["selftest_samples"] > 0
    for histogram in (status["lateness"], status["exchange"], status["compute"]):
        # The status is written before its own tick is counted.
        assert histogram["count"] == sum(histogram["counts"]) == status["tick"]
        assert len(histogram["edges_ns"]) == len(histogram["counts"]) + 1
        assert histogram["p50_ns"] <= histogram["p99_ns"] <= histogram["p999_ns"] <= histogram["max_ns"]


def test_what_the_kernel_refuses_is_said_with_its_cure(rig: ServoRig) -> None:
    rig.start(cpu=1023)
    observer = rig.observer()
    until(lambda: observer.status() is not None, "a status")
    status = observer.status()
    assert status is not None
    assert status["scheduling"]["cpu"] != 1023
    assert "Pinning to CPU 1023 was refused" in " ".join(status["scheduling"]["problems"])


def test_a_second_servo_for_the_same_device_is_refused(rig: ServoRig) -> None:
    first = rig.start()
    second = rig.launch()
    _, complaint = second.communicate(timeout=PATIENCE_S)
    assert second.returncode == 2
    assert "another servo runs on" in complaint
    assert first.poll() is None
    assert rig.observer().servo_alive()


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"rate_hz": 0.0}, "rate_hz is 0"),
        ({"rate_hz": "fast"}, "rate_hz: .*expected f64"),
        ({"priority": 0}, "priority is 0"),
        ({"realtime": "maybe"}, "realtime: .*maybe"),
        ({"orphan_exit_s": -1.0}, "orphan_exit_s"),
        ({"colour": "red"}, "colour"),
        ({"twin_model": None}, "either a driver or a twin_model"),
        ({"device_model": {"name": "x"}}, "device_model"),
        ({"driver": "no_such_driver"}, "there is no 'no_such_driver'. Drivers: .*hapticd_io.*twin"),
        ({"driver": "hapticd_io"}, "driver 'hapticd_io': "),
    ],
)
def test_a_configuration_that_cannot_be_used_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], changes: dict[str, Any], reason: str
) -> None:
    path = tmp_path / "servo.json"
    path.write_text(json.dumps(servo_config(tmp_path / "region.shm", **changes)))
    assert main([str(path)]) == 2
    complaint = capsys.readouterr().err
    assert complaint.startswith("hapticd.servo: ")
    assert re.search(reason, complaint), complaint


def test_a_file_that_is_no_configuration_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="No such file"):
        read_config(tmp_path / "none.json")
    path = tmp_path / "list.json"
    path.write_text("[]")
    with pytest.raises(ConfigError, match="not a JSON object"):
        read_config(path)


def test_a_twin_needs_no_driver(tmp_path: Path) -> None:
    assert create_driver(servo_config(tmp_path / "region.shm")) is None
