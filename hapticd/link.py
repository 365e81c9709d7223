"""The way to a device: its driver, connected again and again until it answers."""

from __future__ import annotations

import logging
import threading
from typing import TYPE_CHECKING

from hapticd.backoff import Backoff

if TYPE_CHECKING:
    from hapticd._core import Driver

FIRST_PAUSE_S = 0.2
LONGEST_PAUSE_S = 5.0

log = logging.getLogger(__name__)


class Link:
    """One driver and its connection. Belongs to the main thread, which is parked while the loop runs."""

    def __init__(self, driver: Driver) -> None:
        self._driver = driver
        self._backoff = Backoff(FIRST_PAUSE_S, LONGEST_PAUSE_S)
        self._given_up = threading.Event()
        self._opened = False
        self._last_complaint = ""

    def connect(self) -> bool:
        """Closes what is open and connects, with longer and longer pauses. False: ``give_up`` was called."""
        self._backoff.reset()
        while not self._given_up.is_set():
            self.close()
            if self._try_once():
                return True
            self._given_up.wait(self._backoff.pause_s())
        return False

    def give_up(self) -> None:
        """Ends ``connect``. May be called from a signal handler."""
        self._given_up.set()

    def close(self) -> None:
        """Lets go of the device. Does nothing when it was not opened."""
        if not self._opened:
            return
        self._opened = False
        try:
            self._driver.close()
        except Exception as error:
            # A driver is somebody else's code: whatever it raises must not keep it from being reopened.
            self._complain("closing", error)

    def _try_once(self) -> bool:
        self._opened = True
        try:
            self._driver.connect()
        except Exception as error:
            # As above: an unknown error of a driver is a device that is not there yet.
            self._complain("connecting", error)
            return False
        self._last_complaint = ""
        log.info("connected to %s", self._driver.identity)
        return True

    def _complain(self, doing: str, error: Exception) -> None:
        """Logs a failure once, not every time it repeats."""
        complaint = f"{doing} failed: {type(error).__name__}: {error}"
        if complaint != self._last_complaint:
            self._last_complaint = complaint
            log.warning(complaint)
