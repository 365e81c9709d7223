"""The daemon: where it listens, and that it ends when told to."""

from __future__ import annotations

import os
import signal
import socket
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from unittest.mock import Mock

import pytest

from hapticd import _core
from hapticd.config import ApiConfig
from hapticd.daemon import NOTSENT_LOWAT_BYTES, address_of, listen
from hapticd.problem import Problem
from hapticd.supervisor import is_running

DAEMON = """
import sys
from pathlib import Path
from hapticd.config import load_config
from hapticd.daemon import run
run(load_config(Path(sys.argv[1])))
"""


def test_taken_port_is_a_problem_that_names_it() -> None:
    with closing(listen(ApiConfig(port=0))) as first:
        first.listen()
        port = first.getsockname()[1]
        with pytest.raises(Problem, match=f"127.0.0.1 port {port} is taken") as caught:
            listen(ApiConfig(port=port))
    assert caught.value.slug == "address-in-use"


def test_address_can_be_opened_in_a_browser() -> None:
    with closing(listen(ApiConfig(host="localhost", port=0))) as listener:
        assert address_of(listener) == f"http://127.0.0.1:{listener.getsockname()[1]}/"
    version_6 = Mock(spec=socket.socket)
    version_6.getsockname.return_value = ("::1", 8420, 0, 0)
    assert address_of(version_6) == "http://[::1]:8420/"


def test_frozen_client_gets_little_stale_data_and_small_answers_do_not_wait() -> None:
    with closing(listen(ApiConfig(port=0))) as listener:
        listener.listen()
        with (
            closing(socket.create_connection(listener.getsockname())),
            closing(listener.accept()[0]) as accepted,
        ):
            kept = accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT)
            prompt = accepted.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)
    assert kept == NOTSENT_LOWAT_BYTES
    assert prompt, "small answers wait for the client's delayed ACK"


@pytest.mark.system
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_signal_ends_daemon_and_servos(tmp_path: Path, number: signal.Signals) -> None:
    config = tmp_path / "hapticd.toml"
    config.write_text(
        f"[api]\nport = 0\n[paths]\nstate_dir = '{tmp_path}/state'\nruntime_dir = '{tmp_path}/run'\n"
    )
    command = [sys.executable, "-c", DAEMON, str(config)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as daemon:
        assert daemon.stdout is not None
        assert daemon.stdout.readline().startswith("hapticd is ready: http://127.0.0.1:")
        os.kill(daemon.pid, number)
        assert daemon.wait(timeout=60) == 0
    for region in ("phantom.shm", "hhd.shm"):
        servo = _core.Front(str(tmp_path / "run" / region), observe=True)
        assert not is_running(servo.info()["pid"])
        servo.close()
