"""The daemon: the composition root that joins the station with the API and serves until told to stop."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import importlib
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from typing import Any, cast

import uvicorn

from hapticd import log
from hapticd.config import ApiConfig, Config
from hapticd.problem import Problem
from hapticd.station import Station

API = "hapticd_api:create_app"
"""The API, by import string: nothing in ``hapticd`` imports it."""

NOTSENT_LOWAT_BYTES = 16_384
"""Unsent bytes the kernel keeps for a client:

a frozen one then gets a second of stale frames, not seventeen.
"""

GRACE_S = 3
"""Time that connections get to end by themselves."""

READY_WAIT_S = 8.0

CreateApp = Callable[[Station], Any]


class _Server(uvicorn.Server):
    """uvicorn, with signals left to the daemon: forces fade out before connections close."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        yield


def run(config: Config) -> None:
    """Runs the daemon until SIGINT or SIGTERM. ``Problem`` when it cannot start."""
    log.configure()
    with contextlib.closing(listen(config.api)) as listener:
        asyncio.run(_serve(config, listener))


def listen(api: ApiConfig) -> socket.socket:
    """The listening socket. ``Problem``: address-in-use, config-invalid."""
    family = socket.AF_INET6 if ":" in api.host else socket.AF_INET
    listener = socket.socket(family, socket.SOCK_STREAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    # Accepted sockets inherit both. Without the second an answer in two parts waits 40 ms for an ACK.
    listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, NOTSENT_LOWAT_BYTES)
    listener.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    try:
        listener.bind((api.host, api.port))
    except OSError as error:
        listener.close()
        taken = error.errno == errno.EADDRINUSE
        slug, why = (
            ("address-in-use", "is taken")
            if taken
            else ("config-invalid", f"cannot be used: {error.strerror}")
        )
        raise Problem(slug, f"{api.host} port {api.port} {why}.") from None
    return listener


def address_of(listener: socket.socket) -> str:
    """The address to open in a browser."""
    host, port = listener.getsockname()[:2]
    return f"http://[{host}]:{port}/" if ":" in host else f"http://{host}:{port}/"


async def _serve(config: Config, listener: socket.socket) -> None:
    station = Station(config)
    app = _create_app()(station)
    server = _Server(
        uvicorn.Config(
            app,
            ws="websockets-sansio",
            # Compression costs ten times the processor to save a quarter of the bytes.
            ws_per_message_deflate=False,
            timeout_graceful_shutdown=GRACE_S,
            log_config=None,
            access_log=False,
        )
    )
    stop = _stop_signal(server)
    await station.start()
    serving = asyncio.create_task(server.serve(sockets=[listener]), name="http")
    announcing = asyncio.create_task(_announce(station, address_of(listener)), name="announce")
    stopped = asyncio.create_task(stop.wait(), name="signal")
    await asyncio.wait({serving, stopped}, return_when=asyncio.FIRST_COMPLETED)
    announcing.cancel()
    stopped.cancel()
    await station.stop()
    server.should_exit = True
    await serving


def _stop_signal(server: uvicorn.Server) -> asyncio.Event:
    """Set by the first SIGINT or SIGTERM; a second one cuts connections off."""
    stop = asyncio.Event()

    def on_signal() -> None:
        server.force_exit = stop.is_set()
        stop.set()

    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, on_signal)
    return stop


async def _announce(station: Station, address: str) -> None:
    """Prints the address once the devices are there, or says which are not."""
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(READY_WAIT_S):
            while station.ready():  # noqa: ASYNC110 - other processes set it
                await asyncio.sleep(0.05)
    missing = station.ready()
    print(f"hapticd is ready: {address}" if not missing else f"hapticd serves {address}")
    for line in missing:
        print(f"  not ready: {line}")
    sys.stdout.flush()


def _create_app() -> CreateApp:
    module, _, name = API.partition(":")
    return cast(CreateApp, getattr(importlib.import_module(module), name))
