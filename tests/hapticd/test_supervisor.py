"""The supervisor: a device gets its servo back, says why it is gone meanwhile, and is never left beating."""

from __future__ import annotations

import asyncio
import os
import subprocess
import sys
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import pytest

from hapticd import channel, supervisor
from hapticd.backoff import Backoff
from hapticd.heartbeat import Heartbeat
from hapticd.problem import Problem
from hapticd.supervisor import Supervisor, is_running
from tests.hapticd.conftest import Bench, make_wall
from tests.hapticd.fake_link import FakeLink


class FakeServo:
    """A servo process played in memory. ``link`` is its shared memory while it is there."""

    region = Path("unused")

    def __init__(self) -> None:
        self.link: FakeLink | None = None
        self.launches = 0
        self.stillborn: str | None = None
        self.alike = True
        self.muted_from_birth = False
        self.terminated = False
        self.dead: set[int] = set()
        self._ending: str | None = None

    @property
    def pid(self) -> int | None:
        return None if self.launches == 0 or self._ending else 1000 + self.launches

    def configured_alike(self) -> bool:
        return self.alike

    async def launch(self) -> None:
        self.launches += 1
        self._ending = self.stillborn
        if not self.stillborn:
            self.link = FakeLink(pid=1000 + self.launches)
            self.link.run()
            self.link.mute = self.muted_from_birth

    def ending(self) -> str | None:
        return self._ending

    def last_words(self) -> str:
        return "Its log ends: no such port."

    async def terminate(self) -> bool:
        self.terminated = True
        if self.launches:
            self.die("Its servo exited with code 0.")
        return True

    def die(self, why: str) -> None:
        # As after a kill: the heartbeat it left is still young.
        self.dead.add(1000 + self.launches)
        self._ending = why

    def open(self, _: Path) -> FakeLink:
        if self.link is None:
            raise FileNotFoundError
        return self.link


class Watch:
    """A supervisor at work on a bench."""

    def __init__(self, bench: Bench) -> None:
        self.bench = bench
        self.servo = FakeServo()
        self.heartbeat = Heartbeat()
        self.supervisor = Supervisor(
            bench.device,
            self.servo,
            self.heartbeat,
            bench.events,
            open_link=self.servo.open,
            is_running=lambda pid: pid not in self.servo.dead,
            backoff=Backoff(first_s=0.01, longest_s=0.05),
        )
        self.task: asyncio.Task[None] | None = None

    def start(self) -> None:
        self.task = asyncio.create_task(self.supervisor.run())

    async def stop(self) -> None:
        await self.supervisor.stop()
        if self.task is not None:
            await asyncio.wait_for(self.task, 5.0)

    @property
    def state(self) -> str:
        return self.bench.device.snapshot().state

    @property
    def why(self) -> str | None:
        return self.bench.device.snapshot().health.why

    @property
    def link(self) -> FakeLink:
        assert self.servo.link is not None
        return self.servo.link

    async def until(self, condition: Callable[[], bool]) -> None:
        """Waits for something to become true, a few seconds at most."""
        async with asyncio.timeout(5.0):
            while not condition():  # noqa: ASYNC110 - plain attributes announce nothing
                await asyncio.sleep(0.002)


@pytest.fixture
async def watch(bench: Bench, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Watch]:
    monkeypatch.setattr(supervisor, "WATCH_S", 0.005)
    monkeypatch.setattr(supervisor, "RESTORE_AGAIN_S", 0.01)
    monkeypatch.setattr(supervisor, "EXPLAIN_S", 0.005)
    made = Watch(bench)
    yield made
    await made.stop()


async def test_servo_is_started_beaten_to_and_given_the_scene(watch: Watch) -> None:
    await watch.bench.device.put_wall(make_wall("floor"))
    watch.start()
    await watch.until(lambda: watch.bench.device.scene_in_force)
    assert (watch.servo.launches, watch.state, watch.link.beats) == (1, "disabled", 1)
    assert watch.bench.kinds()[-1] == "servo.attached"
    assert watch.bench.device.snapshot().health.pid == 1001


async def test_living_servo_is_attached_to_and_not_started_again(watch: Watch) -> None:
    watch.servo.link = FakeLink(pid=77)
    watch.servo.link.run()
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    assert watch.servo.launches == 0


async def test_living_servo_of_another_configuration_is_replaced(watch: Watch) -> None:
    outdated = FakeLink(pid=77)
    outdated.run()
    watch.servo.link, watch.servo.alike = outdated, False
    watch.start()
    await watch.until(lambda: bool(outdated.requests))
    assert outdated.requests == [{"type": "stop"}]
    assert watch.servo.launches == 0
    outdated.alive = False
    await watch.until(lambda: watch.state == "disabled")
    assert (watch.servo.launches, outdated.closed) == (1, True)


def test_process_is_known_to_run_or_not() -> None:
    assert is_running(os.getpid())
    assert is_running(1)
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    assert not is_running(gone.pid)


async def test_servo_of_another_device_is_left_alone(watch: Watch) -> None:
    stranger = FakeLink("hhd", pid=77)
    watch.servo.link = stranger
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    assert (watch.servo.launches, stranger.requests, stranger.closed) == (1, [], True)


async def test_dead_servo_takes_its_device_offline_and_comes_back_disabled(
    watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    watch.start()
    await watch.until(lambda: watch.bench.device.scene_in_force)
    await watch.bench.device.set_desired("enabled")
    dead = watch.link
    monkeypatch.setattr(watch.servo, "stillborn", "Its servo exited with code 1.")
    watch.servo.die("Its servo was killed by signal 9.")
    await watch.until(lambda: watch.state == "offline")
    await watch.until(lambda: dead.closed)
    beats = dead.beats
    watch.heartbeat.beat()
    assert dead.beats == beats
    lost = [event for event in watch.bench.events.after() if event.kind == "servo.lost"]
    assert lost[0].message == "phantom lost its servo. Its servo was killed by signal 9."
    await watch.until(lambda: "servo.failed" in watch.bench.kinds())
    assert watch.why == "Its servo exited with code 1."
    watch.servo.stillborn = None
    await watch.until(lambda: watch.state == "disabled")
    assert watch.bench.device.snapshot().health.restarts == 1


async def test_device_that_does_not_answer_its_servo_says_what_the_driver_met(watch: Watch) -> None:
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    watch.link.state = "offline"
    watch.link.run()
    await watch.until(lambda: watch.why is not None)
    assert watch.why == "Its servo runs, but the device does not answer. Its log ends: no such port."
    assert watch.bench.device.snapshot().health.online
    watch.link.state = "disabled"
    watch.link.run()
    await watch.until(lambda: watch.why is None)


async def test_servo_that_stops_beating_counts_as_gone(watch: Watch) -> None:
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    silent = watch.link
    silent.alive = False
    await watch.until(lambda: watch.servo.launches == 2)
    assert silent.closed
    messages = [event.message for event in watch.bench.events.after() if event.kind == "servo.lost"]
    assert messages == ["phantom lost its servo. Its servo stopped beating."]


async def test_scene_is_offered_again_until_the_loop_takes_it(
    watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(channel, "ACK_TIMEOUT_S", 0.01)
    await watch.bench.device.put_wall(make_wall("floor"))
    living = FakeLink()
    living.run()
    living.mute = True
    watch.servo.link = living
    watch.start()
    await watch.until(lambda: watch.bench.kinds().count("scene.not_restored") == 2)
    living.mute = False
    await watch.until(lambda: watch.bench.device.scene_in_force)


async def test_fault_of_the_supervisor_does_not_leave_the_device_without_one(
    watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    first = watch.link
    first.told = [{"seq": 0, "kind": "state", "tick": 1, "t_mono_ns": 1, "details": {}}]
    await watch.until(lambda: first.closed)
    await watch.until(lambda: watch.state == "disabled" and watch.bench.device.scene_in_force)
    assert "servo.failed" in watch.bench.kinds()


async def test_cancelled_supervisor_lets_go_of_a_servo_that_runs_on(watch: Watch) -> None:
    watch.servo.link = FakeLink(pid=77)
    watch.servo.link.run()
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    assert watch.task is not None
    watch.task.cancel()
    with pytest.raises(asyncio.CancelledError):
        await watch.task
    watch.task = None
    assert (watch.state, watch.why, watch.link.closed) == ("offline", "Its supervisor was interrupted.", True)


async def test_edit_nobody_acknowledged_does_not_stay_in_the_loop(
    watch: Watch, monkeypatch: pytest.MonkeyPatch
) -> None:
    watch.start()
    await watch.until(lambda: watch.bench.device.scene_in_force)
    monkeypatch.setattr(channel, "ACK_TIMEOUT_S", 0.02)
    watch.link.forgetful = True
    with pytest.raises(Problem, match="did not acknowledge"):
        await watch.bench.device.put_wall(make_wall("floor"))
    watch.link.forgetful = False
    await watch.until(lambda: watch.bench.device.scene_in_force)
    assert watch.link.requests[-1]["scene"]["walls"] == []


async def test_estop_is_not_lost_when_servo_after_servo_dies(watch: Watch) -> None:
    watch.start()
    await watch.until(lambda: watch.bench.device.scene_in_force)
    await watch.bench.device.engage_estop()
    watch.servo.muted_from_birth = True
    watch.servo.die("Its servo was killed by signal 9.")
    await watch.until(lambda: watch.servo.launches == 2 and watch.state == "disabled")
    watch.servo.muted_from_birth = False
    watch.servo.die("Its servo was killed by signal 9.")
    await watch.until(lambda: watch.servo.launches == 3 and watch.bench.device.scene_in_force)
    assert watch.bench.device.snapshot().flags.estop


async def test_lasting_failure_is_told_once(watch: Watch) -> None:
    watch.servo.stillborn = "Its servo exited with code 1."
    watch.start()
    await watch.until(lambda: watch.servo.launches >= 5)
    watch.servo.stillborn = "Its servo exited with code 2."
    await watch.until(lambda: watch.why == "Its servo exited with code 2.")
    assert watch.bench.kinds().count("servo.failed") == 2


async def test_servo_that_others_started_runs_on_when_the_daemon_stops(watch: Watch) -> None:
    watch.servo.link = FakeLink(pid=77)
    watch.servo.link.run()
    watch.start()
    await watch.until(lambda: watch.bench.device.scene_in_force)
    await watch.stop()
    assert (watch.state, watch.why, watch.link.closed) == ("offline", "The daemon is stopping.", True)
    assert {"type": "stop"} not in watch.link.requests


async def test_stopping_ends_the_servo_for_good(watch: Watch) -> None:
    watch.start()
    await watch.until(lambda: watch.state == "disabled")
    await watch.stop()
    assert watch.servo.terminated
    assert watch.servo.launches == 1
    assert "servo.lost" not in watch.bench.kinds()


async def test_stopping_does_not_wait_for_the_back_off(watch: Watch) -> None:
    watch.servo.stillborn = "Its servo exited with code 1."
    watch.start()
    await watch.until(lambda: watch.servo.launches >= 3)
    await watch.stop()
    assert watch.task is not None
    assert watch.task.done()
