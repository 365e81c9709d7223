"""A client that talks to a double, and the command line over that client."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import pytest
from typer.testing import CliRunner, Result

import hapticd_client.terminal
from hapticd_client import Client
from hapticd_client.commands import app
from tests.clients.daemon_double import DaemonDouble

Run = Callable[..., Result]


@pytest.fixture
def double() -> DaemonDouble:
    return DaemonDouble()


@pytest.fixture
def client(double: DaemonDouble) -> Iterator[Client]:
    with Client("http://daemon.test", transport=double.transport()) as client:
        yield client


@pytest.fixture
def run(double: DaemonDouble, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Runs a command line against the double."""

    def connected(url: str | None) -> Client:
        return Client(url, transport=double.transport())

    monkeypatch.setattr(hapticd_client.terminal, "Client", connected)
    monkeypatch.setattr(hapticd_client.terminal.console, "width", 160)

    def invoke(*words: str) -> Result:
        return CliRunner().invoke(app, list(words))

    return invoke
