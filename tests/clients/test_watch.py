"""`hapticd watch`: when it tries again, when it gives up, and what it prints for programs."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from hapticd_client import StreamClosed, Unreachable, watch
from hapticd_client.stream import Data, Happening, Message, Snapshot
from tests.clients.conftest import Run
from tests.clients.daemon_double import device

Act = Message | BaseException


class StreamDouble:
    """A stream that says what it was told to, and ends with an exception."""

    def __init__(self, acts: list[Act]) -> None:
        self.device_ids = ["phantom", "hhd"]
        self.subscribed: list[str] = []
        self._acts = acts

    def subscribe(self, device_id: str, *_: Any, **__: Any) -> None:
        self.subscribed.append(device_id)

    def __iter__(self) -> Iterator[Message]:
        for act in self._acts:
            if isinstance(act, BaseException):
                raise act
            yield act


class Daemon:
    """Opens one stream after the other; after the last one, the person presses Ctrl-C."""

    def __init__(self) -> None:
        self.streams: list[StreamDouble | Exception] = []
        self.opened: list[StreamDouble] = []

    def will_say(self, *acts: Act) -> StreamDouble:
        self.streams.append(stream := StreamDouble(list(acts)))
        return stream

    @contextmanager
    def open_stream(self, _: str | None) -> Iterator[StreamDouble]:
        if not self.streams:
            raise KeyboardInterrupt
        stream = self.streams.pop(0)
        if isinstance(stream, Exception):
            raise stream
        self.opened.append(stream)
        yield stream


@pytest.fixture
def daemon(monkeypatch: pytest.MonkeyPatch) -> Daemon:
    daemon = Daemon()
    monkeypatch.setattr(watch, "open_stream", daemon.open_stream)
    monkeypatch.setattr(watch, "RETRY_S", 0.0)
    return daemon


SNAPSHOT = Snapshot(device())
GONE = StreamClosed(1001, "the daemon is stopping")


def test_a_daemon_that_never_was_there_ends_the_command(run: Run, daemon: Daemon) -> None:
    daemon.streams.append(Unreachable("http://daemon.test", "Connection refused"))
    assert run("watch").exit_code == 3


def test_a_daemon_that_restarts_is_watched_on(run: Run, daemon: Daemon) -> None:
    daemon.will_say(SNAPSHOT, GONE)
    daemon.streams.append(Unreachable("http://daemon.test", "Connection refused"))
    daemon.will_say(SNAPSHOT, GONE)
    result = run("watch")
    assert result.exit_code == 0
    assert len(daemon.opened) == 2


def test_a_refusal_that_will_not_change_ends_the_command(run: Run, daemon: Daemon) -> None:
    daemon.will_say(SNAPSHOT, StreamClosed(4426, "no common protocol version"))
    daemon.will_say(SNAPSHOT)
    result = run("watch")
    assert result.exit_code == 3
    assert "no common protocol version" in result.stderr


def test_all_devices_are_watched_unless_some_are_named(run: Run, daemon: Daemon) -> None:
    everything = daemon.will_say(KeyboardInterrupt())
    run("watch")
    only_one = daemon.will_say(KeyboardInterrupt())
    run("watch", "hhd")
    assert (everything.subscribed, only_one.subscribed) == (["phantom", "hhd"], ["hhd"])


def test_programs_get_one_line_of_json_for_each_message(run: Run, daemon: Daemon) -> None:
    event: Any = {"id": 3, "t_utc": "2026-01-01T00:00:00Z", "message": "Enabled."}
    data = Data("phantom", tick=5, t_mono_ns=9, count=1, dropped=2, values={"missed_ticks": [0]})
    daemon.will_say(SNAPSHOT, data, Happening(event), KeyboardInterrupt())
    snapshot_line, data_line, event_line = map(json.loads, run("watch", "--json").stdout.splitlines())
    assert snapshot_line == {"type": "snapshot", "device": device()}
    assert (data_line["type"], data_line["tick"], data_line["dropped"]) == ("data", 5, 2)
    assert event_line == {"type": "event", "event": event}
