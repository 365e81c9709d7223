"""How the PHANTOM's spring drives are tuned in an experiment: what the paper leaves open, as parameters."""

from __future__ import annotations

import json
from typing import Any

import numpy as np

from hapticd.experiments.experiment import Parameter
from hapticd.experiments.run import Run

MODEL = "phantom-1.0"

RESIDUAL = Parameter(
    "residual_share",
    0.05,
    "1",
    "dR/R, what the cancellation leaves of the winding's resistance: 1 − R̂/R",
    "assumed, range 0.02…0.1: WN give no number",
    minimum=0.002,
    maximum=0.5,
    uncertain=True,
)

TUNING = Parameter(
    "k_p_share",
    0.6,
    "1",
    "K_P as a share of k_T dR/L, which is K_DC as a share of K_HF",
    "assumed, passive up to 1: WN give no number",
    minimum=0.01,
    maximum=3.0,
    uncertain=True,
)


def tuned(run: Run) -> dict[str, Any]:
    """R̂ and K_P of every drive as ``RESIDUAL`` and ``TUNING`` say, by dotted key."""
    drive = json.loads(run.model(MODEL).device_json)["drive"]
    r, k_t, inductance = (np.array(drive[key]) for key in ("r_25_ohm", "k_t_nm_per_a", "l_h"))
    d_r = run.number(RESIDUAL.name) * r
    k_p = run.number(TUNING.name) * k_t * d_r / inductance
    return {"drive.r_hat_ohm": (r - d_r).tolist(), "drive.k_p_v_per_rad": k_p.tolist()}
