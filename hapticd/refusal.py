"""What a servo's refusal means, as a problem."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from hapticd.problem import Problem
from hapticd.reasons import NOT_ENABLED, open_interlocks

if TYPE_CHECKING:
    from hapticd._core import Ack

REACHABLE: Mapping[str, tuple[str, ...]] = {
    "offline": (),
    "disabled": ("enabled",),
    "enabled": ("paused", "disabled"),
    "paused": ("enabled", "disabled"),
    "fault": (),
}
"""States that can be asked for, by the present one. A fault is left by acknowledging it."""


def refusal(device_id: str, request_type: str, ack: Ack) -> Problem:
    """The problem for an acknowledgement that does not say ``applied``."""
    if ack["result"] == "refused":
        return _refused(device_id, ack)
    if ack["result"] == "epoch":
        return Problem("epoch-stale", f"{device_id} has seen a newer lease.", device_id=device_id)
    detail = f"The servo of {device_id} found the request {request_type!r} {ack['result']}."
    return Problem("internal-error", detail, device_id=device_id)


def _refused(device_id: str, ack: Ack) -> Problem:
    found = open_interlocks(ack["interlocks"])
    only_the_step = all(interlock.id == NOT_ENABLED for interlock in found)
    return Problem(
        "state-refused" if only_the_step else "interlock-open",
        " ".join([f"{device_id} is {ack['state']} and refused.", *(interlock.why for interlock in found)]),
        hint=" ".join(interlock.cure for interlock in found) or None,
        device_id=device_id,
        current_state=ack["state"],
        allowed=REACHABLE.get(ack["state"], ()),
        interlocks=[interlock.model_dump() for interlock in found],
    )
