"""Every line of docs/walls.md that can be sent is accepted, in the order in which it is written."""

from __future__ import annotations

import json
import re
from pathlib import Path

import httpx

PAGE = Path(__file__).parents[2] / "docs" / "walls.md"
LINE = re.compile(r"^send -X (PUT|PATCH) \"?\$(P|H)(/[^ \"]+)\"? -d '(.*)'$", re.MULTILINE)
DEVICES = {"P": "phantom", "H": "hhd"}


async def test_every_line_of_the_page_is_accepted(http: httpx.AsyncClient) -> None:
    text = PAGE.read_text(encoding="utf-8")
    lines = LINE.findall(text)
    assert len(lines) == text.count("\nsend ")
    for method, device, path, body in lines:
        address = f"/api/v1/devices/{DEVICES[device]}/scene/walls{path}"
        answer = await http.request(method, address, json=json.loads(body))
        assert answer.is_success, (path, answer.text)


async def test_lines_that_force_would_be_refused_without(http: httpx.AsyncClient) -> None:
    forced = 0
    for method, device, path, body in LINE.findall(PAGE.read_text(encoding="utf-8")):
        path, _, force = path.partition("?")
        address = f"/api/v1/devices/{DEVICES[device]}/scene/walls{path}"
        answer = await http.request(method, address, json=json.loads(body))
        assert (answer.status_code == 422) == bool(force), (path, answer.text)
        forced += bool(force)
    assert forced
