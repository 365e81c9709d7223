"""Faults that can be injected into a twin, to see how everything behind it takes them."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, TypeAdapter

from hapticd.document import Document

DURATION_MAX_S = 60.0


class Outage(Document):
    """A fault of the simulated hardware that lasts a while and then heals.

    ``unplug``: the device is gone. ``silence``: no frame arrives, commands still act. ``not_finite``:
    measured forces are NaN. ``encoder_jump``: the first encoder reads half a radian too much.
    ``estop_input``: the E-stop input opens. ``sensor_saturated``: the force sensor is at the end of its
    range. ``amplifier_fault``: an amplifier gives nothing.
    """

    type: Literal[
        "unplug",
        "silence",
        "not_finite",
        "encoder_jump",
        "estop_input",
        "sensor_saturated",
        "amplifier_fault",
    ]
    duration_s: float = Field(0.5, ge=0.0, le=DURATION_MAX_S)


class DropFrames(Document):
    """Frames are lost at random."""

    type: Literal["drop_frames"]
    fraction: float = Field(ge=0.0, le=1.0, description="Lost share of the frames")
    duration_s: float = Field(0.5, ge=0.0, le=DURATION_MAX_S)


Injection = Annotated[Outage | DropFrames, Field(discriminator="type")]

INJECTION: TypeAdapter[Injection] = TypeAdapter(Injection)
