"""Request bodies: JSON only, and no larger than the limit."""

from __future__ import annotations

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hapticd.problem import Problem
from hapticd_api.problem_response import problem_response

BODY_MAX_BYTES = 1 << 20
"""Largest request body: a full scene of 256 walls is about 60 kB."""


DISCARD_MAX_BYTES = 16 << 20
"""How much of a body too large is still read, and thrown away: a connection closed on a client that is
sending is reset, and the answer lost with it."""


class BodyGuard:
    """ASGI middleware that reads a request's body whole, and refuses one too large or not JSON.

    A media type other than JSON is what a web page can send to another site without asking first, so this
    is a part of the defence against cross-site requests.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Passes the request on with its body at hand, or answers 413 or 415."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        body = await _read(receive)
        if body is None:
            await problem_response(_too_large(), {"Connection": "close"})(scope, receive, send)
        elif body and not _is_json(headers.get("content-type", "")):
            await problem_response(_not_json(headers))(scope, receive, send)
        else:
            await self._app(scope, _replay(body, receive), send)


async def _read(receive: Receive) -> bytes | None:
    """The whole body, or None where it has grown past the limit."""
    body = bytearray()
    size = 0
    while size <= DISCARD_MAX_BYTES:
        message = await receive()
        chunk: bytes = message.get("body", b"")
        size += len(chunk)
        if size <= BODY_MAX_BYTES:
            body += chunk
        if not message.get("more_body", False):
            break
    return bytes(body) if size <= BODY_MAX_BYTES else None


def _is_json(content_type: str) -> bool:
    media_type = content_type.partition(";")[0].strip().lower()
    return media_type in ("application/json", "application/merge-patch+json")


def _replay(body: bytes, receive: Receive) -> Receive:
    """A `receive` that yields `body` once, and then what the client still sends: its disconnect."""
    pending: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def replayed() -> Message:
        return pending.pop() if pending else await receive()

    return replayed


def _too_large() -> Problem:
    return Problem("body-too-large", f"The body is larger than {BODY_MAX_BYTES} bytes.")


def _not_json(headers: Headers) -> Problem:
    sent = headers.get("content-type") or "none"
    return Problem(
        "unsupported-media-type", f"The body's Content-Type is {sent}.", allowed=["application/json"]
    )
