"""Stability and stiffness of a device over HTTP, and walls that are refused because of them."""

from __future__ import annotations

from typing import Any

import httpx
import numpy as np
import pytest

from tests.api.test_problems import problem_of

STABILITY = "/api/v1/devices/{}/analysis/stability"
STIFFNESS = "/api/v1/devices/{}/analysis/stiffness"


async def analysed(http: httpx.AsyncClient, device_id: str, **question: Any) -> dict[str, Any]:
    response = await http.post(STABILITY.format(device_id), json=question)
    assert response.status_code == 200, response.text
    answer: dict[str, Any] = response.json()
    return answer


def spring(stiffness: float, damping: float = 0.0) -> dict[str, Any]:
    return {"type": "spring", "stiffness_n_per_m": stiffness, "damping_n_s_per_m": damping}


async def test_budget_names_limits_margin_and_what_would_raise_them(http: httpx.AsyncClient) -> None:
    budget = await analysed(http, "hhd", law=spring(500.0))
    assert budget["verdict"] == "passive"
    assert budget["requested_n_per_m"] == 500.0
    assert 500.0 < budget["largest_passive_n_per_m"] < budget["largest_linear_n_per_m"]
    assert {limit["name"] for limit in budget["limits"]} >= {"sampling", "resolution", "linear"}
    raised = {advice["parameter"]: advice for advice in budget["advice"]}
    assert raised["damping_n_s_per_m"]["limit_then"] > raised["damping_n_s_per_m"]["limit_now"]


async def test_budget_of_the_phantom_speaks_of_its_drive(http: httpx.AsyncClient) -> None:
    budget = await analysed(http, "phantom", law=spring(50e3))
    limits = {limit["name"]: limit["value"] for limit in budget["limits"]}
    assert limits["tuning"] == pytest.approx(0.6 * limits["spring_drive"], rel=1e-3)
    assert budget["granted_n_per_m"] == pytest.approx(limits["tuning"])


async def test_rate_and_delay_of_the_question_are_used(http: httpx.AsyncClient) -> None:
    law = spring(500.0, 50.0)
    now = await analysed(http, "hhd", law=law)
    faster = await analysed(http, "hhd", law=law, rate_hz=4000.0)
    slower = await analysed(http, "hhd", law=law, delay_s=5e-3)
    assert now["delay_s"] == pytest.approx(1e-3)
    assert faster["delay_s"] == pytest.approx(0.25e-3)
    assert faster["largest_linear_n_per_m"] > now["largest_linear_n_per_m"] > slower["largest_linear_n_per_m"]


async def test_question_with_a_field_nobody_knows_is_refused(http: httpx.AsyncClient) -> None:
    response = await http.post(STABILITY.format("hhd"), json={"law": spring(1.0), "speed": 1})
    assert problem_of(response, 422, "unknown-field")["pointer"] == "/speed"


@pytest.mark.parametrize("question", [{"rate_hz": 1.0}, {"delay_s": -1e-3}])
async def test_rates_and_delays_that_make_no_sense_are_refused(
    http: httpx.AsyncClient, question: dict[str, float]
) -> None:
    response = await http.post(STABILITY.format("hhd"), json={"law": spring(1.0), **question})
    problem_of(response, 422, "invalid-document")


async def test_stiffness_at_a_pose_is_an_ellipsoid_around_the_ball_of_the_transpose(
    http: httpx.AsyncClient,
) -> None:
    """WN Fig. 3: at q3 − q2 = 30° the links' plane has κ = 3 (physics §3.2)."""
    stiffness = (await http.get(STIFFNESS.format("phantom"), params={"q": "0,0,0.5235987756"})).json()
    softest, *_, hardest = (axis["stiffness_n_per_m"] for axis in stiffness["inverse"])
    in_plane = [a["stiffness_n_per_m"] for a in stiffness["inverse"] if abs(a["direction"][1]) < 1e-6]
    assert in_plane[1] / in_plane[0] == pytest.approx(3.0, rel=1e-3)
    assert stiffness["transpose_n_per_m"] == pytest.approx(softest, rel=1e-6)
    assert softest < hardest
    assert stiffness["workspace_n_per_m"] <= stiffness["transpose_n_per_m"]
    assert stiffness["tip_position_m"] == pytest.approx([0.21, 0.0, -0.121], abs=1e-3)
    for axis in stiffness["inverse"]:
        assert np.linalg.norm(axis["direction"]) == pytest.approx(1.0)


async def test_stiffness_of_the_hhd_is_its_virtual_coupling(http: httpx.AsyncClient) -> None:
    stiffness = (await http.get(STIFFNESS.format("hhd"), params={"q": "0.5236,2.618"})).json()
    assert stiffness["inverse"] is None
    assert stiffness["transpose_n_per_m"] == 60_000.0
    assert stiffness["tip_position_m"] == pytest.approx([0.0, 0.2], abs=1e-4)


async def test_pose_with_too_few_angles_is_refused(http: httpx.AsyncClient) -> None:
    problem_of(await http.get(STIFFNESS.format("phantom"), params={"q": "0,0"}), 422, "dimension-mismatch")


@pytest.mark.parametrize("pose", ["0,zero,0", "0,nan,0", "0,1e9,0"])
async def test_pose_that_is_no_pose_is_refused(http: httpx.AsyncClient, pose: str) -> None:
    problem_of(await http.get(STIFFNESS.format("phantom"), params={"q": pose}), 422, "invalid-document")


async def test_singular_pose_is_refused(http: httpx.AsyncClient) -> None:
    response = await http.get(STIFFNESS.format("hhd"), params={"q": "1.3,1.3"})
    assert "singular" in problem_of(response, 422, "invalid-document")["detail"]


async def test_stiffness_of_an_offline_device_needs_a_pose(http: httpx.AsyncClient) -> None:
    problem_of(await http.get(STIFFNESS.format("bench")), 409, "device-offline")
    assert (await http.get(STIFFNESS.format("bench"), params={"q": "0.5236,2.618"})).status_code == 200
