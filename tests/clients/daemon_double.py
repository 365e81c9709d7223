"""A daemon's HTTP side, answered from a table: what is sent can be looked at, what comes back is chosen."""

from __future__ import annotations

import json
from typing import Any

import httpx


class DaemonDouble:
    """Answers requests by ``method path``; an answer is a status and a document, or an exception to raise."""

    def __init__(self) -> None:
        self.answers: dict[str, tuple[int, Any] | Exception] = {}
        self.requests: list[httpx.Request] = []

    def answer(self, request_line: str, document: Any, *, status: int = 200) -> None:
        """Sets the answer to a request such as ``GET /api/v1/devices``."""
        self.answers[request_line] = (status, document)

    def fail(self, request_line: str, error: Exception) -> None:
        """Makes a request fail in transport."""
        self.answers[request_line] = error

    @property
    def last_body(self) -> Any:
        """The document of the last request."""
        return json.loads(self.requests[-1].content)

    @property
    def lines(self) -> list[str]:
        """What was asked, in order."""
        return [f"{request.method} {request.url.path}" for request in self.requests]

    def transport(self) -> httpx.MockTransport:
        """The transport to hand to a client."""
        return httpx.MockTransport(self._handle)

    def _handle(self, request: httpx.Request) -> httpx.Response:
        self.requests.append(request)
        # raw_path keeps what was quoted, so that an id with a slash is seen as one segment.
        path = request.url.raw_path.decode().partition("?")[0]
        answer = self.answers.get(f"{request.method} {path}", (404, problem("route-not-found", 404)))
        if isinstance(answer, Exception):
            raise answer
        status, document = answer
        if isinstance(document, str):
            return httpx.Response(status, text=document)
        return httpx.Response(status, json=document, headers={"ETag": '"7"'})


def problem(slug: str, status: int, **members: Any) -> dict[str, Any]:
    """A problem document as the daemon sends them."""
    return {
        "type": f"/problems/{slug}",
        "title": slug.replace("-", " ").capitalize(),
        "status": status,
        "detail": f"This is the detail of {slug}.",
        "hint": f"This cures {slug}.",
        "retryable": False,
        **members,
    }


def device(device_id: str = "phantom", **members: Any) -> dict[str, Any]:
    """A device as the daemon reports it."""
    return {
        "id": device_id,
        "model": "phantom-1.0",
        "driver": "twin",
        "twin": True,
        "dof": 3,
        "rate_hz": 1000.0,
        "traits": ["spring_drive"],
        "state": "disabled",
        "flags": {"homed": True, "busy": False, "estop": False, "fading": False, "contact": False},
        "faults": [],
        "interlocks": [],
        "tick": 4711,
        "t_mono_ns": 1,
        "tip_position_m": [0.18, 0.0, -0.0215],
        "tip_force_n": [0.0, 0.3, 0.4],
        "stiffness_n_per_m": 912.0,
        "contact_wall": None,
        "scene_revision": 7,
        "walls": 0,
        "health": {"online": True, "why": None, "restarts": 0, "missed_ticks": 0},
        **members,
    }
