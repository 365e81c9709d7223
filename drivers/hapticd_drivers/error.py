"""What can go wrong between a driver and its device.

::

    DriverError
    ├── OptionError    the configuration names something that is not there, or leaves something out
    ├── DeviceLost     the port is gone, hung up, or was never there: unplugged, board off, emulator stopped
    ├── NoAnswer       the port opens, but what is behind it does not speak the protocol, or not in time
    └── WrongDevice    it answers, and it is not the board that the configuration describes
"""

from __future__ import annotations


class DriverError(Exception):
    """Base of everything a driver raises on purpose."""


class OptionError(DriverError, ValueError):
    """A driver option is missing, unknown or out of range."""


class DeviceLost(DriverError, ConnectionError):
    """The link to the device is gone."""


class NoAnswer(DriverError, TimeoutError):
    """The device does not answer."""


class WrongDevice(DriverError):
    """Another device than the configured one answers."""
