"""The driver over an emulated board, in virtual time."""

from __future__ import annotations

from typing import Any

import pytest

from hapticd_drivers.error import NoAnswer, WrongDevice
from hapticd_drivers.hapticd_io.board import Board
from hapticd_drivers.hapticd_io.driver import DOWN, FRESH, MISSING
from hapticd_drivers.hapticd_io.observation import (
    AMPLIFIER_FAULT,
    BOARD_WATCHDOG,
    CURRENT_PRESENT,
    FORCE_PRESENT,
    HOMED,
    OUTPUTS_LIVE,
    SENSOR_SATURATED,
)
from hapticd_drivers.line import LineFaults
from tests.drivers.conformance import OFF, DriverConformance
from tests.drivers.device_rig import Rig

HHD = (1.0, 0.0, 0.0, 0.0, 5.0, -3.0, 0.0, 2.0, 1.0, 0.0)
PHANTOM = (1.0, 20.0, -0.5, 3.25, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


class OverEmulator(DriverConformance):
    RESOLUTION = 1.3e-3
    TICKS_TO_SAFE = 55
    TICKS_TO_DOWN = 1100


class TestHhdBoardPaced(OverEmulator):
    COMMAND = HHD

    @pytest.fixture
    def rig(self) -> Rig:
        return Rig("hhd", "device")


class TestHhdHostPaced(OverEmulator):
    COMMAND = HHD

    @pytest.fixture
    def rig(self) -> Rig:
        return Rig("hhd", "host")


class TestPhantomBoardPaced(OverEmulator):
    COMMAND = PHANTOM

    @pytest.fixture
    def rig(self) -> Rig:
        return Rig("phantom-1.0", "device", 2000)

    TICKS_TO_SAFE = 110
    TICKS_TO_DOWN = 2200


@pytest.fixture
def live() -> Rig:
    rig = Rig("hhd", "host").connect()
    rig.tick(OFF, 10)
    rig.tick(HHD, 10)
    return rig


def test_another_board_than_the_configured_one_is_refused() -> None:
    with pytest.raises(WrongDevice, match="0011223344556677 is configured"):
        Rig(uid="0011223344556677").connect()


def test_a_board_exchanged_between_two_connections_is_refused() -> None:
    rig = Rig(uid="").connect()
    rig.cable.device.board.description = rig.description._replace(uid=b"another1")
    with pytest.raises(WrongDevice):
        rig.connect()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"encoders": 1}, "encoders names channel 1, the board has 1"),
        ({"analog_out": 3}, "brake_nm_per_a names channel 3, the board has 3"),
        ({"analog_in": 1}, "force_inputs names channel 1"),
        ({"ao_units": (1, 2, 2, 2, 0, 0, 0, 0)}, "wants outputs in V, output 1 of the board is in A"),
        ({"ao_full_scale": (7000, 10_000, 1000, 1000, 0, 0, 0, 0)}, "output 0 reaches 19.4.*allows 22.2"),
        ({"watchdog_max": 400}, "watchdog_s is at most 0.04"),
        ({"tick_max_hz": 1500}, "refuses"),
    ],
)
def test_a_board_that_does_not_fit_is_refused_with_the_reason(change: dict[str, Any], words: str) -> None:
    rig = Rig()
    rig.cable.device.board.description = rig.description._replace(**change)
    with pytest.raises(WrongDevice, match=words):
        rig.connect()


def test_something_that_does_not_speak_the_protocol_is_no_answer() -> None:
    rig = Rig()
    rig.silence()
    with pytest.raises(NoAnswer, match="DESCRIBE_REQ"):
        rig.connect()
    assert rig.cable.now_s < 1.0


def test_a_board_that_never_sends_state_is_no_answer() -> None:
    rig = Rig()
    rig.cable.device.board.state = lambda: b""
    with pytest.raises(NoAnswer, match="sends no STATE"):
        rig.connect()


def test_settings_get_through_a_line_that_loses_a_third_of_all_frames() -> None:
    rig = Rig()
    rig.cable.spoil(LineFaults(lose=0.33), seed=3)
    assert rig.connect().driver.identity


def test_present_bits_tell_what_is_wired(live: Rig) -> None:
    assert live.seen()["status"] == FORCE_PRESENT | HOMED | OUTPUTS_LIVE
    phantom = Rig("phantom-1.0", current_inputs=[0, 1, 2], current_a_per_v=[1.0, 1.0, 1.0]).connect()
    phantom.tick()
    assert phantom.seen()["status"] == CURRENT_PRESENT | HOMED


def test_a_force_past_the_range_is_told_as_saturated(live: Rig) -> None:
    live.plant.force_n = (1000.0, 0.0, 0.0)
    live.tick(HHD, 2)
    assert live.seen()["status"] & SENSOR_SATURATED


def test_a_turned_and_biased_force_sensor_reads_in_the_base_frame() -> None:
    matrix = [[0.0, -40.0], [40.0, 0.0]]
    rig = Rig(force_inputs=[1, 0], force_n_per_v=matrix, force_bias_v=[0.5, -0.25]).connect()
    raw = [round((-0.25 + 0.2) * 3276.8), round((0.5 + 0.1) * 3276.8), 0, 0, 0, 0, 0, 0]
    assert rig.driver._wiring.force.to_axes(raw) == pytest.approx([-8.0, 4.0, 0.0], abs=0.02)


def test_a_restarted_board_is_down_until_it_is_set_up_again(live: Rig) -> None:
    live.cable.device.board = Board(live.description)
    live.cable.device.board.host_paced = True
    assert live.tick(HHD) == DOWN
    live.connect()
    assert live.tick(OFF, 3) == FRESH


def test_an_expired_watchdog_is_told_while_outputs_are_wanted_and_cleared_once_they_are_not(
    live: Rig,
) -> None:
    live.host_dies(60)
    live.tick(HHD)
    assert live.seen()["status"] & BOARD_WATCHDOG
    assert not live.seen()["status"] & OUTPUTS_LIVE
    live.tick(HHD, 20)
    assert not live.seen()["status"] & OUTPUTS_LIVE, "never live again while the core still asks for outputs"
    live.tick(OFF, 5)
    assert not live.seen()["status"] & BOARD_WATCHDOG
    live.tick(HHD, 10)
    assert live.seen()["status"] & OUTPUTS_LIVE


def test_a_board_just_switched_on_reports_no_fault(live: Rig) -> None:
    fresh = Rig("hhd", "host").connect()
    fresh.tick()
    assert not fresh.seen()["status"] & BOARD_WATCHDOG


def test_an_amplifier_fault_is_told_and_stops_the_outputs(live: Rig) -> None:
    live.plant.status |= AMPLIFIER_FAULT
    live.tick(HHD, 3)
    assert live.seen()["status"] & AMPLIFIER_FAULT
    assert live.plant.command == OFF


def test_enabling_in_the_tick_after_withdrawing_still_goes_live(live: Rig) -> None:
    live.tick(OFF)
    live.tick(HHD, 12)
    assert live.seen()["status"] & OUTPUTS_LIVE


def test_a_fault_long_after_connecting_can_still_be_cleared() -> None:
    """The frame counter has wrapped past the half of its range since the last withdrawal."""
    rig = Rig("hhd", "host").connect()
    for _ in range(3):
        rig.tick(OFF, 5)
        rig.driver._link._seq = rig.driver._link.seq + 20_000 & 0xFFFF
    rig.press_estop()
    rig.tick(OFF, 5)
    rig.release_estop()
    rig.tick(OFF, 5)
    rig.tick(HHD, 10)
    assert rig.seen()["status"] & OUTPUTS_LIVE


def test_the_board_itself_bounds_a_host_gone_wrong(live: Rig) -> None:
    live.driver._wiring.outputs[:] = [o._replace(low=-32767, high=32767) for o in live.driver._wiring.outputs]
    live.tick((1.0, 0.0, 0.0, 0.0, 1e6, -1e6, 0.0, 1e6, -1e6, 0.0), 3)
    assert live.plant.command[4:9] == pytest.approx((22.2, -22.2, 0.0, 10.0, 0.0), abs=1e-3)


def test_only_the_newest_state_counts_when_several_wait() -> None:
    rig = Rig("hhd", "device").connect()
    rig.tick(OFF, 2)
    before = rig.seen()
    rig.host_dies(5)
    rig.plant.counts = (7, 0, 0)
    rig.host_dies(1)
    assert rig.tick() == FRESH
    assert rig.seen()["seq"] >= before["seq"] + 5
    assert rig.seen()["counts"][0] == 7


def test_after_a_long_pause_the_first_observation_is_not_an_old_one() -> None:
    """A port keeps no more than 4096 bytes for a reader: after a pause those are the oldest."""
    rig = Rig("hhd", "device").connect()
    rig.tick(OFF, 2)
    rig.host_dies(100)
    rig.plant.counts = (7, 0, 0)
    rig.host_dies(1)
    outcomes = [rig.tick() for _ in range(3)]
    assert FRESH in outcomes
    assert rig.seen()["counts"][0] == 7
    assert rig.driver.statistics()["lost"] >= 95
    assert rig.driver.statistics()["malformed"] == 0


def test_an_exchange_never_waits_longer_than_it_may(live: Rig) -> None:
    live.silence()
    for _ in range(20):
        start_s = live.cable.now_s
        live.driver.exchange(memoryview(bytes(80)), memoryview(live.observation))
        assert live.cable.now_s - start_s <= live.options.reply_timeout_s + 1e-12


def test_a_half_written_command_spoils_no_other(live: Rig) -> None:
    live.cable.taken = 20
    live.tick(HHD)
    live.cable.taken = 1 << 30
    counters = live.cable.device.board.link.counters
    good, bad = counters.frames, counters.malformed + counters.checksum_errors
    live.tick(HHD, 3)
    assert counters.frames == good + 3
    assert counters.malformed + counters.checksum_errors == bad + 1


@pytest.mark.parametrize("pacing", ["device", "host"])
@pytest.mark.parametrize("spec", ["lose=0.1", "corrupt=0.1", "duplicate=0.2", "reorder=0.2", "delay=0.003"])
def test_a_bad_cable_loses_ticks_but_never_gives_a_wrong_value(pacing: str, spec: str) -> None:
    rig = Rig("hhd", pacing).connect()
    rig.plant.counts = (1, 2, 0)
    rig.tick(OFF, 10)
    rig.cable.spoil(LineFaults.parse(spec), seed=11)
    outcomes = set()
    for tick in range(400):
        rig.plant.counts = (1000 + tick, -tick, 0)
        last = rig.seen()
        outcome = rig.tick(HHD)
        outcomes.add(outcome)
        if outcome == FRESH:
            first, second, _ = rig.seen()["counts"]
            assert rig.seen()["seq"] > last["seq"]
            assert second == 1000 - first or (first, second) == (1, 2)
        else:
            assert rig.seen() == last
        for _, _, _, _, m1, m2, _, b1, b2, _ in rig.plant.commands[-1:]:
            assert (m1, m2, b1, b2) == pytest.approx(HHD[4:6] + HHD[7:9], abs=1.3e-3) or (m1, m2, b1, b2) == (
                0.0,
            ) * 4
    assert outcomes <= {FRESH, MISSING}
    statistics = rig.driver.statistics()
    told = {"lose": "lost", "corrupt": "lost", "duplicate": "stale", "reorder": "stale", "delay": "missing"}
    assert statistics[told[spec.split("=")[0]]] > 0


def test_damaged_frames_are_counted() -> None:
    rig = Rig("hhd", "device").connect()
    rig.cable.spoil(LineFaults(corrupt=0.2), seed=5)
    rig.tick(OFF, 200)
    statistics = rig.driver.statistics()
    assert statistics["checksum_errors"] + statistics["malformed"] >= 20
    assert statistics["lost"] >= 20
