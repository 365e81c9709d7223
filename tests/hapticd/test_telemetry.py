"""Telemetry: every tick arrives once, shared by all, and a slow subscriber costs only itself."""

import asyncio
import json
import math
from typing import Any

import msgpack
import numpy as np
import pytest

from hapticd.device import TickBatch
from hapticd.frame import Frame
from hapticd.problem import Problem
from hapticd.record import record_dtype
from hapticd.signals import signals
from hapticd.telemetry import PUMP_HZ, QUEUE_MAX, Delivery, Subscription, Telemetry


class Ring:
    """A source of ticks that keeps the last ``capacity``, and counts how often it is read."""

    def __init__(self, capacity: int = 1000) -> None:
        self.capacity = capacity
        self.records = np.zeros(0, record_dtype())
        self.reads = 0

    def run(self, ticks: int) -> None:
        more = np.zeros(ticks, record_dtype())
        more["tick"] = np.arange(len(self.records), len(self.records) + ticks)
        more["t_mono_ns"] = more["tick"] * 1_000_000
        more["tip_position_m"][:, 0] = more["tick"] / 1000
        more["contact_wall"] = 2**64 - 1
        self.records = np.concatenate([self.records, more])

    def restart(self) -> None:
        self.records = self.records[:0]

    def head(self) -> int:
        return len(self.records)

    def read(self, since: int, limit: int) -> TickBatch:
        self.reads += 1
        first = max(since, self.head() - self.capacity)
        return TickBatch(self.records[first : first + limit], first, first - since)


@pytest.fixture
def ring() -> Ring:
    made = Ring()
    made.run(5)
    return made


@pytest.fixture
def telemetry(ring: Ring) -> Telemetry:
    return Telemetry(ring)


async def next_of(subscription: Subscription) -> Delivery:
    return await asyncio.wait_for(subscription.next(), 1.0)


async def test_batches_hold_every_tick_from_the_subscription_on(ring: Ring, telemetry: Telemetry) -> None:
    with telemetry.subscribe(["tick"], mode="batch") as subscription:
        telemetry.pump()
        seen: list[int] = []
        for ticks in (17, 16, 1, 40):
            ring.run(ticks)
            telemetry.pump()
            delivery = await next_of(subscription)
            assert (delivery.dropped, delivery.frame.count) == (0, ticks)
            seen += delivery.frame.values["tick"]
    assert seen == list(range(5, 5 + 17 + 16 + 1 + 40))


async def test_latest_holds_the_newest_tick_as_plain_values(ring: Ring, telemetry: Telemetry) -> None:
    with telemetry.subscribe(["tick", "tip_position_m", "contact_wall"]) as subscription:
        telemetry.pump()
        ring.run(17)
        telemetry.pump()
        frame = (await next_of(subscription)).frame
    assert (frame.tick, frame.count) == (21, 1)
    assert frame.values == {"tick": 21, "tip_position_m": [0.021, 0.0, 0.0], "contact_wall": -1}


async def test_slower_batches_hold_all_the_ticks_between(ring: Ring, telemetry: Telemetry) -> None:
    with telemetry.subscribe(["tick"], rate_hz=PUMP_HZ / 4, mode="batch") as subscription:
        telemetry.pump()
        for _ in range(7):
            ring.run(10)
            telemetry.pump()
        first, second = await next_of(subscription), await next_of(subscription)
    assert first.frame.values["tick"] == list(range(5, 35))
    assert second.frame.values["tick"] == list(range(35, 75))


async def test_slow_subscriber_is_told_what_it_missed_and_the_others_miss_nothing(
    ring: Ring, telemetry: Telemetry
) -> None:
    with (
        telemetry.subscribe(["tick"], mode="batch") as slow,
        telemetry.subscribe(["tick"], mode="batch") as quick,
    ):
        telemetry.pump()
        for _ in range(QUEUE_MAX + 3):
            ring.run(10)
            telemetry.pump()
            assert (await next_of(quick)).dropped == 0
        delivery = await next_of(slow)
        assert (delivery.seq, delivery.dropped, delivery.frame.tick) == (0, 30, 35)
        assert ((await next_of(slow)).seq, (await next_of(slow)).dropped) == (1, 0)


async def test_ticks_the_ring_no_longer_had_are_told(ring: Ring, telemetry: Telemetry) -> None:
    ring.capacity = 100
    with telemetry.subscribe(["tick"], mode="batch") as subscription:
        telemetry.pump()
        ring.run(150)
        telemetry.pump()
        delivery = await next_of(subscription)
    assert (delivery.dropped, delivery.frame.tick, delivery.frame.count) == (50, 55, 100)


async def test_ring_is_read_once_and_a_frame_encoded_once_for_all(ring: Ring, telemetry: Telemetry) -> None:
    with (
        telemetry.subscribe(["tick"], mode="batch") as one,
        telemetry.subscribe(["tick"], mode="batch") as two,
        telemetry.subscribe(["tip_position_m"]),
    ):
        telemetry.pump()
        ring.reads = 0
        ring.run(17)
        telemetry.pump()
        assert ring.reads == 1
        assert (await next_of(one)).frame is (await next_of(two)).frame
        assert telemetry.subscribers == 3
    assert telemetry.subscribers == 0


async def test_restarted_servo_counts_from_zero_and_is_followed(ring: Ring, telemetry: Telemetry) -> None:
    with telemetry.subscribe(["tick"], mode="batch") as subscription:
        telemetry.pump()
        ring.restart()
        telemetry.pump()
        ring.run(3)
        telemetry.pump()
        assert (await next_of(subscription)).frame.values["tick"] == [0, 1, 2]


async def test_nobody_watching_costs_no_read(ring: Ring, telemetry: Telemetry) -> None:
    telemetry.pump()
    assert ring.reads == 0


async def test_pump_runs_by_itself(ring: Ring, telemetry: Telemetry) -> None:
    pumping = asyncio.create_task(telemetry.run())
    try:
        with telemetry.subscribe(["tick"]) as subscription:
            waiting = asyncio.create_task(subscription.next())
            while not waiting.done():
                ring.run(1)
                await asyncio.sleep(0.01)
            assert waiting.result().frame.tick >= 5
    finally:
        pumping.cancel()


def test_unknown_signal_is_named_with_those_there_are(telemetry: Telemetry) -> None:
    with pytest.raises(Problem, match="'tip_positon_m'") as caught, telemetry.subscribe(["tip_positon_m"]):
        pass
    assert caught.value.allowed is not None
    assert "tip_position_m" in caught.value.allowed


def records(count: int) -> np.ndarray[Any, Any]:
    made = np.zeros(count, record_dtype())
    made["tick"] = np.arange(count)
    made["gain"] = np.linspace(0, 1, count)
    return made


@pytest.mark.parametrize("latest", [True, False])
def test_every_signal_is_the_same_in_json_msgpack_and_python(latest: bool) -> None:
    frame = Frame(records(1 if latest else 17), tuple(signals()), latest=latest, lost=0)
    assert json.loads(frame.json) == frame.values
    assert msgpack.unpackb(frame.msgpack) == frame.values


@pytest.mark.parametrize("latest", [True, False])
def test_number_that_is_not_finite_is_sent_as_null(latest: bool) -> None:
    made = records(1 if latest else 3)
    made["gain"][0] = math.nan
    made["tip_position_m"][0] = [1.0, math.inf, 3.0]
    frame = Frame(made, ("gain", "tip_position_m"), latest=latest, lost=0)
    decoded = json.loads(frame.json)
    gain, position = decoded["gain"], decoded["tip_position_m"]
    assert (gain if latest else gain[0]) is None
    assert (position if latest else position[0]) == [1.0, None, 3.0]
    assert msgpack.unpackb(frame.msgpack) == frame.values == decoded
