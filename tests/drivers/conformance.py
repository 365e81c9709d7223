"""What every driver must do, whatever the device. A driver's test class inherits this and makes the rig.

A rig offers `driver`, `plant`, `tick(command, ticks)`, `seen()`, `connect()`, and `unplug`, `replug`,
`silence`, `speak`, `press_estop`, `release_estop`, `host_dies(ticks)`, and the figures `axes`, `has_force`.
"""

from __future__ import annotations

import math
from typing import Any

import pytest

from hapticd_drivers.hapticd_io.driver import DOWN, FRESH, MISSING
from hapticd_drivers.hapticd_io.observation import ESTOP_INPUT, OUTPUTS_LIVE

OFF = (0.0,) * 10


class DriverConformance:
    """Hooks: the fixture `rig`, and the figures below. `COMMAND` has every actuator in use."""

    COMMAND: tuple[float, ...]
    RESOLUTION: float
    TICKS_TO_LIVE = 10
    TICKS_TO_SAFE: int
    TICKS_TO_DOWN: int

    @pytest.fixture
    def live(self, rig: Any) -> Any:
        """A rig with outputs on."""
        rig.connect()
        rig.tick(OFF, 10)
        rig.tick(self.COMMAND, self.TICKS_TO_LIVE)
        return rig

    def test_a_connected_device_says_who_it_is(self, rig: Any) -> None:
        assert rig.driver.identity == ""
        assert rig.connect().driver.identity != ""

    def test_every_tick_brings_an_observation(self, rig: Any) -> None:
        rig.connect().tick()
        for _ in range(50):
            before = rig.seen()
            assert rig.tick() == FRESH
            assert rig.seen()["seq"] == before["seq"] + 1
            assert rig.seen()["t_ns"] > before["t_ns"]

    def test_nothing_is_driven_before_it_is_enabled(self, rig: Any) -> None:
        rig.connect().tick((0.0, *self.COMMAND[1:]), 20)
        assert not rig.seen()["status"] & OUTPUTS_LIVE
        assert set(rig.plant.commands) == {OFF}

    def test_every_actuator_gets_what_it_is_asked_for(self, live: Any) -> None:
        assert live.seen()["status"] & OUTPUTS_LIVE
        assert live.plant.command == pytest.approx(self.COMMAND, abs=self.RESOLUTION)

    def test_a_reversed_command_arrives_reversed(self, live: Any) -> None:
        motors = tuple(-value for value in self.COMMAND[1:7])
        live.tick((1.0, *motors, *self.COMMAND[7:]), 3)
        assert live.plant.command[1:7] == pytest.approx(motors, abs=self.RESOLUTION)

    def test_withdrawing_takes_effect_with_the_next_frame(self, live: Any) -> None:
        live.tick(OFF, 2)
        assert live.plant.command == OFF

    def test_it_can_be_enabled_again(self, live: Any) -> None:
        live.tick(OFF, 10)
        live.tick(self.COMMAND, self.TICKS_TO_LIVE)
        assert live.plant.command == pytest.approx(self.COMMAND, abs=self.RESOLUTION)

    def test_counts_and_sensors_are_those_of_the_plant(self, rig: Any) -> None:
        rig.connect()
        rig.plant.counts = tuple(c if axis < rig.axes else 0 for axis, c in enumerate((123456, -654321, 42)))
        rig.plant.force_n = (12.5, -7.25, 0.0)
        rig.tick(OFF, 3)
        assert rig.seen()["counts"] == rig.plant.counts
        if rig.has_force:
            assert rig.seen()["force_n"] == pytest.approx(rig.plant.force_n, abs=0.02)

    def test_silence_is_missing_and_leaves_the_observation_alone(self, live: Any) -> None:
        live.silence()
        live.tick(self.COMMAND)  # what was under way arrives
        before = live.seen()
        assert live.tick(self.COMMAND, 3) == MISSING
        assert live.seen() == before
        live.speak()
        live.tick(self.COMMAND, 2)
        assert live.tick(self.COMMAND) == FRESH
        assert live.seen()["seq"] > before["seq"] + 1

    def test_lasting_silence_asks_for_a_new_connection(self, live: Any) -> None:
        live.silence()
        assert live.tick(OFF, self.TICKS_TO_DOWN) == DOWN

    def test_a_device_pulled_out_is_down_and_comes_back_with_outputs_off(self, live: Any) -> None:
        live.unplug()
        assert live.tick(self.COMMAND) == DOWN
        live.driver.close()
        live.replug()
        live.connect()
        assert live.tick(OFF, 5) == FRESH
        assert live.plant.command == OFF

    def test_numbers_go_on_over_a_new_connection(self, live: Any) -> None:
        before = live.seen()
        live.driver.close()
        live.connect().tick()
        assert live.seen()["seq"] > before["seq"]
        assert live.seen()["t_ns"] > before["t_ns"]

    def test_a_dead_host_leaves_outputs_safe(self, live: Any) -> None:
        live.host_dies(self.TICKS_TO_SAFE)
        assert live.plant.command == OFF

    def test_the_estop_input_is_seen_and_stops_the_outputs(self, live: Any) -> None:
        live.press_estop()
        live.tick(self.COMMAND, 3)
        assert live.seen()["status"] & ESTOP_INPUT
        assert live.plant.command == OFF
        live.release_estop()
        live.tick(OFF, 10)
        assert not live.seen()["status"] & ESTOP_INPUT

    @pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
    def test_a_value_that_is_not_finite_never_reaches_the_device(self, live: Any, value: float) -> None:
        sent = len(live.plant.commands)
        with pytest.raises((ValueError, OverflowError)):
            live.tick((1.0, *(value,) * 9))
        live.host_dies(self.TICKS_TO_SAFE)
        assert all(map(math.isfinite, (v for command in live.plant.commands[sent:] for v in command)))
        assert live.plant.command == OFF

    def test_closing_twice_is_fine(self, rig: Any) -> None:
        rig.connect()
        rig.driver.close()
        rig.driver.close()
