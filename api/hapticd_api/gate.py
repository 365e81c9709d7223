"""Who may talk to the daemon from where: Host allow-list, and Origin on writes and WebSockets.

Without a token, the address bar is the only thing that tells a person's own browser tab from a
hostile page: the Host check stops DNS rebinding, the Origin check stops cross-site requests.
"""

from __future__ import annotations

import ipaddress
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from hapticd.problem import Problem
from hapticd_api.problem_response import problem_response
from hapticd_api.stream.close import CloseCode

READING_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


class Gate:
    """ASGI middleware that lets through only requests addressed to this daemon by name.

    `hosts` are the names besides loop-back under which the daemon may be addressed.
    """

    def __init__(self, app: ASGIApp, hosts: frozenset[str] = frozenset()) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Passes the request on, or answers 403 (HTTP) or closes with 1008 (WebSocket)."""
        refusal = self._refusal(scope) if scope["type"] in ("http", "websocket") else None
        if refusal is None:
            await self._app(scope, receive, send)
        elif scope["type"] == "http":
            await problem_response(refusal)(scope, receive, send)
        else:
            await _close(receive, send, refusal)

    def _refusal(self, scope: Scope) -> Problem | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._is_ours(host):
            return Problem(
                "host-not-allowed",
                f"This daemon does not answer to the host name {host!r}.",
                hint="Use http://localhost or http://127.0.0.1 with the daemon's port.",
            )
        changes = scope["type"] == "websocket" or scope["method"] not in READING_METHODS
        origin = headers.get("origin")
        if changes and origin is not None and not _same_origin(origin, host):
            return Problem(
                "origin-not-allowed",
                f"A page of {origin} may not change or stream a device.",
                hint="Open the page that the daemon itself serves, or call the API from a program.",
            )
        return None

    def _is_ours(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname or ""
        except ValueError:
            return False
        return name in self._hosts or name == "localhost" or _is_loopback(name)


def _is_loopback(name: str) -> bool:
    try:
        return ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def _same_origin(origin: str, host: str) -> bool:
    # The scheme is not compared: behind a proxy that ends TLS this side never knows it.
    try:
        return urlsplit(origin).netloc.lower() == host.lower()
    except ValueError:
        return False


async def _close(receive: Receive, send: Send, refusal: Problem) -> None:
    # Accepted first: a refused handshake reaches a browser as 1006, which names no cause.
    await receive()
    await send({"type": "websocket.accept"})
    await send({"type": "websocket.close", "code": CloseCode.ORIGIN, "reason": refusal.detail[:120]})
