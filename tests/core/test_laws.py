"""Every wall's law in the core against its restatement in numpy, over random inputs."""

import json
from typing import Any

import numpy as np
import pytest

from hapticd._core import Law
from tests.oracle import law as oracle
from tests.oracle.devices import BOTH, HHD, device, device_json

PERIODS_S = (0.001, 0.0005, 0.00025)


def cubic(c: float, form: str) -> dict[str, Any]:
    return {"type": "cubic_damper", "coefficient_n_s3_per_m3": c, "form": form}


def random_laws(rng: np.random.Generator) -> list[dict[str, Any]]:
    """One of every law."""
    c = float(10 ** rng.uniform(3, 9))
    stiffness, damping = float(rng.uniform(1, 2e5)), float(rng.uniform(0, 2e3))
    return [
        {"type": "motion", "eta": float(rng.uniform(0, 1))},
        {"type": "spring", "stiffness_n_per_m": stiffness, "damping_n_s_per_m": damping},
        {"type": "damper", "damping_n_s_per_m": damping},
        cubic(c, "explicit"),
        cubic(c, "implicit"),
    ]


def lag_s(name: str) -> float:
    """The drive's: of a winding with the residual resistance, or of a torque-commanded motor."""
    drive = device(name)["drive"]
    if name == HHD:
        return float(drive["lag_s"])
    return float(max(np.array(drive["l_h"]) / np.subtract(drive["r_25_ohm"], drive["r_hat_ohm"])))


def hardest(name: str, period_s: float) -> float:
    model = device(name)
    lam = model["estimator"]["lambda_rad_per_s"]
    return oracle.hardest_damper(model["tip"]["mass_kg"], period_s, lag_s(name), lam)


@pytest.mark.parametrize("name", BOTH)
def test_every_wall_without_spring_pushes_as_its_law_says(name: str) -> None:
    rng = np.random.default_rng(11)
    limit = device(name)["limits"]["tip_force_n"]
    for period_s in PERIODS_S:
        bound = hardest(name, period_s)
        for law in random_laws(rng):
            core = Law(device_json(name), json.dumps(law), period_s)
            for v in [*rng.uniform(-1, 2, 4), *10 ** rng.uniform(-4, 0, 4), 0.0]:
                expected = oracle.damper_force(law, float(v), bound, limit)
                assert core.damper_force(v) == pytest.approx(expected, rel=1e-3, abs=1e-9), (law, v)


@pytest.mark.parametrize("name", BOTH)
def test_every_wall_with_a_spring_is_as_stiff_as_its_law_says(name: str) -> None:
    rng = np.random.default_rng(12)
    for _ in range(50):
        rigid = (float(rng.uniform(100, 1e5)), float(rng.uniform(0, 500)))
        reference = rigid[0] * float(rng.choice([1.0, rng.uniform(1, 5)]))
        for law in random_laws(rng):
            core = Law(device_json(name), json.dumps(law), 0.001)
            assert core.spring(*rigid) == pytest.approx(oracle.spring(law, rigid))
            expected = oracle.penetration_let_pass(law, rigid[0], reference)
            assert core.eta(rigid[0], reference) == pytest.approx(expected, abs=1e-12)


def test_implicit_form_is_the_printed_one_where_slow_and_bounded_where_fast() -> None:
    printed = Law(device_json(HHD), json.dumps(cubic(1.6e6, "explicit")), 0.001)
    implicit = Law(device_json(HHD), json.dumps(cubic(1.6e6, "implicit")), 0.001)
    assert implicit.damper_force(1e-3) == pytest.approx(printed.damper_force(1e-3), rel=0.02)
    slope = (implicit.damper_force(0.1) - implicit.damper_force(0.099)) / 0.001
    assert slope < hardest(HHD, 0.001)
    assert printed.damper_force(0.04) == pytest.approx(102.4)


def test_unknown_law_is_refused() -> None:
    with pytest.raises(ValueError, match="unknown variant"):
        Law(device_json(HHD), json.dumps({"type": "magic"}), 0.001)
