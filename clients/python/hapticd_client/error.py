"""What can go wrong when talking to a daemon.

HapticdError
├── Unreachable       no daemon answers at the address: not started, another port, no network
├── NotHapticd        something answers there, but it is not a hapticd
└── Refused           the daemon answered with a problem document: what is wrong, and what cures it
"""

from __future__ import annotations

from typing import Any

from hapticd_client.documents import Interlock


class HapticdError(Exception):
    """Any failure of this client. ``str()`` is one sentence for a person, ``hint`` what to do about it."""

    hint = ""

    def document(self) -> dict[str, Any]:
        """The error in the form of a problem document (RFC 9457), for programs."""
        return {"title": type(self).__name__, "detail": str(self), "hint": self.hint}


class Unreachable(HapticdError, ConnectionError):
    """No daemon answers at ``url``."""

    hint = "Start one with 'hapticd run' (or 'make run'), or name another address with --url or $HAPTICD_URL."

    def __init__(self, url: str, why: str) -> None:
        super().__init__(f"No daemon answers at {url}: {why}.")


class NotHapticd(HapticdError):
    """Something else answers at ``url``."""

    hint = "Another program may have the port: 'ss -ltnp' shows which. Name the daemon's address with --url."

    def __init__(self, url: str, why: str) -> None:
        super().__init__(f"What answers at {url} is not a hapticd: {why}.")


class StreamClosed(HapticdError, ConnectionError):
    """The stream has ended; ``code`` is the WebSocket close code (see /asyncapi.json)."""

    hint = "Open a new stream."

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(f"The stream was closed: {reason or 'no reason was given'} ({code}).")
        self.code = code
        self.reason = reason

    @property
    def final(self) -> bool:
        """Whether a new stream would end the same way: origin refused, nothing in common, no right."""
        return self.code in (1008, 4400, 4401, 4403, 4426)


class Refused(HapticdError):
    """The daemon refused a request. ``problem`` is its problem document, whole."""

    def __init__(self, problem: dict[str, Any]) -> None:
        super().__init__(str(problem.get("detail") or problem.get("title")))
        self.problem = problem
        self.status = int(problem["status"])
        self.title = str(problem.get("title", f"HTTP {self.status}"))
        self.slug = str(problem.get("type", "")).rpartition("/")[2]
        self.hint = str(problem.get("hint", ""))
        self.pointer: str | None = problem.get("pointer")
        self.retryable = bool(problem.get("retryable", False))
        self.interlocks: list[Interlock] = problem.get("interlocks", [])

    def document(self) -> dict[str, Any]:
        """The problem document as the daemon sent it."""
        return self.problem
