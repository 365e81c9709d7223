"""`Idempotency-Key` on POST: a request sent twice is carried out once, and both are given the same answer."""

from __future__ import annotations

import asyncio
import hashlib
from collections import OrderedDict
from dataclasses import dataclass, field

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hapticd.problem import Problem
from hapticd_api.problem_response import problem_response

KEYS_MAX = 1000
"""Answers kept; the oldest are forgotten first."""


@dataclass
class _Answer:
    """What one request was answered, once `done` is set. Empty when carrying it out failed."""

    fingerprint: bytes
    done: asyncio.Event = field(default_factory=asyncio.Event)
    messages: list[Message] = field(default_factory=list)


class Idempotency:
    """ASGI middleware. Needs the request's body whole in its first message, as `BodyGuard` leaves it."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app
        self._answers: OrderedDict[tuple[str, str], _Answer] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Passes the request on, or repeats the answer that its key was given before."""
        key = Headers(scope=scope).get("idempotency-key") if scope["type"] == "http" else None
        if key is None or scope["method"] != "POST":
            await self._app(scope, receive, send)
            return
        request = await receive()
        fingerprint = hashlib.sha256(scope["query_string"] + b"\n" + request.get("body", b"")).digest()
        known = self._answers.get((scope["path"], key))
        if known is None:
            await self._carry_out((scope["path"], key), fingerprint, scope, _first(request, receive), send)
        elif known.fingerprint != fingerprint:
            await problem_response(_reused(key))(scope, receive, send)
        else:
            await self._repeat(known, scope, _first(request, receive), send)

    async def _carry_out(
        self, key: tuple[str, str], fingerprint: bytes, scope: Scope, receive: Receive, send: Send
    ) -> None:
        answer = self._answers[key] = _Answer(fingerprint)
        if len(self._answers) > KEYS_MAX:
            self._answers.popitem(last=False)

        async def kept(message: Message) -> None:
            answer.messages.append(message)
            await send(message)

        try:
            await self._app(scope, receive, kept)
        except BaseException:
            self._forget(key, answer)
            raise
        finally:
            answer.done.set()
        if answer.messages[0]["status"] >= 500:
            self._forget(key, answer)

    def _forget(self, key: tuple[str, str], answer: _Answer) -> None:
        """A failure may be gone at the next try, so it is not repeated."""
        answer.messages.clear()
        if self._answers.get(key) is answer:
            del self._answers[key]

    async def _repeat(self, answer: _Answer, scope: Scope, receive: Receive, send: Send) -> None:
        await answer.done.wait()
        if not answer.messages:
            await self._app(scope, receive, send)
            return
        for message in answer.messages:
            await send(message)


def _first(request: Message, receive: Receive) -> Receive:
    """A `receive` that yields `request` again before anything else."""
    pending = [request]

    async def replayed() -> Message:
        return pending.pop() if pending else await receive()

    return replayed


def _reused(key: str) -> Problem:
    return Problem("idempotency-key-reused", f"The key {key!r} came before with another request.")
