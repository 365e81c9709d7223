"""Clients that hammer a daemon: REST readers and writers, and streams that want every tick.

``python -m tests.bench.hammer ADDRESS SECONDS`` prints one line of JSON: what they got.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time

import httpx
from websockets.asyncio.client import connect
from websockets.typing import Subprotocol

REST_CLIENTS = 8
STREAM_CLIENTS = 20
SIGNALS = [
    "tip_position_m",
    "tip_velocity_m_per_s",
    "tip_force_n",
    "setpoint_position_m",
    "lateness_ns",
    "tick",
]


async def rest(address: str, number: int, end_s: float, latencies_s: list[float]) -> None:
    """One client: reads a device, then edits its own wall, as fast as answers come."""
    device = ("phantom", "hhd")[number % 2]
    dof = 3 - number % 2
    async with httpx.AsyncClient(base_url=address) as http:
        while time.monotonic() < end_s:
            for request in (
                http.build_request("GET", f"/api/v1/devices/{device}"),
                http.build_request(
                    "PUT", f"/api/v1/devices/{device}/scene/walls/hammer-{number}", json=far_wall(number, dof)
                ),
            ):
                began_s = time.monotonic()
                (await http.send(request)).raise_for_status()
                latencies_s.append(time.monotonic() - began_s)


def far_wall(number: int, dof: int) -> dict[str, object]:
    """A wall out of reach: the edit is real, the force is not touched."""
    point_m, normal = [0.0] * dof, [0.0] * dof
    point_m[-1], normal[-1] = -0.9, 1.0
    eta = time.monotonic() % 1.0
    return {
        "id": f"hammer-{number}",
        "shape": {"type": "plane", "point_m": point_m, "normal": normal},
        "law": {"type": "motion", "eta": eta},
    }


async def stream(address: str, number: int, end_s: float, ticks: list[int]) -> None:
    """One client that wants every tick of one device; counts what came and what was dropped."""
    url = f"{address.replace('http', 'ws', 1)}/api/v1/stream"
    subscribe = {"type": "subscribe", "id": "all", "device": ("phantom", "hhd")[number % 2]}
    async with connect(url, subprotocols=[Subprotocol("hapticd.v1+json")], max_size=None) as socket:
        await socket.send(json.dumps({"type": "hello", "version": 1}))
        await socket.send(json.dumps({**subscribe, "signals": SIGNALS, "mode": "batch"}))
        while time.monotonic() < end_s:
            message = json.loads(await socket.recv())
            if message["type"] == "data":
                ticks[0] += len(message["values"]["tick"])
                ticks[1] += message["dropped"]


async def hammer(address: str, seconds: float) -> dict[str, float]:
    """All of them at once for ``seconds``."""
    end_s = time.monotonic() + seconds
    latencies_s: list[float] = []
    ticks = [0, 0]
    async with asyncio.TaskGroup() as tasks:
        for number in range(REST_CLIENTS):
            tasks.create_task(rest(address, number, end_s, latencies_s))
        for number in range(STREAM_CLIENTS):
            tasks.create_task(stream(address, number, end_s, ticks))
    latencies_s.sort()
    return {
        "requests": len(latencies_s),
        "p50_ms": 1e3 * latencies_s[len(latencies_s) // 2],
        "p99_ms": 1e3 * latencies_s[len(latencies_s) * 99 // 100],
        "ticks": ticks[0],
        "dropped": ticks[1],
    }


if __name__ == "__main__":
    print(json.dumps(asyncio.run(hammer(sys.argv[1], float(sys.argv[2])))))
