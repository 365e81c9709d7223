"""The board's end of a pseudo-terminal, for emulators of serial devices."""

from __future__ import annotations

import contextlib
import os
import tty
from pathlib import Path

from hapticd_drivers.transport import bytes_waiting


class PseudoTerminal:
    """A port that a driver opens like any serial port.

    The far end is kept open here too, so that the port survives a driver that comes and goes, and
    hangs up when this object is closed. `link` is a path that always names the present port.
    """

    def __init__(self, link: Path | None = None) -> None:
        self._link = link
        self.open()

    def open(self) -> None:
        """Makes the port anew; its name may change, the link's does not."""
        self.fd, self._far_fd = os.openpty()
        tty.setraw(self._far_fd)
        os.set_blocking(self.fd, False)
        self.port = os.ttyname(self._far_fd)
        if self._link is not None:
            fresh = self._link.with_name(f".{self._link.name}.{os.getpid()}")
            fresh.unlink(missing_ok=True)
            fresh.symlink_to(self.port)
            fresh.replace(self._link)

    def read(self) -> bytes:
        """Whatever has arrived; empty when nothing has, or when the plug is out. Never waits."""
        size = bytes_waiting(self.fd) if self.fd >= 0 else 0
        return os.read(self.fd, size) if size else b""

    def write(self, data: bytes) -> None:
        """Sends; what nobody reads is lost, as on a wire."""
        with contextlib.suppress(BlockingIOError):
            os.write(self.fd, data)

    def close(self) -> None:
        """Pulls the plug; closing twice is fine."""
        for fd in (self.fd, self._far_fd):
            if fd >= 0:
                os.close(fd)
        self.fd = self._far_fd = -1

    def remove_link(self) -> None:
        """Takes the link away, unless it has become another's."""
        if self._link is not None and self._link.is_symlink() and str(self._link.readlink()) == self.port:
            self._link.unlink()
