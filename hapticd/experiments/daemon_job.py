"""A job of a running daemon, from outside: started, watched, fetched."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import httpx

from hapticd.experiments.progress import Report
from hapticd.problem import Problem
from hapticd.problem_types import PROBLEM_TYPES

DEFAULT_URL = "http://127.0.0.1:8420"
URL_VARIABLE = "HAPTICD_URL"
TIMEOUT_S = 10.0
POLL_S = 0.25
RUNNING = ("queued", "running")


class DaemonJob:
    """One experiment on the daemon at ``url``. Left before its end, as by Ctrl-C, the job is cancelled.

    Every method raises ``Problem``: the daemon's own, or daemon-unreachable.
    """

    def __init__(
        self, request: Mapping[str, Any], url: str | None = None, transport: httpx.BaseTransport | None = None
    ) -> None:
        self._url = (url or os.environ.get(URL_VARIABLE) or DEFAULT_URL).rstrip("/")
        # Not through a proxy of the environment: the daemon is on this machine or this network.
        self._http = httpx.Client(base_url=self._url, timeout=TIMEOUT_S, transport=transport, trust_env=False)
        self._request = dict(request)
        self._address = ""
        self._state = ""

    def __enter__(self) -> Self:
        try:
            response = self._send("POST", "/api/v1/experiments", json=self._request)
        except BaseException:
            self._http.close()
            raise
        self._address, self._state = response.headers["location"], "queued"
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None and self._state in RUNNING:
            with suppress(httpx.TransportError):
                self._http.delete(self._address)
        self._http.close()

    def wait(self, report: Report) -> dict[str, Any]:
        """The job once it has succeeded; its failure is raised."""
        while True:
            job: dict[str, Any] = self._send("GET", self._address).json()
            self._state = job["state"]
            report(job["progress"], job["doing"] or self._state)
            if self._state not in RUNNING:
                break
            time.sleep(POLL_S)
        if job["error"] is not None:
            raise _problem(job["error"])
        return job

    def fetch(self, job: Mapping[str, Any], out: Path) -> list[Path]:
        """Copies the job's files into ``out``."""
        out.mkdir(parents=True, exist_ok=True)
        fetched = []
        for name in job["files"]:
            file = out / Path(name).name
            file.write_bytes(self._send("GET", f"{self._address}/files/{name}").content)
            fetched.append(file)
        return fetched

    def _send(self, method: str, address: str, **parts: Any) -> httpx.Response:
        try:
            response = self._http.request(method, address, **parts)
        except httpx.TransportError as error:
            raise Problem("daemon-unreachable", f"{self._url}: {error}.") from error
        if response.is_error:
            raise _problem(_document(response))
        return response


def _document(response: httpx.Response) -> dict[str, Any]:
    if response.headers.get("content-type", "").startswith("application/problem+json"):
        document: dict[str, Any] = response.json()
        return document
    return {"detail": f"{response.url} answers HTTP {response.status_code}, not as hapticd does."}


def _problem(document: Mapping[str, Any]) -> Problem:
    """The daemon's problem as one of our own."""
    slug = str(document.get("type", "")).rpartition("/")[2]
    known = slug if slug in PROBLEM_TYPES else "daemon-unreachable"
    return Problem(
        known,
        document["detail"],
        hint=document.get("hint"),
        pointer=document.get("pointer"),
        device_id=document.get("device_id"),
        allowed=document.get("allowed"),
    )
