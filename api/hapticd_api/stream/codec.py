"""The two spellings of stream messages: JSON text and MessagePack.

The values of a telemetry frame are encoded once for all clients; here they are only put into their envelope.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import msgpack
import orjson
from starlette.types import Message

from hapticd.telemetry import Delivery


class Undecodable(ValueError):
    """A client message that cannot be read."""


class Codec(Protocol):
    """Turns messages into WebSocket payloads and back."""

    @property
    def subprotocol(self) -> str: ...
    def encode(self, message: Mapping[str, Any]) -> Message: ...
    def data(self, subscription_id: str, delivery: Delivery) -> Message: ...
    def decode(self, payload: str | bytes) -> Any: ...


def _envelope(subscription_id: str, delivery: Delivery) -> dict[str, Any]:
    frame = delivery.frame
    return {
        "type": "data",
        "sub": subscription_id,
        "seq": delivery.seq,
        "tick": frame.tick,
        "t_mono_ns": frame.t_mono_ns,
        "count": frame.count,
        "dropped": delivery.dropped,
    }


class JsonCodec:
    """JSON in text messages. Numbers that are not finite become null."""

    subprotocol = "hapticd.v1+json"

    def encode(self, message: Mapping[str, Any]) -> Message:
        """One message as text."""
        return _text(orjson.dumps(message))

    def data(self, subscription_id: str, delivery: Delivery) -> Message:
        """One telemetry frame as text."""
        head = orjson.dumps(_envelope(subscription_id, delivery))
        return _text(head[:-1] + b',"values":' + delivery.frame.json + b"}")

    def decode(self, payload: str | bytes) -> Any:
        """The value a message holds. Raises `Undecodable`."""
        try:
            return orjson.loads(payload)
        except orjson.JSONDecodeError as error:
            raise Undecodable(f"The message is not JSON: {error}.") from None


class MsgpackCodec:
    """MessagePack in binary messages. Numbers that are not finite become nil."""

    subprotocol = "hapticd.v1+msgpack"

    def encode(self, message: Mapping[str, Any]) -> Message:
        """One message as bytes."""
        return _binary(msgpack.packb(message))

    def data(self, subscription_id: str, delivery: Delivery) -> Message:
        """One telemetry frame as bytes."""
        envelope = _envelope(subscription_id, delivery)
        packer = msgpack.Packer(autoreset=False)
        packer.pack_map_header(len(envelope) + 1)
        for name, value in envelope.items():
            packer.pack(name)
            packer.pack(value)
        packer.pack("values")
        return _binary(packer.bytes() + delivery.frame.msgpack)

    def decode(self, payload: str | bytes) -> Any:
        """The value a message holds. Raises `Undecodable`."""
        if isinstance(payload, str):
            raise Undecodable("The message is text; this subprotocol takes binary messages.")
        try:
            return msgpack.unpackb(payload)
        except (ValueError, msgpack.UnpackException) as error:
            raise Undecodable(f"The message is not MessagePack: {error}.") from None


def _text(payload: bytes) -> Message:
    return {"type": "websocket.send", "text": payload.decode()}


def _binary(payload: bytes) -> Message:
    return {"type": "websocket.send", "bytes": payload}


CODECS: Mapping[str, Codec] = {codec.subprotocol: codec for codec in (JsonCodec(), MsgpackCodec())}
DEFAULT = CODECS["hapticd.v1+json"]


def negotiated(offered: list[str]) -> Codec | None:
    """The codec of the first subprotocol both sides know; JSON for a client that offers none."""
    if not offered:
        return DEFAULT
    return next((CODECS[name] for name in offered if name in CODECS), None)
