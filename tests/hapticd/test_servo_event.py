"""What a servo tells: every kind has its sentence."""

from typing import Any

import pytest

from hapticd.reasons import fault_bits
from hapticd.servo_event import message_of

BITS = fault_bits()


@pytest.mark.parametrize(
    ("kind", "details", "sentence"),
    [
        ("started", {}, "The loop of hhd runs."),
        ("state", {"from": "enabled", "to": "paused"}, "hhd went from enabled to paused."),
        ("faults", {"raised": 0, "latched": 0}, "hhd: faults acknowledged; none is left."),
        (
            "faults",
            {"raised": 0, "latched": BITS["amplifier"]},
            "hhd: faults acknowledged; still latched: amplifier.",
        ),
        ("device", {"link": "fresh"}, "hhd answers."),
        ("device", {"link": "down"}, "hhd is gone; the driver tries to reach it again."),
        ("front", {"alive": True}, "hhd hears the front again."),
        ("front", {"alive": False}, "hhd no longer heard the front."),
        ("overflow", {"lost": 3}, "3 events of hhd were lost: too many at once."),
        ("garbled", {}, "hhd found garbage in its request queue and dropped it."),
        ("stopped", {"reason": "orphaned"}, "The loop of hhd ended: orphaned."),
        (
            "passivity",
            {"wall": "floor", "acting": True, "energy_j": 0.0042, "damping_n_s_per_m": 90.0},
            "Passivity control acts on wall floor of hhd; it has taken 4.2 mJ from the hand.",
        ),
        (
            "passivity",
            {"wall": None, "acting": False, "energy_j": 0.0, "damping_n_s_per_m": 90.0},
            "Passivity control of a wall of hhd rests; it has taken 0.0 mJ from the hand, "
            "damped by up to 90 N·s/m.",
        ),
        ("of-a-newer-servo", {}, "hhd: of-a-newer-servo."),
    ],
)
def test_event_is_told_in_a_sentence(kind: str, details: dict[str, Any], sentence: str) -> None:
    assert (
        message_of("hhd", {"seq": 0, "kind": kind, "tick": 0, "t_mono_ns": 0, "details": details}) == sentence
    )


def test_raised_faults_are_told_with_cause_and_cure() -> None:
    raised = BITS["amplifier"] | BITS["motor-hot"]
    told = message_of(
        "hhd",
        {
            "seq": 0,
            "kind": "faults",
            "tick": 0,
            "t_mono_ns": 0,
            "details": {"raised": raised, "latched": raised},
        },
    )
    assert "An amplifier reported a fault." in told
    assert "Let the motor cool" in told
