"""A device: what it refuses and why, and what its snapshot says."""

import asyncio

import pytest

from hapticd import channel
from hapticd.hand import HAND_SCRIPT
from hapticd.injection import INJECTION
from hapticd.problem import Problem
from tests.hapticd.conftest import Bench, make_wall, settle


@pytest.fixture
async def attached(bench: Bench) -> Bench:
    await bench.attach()
    return bench


async def test_device_without_a_servo_is_offline_and_says_why(bench: Bench) -> None:
    snapshot = bench.device.snapshot()
    assert (snapshot.state, snapshot.health.online, snapshot.tick) == ("offline", False, None)
    assert snapshot.health.why == "Its servo has not started yet."
    assert [entry.id for entry in snapshot.interlocks if not entry.ok] == ["offline"]
    assert bench.device.realtime() is None
    assert len(bench.device.read(0, 10).records) == 0
    with pytest.raises(Problem) as caught:
        await bench.device.set_desired("enabled")
    assert (caught.value.slug, caught.value.retryable) == ("device-offline", True)


async def test_enabling_tells_when_it_took_effect(attached: Bench) -> None:
    applied = await attached.device.set_desired("enabled")
    snapshot = attached.device.snapshot()
    assert snapshot.state == "enabled"
    assert (applied.tick, applied.fade_s) == (snapshot.tick, snapshot.limits.ramp_s)
    assert applied.t_mono_ns == snapshot.t_mono_ns


async def test_limits_that_act_are_named_in_the_answer(attached: Bench) -> None:
    attached.link.record["limits"] = 0b1001
    assert (await attached.device.set_desired("enabled")).clamped == ["voltage", "slew"]


async def test_enabling_under_an_estop_lists_the_interlock_and_its_cure(attached: Bench) -> None:
    await attached.device.engage_estop()
    assert attached.device.snapshot().flags.estop
    with pytest.raises(Problem) as caught:
        await attached.device.set_desired("enabled")
    problem = caught.value
    assert (problem.slug, problem.status, problem.current_state) == ("interlock-open", 409, "disabled")
    assert problem.interlocks is not None
    assert [entry["id"] for entry in problem.interlocks] == ["estop-latched"]
    assert "acknowledge the E-stop" in problem.hint
    await attached.device.acknowledge_estop()
    assert (await attached.device.set_desired("enabled")).tick > 0


async def test_step_the_machine_does_not_have_says_which_it_has(attached: Bench) -> None:
    with pytest.raises(Problem) as caught:
        await attached.device.set_desired("paused")
    assert (caught.value.slug, caught.value.current_state) == ("state-refused", "disabled")
    assert caught.value.allowed == ["enabled"]


async def test_word_that_is_no_state_never_reaches_the_servo(attached: Bench) -> None:
    with pytest.raises(Problem) as caught:
        await attached.device.set_desired("fast")
    assert caught.value.allowed == ["enabled", "disabled", "paused"]
    assert attached.link.requests == []


async def test_fault_names_cause_and_cure_until_it_is_acknowledged(attached: Bench) -> None:
    attached.link.raise_fault("encoder-jump")
    (fault,) = attached.device.snapshot().faults
    assert (fault.id, fault.severity) == ("encoder-jump", "stop_now")
    assert fault.cause
    assert fault.cure
    await attached.device.acknowledge_fault("encoder-jump")
    assert attached.device.snapshot().faults == []
    assert attached.device.snapshot().state == "disabled"


async def test_fault_that_is_not_latched_cannot_be_acknowledged(attached: Bench) -> None:
    attached.link.raise_fault("encoder-jump")
    for slug in ("amplifier", "no-such-fault"):
        with pytest.raises(Problem) as caught:
            await attached.device.acknowledge_fault(slug)
        assert (caught.value.slug, caught.value.allowed) == ("fault-not-found", ["encoder-jump"])


async def test_silent_servo_is_a_problem_and_not_a_wait_for_ever(
    attached: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(channel, "ACK_TIMEOUT_S", 0.02)
    attached.link.mute = True
    with pytest.raises(Problem) as caught:
        await attached.device.set_desired("enabled")
    assert (caught.value.slug, caught.value.status, caught.value.retryable) == ("servo-silent", 504, True)


async def test_full_queue_is_told_at_once(attached: Bench) -> None:
    attached.link.full = True
    with pytest.raises(Problem) as caught:
        await attached.device.engage_estop()
    assert caught.value.slug == "servo-busy"


async def test_losing_the_servo_ends_requests_that_wait(attached: Bench) -> None:
    attached.link.mute = True
    waiting = asyncio.create_task(attached.device.set_desired("enabled"))
    await settle()
    attached.device.detach("Its servo was killed by signal 9.")
    with pytest.raises(Problem, match="signal 9") as caught:
        await waiting
    assert caught.value.slug == "device-offline"
    assert attached.device.snapshot().state == "offline"


async def test_estop_does_not_wait_behind_an_edit_that_hangs(attached: Bench) -> None:
    attached.link.mute = True
    edit = asyncio.create_task(attached.device.put_wall(make_wall("floor")))
    await attached.sent()
    attached.link.mute = False
    await attached.device.engage_estop()
    assert attached.device.snapshot().flags.estop
    assert not edit.done()
    attached.device.detach("The test is over.")
    with pytest.raises(Problem):
        await edit


async def test_wall_in_contact_is_named(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("off", enabled=False))
    await attached.device.put_wall(make_wall("floor"))
    attached.link.record["contact_wall"] = 0
    attached.link.run()
    assert attached.device.snapshot().contact_wall == "floor"
    attached.link.record["contact_wall"] = 2**64 - 1
    attached.link.run()
    assert attached.device.snapshot().contact_wall is None


async def test_hand_script_reaches_the_twin_padded_to_its_axes(attached: Bench) -> None:
    script = HAND_SCRIPT.validate_python({"target_m": [0.1, 0, 0.02]})
    await attached.device.set_hand(script)
    assert attached.device.hand == script
    assert attached.link.requests[-1] == {
        "type": "hand",
        "script": {"type": "follow", "target_m": [0.1, 0.0, 0.02]},
    }


async def test_hand_script_of_another_dimension_is_refused(attached: Bench) -> None:
    before = attached.device.hand
    with pytest.raises(Problem) as caught:
        await attached.device.set_hand(HAND_SCRIPT.validate_python({"target_m": [0.1, 0.02]}))
    assert (caught.value.slug, caught.value.pointer) == ("dimension-mismatch", "/target_m")
    assert attached.device.hand == before


async def test_injection_reaches_the_twin(attached: Bench) -> None:
    injection = INJECTION.validate_python({"type": "drop_frames", "fraction": 0.5, "duration_s": 0.1})
    await attached.device.inject(injection)
    assert attached.link.requests[-1]["injection"] == {
        "type": "drop_frames",
        "fraction": 0.5,
        "duration_s": 0.1,
    }


async def test_hardware_has_no_simulated_hand(bench: Bench) -> None:
    device = Bench(bench.state_dir, driver="hapticd_io").device
    with pytest.raises(Problem, match="driven by hapticd_io") as caught:
        await device.set_hand(HAND_SCRIPT.validate_python({"type": "free"}))
    assert caught.value.slug == "not-a-twin"
    with pytest.raises(Problem, match="not by a twin"):
        await device.inject(INJECTION.validate_python({"type": "silence"}))
    with pytest.raises(Problem, match="not by a twin"):
        _ = device.hand


async def test_servo_that_comes_back_gets_hand_and_scene_again(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"))
    await attached.device.set_hand(
        HAND_SCRIPT.validate_python({"type": "push", "direction": [0, 0, -1], "force_n": 2})
    )
    attached.device.detach("Its servo was killed by signal 9.")
    fresh = Bench(attached.state_dir).link
    fresh.run()
    attached.device.attach(fresh)
    await attached.device.restore()
    assert [request["type"] for request in fresh.requests] == ["hand", "scene"]
    assert [wall["law"]["eta"] for wall in fresh.requests[1]["scene"]["walls"]] == [0.0]
    snapshot = attached.device.snapshot()
    assert (snapshot.state, snapshot.scene_in_force, snapshot.health.restarts) == ("disabled", True, 1)


async def test_estop_outlives_the_servo_that_latched_it(attached: Bench) -> None:
    await attached.device.engage_estop()
    attached.device.detach("Its servo was killed by signal 9.")
    fresh = Bench(attached.state_dir).link
    fresh.run()
    attached.device.attach(fresh)
    await attached.device.restore()
    assert attached.device.snapshot().flags.estop
    await attached.device.acknowledge_estop()
    attached.device.detach("Its servo was killed by signal 9.")
    attached.device.attach(Bench(attached.state_dir).link)
    await attached.device.restore()
    assert not attached.device.snapshot().flags.estop


async def test_estop_pressed_without_a_servo_is_latched_in_the_next_one(bench: Bench) -> None:
    assert await bench.device.engage_estop() is None
    assert bench.device.snapshot().flags.estop
    await bench.attach()
    assert bench.device.snapshot().flags.estop


async def test_estop_acknowledged_before_a_servo_came_is_forgotten(bench: Bench) -> None:
    await bench.device.engage_estop()
    assert await bench.device.acknowledge_estop() is None
    await bench.attach()
    assert not bench.device.snapshot().flags.estop


async def test_what_the_servo_tells_becomes_events_in_words(attached: Bench) -> None:
    attached.link.told = [
        {"seq": 0, "kind": "state", "tick": 5, "t_mono_ns": 5, "details": {"from": "enabled", "to": "fault"}},
    ]
    attached.device.tell_servo_events()
    event = attached.events.after()[-1]
    assert (event.kind, event.device_id, event.tick) == ("servo.state", "phantom", 5)
    assert event.message == "phantom went from enabled to fault."


async def test_passivity_control_is_told_with_the_id_of_its_wall(attached: Bench) -> None:
    await attached.device.put_wall(make_wall("floor"))
    details = {"wall": 0, "acting": True, "energy_j": 0.002, "damping_n_s_per_m": 90.0}
    attached.link.told = [{"seq": 0, "kind": "passivity", "tick": 5, "t_mono_ns": 5, "details": details}]
    attached.device.tell_servo_events()
    event = attached.events.after()[-1]
    assert event.kind == "passivity.acted"
    assert event.details == {**details, "wall": "floor"}


async def test_new_front_does_not_repeat_what_the_one_before_it_told(attached: Bench) -> None:
    details = {"from": "enabled", "to": "fault"}
    attached.link.told = [{"seq": 0, "kind": "state", "tick": 5, "t_mono_ns": 5, "details": details}]
    attached.device.tell_servo_events()
    again = Bench(attached.state_dir)
    again.link.told = [
        {"seq": 0, "kind": "state", "tick": 5, "t_mono_ns": 5, "details": details},
        {"seq": 1, "kind": "front", "tick": 9, "t_mono_ns": 9, "details": {"alive": True}},
    ]
    again.device.attach(again.link)
    again.device.tell_servo_events()
    assert again.kinds() == ["servo.state", "servo.front"]


async def test_misses_are_reported_with_their_context_but_do_not_fill_the_log(attached: Bench) -> None:
    details = {"skipped": 2, "phase": "exchange", "lateness_ns": 1, "exchange_ns": 3_000_000, "compute_ns": 2}
    before = attached.kinds().count("servo.miss")
    for tick in range(500):
        attached.link.told.append(
            {"seq": tick, "kind": "miss", "tick": tick, "t_mono_ns": tick, "details": details}
        )
        attached.device.tell_servo_events()
    report = attached.device.realtime()
    assert report is not None
    assert (report.misses[-1].tick, report.misses[-1].phase) == (499, "exchange")
    assert len(report.misses) == 100
    assert report.scheduling.policy == "fifo"
    # Empty buckets above the longest duration are left out.
    assert (report.lateness.counts, report.lateness.edges_ns) == ([0, 1], [0, 1000, 2000])
    assert attached.kinds().count("servo.miss") == before + 1


async def test_ticks_are_read_as_records(attached: Bench) -> None:
    attached.link.run(20)
    attached.link.forget(4)
    batch = attached.device.read(0, 10)
    assert (batch.first, batch.lost, batch.records["tick"].tolist()) == (4, 4, list(range(4, 14)))
