"""The link to a driver: connected again and again, closed before each attempt, never in anybody's way."""

from __future__ import annotations

import logging
from collections.abc import Callable

import pytest

from hapticd import link as link_module
from hapticd.link import Link


class ScriptedDriver:
    """Fails to connect as often as it is told to."""

    identity = "board 4711"

    def __init__(self, *failures: Exception, closing: Exception | None = None) -> None:
        self._failures = list(failures)
        self._closing = closing
        self.calls: list[str] = []
        self.on_close: Callable[[], None] = lambda: None

    def connect(self) -> None:
        self.calls.append("connect")
        if self._failures:
            raise self._failures.pop(0)

    def exchange(self, command: memoryview, observation: memoryview) -> int:
        raise AssertionError("only the loop exchanges")

    def close(self) -> None:
        self.calls.append("close")
        self.on_close()
        if self._closing:
            raise self._closing


@pytest.fixture(autouse=True)
def _short_pauses(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(link_module, "FIRST_PAUSE_S", 1e-3)
    monkeypatch.setattr(link_module, "LONGEST_PAUSE_S", 2e-3)


def test_it_tries_until_the_device_answers_and_closes_what_failed() -> None:
    driver = ScriptedDriver(OSError("no such port"), TimeoutError("no answer"))
    assert Link(driver).connect()
    assert driver.calls == ["connect", "close", "connect", "close", "connect"]


def test_a_lost_device_is_closed_before_it_is_opened_again() -> None:
    driver = ScriptedDriver()
    link = Link(driver)
    link.connect()
    link.connect()
    link.close()
    link.close()
    assert driver.calls == ["connect", "close", "connect", "close"]


def test_a_driver_that_cannot_even_close_is_opened_again() -> None:
    driver = ScriptedDriver(OSError("gone"), closing=OSError("stuck"))
    assert Link(driver).connect()


def test_giving_up_ends_the_attempts() -> None:
    driver = ScriptedDriver(*[OSError("no such port")] * 1000)
    link = Link(driver)
    driver.on_close = lambda: link.give_up() if len(driver.calls) > 6 else None
    assert not link.connect()
    assert driver.calls.count("connect") == 5


def test_a_failure_that_repeats_is_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.INFO)
    Link(ScriptedDriver(*[OSError("no such port")] * 5, OSError("busy"))).connect()
    said = [record.message for record in caplog.records]
    assert said == [
        "connecting failed: OSError: no such port",
        "connecting failed: OSError: busy",
        "connected to board 4711",
    ]
