"""One curve of WN Fig. 2 from the twin: a drive, shaken at one frequency after the other."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.drive_tuning import MODEL, tuned
from hapticd.experiments.plane_wall import pinned
from hapticd.experiments.run import Run
from hapticd.experiments.shaker import Shake, shaken

Vector = NDArray[np.float64]
Spectrum = NDArray[np.complex128]

POSE_RAD = np.array([0.0, 0.9, 0.9])
"""Links perpendicular: along its column of the Jacobian, joint 2 moves alone."""

JOINT = 1

NO_GAIN = [1e-12] * 3
"""K_P of an uncompensated drive, V/rad; a device model wants it above zero."""

NOTHING_CANCELLED = [1e-9] * 3
"""R̂ of a bare motor, Ω; likewise."""

KEEP_OFF = 0.15
"""Distance, in half rates, from multiples of half the rate: there the samples of a sine tell no phase."""

SETTINGS = ("motor", "spring_drive", "p", "pd")
"""The drives of the figure, by name."""


@dataclass(frozen=True)
class Curve:
    """One drive at one rate, its stiffness at each frequency, shape (n,), and the limits that acted."""

    name: str
    drive: SpringDrive
    rate_hz: float
    delay_ticks: int
    frequency_hz: Vector
    stiffness: Spectrum
    limits: int

    def closed_form(self) -> Spectrum:
        """WN eq. 12 at the measured frequencies, N·m/rad."""
        return self.drive.stiffness(self.frequency_hz)

    def sampled_form(self) -> Spectrum:
        """The same with sampled, held and late feedback, N·m/rad."""
        return self.drive.sampled(self.frequency_hz, 1.0 / self.rate_hz, self.delay_ticks)

    def deviation(self) -> float:
        """Largest relative distance from the sampled form."""
        expected = self.sampled_form()
        return float(np.max(np.abs(self.stiffness / expected - 1.0)))

    def deviation_db(self) -> float:
        """Largest distance of the magnitude from eq. 12 up to half the rate, dB."""
        seen = self.frequency_hz < 0.5 * self.rate_hz
        ratio = np.abs(self.stiffness / self.closed_form())[seen]
        return float(np.max(np.abs(20 * np.log10(ratio))))

    def numbers(self) -> dict[str, Any]:
        """The curve as JSON."""
        return {
            "rate_hz": self.rate_hz,
            "frequency_hz": self.frequency_hz.tolist(),
            "magnitude_nm_per_rad": np.abs(self.stiffness).tolist(),
            "phase_deg": np.degrees(np.angle(self.stiffness)).tolist(),
            "closed_form_nm_per_rad": np.abs(self.closed_form()).tolist(),
            "max_deviation_from_sampled_form": self.deviation(),
            "max_deviation_from_closed_form_db": self.deviation_db(),
            "limits": self.limits,
        }

    def trace(self) -> dict[str, Vector]:
        """The curve as a table."""
        closed, sampled = self.closed_form(), self.sampled_form()
        return {
            "frequency_hz": self.frequency_hz,
            "stiffness_real_nm_per_rad": self.stiffness.real,
            "stiffness_imag_nm_per_rad": self.stiffness.imag,
            "closed_real_nm_per_rad": closed.real,
            "closed_imag_nm_per_rad": closed.imag,
            "sampled_real_nm_per_rad": sampled.real,
            "sampled_imag_nm_per_rad": sampled.imag,
        }


def measured_curves(run: Run) -> list[Curve]:
    """The four curves at the fast rate, and P once more at the servo's."""
    fast, slow = run.number("rate_hz"), run.number("servo_rate_hz")
    plan = [(name, name, fast) for name in SETTINGS] + [("p_servo", "p", slow)]
    shakes = [(setting, rate, f) for _, setting, rate in plan for f in frequencies(run, setting, rate)]
    stiffness = run.map(lambda shake: _stiffness(run, *shake), shakes, doing="shaking", until=0.9)
    by_shake = dict(zip(shakes, stiffness, strict=True))
    return [_curve(run, name, setting, rate, by_shake) for name, setting, rate in plan]


def drive_of(run: Run, setting: str) -> SpringDrive:
    """The drive of the shaken joint under a setting."""
    return SpringDrive.of_model(run.model(MODEL, drive_overrides(run, setting)), JOINT)


def drive_overrides(run: Run, setting: str) -> dict[str, Any]:
    """What a setting changes in the model."""
    k_t = np.array(json.loads(run.model(MODEL).device_json)["drive"]["k_t_nm_per_a"])
    bare = {"drive.r_hat_ohm": NOTHING_CANCELLED} if setting == "motor" else {}
    loose = {"drive.k_p_v_per_rad": NO_GAIN} if setting in ("motor", "spring_drive") else {}
    k_d = {"drive.k_d_v_s_per_rad": (run.number("k_d_share") * k_t).tolist()} if setting == "pd" else {}
    return {**tuned(run), **bare, **loose, **k_d}


def frequencies(run: Run, setting: str, rate_hz: float) -> list[float]:
    """Logarithmic, those of sampled feedback below half the rate: past it a sample is of an image."""
    highest = run.number("highest_hz")
    if setting in ("p", "pd"):
        highest = min(highest, (1.0 - KEEP_OFF) * rate_hz / 2)
    spaced = np.geomspace(run.number("lowest_hz"), highest, run.integer("points"))
    return [_clear(float(f), rate_hz) for f in spaced]


def _clear(frequency_hz: float, rate_hz: float) -> float:
    halves = 2.0 * frequency_hz / rate_hz
    nearest = round(halves)
    if nearest and abs(halves - nearest) < KEEP_OFF:
        return (nearest - KEEP_OFF) * rate_hz / 2
    return frequency_hz


def hold(run: Run, eta: float = 0.0) -> tuple[Vector, dict[str, Any]]:
    """Direction in which the joint moves alone, and the scene that holds its set-point along it."""
    kinematics = _core.Kinematics(run.model(MODEL).device_json)
    column = np.array(kinematics.jacobian(POSE_RAD))[:, JOINT]
    axis = column / np.linalg.norm(column)
    tip = np.array(kinematics.forward(POSE_RAD))
    return axis, {"mapping": "inverse", "walls": pinned(tip, axis[None, :], eta)}


def shake_of(run: Run, rate_hz: float, frequency_hz: float, scene: Mapping[str, Any]) -> Shake:
    """The shake of this experiment at one frequency."""
    axis, _ = hold(run)
    return Shake(POSE_RAD, axis, run.number("amplitude_m"), frequency_hz, rate_hz, scene)


def stiffness_at(run: Run, setting: str, shake: Shake) -> tuple[complex, int]:
    """Resisting torque by angle at the rotor, N·m/rad, from current and encoder; limits that acted."""
    answer = shaken(run, shake, drive_overrides(run, setting))
    model = json.loads(run.model(MODEL).device_json)["drive"]
    torque_nm = model["k_t_nm_per_a"][JOINT] * answer.current_a[JOINT]
    theta_rad = model["ratio"][JOINT] * answer.joint_rad[JOINT]
    return complex(-torque_nm / theta_rad), answer.limits


def _stiffness(run: Run, setting: str, rate_hz: float, frequency_hz: float) -> tuple[complex, int]:
    _, scene = hold(run)
    return stiffness_at(run, setting, shake_of(run, rate_hz, frequency_hz, scene))


def _curve(
    run: Run,
    name: str,
    setting: str,
    rate_hz: float,
    by_shake: Mapping[tuple[str, float, float], tuple[complex, int]],
) -> Curve:
    spaced = frequencies(run, setting, rate_hz)
    found = [by_shake[setting, rate_hz, f] for f in spaced]
    return Curve(
        name,
        drive_of(run, setting),
        rate_hz,
        1 + json.loads(run.model(MODEL).twin_json)["command_delay_ticks"],
        np.array(spaced),
        np.array([stiffness for stiffness, _ in found]),
        int(np.bitwise_or.reduce([limits for _, limits in found])),
    )
