"""The shared memory across processes, with either side killed in the middle of everything."""

from __future__ import annotations

import signal
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from hapticd import _core
from hapticd.frame import Records
from tests.servo.rig import ServoRig, ask, enable, records, state, until

DISABLED, ENABLED = 1, 2

VERSION_WORD, SCHEMA_WORD = 1, 2


def assert_whole(ticks: Records, first: int) -> None:
    """Every record is the tick its place says, from its first word to those far behind it."""
    expected = np.arange(first, first + len(ticks), dtype=np.uint64)
    np.testing.assert_array_equal(ticks["tick"], expected)
    # The twin sends one frame a tick.
    np.testing.assert_array_equal(
        ticks["observation_seq"] - ticks["tick"], ticks["observation_seq"][0] - first
    )
    assert np.all(np.diff(ticks["t_mono_ns"].astype(np.int64)) > 0)
    assert np.all(np.diff(ticks["missed_ticks"].astype(np.int64)) >= 0)


def test_a_reader_gets_every_tick_whole_while_the_servo_writes_and_after_it_was_killed(rig: ServoRig) -> None:
    servo = rig.start(rate_hz=4000.0)
    reader = rig.observer()
    seen = 0
    while seen < 6000:
        data, first, lost = reader.read(seen, 500)
        assert (first, lost) == (seen, 0)
        if data:
            assert_whole(records(data), first)
        seen += len(records(data))
        if seen > 3000 and servo.poll() is None:
            servo.kill()
            servo.wait()
        if servo.poll() is not None and seen == reader.head():
            break
    data, first, _ = reader.read(0, 10**6)
    assert_whole(records(data), first)
    assert len(records(data)) == reader.head() - first


def test_a_reader_that_was_away_too_long_is_told_how_much_it_lost(rig: ServoRig) -> None:
    rig.start(rate_hz=4000.0)
    reader = rig.observer()
    capacity = reader.info()["tick_capacity"]
    until(lambda: reader.head() > capacity + 500, "the ring to come round")
    data, first, lost = reader.read(100, 10)
    assert first == 100 + lost
    assert lost >= 400
    assert_whole(records(data), first)


def test_a_killed_front_leaves_a_servo_that_withdraws_and_serves_the_next_front(rig: ServoRig) -> None:
    rig.start()
    command = [sys.executable, "-m", "tests.servo.dying_front", str(rig.region)]
    front = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert front.stdout is not None
    assert front.stdout.readline() == "enabled\n"
    observer = rig.observer()
    until(lambda: records(observer.latest())["scene_revision"][0] > 20, "scenes to flow")
    assert state(observer) == ENABLED
    front.kill()
    front.wait()
    front.stdout.close()
    until(lambda: state(observer) != ENABLED, "the servo to notice")
    until(lambda: records(observer.latest())["gain"][0] == 0.0, "the fade to end")
    successor = rig.front()
    assert ask(successor, type="desired", desired="disabled")["result"] == "applied"
    assert "garbled" not in [event["kind"] for event in successor.events()]


def test_a_killed_servo_is_seen_dead_and_its_successor_starts_afresh(rig: ServoRig) -> None:
    first = rig.start()
    front = rig.front()
    assert front.servo_alive()
    enable(front)
    first.kill()
    first.wait()
    until(lambda: not front.servo_alive(), "the silence to be noticed")
    ticks = front.head()
    second = rig.start()
    # The old mapping keeps the last ticks of the dead servo: they are its black box.
    assert front.head() == ticks
    successor = rig.front()
    assert successor.info()["pid"] == second.pid
    assert successor.servo_alive()
    assert state(successor) == DISABLED
    assert ask(successor, type="desired", desired="disabled")["id"] == 1


def test_a_stopped_servo_beats_no_more_and_beats_again_when_it_is_continued(rig: ServoRig) -> None:
    servo = rig.start()
    observer = rig.observer()
    servo.send_signal(signal.SIGSTOP)
    until(lambda: not observer.servo_alive(), "the silence to be noticed")
    servo.send_signal(signal.SIGCONT)
    until(observer.servo_alive, "the heartbeat")
    until(lambda: "miss" in [event["kind"] for event in observer.events()], "the miss")


@pytest.mark.parametrize(
    ("word", "reason"),
    [(VERSION_WORD, "has layout 7, this build reads layout"), (SCHEMA_WORD, "have schema")],
)
def test_another_layout_is_refused_with_its_reason(
    rig: ServoRig, tmp_path: Path, word: int, reason: str
) -> None:
    rig.start()
    other = tmp_path / "other.shm"
    content = bytearray(rig.region.read_bytes())
    struct.pack_into("=Q", content, 8 * word, 7)
    other.write_bytes(content)
    with pytest.raises(_core.RegionError, match=reason):
        _core.Front(str(other))


def test_what_is_no_region_is_refused(tmp_path: Path) -> None:
    noise = tmp_path / "noise"
    noise.write_bytes(b"no region" * 1000)
    with pytest.raises(_core.RegionError, match="is not a servo's shared memory"):
        _core.Front(str(noise))
    with pytest.raises(FileNotFoundError):
        _core.Front(str(tmp_path / "nothing"))


def test_there_is_one_front_and_any_number_of_observers(rig: ServoRig) -> None:
    rig.start()
    front = rig.front()
    with pytest.raises(_core.RegionError, match="another front"):
        rig.front()
    observer = rig.observer()
    assert observer.head() > 0
    with pytest.raises(_core.RegionError, match="observer"):
        observer.heartbeat()
    with pytest.raises(_core.RegionError, match="observer"):
        observer.send('{"type": "stop"}')
    front.close()
    with pytest.raises(_core.RegionError, match="closed"):
        front.heartbeat()
    assert rig.front().servo_alive()


@pytest.mark.parametrize(
    "request_json",
    [
        "",
        "[]",
        '{"type": "dance"}',
        '{"type": "estop", "epoch": -1}',
        '{"type": "scene", "scene": {"walls": []}}',
    ],
)
def test_a_request_that_makes_no_sense_is_refused_before_it_is_sent(rig: ServoRig, request_json: str) -> None:
    rig.start()
    front = rig.front()
    with pytest.raises(ValueError, match=r".+"):
        front.send(request_json)
    assert ask(front, type="desired", desired="disabled")["id"] == 1


def test_requests_without_a_servo_end_in_a_full_queue_and_not_in_a_wait(rig: ServoRig) -> None:
    servo = rig.start()
    front = rig.front()
    servo.kill()
    servo.wait()

    def send_for_ever() -> None:
        for _ in range(100_000):
            front.send('{"type": "desired", "desired": "disabled"}')

    with pytest.raises(BlockingIOError, match="full"):
        send_for_ever()
