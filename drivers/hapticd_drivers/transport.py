"""Byte transports: what a serial driver reads from and writes to, and tests put something else behind."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import os
import struct
import termios
import time
from typing import Final, Protocol

import serial

from hapticd_drivers.error import DeviceLost

READ_MAX_BYTES: Final = 4096

PAUSE_S: Final = 50e-6
"""Shortest sleep between two looks at an empty port."""

PAUSE_SHARE: Final = 0.01
"""Share of a longer wait between two looks."""

_TIOCGSERIAL: Final = 0x541E
_TIOCSSERIAL: Final = 0x541F
_SERIAL_STRUCT_BYTES: Final = 72
_CLOSING_WAIT_OFFSET: Final = 40
_CLOSING_WAIT_NONE: Final = 65535
_COUNT: Final = struct.Struct("i")
_NO_COUNT: Final = bytes(_COUNT.size)


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

    def flush(self) -> None:
        """Drops whatever has arrived and was not read. Raises `DeviceLost`."""

    def close(self) -> None:
        """Closes the link at once, whether or not the device still takes bytes; closing twice is fine."""


class SerialTransport:
    """A serial port, opened by pyserial, read and written without its per-call overhead."""

    def __init__(self, port: str, baud: int) -> None:
        self._port = port
        self._baud = baud
        self._serial: serial.Serial | None = None
        self._fd = -1

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

    def read(self, timeout_s: float) -> bytes:
        """See `ByteTransport.read`.

        Asks how much has arrived and sleeps in between. `select`, and `read` on an empty port, would
        first wait for the kernel worker that hands received bytes over: that worker is not real-time,
        and on a busy machine it made a wait of 0.6 ms last up to 48 ms.
        """
        try:
            size = bytes_waiting(self._fd)
            if not size and timeout_s > 0.0:
                size = self._wait(timeout_s)
            return os.read(self._fd, min(size, READ_MAX_BYTES)) if size else b""
        except OSError as error:
            raise DeviceLost(_reason(self._port, error)) from error

    def _wait(self, timeout_s: float) -> int:
        deadline = time.monotonic() + timeout_s
        pause_s = max(PAUSE_S, timeout_s * PAUSE_SHARE)
        while not (size := bytes_waiting(self._fd)) and (left_s := deadline - time.monotonic()) > 0.0:
            time.sleep(min(pause_s, left_s))
        return size

    def write(self, data: bytes) -> int:
        """See `ByteTransport.write`; a board that does not read takes nothing, and nothing waits for it."""
        try:
            return os.write(self._fd, data)
        except BlockingIOError:
            return 0
        except OSError as error:
            raise DeviceLost(_reason(self._port, error)) from error

    def flush(self) -> None:
        """See `ByteTransport.flush`; also what the kernel has not handed over yet."""
        try:
            termios.tcflush(self._fd, termios.TCIFLUSH)
        except (termios.error, OSError) as error:
            raise DeviceLost(f"{self._port}: {error}") from error

    def close(self) -> None:
        """See `ByteTransport.close`."""
        port, self._serial = self._serial, None
        self._fd = -1
        if port is not None:
            with contextlib.suppress(OSError):  # the adapter may be gone already
                port.close()


def bytes_waiting(fd: int) -> int:
    """Bytes that a terminal has ready. Never waits. `OSError` when it hung up."""
    return int(_COUNT.unpack(fcntl.ioctl(fd, termios.FIONREAD, _NO_COUNT))[0])


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
