"""The direction of the force on a device of a daemon whose tip is locked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.phantom_pose import joint_stiffness
from hapticd.analysis.stiffness import direction_error_rad, locked_joints
from hapticd.experiments.bench import DeviceBench
from hapticd.experiments.direction_series import Series, wall_angles
from hapticd.experiments.drive_tuning import MODEL
from hapticd.experiments.plane_wall import plane_wall
from hapticd.experiments.run import Run
from hapticd.problem import Problem

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]

LOOK_S = 0.1
"""Time over which the pose is averaged at the start."""

CLAMP_S = 1.0
"""Time in which a twin's clamp takes hold."""

MEASURED = "the force sensor"
ESTIMATED = "the motors' estimate, which sees neither friction nor the sensor's mounting"


@dataclass(frozen=True)
class OnDevice:
    """Both mappings, where the tip was and how far it moved, m, and whence the force is known."""

    series: Mapping[str, Series]
    tip: Vector
    force_from: str
    depth_m: float
    moved_m: float

    @property
    def locked(self) -> bool:
        """Whether the tip stayed inside of every wall."""
        return self.moved_m < self.depth_m


@dataclass(frozen=True)
class Held:
    """A tip that is held: its place, the two directions (2, 3) of the plane of the links, and K_inv in it."""

    tip: Vector
    plane: Matrix
    k_inv: Matrix


@dataclass(frozen=True)
class Reading:
    """Force on what holds the tip, N, whether a sensor measured it, and where the tip was, m."""

    force_n: Vector
    sensed: bool
    tip: Vector


async def measure_on(run: Run, bench: DeviceBench) -> OnDevice:
    """Every wall in turn, both mappings. ``Problem`` when the device is no PHANTOM."""
    if bench.model != MODEL:
        detail = f"{bench.device_id} is a {bench.model}; both mappings are those of spring drives."
        raise Problem("parameter-invalid", detail, hint=f"Choose a device of model {MODEL}.")
    held = await _held(run, bench)
    try:
        return await _all_around(run, bench, held)
    finally:
        if bench.is_twin:
            await bench.hand({"type": "free"})


async def _all_around(run: Run, bench: DeviceBench, held: Held) -> OnDevice:
    found: dict[str, Series] = {}
    readings: list[Reading] = []
    angles = wall_angles(run.number("spacing_deg"))
    for mapping in ("transpose", "inverse"):
        for index, angle in enumerate(angles):
            done = (len(found) + index / len(angles)) / 2
            run.progress(done, f"{mapping}, wall {index + 1} of {len(angles)}")
            readings.append(await _read(run, bench, held, mapping, float(angle)))
        forces = np.array([held.plane @ reading.force_n for reading in readings[-len(angles) :]])
        inverse = partial(direction_error_rad, held.k_inv)
        found[mapping] = Series(angles, forces, inverse if mapping == "inverse" else np.zeros_like)
    moved_m = max(float(np.linalg.norm(reading.tip - held.tip)) for reading in readings)
    force_from = MEASURED if readings[-1].sensed else ESTIMATED
    return OnDevice(found, held.tip, force_from, run.number("depth_m"), moved_m)


async def _held(run: Run, bench: DeviceBench) -> Held:
    await bench.scene({"walls": []})
    records = await bench.record(LOOK_S)
    if bench.is_twin:
        tip = records["tip_position_m"][-1].tolist()
        await bench.hand({"type": "clamp", "position_m": tip})
        records = (await bench.record(CLAMP_S))[-round(LOOK_S * bench.rate_hz) :]
    q, tip = records["joint_position_rad"].mean(axis=0), records["tip_position_m"].mean(axis=0)
    model = run.model(MODEL)
    jacobian = np.array(_core.Kinematics(model.device_json).jacobian(q))
    outward = np.array([np.cos(q[0]), np.sin(q[0]), 0.0])
    plane = np.stack([outward, [0.0, 0.0, 1.0]])
    return Held(tip, plane, locked_joints((plane @ jacobian)[:, 1:], joint_stiffness(model)[1:]))


async def _read(run: Run, bench: DeviceBench, held: Held, mapping: str, angle_rad: float) -> Reading:
    """What a wall adds to the force of the device on what holds it."""
    n = held.plane.T @ np.array([np.cos(angle_rad), np.sin(angle_rad)])
    wall = plane_wall(n, float(n @ held.tip) + run.number("depth_m"))
    settle_s, measure_s = run.number("settle_s"), run.number("measure_s")
    tare = await bench.record(run.number("rest_s") + settle_s + measure_s)
    await bench.scene({"mapping": mapping, "walls": [wall]})
    await bench.record(settle_s)
    records = await bench.record(measure_s)
    await bench.scene({"walls": []})
    sensed = bool(np.any(records["sensor_force_n"]))
    column, sign = ("sensor_force_n", -1.0) if sensed else ("tip_force_n", 1.0)
    before = tare[column][-len(records) :].mean(axis=0)
    force_n = sign * (records[column].mean(axis=0) - before)
    return Reading(force_n, sensed, records["tip_position_m"].mean(axis=0))
