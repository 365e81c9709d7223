"""What WN say about the drive beside its curve: compliant walls, free space, drift without compensation."""

from __future__ import annotations

import json

import numpy as np

from hapticd.experiments.drive_tuning import MODEL
from hapticd.experiments.run import Run
from hapticd.experiments.stiffness_curve import (
    JOINT,
    POSE_RAD,
    drive_of,
    drive_overrides,
    hold,
    shake_of,
    stiffness_at,
)

SLOW_HZ = 1.0
"""Slow enough for the static stiffness: 1 % of the corner of the spring drive."""

HAND_HZ = 5.0
"""As fast as a hand moves by itself."""

PUSH_N = 0.5
"""Gentle: the residual damper gives in with 40 mm/s."""

DEVICE_MASS_KG = 0.075
"""Apparent mass of the tip, the maker's figure."""


def compliant(run: Run) -> dict[str, float]:
    """Static stiffness behind a wall of η, as a share of that behind a rigid one (WN eq. 17)."""
    rate_hz = run.number("servo_rate_hz")

    def static(eta: float) -> float:
        _, scene = hold(run, eta)
        return abs(stiffness_at(run, "p", shake_of(run, rate_hz, SLOW_HZ, scene))[0])

    return {"eta": run.number("eta"), "share_of_rigid": static(run.number("eta")) / static(0.0)}


def free_space(run: Run) -> dict[str, float]:
    """Mass that the filtered set-point velocity adds at the tip in free space, kg (WN eq. 16)."""
    rate_hz = run.number("servo_rate_hz")
    stiffness, _ = stiffness_at(run, "p", shake_of(run, rate_hz, HAND_HZ, {}))
    drive = drive_of(run, "p")
    frequency_hz = np.array([HAND_HZ])
    omega_squared = (2 * np.pi * HAND_HZ) ** 2
    delay_ticks = 1 + json.loads(run.model(MODEL).twin_json)["command_delay_ticks"]
    sampled = drive.sampled_free_space(frequency_hz, 1.0 / rate_hz, delay_ticks)[0]
    scale = _tip_scale(run)
    return {
        "added_mass_kg": -stiffness.real / omega_squared * scale,
        "closed_form_kg": drive.added_inertia * scale,
        "sampled_form_kg": float(-sampled.real) / omega_squared * scale,
        "device_mass_kg": DEVICE_MASS_KG,
    }


def drift(run: Run) -> dict[str, float]:
    """Steady motion under a steady push without compensation, and the damper that makes of it."""
    axis, scene = hold(run)
    overrides = {**drive_overrides(run, "spring_drive"), "joints.home_rad": POSE_RAD.tolist()}
    twin = run.twin(MODEL, overrides=overrides)
    twin.scene(scene)
    twin.enable()
    twin.run(0.4)
    twin.hand({"type": "push", "direction": axis.tolist(), "force_n": PUSH_N})
    last = twin.run(0.8)[-300:]
    moved_m = (last["tip_position_m"][-1] - last["tip_position_m"][0]) @ axis
    speed = float(moved_m) / (len(last) - 1) * twin.rate_hz
    force_n = float(np.mean(last["hand_force_n"] @ axis))
    return {
        "speed_m_per_s": speed,
        "force_n": force_n,
        "damping_n_s_per_m": force_n / speed,
        "residual_damper_n_s_per_m": drive_of(run, "spring_drive").b_dr * _tip_scale(run),
    }


def _tip_scale(run: Run) -> float:
    """From the rotor to the tip along the joint's own direction: (ρ/l)², 1/m²."""
    device = json.loads(run.model(MODEL).device_json)
    return float((device["drive"]["ratio"][JOINT] / device["kinematics"]["l1_m"]) ** 2)
