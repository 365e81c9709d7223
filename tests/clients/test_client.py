"""The client sends what the API documents, and turns every failure into one of its errors."""

from __future__ import annotations

import httpx
import pytest

from hapticd_client import Client, NotHapticd, Refused, Unreachable, plane
from tests.clients.daemon_double import DaemonDouble, device, problem

FLOOR = plane("floor", point_m=[0.0, 0.0, -0.02], normal=[0.0, 0.0, 1.0])


def test_devices_are_listed_in_the_daemons_order(client: Client, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices", {"devices": [device("phantom"), device("hhd")]})
    assert [each["id"] for each in client.devices()] == ["phantom", "hhd"]


def test_enabling_asks_for_the_state(client: Client, double: DaemonDouble) -> None:
    double.answer("PUT /api/v1/devices/phantom/state", {"state": "enabled"})
    client.enable("phantom")
    assert double.last_body == {"desired": "enabled"}


def test_a_wall_is_put_under_its_id(client: Client, double: DaemonDouble) -> None:
    double.answer("PUT /api/v1/devices/phantom/scene/walls/floor", {"wall": FLOOR})
    client.put_wall("phantom", FLOOR)
    assert double.last_body == FLOOR
    assert "if-match" not in double.requests[-1].headers
    assert "if-none-match" not in double.requests[-1].headers


def test_a_new_wall_must_not_replace_another(client: Client, double: DaemonDouble) -> None:
    double.answer("PUT /api/v1/devices/phantom/scene/walls/floor", {"wall": FLOOR})
    client.put_wall("phantom", FLOOR, create_only=True)
    assert double.requests[-1].headers["if-none-match"] == "*"


def test_an_edit_carries_the_tag_it_was_made_from(client: Client, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices/phantom/scene", {"walls": []})
    double.answer("PUT /api/v1/devices/phantom/scene", {"revision": 8})
    scene, etag = client.scene("phantom")
    client.replace_scene("phantom", scene, etag=etag)
    assert double.requests[-1].headers["if-match"] == '"7"'


def test_a_dry_run_says_so(client: Client, double: DaemonDouble) -> None:
    double.answer("DELETE /api/v1/devices/phantom/scene/walls/floor", {"wall": None})
    client.delete_wall("phantom", "floor", dry_run=True)
    assert double.requests[-1].url.params["dry_run"] == "true"


def test_an_edit_is_not_dry_by_default(client: Client, double: DaemonDouble) -> None:
    double.answer("DELETE /api/v1/devices/phantom/scene/walls/floor", {"wall": None})
    client.delete_wall("phantom", "floor")
    assert not double.requests[-1].url.query


def test_an_id_with_a_slash_stays_one_segment(client: Client, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices/a%2Fb", device("a/b"))
    assert client.device("a/b")["id"] == "a/b"


def test_estops_of_all_devices_go_out_in_one_request(client: Client, double: DaemonDouble) -> None:
    double.answer("PUT /api/v1/estop", {"engaged": True, "devices": []})
    client.engage_all_estops()
    assert double.lines == ["PUT /api/v1/estop"]


def test_a_refusal_carries_the_whole_problem(client: Client, double: DaemonDouble) -> None:
    interlock = {"id": "estop-latched", "ok": False, "why": "It is latched.", "cure": "Acknowledge it."}
    document = problem("interlock-open", 409, interlocks=[interlock], pointer="/desired", retryable=True)
    double.answer("PUT /api/v1/devices/phantom/state", document, status=409)
    with pytest.raises(Refused, match=r"This is the detail of interlock-open\.") as caught:
        client.enable("phantom")
    refused = caught.value
    assert (refused.slug, refused.status, refused.retryable) == ("interlock-open", 409, True)
    assert (refused.pointer, refused.interlocks) == ("/desired", [interlock])
    assert refused.document() == document


def test_a_daemon_that_is_not_there_is_named_with_its_address(client: Client, double: DaemonDouble) -> None:
    double.fail("GET /api/v1/devices", httpx.ConnectError("[Errno 111] Connection refused"))
    with pytest.raises(Unreachable, match=r"No daemon answers at http://daemon\.test: Connection refused\."):
        client.devices()


def test_a_daemon_that_says_nothing_is_unreachable(client: Client, double: DaemonDouble) -> None:
    double.fail("GET /api/v1/devices", httpx.ReadTimeout("timed out"))
    with pytest.raises(Unreachable, match="did not answer in time"):
        client.devices()


def test_a_web_page_on_the_port_is_not_taken_for_a_daemon(client: Client, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices", "<html>welcome</html>")
    with pytest.raises(NotHapticd, match="text/plain"):
        client.devices()


def test_an_error_of_another_program_is_not_taken_for_a_refusal(client: Client, double: DaemonDouble) -> None:
    double.answer("GET /api/v1/devices", {"message": "nope"}, status=500)
    with pytest.raises(NotHapticd, match="HTTP 500 without a problem document"):
        client.devices()


def test_the_address_comes_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HAPTICD_URL", "http://lab.test:9000/")
    with Client() as client:
        assert client.url == "http://lab.test:9000"


def test_the_address_is_the_daemons_default_otherwise(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("HAPTICD_URL", raising=False)
    with Client() as client:
        assert client.url == "http://127.0.0.1:8420"
