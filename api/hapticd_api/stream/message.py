"""What a client may say on the stream."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, Strict, TypeAdapter

from hapticd.document import Document

PROTOCOL_VERSION = 1

SubscriptionId = Annotated[str, Field(min_length=1, max_length=64)]
SignalNames = Annotated[tuple[str, ...], Field(min_length=1, max_length=100), Strict(False)]
Rate = Annotated[float, Field(gt=0.0, le=1000.0)]


class Hello(Document):
    """The first message. `client` is a name for the daemon's log."""

    type: Literal["hello"]
    version: int = PROTOCOL_VERSION
    client: Annotated[str, Field(max_length=100)] | None = None


class Subscribe(Document):
    """Asks for signals of a device. `batch` carries every tick between two frames, `latest` the newest alone.

    Frames come at 60 Hz at most; the result says which rate was granted.
    """

    type: Literal["subscribe"]
    id: SubscriptionId
    device: str
    signals: SignalNames
    rate_hz: Rate = 60.0
    mode: Literal["latest", "batch"] = "latest"


class Unsubscribe(Document):
    """Ends a subscription."""

    type: Literal["unsubscribe"]
    id: SubscriptionId


class Ping(Document):
    """Asks for a `pong`, which echoes `nonce` and tells both clocks."""

    type: Literal["ping"]
    nonce: Annotated[str, Field(max_length=64)] | None = None


ClientMessage = Hello | Subscribe | Unsubscribe | Ping

CLIENT_MESSAGE: TypeAdapter[ClientMessage] = TypeAdapter(
    Annotated[ClientMessage, Field(discriminator="type")]
)
