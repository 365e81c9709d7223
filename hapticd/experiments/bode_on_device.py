"""The stiffness of a device of a daemon whose tip is locked: its set-point moves, its motors answer."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.phasor import phasor
from hapticd.analysis.rendered_stiffness import RenderedStiffness, SpringDrives, VirtualCoupling
from hapticd.experiments.bench import DeviceBench
from hapticd.experiments.bode_series import BodeSeries
from hapticd.experiments.drive_tuning import MODEL
from hapticd.experiments.experiment import Parameter
from hapticd.experiments.run import Run
from hapticd.experiments.stiffness_curve import KEEP_OFF
from hapticd.model import Model, load_model

Vector = NDArray[np.float64]
Matrix = NDArray[np.float64]
Spectrum = NDArray[np.complex128]

PROBE = Parameter(
    "probe_m",
    3e-4,
    "m",
    "Motion of the set-point on a device; less where a limit of its force would act",
    "chosen: a third of it is more than the encoders' counts",
    minimum=1e-4,
    maximum=2e-3,
)

LOOK_S = 0.1
"""Time over which the pose is averaged at the start."""

CLAMP_S = 1.0
"""Time in which a twin's clamp takes hold."""

FADE_S = 0.05
SETTLE_S = 0.2
"""From one frequency to the next: cross-fade, and with it the time until the measurement, s."""

PERIODS = 2.0
WINDOW_S = 0.3
"""Periods and time measured at least, s."""

FORCE_SHARE = 0.3
SLEW_SHARE = 0.5
"""Shares of the limits of force and slew rate that the probe may ask for: there the answer is linear."""

LOCKED_SHARE = 1.0 / 3.0
"""Share of ``probe_m`` by which a locked tip may move."""

CURRENT_PRESENT = 1 << 1
"""Bit of ``observation_status``: the motor currents are measured."""

DELAY_TICKS: Mapping[str, int] = {"estimate": 0, "currents": 1, "sensor": 1}
"""The estimate steps with its command; what the device measures comes an exchange later."""

FORCE_FROM: Mapping[str, str] = {
    "currents": "the measured motor currents",
    "estimate": "the daemon's model of the motors, which sees neither their faults nor friction",
    "sensor": "the force sensor",
}


@dataclass(frozen=True)
class Held:
    """A tip that is held: its place, the probe's direction (3,), joint angles (3,), and the device model."""

    model: Model
    q: Vector
    tip: Vector
    direction: Vector

    def form(self, k_c: float, winding_c: Vector) -> RenderedStiffness:
        """The closed form of what is rendered here."""
        if self.model.name == MODEL:
            return SpringDrives.at(self.model, k_c, self.q, self.direction, winding_c)
        return VirtualCoupling.of_model(self.model)

    def by_joints(self, torque_nm: Matrix) -> Vector:
        """Force along the probe's direction, N, of joint torques (n, 3)."""
        dof = self.model.dof
        jacobian = np.array(_core.Kinematics(self.model.device_json).jacobian(self.q))[:dof, :dof]
        return np.asarray(torque_nm[:, :dof] @ np.linalg.solve(jacobian, self.direction[:dof]))


@dataclass(frozen=True)
class Answer:
    """One frequency: stiffness by instrument, N/m, and what tells whether it may be believed.

    ``moved_m`` is how far the tip got from where it was held, ``limits`` the bits of the limits that acted.
    """

    frequency_hz: float
    stiffness: Mapping[str, complex]
    k_c: float
    winding_c: Vector
    moved_m: float
    limits: int


@dataclass(frozen=True)
class BodeOnDevice:
    """Every instrument's series, the closed form, k_c of the records, and what may speak against them."""

    series: Mapping[str, BodeSeries]
    form: RenderedStiffness
    k_c: float
    rate_hz: float
    tip: Vector
    moved_m: float
    locked_m: float
    limits: int

    @property
    def motors(self) -> BodeSeries:
        """By currents where they are measured, else by the model of the motors."""
        return self.series.get("currents", self.series["estimate"])

    @property
    def doubt(self) -> str | None:
        """Why nothing can be said, if so."""
        if self.moved_m > self.locked_m:
            return f"the tip is not locked: it moved by {1e3 * self.moved_m:.2f} mm"
        return f"a limit acted (limits = {self.limits:#x}): the answer is not linear" if self.limits else None


async def measure_on(run: Run, bench: DeviceBench) -> BodeOnDevice:
    """One frequency after the other, from the highest down: a loose tip is found out before it goes far."""
    held = await _held(run, bench)
    try:
        answers = await _sweep(run, bench, held)
    finally:
        await bench.scene({"walls": []})
        if bench.is_twin:
            await bench.hand({"type": "free"})
    return _gathered(held, answers[::-1], bench.rate_hz, LOCKED_SHARE * run.number(PROBE.name))


async def _held(run: Run, bench: DeviceBench) -> Held:
    await bench.scene({"walls": []})
    records = await bench.record(LOOK_S)
    if bench.is_twin:
        await bench.hand({"type": "clamp", "position_m": records["tip_position_m"][-1].tolist()})
        records = (await bench.record(CLAMP_S))[-round(LOOK_S * bench.rate_hz) :]
    tip = records["tip_position_m"].mean(axis=0)
    model = run.model(MODEL) if bench.model == MODEL else load_model(bench.model)
    outward = np.array([tip[0], tip[1], 0.0])
    return Held(model, records["joint_position_rad"].mean(axis=0), tip, outward / np.linalg.norm(outward))


async def _sweep(run: Run, bench: DeviceBench, held: Held) -> list[Answer]:
    spaced = _frequencies(run, bench.rate_hz)
    durations = [SETTLE_S + _window_s(f) for f in spaced]
    answers: list[Answer] = []
    for index, frequency_hz in enumerate(spaced):
        run.progress(sum(durations[:index]) / sum(durations), f"probing at {frequency_hz:.3g} Hz")
        answers.append(await _probed(run, bench, held, frequency_hz))
        if answers[-1].moved_m > LOCKED_SHARE * run.number(PROBE.name):
            break
    return answers


def _frequencies(run: Run, rate_hz: float) -> list[float]:
    """Logarithmic, falling, the highest below half the rate."""
    highest = min(run.number("highest_hz"), (1.0 - KEEP_OFF) * rate_hz / 2)
    return [float(f) for f in np.geomspace(highest, run.number("lowest_hz"), run.integer("points"))]


def _window_s(frequency_hz: float) -> float:
    return max(PERIODS / frequency_hz, WINDOW_S)


async def _probed(run: Run, bench: DeviceBench, held: Held, frequency_hz: float) -> Answer:
    before = (await bench.record(1.0 / bench.rate_hz))[-1]
    form = held.form(float(before["stiffness_n_per_m"]), before["motor_temperature_c"])
    probe = {
        "direction": held.direction.tolist(),
        "amplitude_m": _amplitude_m(held.model, form, frequency_hz, run.number(PROBE.name)),
        "frequency_hz": frequency_hz,
    }
    # Brakes would hold what the motors push: the stiffness is that of the motors alone.
    await bench.scene({"walls": [], "allocation": "motor_only", "fade_s": FADE_S, "probe": probe})
    await bench.record(SETTLE_S)
    return _answer(held, await bench.record(_window_s(frequency_hz)), frequency_hz, bench.rate_hz)


def _amplitude_m(model: Model, form: RenderedStiffness, frequency_hz: float, wanted_m: float) -> float:
    """As wanted, or as much as keeps clear of the limits of force and slew rate."""
    limits = json.loads(model.device_json)["limits"]
    n_per_m = float(np.abs(form.commanded(np.array([frequency_hz]))[0]))
    by_force_m = FORCE_SHARE * limits["tip_force_n"] / n_per_m
    by_slew_m = SLEW_SHARE * limits["tip_slew_n_per_s"] / (2 * np.pi * frequency_hz * n_per_m)
    return float(min(wanted_m, by_force_m, by_slew_m))


def _answer(held: Held, records: NDArray[Any], frequency_hz: float, rate_hz: float) -> Answer:
    time_s = np.arange(len(records)) / rate_hz
    away = (records["setpoint_position_m"] - records["tip_position_m"]) @ held.direction
    motion = phasor(time_s, away, frequency_hz)
    force_n = _forces_n(held, records)
    moved = np.linalg.norm(records["tip_position_m"] - held.tip, axis=1)
    return Answer(
        frequency_hz,
        {name: complex(phasor(time_s, force, frequency_hz) / motion) for name, force in force_n.items()},
        float(records["stiffness_n_per_m"].mean()),
        records["motor_temperature_c"].mean(axis=0),
        float(moved.max()),
        int(np.bitwise_or.reduce(records["limits"])),
    )


def _forces_n(held: Held, records: NDArray[Any]) -> dict[str, Vector]:
    """Force of the device along the probe, N, by every instrument there is."""
    found = {"estimate": held.by_joints(records["motor_torque_estimate_nm"])}
    drive = json.loads(held.model.device_json)["drive"]
    if drive["type"] == "spring" and np.all(records["observation_status"] & CURRENT_PRESENT):
        nm_per_a = np.array(drive["ratio"]) * np.array(drive["k_t_nm_per_a"])
        found["currents"] = held.by_joints(nm_per_a * records["motor_current_a"])
    if np.any(records["sensor_force_n"]):
        found["sensor"] = -(records["sensor_force_n"] @ held.direction)
    return found


def _gathered(held: Held, answers: Sequence[Answer], rate_hz: float, locked_m: float) -> BodeOnDevice:
    frequency_hz = np.array([answer.frequency_hz for answer in answers])
    instruments = set.intersection(*(set(answer.stiffness) for answer in answers))
    series = {
        name: BodeSeries(
            FORCE_FROM[name],
            frequency_hz,
            np.array([answer.stiffness[name] for answer in answers]),
            _expected(held, answers, rate_hz, DELAY_TICKS[name]),
        )
        for name in sorted(instruments)
    }
    first = answers[0]
    return BodeOnDevice(
        series,
        held.form(first.k_c, first.winding_c),
        first.k_c,
        rate_hz,
        held.tip,
        max(answer.moved_m for answer in answers),
        locked_m,
        int(np.bitwise_or.reduce([answer.limits for answer in answers])),
    )


def _expected(held: Held, answers: Sequence[Answer], rate_hz: float, delay_ticks: int) -> Spectrum:
    """The closed form at each frequency, with the windings as warm as they were."""
    forms = [(held.form(answer.k_c, answer.winding_c), np.array([answer.frequency_hz])) for answer in answers]
    return np.array([form.sampled(f, 1.0 / rate_hz, delay_ticks)[0] for form, f in forms])
