"""Why a stream was closed: the codes of both WebSockets."""

from enum import IntEnum


class CloseCode(IntEnum):
    """WebSocket close codes; those from 4000 on are the daemon's own."""

    SHUTDOWN = 1001
    """The daemon is stopping. Reconnect with back-off."""
    TOO_BIG = 1009
    """A client message was longer than the limit."""
    ORIGIN = 1008
    """The Host or Origin header is not allowed. Reconnecting does not help."""
    TOO_SLOW = 1013
    """The client did not take its events in time. Reconnect, then read /api/v1/events?after=."""
    BAD_REQUEST = 4400
    """The address asks for something that cannot be served; an error message came before."""
    NO_HELLO = 4408
    """No `hello` came in time."""
    VERSION = 4426
    """The client offers no subprotocol or version that this daemon speaks."""


REASONS: dict[CloseCode, str] = {
    CloseCode.SHUTDOWN: "the daemon is stopping",
    CloseCode.TOO_BIG: "message too long",
    CloseCode.ORIGIN: "host or origin not allowed",
    CloseCode.TOO_SLOW: "too slow to take events",
    CloseCode.BAD_REQUEST: "cannot be served; see the error message",
    CloseCode.NO_HELLO: "no hello in time",
    CloseCode.VERSION: "no common protocol version",
}
