"""When an emulated board drives its outputs (docs/io-frame.md §7)."""

from __future__ import annotations

from itertools import product

import pytest

from hapticd_drivers.hapticd_io.enable_sequence import COMMANDS_TO_LIVE, EnableSequence
from hapticd_drivers.hapticd_io.protocol import FAULT_ESTOP, FAULT_WATCHDOG

CLEAR = {"enable": False, "clear": True, "causes": 0}
REST = {"enable": False, "clear": False, "causes": 0}
ENABLE = {"enable": True, "clear": False, "causes": 0}


def feed(sequence: EnableSequence, *commands: dict[str, int]) -> EnableSequence:
    for command in commands:
        sequence.command(**command)
    return sequence


def live() -> EnableSequence:
    return feed(EnableSequence(described=True), CLEAR, ENABLE, ENABLE, ENABLE)


def test_the_third_command_in_a_row_makes_outputs_live() -> None:
    sequence = feed(EnableSequence(described=True), CLEAR)
    states = [(feed(sequence, ENABLE).enabled, sequence.live) for _ in range(COMMANDS_TO_LIVE)]
    assert states == [(True, False), (True, False), (True, True)]


@pytest.mark.parametrize(
    "commands",
    [
        pytest.param([REST, *[ENABLE] * 9], id="power-up fault not cleared"),
        pytest.param([ENABLE | {"clear": True}] * 9, id="cleared while enabled"),
        pytest.param([CLEAR, CLEAR | {"enable": True}, ENABLE, REST, ENABLE, ENABLE, REST], id="streak cut"),
        pytest.param([CLEAR | {"causes": FAULT_ESTOP}, *[ENABLE] * 9], id="cause persists"),
    ],
)
def test_no_short_cut_leads_to_live(commands: list[dict[str, int]]) -> None:
    assert not feed(EnableSequence(described=True), *commands).live


def test_a_host_that_never_asked_what_the_board_is_gets_no_outputs() -> None:
    assert not feed(EnableSequence(), CLEAR, REST, *[ENABLE] * 9).live


@pytest.mark.parametrize("fault", [FAULT_WATCHDOG, FAULT_ESTOP])
def test_after_a_fault_live_takes_clear_and_a_rising_enable(fault: int) -> None:
    sequence = live()
    sequence.trip(fault)
    assert (sequence.live, sequence.enabled, sequence.safe, sequence.fault) == (False, False, True, fault)
    assert not feed(sequence, *[ENABLE] * 9).live
    assert not feed(sequence, REST, *[ENABLE] * 9).live
    assert feed(sequence, CLEAR, *[ENABLE] * 3).live


def test_after_withdrawing_live_takes_clear_too() -> None:
    sequence = feed(live(), REST)
    assert (sequence.live, sequence.safe, sequence.fault) == (False, True, 0)
    assert not feed(sequence, *[ENABLE] * 9).live
    assert feed(sequence, CLEAR, *[ENABLE] * 3).live


def test_clear_acts_on_its_rising_edge_only() -> None:
    sequence = feed(EnableSequence(described=True), CLEAR)
    sequence.trip(FAULT_WATCHDOG)
    assert feed(sequence, CLEAR).fault == FAULT_WATCHDOG
    assert feed(sequence, REST, CLEAR).fault == 0


def test_every_sequence_of_six_commands_keeps_the_rule() -> None:
    """Live only ever follows three enables in a row after a clear that came after the last fault."""
    for commands in product([REST, CLEAR, ENABLE, "trip"], repeat=6):
        sequence = EnableSequence(described=True)
        history = []
        for command in commands:
            if command == "trip":
                sequence.trip(FAULT_ESTOP)
            else:
                sequence.command(**command)
            history.append(command)
            if sequence.live:
                assert history[-3:] == [ENABLE] * 3
                before = history[: len(history) - history[::-1].index(CLEAR)]
                assert "trip" not in history[len(before) :]
