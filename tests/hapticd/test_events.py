"""The event log: no event is lost, repeated or renumbered."""

import asyncio
from pathlib import Path

import pytest

from hapticd import events
from hapticd.events import EventLog


def test_events_keep_their_numbers_across_restarts(tmp_path: Path) -> None:
    first = EventLog(tmp_path)
    kept = [
        first.append("scene.changed", "One."),
        first.append("servo.lost", "Two.", device_id="hhd", tick=7),
    ]
    second = EventLog(tmp_path)
    assert second.after(0) == kept
    assert second.append("daemon.started", "Three.").id == kept[-1].id + 1


def test_resuming_takes_up_after_the_last_one_seen(tmp_path: Path) -> None:
    log = EventLog(tmp_path)
    ids = [log.append("scene.changed", f"Number {n}.", details={"n": n}).id for n in range(5)]
    assert [event.details["n"] for event in log.after(ids[1], limit=2)] == [2, 3]
    assert log.after(ids[-1]) == []
    assert log.oldest_id == ids[0]


def test_memory_is_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events, "KEPT_IN_MEMORY", 10)
    log = EventLog(tmp_path)
    for n in range(25):
        log.append("servo.miss", f"Number {n}.")
    assert [event.id for event in log.after()] == list(range(16, 26))


def test_disk_is_bounded_and_numbers_go_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(events, "FILE_MAX_BYTES", 2000)
    log = EventLog(tmp_path)
    for n in range(100):
        log.append("servo.miss", f"Number {n}.")
    sizes = [file.stat().st_size for file in tmp_path.iterdir()]
    assert len(sizes) == 2
    assert max(sizes) < 3000
    assert EventLog(tmp_path).append("daemon.started", "Next.").id == 101


def test_line_cut_short_by_a_power_failure_costs_only_itself(tmp_path: Path) -> None:
    log = EventLog(tmp_path)
    log.append("scene.changed", "Whole.")
    log.append("scene.changed", "Cut.")
    file = tmp_path / "events.jsonl"
    file.write_bytes(file.read_bytes()[:-20])
    reopened = EventLog(tmp_path)
    assert [event.message for event in reopened.after()] == ["Whole."]
    reopened.append("scene.changed", "After.")
    assert [event.message for event in EventLog(tmp_path).after()] == ["Whole.", "After."]


def test_unwritable_disk_does_not_stop_the_daemon(tmp_path: Path) -> None:
    log = EventLog(tmp_path / "gone")
    log.append("scene.changed", "Kept in memory.")
    assert [event.message for event in log.after()] == ["Kept in memory."]


async def test_subscriber_sees_every_event_from_then_on(tmp_path: Path) -> None:
    log = EventLog(tmp_path)
    log.append("scene.changed", "Before.")
    with log.subscribe() as feed:
        log.append("scene.changed", "First.")
        log.append("scene.changed", "Second.")
        seen = [await feed.next(), await feed.next()]
    log.append("scene.changed", "Afterwards.")
    assert [event.message for event in seen if event] == ["First.", "Second."]


async def test_subscriber_that_falls_behind_is_cut_off_without_a_gap(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(events, "SUBSCRIBER_MAX", 3)
    log = EventLog(tmp_path)
    with log.subscribe() as slow:
        for n in range(5):
            log.append("scene.changed", f"{n}")
        assert slow.overflowed
        taken = [await asyncio.wait_for(slow.next(), 1) for _ in range(4)]
    assert [event.message if event else None for event in taken] == ["0", "1", "2", None]
