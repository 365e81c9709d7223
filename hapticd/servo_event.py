"""What a servo tells, as sentences."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from hapticd.reasons import faults

if TYPE_CHECKING:
    from hapticd._core import ServoEvent

LINKS = {
    "fresh": "answers.",
    "missing": "sends no new frame.",
    "down": "is gone; the driver tries to reach it again.",
}


def message_of(device_id: str, event: ServoEvent) -> str:
    """The sentence for one event; the kind itself where it is not known."""
    say = _SENTENCES.get(event["kind"])
    return say(device_id, event["details"]) if say else f"{device_id}: {event['kind']}."


def _faults(device_id: str, details: Mapping[str, Any]) -> str:
    raised = faults(details["raised"])
    if raised:
        return " ".join(f"{device_id}: {fault.cause} {fault.cure}" for fault in raised)
    left = ", ".join(fault.id for fault in faults(details["latched"]))
    return f"{device_id}: faults acknowledged; {f'still latched: {left}' if left else 'none is left'}."


def kind_of(event: ServoEvent) -> str:
    """The kind under which the event log keeps it."""
    if event["kind"] == "passivity":
        return "passivity.acted" if event["details"]["acting"] else "passivity.ended"
    return f"servo.{event['kind']}"


def _passivity(device_id: str, details: Mapping[str, Any]) -> str:
    wall = (
        f"wall {details['wall']} of {device_id}" if details["wall"] is not None else f"a wall of {device_id}"
    )
    energy = f"it has taken {1e3 * details['energy_j']:.1f} mJ from the hand"
    if details["acting"]:
        return f"Passivity control acts on {wall}; {energy}."
    damping = f"damped by up to {details['damping_n_s_per_m']:.0f} N·s/m"
    return f"Passivity control of {wall} rests; {energy}, {damping}."


_SENTENCES: Mapping[str, Callable[[str, Mapping[str, Any]], str]] = {
    "started": lambda device_id, _: f"The loop of {device_id} runs.",
    "state": lambda device_id, details: f"{device_id} went from {details['from']} to {details['to']}.",
    "faults": _faults,
    "device": lambda device_id, details: f"{device_id} {LINKS.get(details['link'], details['link'])}",
    "front": lambda device_id, details: (
        f"{device_id} hears the front again."
        if details["alive"]
        else f"{device_id} no longer heard the front."
    ),
    "passivity": _passivity,
    "overflow": lambda device_id, details: (
        f"{details['lost']} events of {device_id} were lost: too many at once."
    ),
    "garbled": lambda device_id, _: f"{device_id} found garbage in its request queue and dropped it.",
    "stopped": lambda device_id, details: f"The loop of {device_id} ended: {details['reason']}.",
}
