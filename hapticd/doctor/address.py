"""The address the daemon listens on: free, or held by a hapticd."""

from __future__ import annotations

import http.client
import socket
from collections.abc import Iterator

from hapticd.config import Config
from hapticd.doctor.finding import Finding, fail, ok

TIMEOUT_S = 1.0


def examine(config: Config) -> Iterator[Finding]:
    """Whether a daemon could listen, or already does."""
    host, port = config.api.host, config.api.port
    try:
        family, kind, protocol, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        why = f"{host} is no address of this machine: {error.strerror}."
        yield fail("address", why, "Correct host under [api].")
        return
    with socket.socket(family, kind, protocol) as listener:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            listener.bind(address)
        except OSError as error:
            yield _taken(host, port, error)
            return
    yield ok("address", f"{host}:{port} is free.")


def _taken(host: str, port: int, error: OSError) -> Finding:
    if _hapticd_answers(host, port):
        return ok("address", f"A hapticd serves http://{host}:{port} now.")
    cure = f"ss -ltnp 'sport = :{port}' shows who has it; or choose another port under [api]"
    return fail("address", f"{host}:{port} cannot be used: {error.strerror}.", cure)


def _hapticd_answers(host: str, port: int) -> bool:
    connection = http.client.HTTPConnection(host, port, timeout=TIMEOUT_S)
    try:
        connection.request("GET", "/livez")
        return connection.getresponse().status == http.HTTPStatus.OK
    except (OSError, http.client.HTTPException):
        return False
    finally:
        connection.close()
