"""One HTTP connection to a daemon: requests in, documents or `HapticdError` out."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any
from urllib.parse import quote

import httpx

from hapticd_client.error import NotHapticd, Refused, Unreachable

DEFAULT_URL = "http://127.0.0.1:8420"
URL_VARIABLE = "HAPTICD_URL"


@dataclass(frozen=True, slots=True)
class Reply:
    """A document and its entity tag, empty where it has none."""

    document: Any
    etag: str


def daemon_url(url: str | None = None) -> str:
    """``url``, else ``$HAPTICD_URL``, else the default address, without a slash at the end."""
    return (url or os.environ.get(URL_VARIABLE) or DEFAULT_URL).rstrip("/")


class Connection:
    """Sends requests to one daemon. Close it, or use it as a context manager."""

    def __init__(self, url: str, timeout_s: float, transport: httpx.BaseTransport | None = None) -> None:
        self.url = url
        # Not through a proxy of the environment: the daemon is on this machine or this network.
        self._http = httpx.Client(base_url=url, timeout=timeout_s, transport=transport, trust_env=False)

    def close(self) -> None:
        """Closes the connection."""
        self._http.close()

    def send(
        self,
        method: str,
        *path: str,
        body: object = None,
        query: Mapping[str, str | int | float] | None = None,
        headers: Mapping[str, str] | None = None,
    ) -> Reply:
        """The answer to a request for ``path``, given as its segments. Raises `HapticdError`."""
        address = "/" + "/".join(quote(part, safe="") for part in path)
        try:
            response = self._http.request(method, address, json=body, params=query, headers=headers)
        except httpx.TimeoutException as error:
            raise Unreachable(self.url, "it did not answer in time") from error
        except (httpx.TransportError, httpx.InvalidURL) as error:
            raise Unreachable(self.url, _reason(error)) from error
        return self._reply(response)

    def _reply(self, response: httpx.Response) -> Reply:
        document = self._document(response)
        if response.is_success:
            return Reply(document, response.headers.get("etag", ""))
        if isinstance(document, dict) and "status" in document:
            raise Refused(document)
        raise NotHapticd(self.url, f"it answers HTTP {response.status_code} without a problem document")

    def _document(self, response: httpx.Response) -> Any:
        try:
            return response.json()
        except ValueError:
            kind = response.headers.get("content-type", "a body of no type")
            why = f"it sends {kind} with HTTP {response.status_code}, not JSON"
            raise NotHapticd(self.url, why) from None


def _reason(error: Exception) -> str:
    reason = str(error).strip().rstrip(".")
    return reason.removeprefix("[Errno 111] ") or type(error).__name__
