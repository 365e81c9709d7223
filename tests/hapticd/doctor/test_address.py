"""The address: free, held by a hapticd, or held by something else."""

from __future__ import annotations

import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, HTTPServer

from hapticd.config import ApiConfig, Config
from hapticd.doctor import Finding, Verdict, address


def examined(port: int) -> Finding:
    (finding,) = address.examine(Config(api=ApiConfig(port=port)))
    return finding


@contextmanager
def answering(status: int) -> Iterator[int]:
    """The port of a server that answers every request with ``status``."""

    class Handler(BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(status if self.path == "/livez" else 404)
            self.end_headers()

        def log_message(self, *_: object) -> None:
            return

    with HTTPServer(("127.0.0.1", 0), Handler) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server.server_address[1]
        finally:
            server.shutdown()
            thread.join()


def test_a_free_port_is_fine_and_stays_free() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    assert examined(port).verdict is Verdict.OK
    assert examined(port).verdict is Verdict.OK


def test_a_running_hapticd_is_fine() -> None:
    with answering(200) as port:
        finding = examined(port)
    assert finding.verdict is Verdict.OK
    assert "serves" in finding.detail


def test_another_web_server_fails() -> None:
    with answering(404) as port:
        finding = examined(port)
    assert finding.verdict is Verdict.FAIL
    assert finding.cure is not None
    assert str(port) in finding.cure
