"""One device at its wall as the analysis sees it: what the model says about tip, drive and sampling."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from hapticd import _core
from hapticd.analysis.linear_loop import LinearLoop
from hapticd.analysis.passivity_limit import SampledWall
from hapticd.analysis.tip import Tip, tip_at, worst_tip
from hapticd.model import Model


@dataclass(frozen=True, slots=True)
class Coupling:
    """What stands between set-point and tip.

    A torque drive has a virtual coupling: ``stiffness_n_per_m`` and ``damping_n_s_per_m`` of a rigid wall,
    ``lag_s`` of the motors; ``series_n_per_m`` is 0. A spring drive gives k_c = λ_min(J⁻ᵀ K_q J⁻¹) of K_DC as
    tuned, ``series_n_per_m`` the same of K_HF, and ``lag_s`` is L/dR.
    """

    stiffness_n_per_m: float
    damping_n_s_per_m: float
    lag_s: float
    series_n_per_m: float

    @property
    def is_spring_drive(self) -> bool:
        """Whether stiffness is bounded by what the drives are tuned to."""
        return self.series_n_per_m > 0.0


@dataclass(frozen=True, slots=True)
class DeviceLoop:
    """One device at one rate and delay."""

    tip: Tip
    coupling: Coupling
    lambda_rad_per_s: float
    force_max_n: float
    rate_hz: float
    delay_s: float

    @property
    def linear(self) -> LinearLoop:
        """The closed loop without contact and dry friction."""
        return LinearLoop(
            mass_kg=self.tip.mass_kg,
            friction_n_s_per_m=self.tip.viscous_n_s_per_m,
            rate_hz=self.rate_hz,
            delay_s=self.delay_s,
            lag_s=self.coupling.lag_s,
            lambda_rad_per_s=self.lambda_rad_per_s,
            series_n_per_m=self.coupling.series_n_per_m,
        )

    @property
    def sampled(self) -> SampledWall:
        """The wall as a source of energy."""
        return SampledWall(
            friction_n_s_per_m=self.tip.viscous_n_s_per_m,
            rate_hz=self.rate_hz,
            delay_s=self.delay_s,
            lag_s=self.coupling.lag_s,
            lambda_rad_per_s=self.lambda_rad_per_s,
            series_n_per_m=self.coupling.series_n_per_m,
        )


def device_loop(
    model: Model, rate_hz: float, delay_s: float | None = None, q: Sequence[float] | None = None
) -> DeviceLoop:
    """The loop of a device model at ``rate_hz`` and ``delay_s``, by default one tick.

    ``q``, (3,) rad, is the pose looked at. Without it a torque drive is looked at where its workspace is
    worst, and a spring drive, whose stiffness follows the pose, at home. ``ValueError`` at a singularity.
    """
    tip, coupling, lambda_rad_per_s, force_max_n = _facts(model, None if q is None else tuple(q))
    delay_s = 1.0 / rate_hz if delay_s is None else delay_s
    return DeviceLoop(tip, coupling, lambda_rad_per_s, force_max_n, rate_hz, delay_s)


@lru_cache(maxsize=256)
def _facts(model: Model, q: tuple[float, ...] | None) -> tuple[Tip, Coupling, float, float]:
    device: dict[str, Any] = json.loads(model.device_json)
    lambda_rad_per_s = device["estimator"]["lambda_rad_per_s"]
    force_max_n = device["limits"]["tip_force_n"]
    if device["drive"]["type"] == "torque":
        tip = worst_tip(model) if q is None else tip_at(model, q)
        return tip, _virtual_coupling(device["drive"]), lambda_rad_per_s, force_max_n
    pose = device["joints"]["home_rad"] if q is None else q
    coupling = _spring_coupling(model, device["drive"], pose)
    return tip_at(model, pose), coupling, lambda_rad_per_s, force_max_n


def _virtual_coupling(drive: dict[str, Any]) -> Coupling:
    return Coupling(drive["stiffness_n_per_m"], drive["damping_n_s_per_m"], drive["lag_s"], 0.0)


def _spring_coupling(model: Model, drive: dict[str, Any], q: Sequence[float]) -> Coupling:
    axis = {name: np.array(drive[name]) for name in ("ratio", "k_t_nm_per_a", "l_h", "k_p_v_per_rad")}
    d_r = np.array(drive["r_25_ohm"]) - np.array(drive["r_hat_ohm"])
    k_dc = axis["ratio"] ** 2 * axis["k_t_nm_per_a"] * axis["k_p_v_per_rad"] / d_r
    k_hf = axis["ratio"] ** 2 * axis["k_t_nm_per_a"] ** 2 / axis["l_h"]
    jacobian = _core.Kinematics(model.device_json).jacobian(q)
    return Coupling(
        stiffness_n_per_m=_core.isotropic_stiffness(jacobian, k_dc.tolist()),
        damping_n_s_per_m=0.0,
        lag_s=float(np.max(axis["l_h"] / d_r)),
        series_n_per_m=_core.isotropic_stiffness(jacobian, k_hf.tolist()),
    )
