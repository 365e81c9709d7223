"""What a stability map is drawn over: two quantities of a device, and the model at each pair of them."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd.analysis.device_loop import DeviceLoop, device_loop
from hapticd.analysis.settling import RIGID
from hapticd.model import Model

Vector = NDArray[np.float64]


@dataclass(frozen=True)
class Sheet:
    """A grid over ``across`` (columns) and ``up`` (rows), and the loop and model of each of its points.

    ``stiffness`` and ``damping`` are those of a rigid wall at (across, up), N/m and N·s/m.
    """

    across: Vector
    up: Vector
    across_label: str
    up_label: str
    model_at: Callable[[float, float], Model]
    law_at: Callable[[float, float], Mapping[str, Any]]
    loop_at: Callable[[float, float], DeviceLoop]
    stiffness: Callable[[float, float], float]
    damping: Callable[[float, float], float]

    def points(self) -> list[tuple[float, float]]:
        """Every pair, row by row."""
        return [(float(x), float(y)) for y in self.up for x in self.across]


def coupling_sheet(model: Model, rate_hz: float, stiffness: Vector, damping: Vector) -> Sheet:
    """Damping across, stiffness up: the virtual coupling in front of torque drives, in the home pose."""
    loop = _loop(model, rate_hz)

    def changed(b: float, k: float) -> Model:
        return model.changed({"drive.stiffness_n_per_m": k, "drive.damping_n_s_per_m": b})

    return Sheet(
        across=damping,
        up=stiffness,
        across_label="damping B of the wall, N·s/m",
        up_label="stiffness K of the wall, N/m",
        model_at=changed,
        law_at=lambda b, k: RIGID,
        loop_at=lambda b, k: loop,
        stiffness=lambda b, k: k,
        damping=lambda b, k: b,
    )


def spring_sheet(model: Model, rate_hz: float, stiffness: Vector, damping: Vector) -> Sheet:
    """Damping across, stiffness up: a wall with the spring law, the device as it is."""

    def spring(b: float, k: float) -> Mapping[str, Any]:
        return {"type": "spring", "stiffness_n_per_m": k, "damping_n_s_per_m": b}

    coupled = coupling_sheet(model, rate_hz, stiffness, damping)
    return replace(coupled, model_at=lambda b, k: model, law_at=spring)


def tuning_sheet(model: Model, rate_hz: float, share: Vector, r_hat_share: Vector) -> Sheet:
    """R̂/R across, K_P as a share of k_T dR/L up: the spring drive, at home. At 1, K_DC = K_HF."""

    def changed(r: float, s: float) -> Model:
        return model.changed(tuning(model, r, s))

    def loop(r: float, s: float) -> DeviceLoop:
        return _loop(changed(r, s), rate_hz)

    return Sheet(
        across=r_hat_share,
        up=share,
        across_label="cancelled share R̂/R of the resistance",
        up_label="K_P as a share of k_T dR/L",
        model_at=changed,
        law_at=lambda r, s: RIGID,
        loop_at=loop,
        stiffness=lambda r, s: loop(r, s).coupling.stiffness_n_per_m,
        damping=lambda r, s: 0.0,
    )


def tuning(model: Model, r_hat_share: float, share: float) -> dict[str, Any]:
    """Overrides for R̂ = ``r_hat_share`` R and K_P = ``share`` k_T dR/L on every axis."""
    drive = json.loads(model.device_json)["drive"]
    r, k_t, inductance = (np.array(drive[name]) for name in ("r_25_ohm", "k_t_nm_per_a", "l_h"))
    return {
        "drive.r_hat_ohm": (r_hat_share * r).tolist(),
        "drive.k_p_v_per_rad": (share * k_t * (1.0 - r_hat_share) * r / inductance).tolist(),
    }


def _loop(model: Model, rate_hz: float) -> DeviceLoop:
    ticks = 1 + json.loads(model.twin_json)["command_delay_ticks"]
    home = json.loads(model.device_json)["joints"]["home_rad"]
    return device_loop(model, rate_hz, ticks / rate_hz, home)
