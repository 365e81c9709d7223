"""The heartbeat: it beats while the event loop runs, and only then."""

import asyncio
import threading
import time

from hapticd.heartbeat import Heartbeat


class Pulse:
    def __init__(self, broken: bool = False) -> None:
        self.beats = 0
        self.broken = broken
        self.felt = threading.Event()

    def heartbeat(self) -> None:
        self.beats += 1
        self.felt.set()
        if self.broken:
            raise RuntimeError("the region is gone")


def test_link_is_beaten_to_at_once_and_no_more_once_removed() -> None:
    heartbeat, pulse = Heartbeat(), Pulse()
    heartbeat.add(pulse)
    assert pulse.beats == 1
    heartbeat.beat()
    heartbeat.remove(pulse)
    heartbeat.beat()
    assert pulse.beats == 2


def test_thread_beats_while_the_event_loop_is_busy() -> None:
    heartbeat, pulse = Heartbeat(stall_s=60.0), Pulse()
    heartbeat.start()
    try:
        heartbeat.add(pulse)
        pulse.felt.clear()
        assert pulse.felt.wait(10.0)
    finally:
        heartbeat.stop()


async def test_heartbeat_stops_under_a_wedged_event_loop_and_comes_back() -> None:
    heartbeat, pulse = Heartbeat(stall_s=0.05), Pulse()
    watching = asyncio.create_task(heartbeat.watch_loop())
    await asyncio.sleep(0)
    heartbeat.add(pulse)
    time.sleep(0.1)  # noqa: ASYNC251 - the wedge itself
    heartbeat.beat()
    assert pulse.beats == 1
    await asyncio.sleep(0.02)
    heartbeat.beat()
    assert pulse.beats == 2
    watching.cancel()


def test_one_broken_region_does_not_cost_the_others_their_heartbeat() -> None:
    heartbeat, broken, well = Heartbeat(), Pulse(), Pulse()
    heartbeat.add(broken)
    heartbeat.add(well)
    broken.broken = True
    heartbeat.beat()
    heartbeat.beat()
    assert (broken.beats, well.beats) == (2, 3)
