"""Byte transports: what a serial driver reads from and writes to, and tests put something else behind."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import struct
from select import select
from typing import Final, Protocol

import serial

from hapticd_drivers.error import DeviceLost

READ_MAX_BYTES: Final = 4096

_TIOCGSERIAL: Final = 0x541E
_TIOCSSERIAL: Final = 0x541F
_SERIAL_STRUCT_BYTES: Final = 72
_CLOSING_WAIT_OFFSET: Final = 40
_CLOSING_WAIT_NONE: Final = 65535


class ByteTransport(Protocol):
    """A link that carries bytes in order, or is lost."""

    def open(self) -> None:
        """Opens the link, with nothing left over from before. Raises `DeviceLost`."""

    def read(self, timeout_s: float) -> bytes:
        """Whatever has arrived, waiting at most `timeout_s` for the first byte; empty when none did.

        Raises:
            DeviceLost: the link is gone.
        """

    def write(self, data: bytes) -> int:
        """Writes without waiting and returns how many bytes were taken. Raises `DeviceLost`."""

    def close(self) -> None:
        """Closes the link at once, whether or not the device still takes bytes; closing twice is fine."""


class SerialTransport:
    """A serial port, opened by pyserial, read and written without its per-call overhead."""

    def __init__(self, port: str, baud: int) -> None:
        self._port = port
        self._baud = baud
        self._serial: serial.Serial | None = None
        self._fd = -1
        self._watched: list[int] = []

    def open(self) -> None:
        """Opens the port exclusively and raw, at low latency where the adapter can."""
        try:
            port = serial.Serial(self._port, self._baud, timeout=0, write_timeout=0, exclusive=True)
        except OSError as error:
            raise DeviceLost(_reason(self._port, error)) from error
        with contextlib.suppress(ValueError, OSError):  # a pseudo-terminal has no such mode
            port.set_low_latency_mode(True)
        _never_wait_on_close(port.fileno())
        self._serial, self._fd = port, port.fileno()
        self._watched = [self._fd]

    def read(self, timeout_s: float) -> bytes:
        """See `ByteTransport.read`. `select`, because `poll` waits in whole milliseconds."""
        try:
            ready, _, _ = select(self._watched, (), (), timeout_s)
            if not ready:
                return b""
            chunk = os.read(self._fd, READ_MAX_BYTES)
        except OSError as error:
            raise DeviceLost(_reason(self._port, error)) from error
        if not chunk:
            raise DeviceLost(f"{self._port}: hung up")
        return chunk

    def write(self, data: bytes) -> int:
        """See `ByteTransport.write`; a board that does not read takes nothing, and nothing waits for it."""
        try:
            return os.write(self._fd, data)
        except BlockingIOError:
            return 0
        except OSError as error:
            raise DeviceLost(_reason(self._port, error)) from error

    def close(self) -> None:
        """See `ByteTransport.close`."""
        port, self._serial = self._serial, None
        self._fd, self._watched = -1, []
        if port is not None:
            with contextlib.suppress(OSError):  # the adapter may be gone already
                port.close()


def _never_wait_on_close(fd: int) -> None:
    """Keeps `close` from draining into a board that no longer reads: the kernel would wait 30 s."""
    settings = bytearray(_SERIAL_STRUCT_BYTES)
    with contextlib.suppress(OSError):  # no such setting on a pseudo-terminal
        fcntl.ioctl(fd, _TIOCGSERIAL, settings)
        struct.pack_into("<H", settings, _CLOSING_WAIT_OFFSET, _CLOSING_WAIT_NONE)
        fcntl.ioctl(fd, _TIOCSSERIAL, bytes(settings))


_CURES: Final = {
    errno.ENOENT: "no such port: is it plugged in, is the emulator running?",
    errno.EACCES: "not permitted: add the user to the group of the port (dialout)",
    errno.EAGAIN: "taken by another program",
    errno.EIO: "hung up",
    errno.ENXIO: "hung up",
}


def _reason(port: str, error: OSError) -> str:
    return f"{port}: {_CURES.get(error.errno or 0, error)}"
