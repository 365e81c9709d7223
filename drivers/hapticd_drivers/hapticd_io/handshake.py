"""Getting to know a board and setting it up: a few requests, each with its reply."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Final

from hapticd_drivers.error import NoAnswer, WrongDevice
from hapticd_drivers.hapticd_io.frame import Kind
from hapticd_drivers.hapticd_io.link import Link
from hapticd_drivers.hapticd_io.options import Options
from hapticd_drivers.hapticd_io.protocol import WATCHDOG_UNIT_S, Config, Description, Item, Result
from hapticd_drivers.hapticd_io.wiring import Output
from hapticd_drivers.transport import ByteTransport

ATTEMPTS: Final = 8
REPLY_S: Final = 0.1

_REPLIES: Final = {Kind.DESCRIBE_REQ: Kind.DESCRIBE_RSP, Kind.CONFIG: Kind.CONFIG_ACK}

Clock = Callable[[], float]


def describe(link: Link, transport: ByteTransport, clock: Clock) -> Description:
    """What the board has. Raises `NoAnswer`, `DeviceLost`."""
    transport.write(b"\0")  # ends whatever an earlier host left half sent
    return Description.unpack(_request(link, transport, clock, Kind.DESCRIBE_REQ, b"", lambda _: True))


def configure(
    link: Link,
    transport: ByteTransport,
    clock: Clock,
    options: Options,
    outputs: Iterable[Output],
    board: Description,
) -> None:
    """Sets watchdog, pace and the bounds of every output.

    Raises:
        WrongDevice: the board cannot be set up like this.
        NoAnswer, DeviceLost: it stopped answering.
    """
    watchdog = round(options.watchdog_s / WATCHDOG_UNIT_S)
    if watchdog > board.watchdog_max:
        raise WrongDevice(f"watchdog_s is at most {board.watchdog_max * WATCHDOG_UNIT_S:g} on this board")
    rate_hz = round(options.rate_hz)
    tick = Config(Item.TICK, a=rate_hz) if options.pacing == "device" else Config(Item.TICK, b=rate_hz)
    settings = [Config(Item.WATCHDOG, a=watchdog), tick]
    for output in outputs:
        settings.append(Config(Item.AO_CLAMP, output.channel, a=output.low, b=output.high))
        settings.append(Config(Item.AO_SAFE, output.channel, a=0))
    for setting in settings:
        _apply(link, transport, clock, setting)


def _apply(link: Link, transport: ByteTransport, clock: Clock, setting: Config) -> None:
    def answers(payload: bytes) -> bool:
        return Config.unpack(payload)[:2] == setting[:2]

    reply = Config.unpack(_request(link, transport, clock, Kind.CONFIG, setting.pack(), answers))
    if reply.result == Result.OUTPUTS_LIVE:
        raise NoAnswer("the outputs are still live under another host; its watchdog must run out first")
    if reply != setting:
        raise WrongDevice(f"the board refuses {setting}: result {reply.result}")


def _request(
    link: Link,
    transport: ByteTransport,
    clock: Clock,
    kind: Kind,
    payload: bytes,
    answers: Callable[[bytes], bool],
) -> bytes:
    for _ in range(ATTEMPTS):
        transport.write(link.send(kind, payload))
        deadline = clock() + REPLY_S
        while (left_s := deadline - clock()) > 0.0:
            for frame in link.receive(transport.read(left_s)):
                if frame.kind is _REPLIES[kind] and answers(frame.payload):
                    return frame.payload
    raise NoAnswer(f"no reply to {kind.name} within {ATTEMPTS * REPLY_S:g} s: is it a hapticd I/O board?")
