"""The spring drive's law in the core against the transfer function of the paper."""

import json

import numpy as np
import pytest

from hapticd._core import Estimator, Kinematics, SpringDrive, TorqueDrive
from tests.oracle.devices import HHD, PHANTOM, device, device_json, poses
from tests.oracle.spring_drive import Drive

DR_OHM = np.array([0.109, 0.2, 0.05])


def drive_of(joint: int, d_r: float, *, k_d: float = 0.0) -> Drive:
    """Motor-side parameters of one joint of the shipped PHANTOM."""
    model = device(PHANTOM)
    drive = model["drive"]
    return Drive(
        k_t=drive["k_t_nm_per_a"][joint],
        inductance=drive["l_h"][joint],
        d_r=d_r,
        k_p=drive["k_p_v_per_rad"][joint],
        k_d=k_d,
        lam=model["estimator"]["lambda_rad_per_s"],
    )


def test_printed_stiffness_follows_from_the_law_and_the_circuit() -> None:
    rng = np.random.default_rng(1)
    for _ in range(200):
        drive = drive_of(0, rng.uniform(0.02, 0.5), k_d=rng.uniform(0, 0.1))
        s = 1j * 10.0 ** rng.uniform(-1, 5)
        assert drive.k_theta(s) == pytest.approx(drive.torque_per_angle(s), rel=1e-9)


def test_stiffness_at_rest_and_at_high_frequency_are_the_limits_of_the_paper() -> None:
    for joint, d_r in enumerate(DR_OHM):
        drive = drive_of(joint, d_r, k_d=0.03)
        assert -drive.k_theta(1e-6j) == pytest.approx(drive.dc(), rel=1e-4)
        assert -drive.k_theta(1e9j) == pytest.approx(drive.hf(), rel=1e-3)


def test_shipped_gain_makes_the_coupling_passive_from_cold() -> None:
    """K_DC ≤ K_HF keeps Im K_θ ≥ 0 (physics §2.1); residual resistance only grows with heat."""
    drive = device(PHANTOM)["drive"]
    for joint, (cold, cancelled) in enumerate(zip(drive["r_25_ohm"], drive["r_hat_ohm"], strict=True)):
        coupling = drive_of(joint, cold - cancelled)
        assert coupling.dc() <= coupling.hf()
        assert all(-coupling.k_theta(1j * w).imag >= -1e-12 for w in np.logspace(0, 5, 200))


def test_core_stiffness_is_the_limit_at_rest_through_the_gear() -> None:
    core, ratio = SpringDrive(device_json(PHANTOM)), device(PHANTOM)["drive"]["ratio"]
    expected = [
        rho**2 * drive_of(j, d_r).dc() for j, (rho, d_r) in enumerate(zip(ratio, DR_OHM, strict=True))
    ]
    assert core.dc_stiffness(DR_OHM) == pytest.approx(expected, rel=1e-12)


def test_demand_of_random_states_is_the_printed_law() -> None:
    core, model = SpringDrive(device_json(PHANTOM)), device(PHANTOM)["drive"]
    rho, k_t, k_p = (np.array(model[key]) for key in ("ratio", "k_t_nm_per_a", "k_p_v_per_rad"))
    rng = np.random.default_rng(2)
    for q in poses(PHANTOM, 200, seed=2):
        qd, q_sd, qd_sd = rng.normal(size=3), q + 0.02 * rng.normal(size=3), rng.normal(size=3)
        torque, _, volts = core.demand(q=q, qd=qd, q_sd=q_sd, qd_sd=qd_sd, dr_ohm=DR_OHM)
        e_w = k_t * rho * qd_sd + k_p * rho * (q_sd - q)
        assert volts == pytest.approx(e_w, rel=1e-12)
        assert torque == pytest.approx(rho * k_t * (e_w - k_t * rho * qd) / DR_OHM, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("frequency_hz", [5.0, 30.0, 120.0])
def test_core_in_closed_loop_with_the_circuit_has_the_printed_stiffness(frequency_hz: float) -> None:
    """The core's estimate and law run at 50 kHz against dR i + L di/dt = e_W − k_T θ̇ while the
    joint is moved in a sine; the torque's phasor is compared with WN eq. 12."""
    model, joint, k_d = device(PHANTOM), 1, 0.02
    model["joints"]["counts_per_rad"] = [1e12, 1e12, 1e12]
    model["drive"]["k_d_v_s_per_rad"] = [k_d] * 3
    text, home = json.dumps(model), np.array(model["joints"]["home_rad"])
    estimator, core, rho = Estimator(text), SpringDrive(text), model["drive"]["ratio"][joint]
    drive, dt_s, omega = drive_of(joint, DR_OHM[joint], k_d=k_d), 2e-5, 2 * np.pi * frequency_hz
    per_period = round(1 / frequency_hz / dt_s)
    decay = np.exp(-drive.d_r / drive.inductance * dt_s)
    current, phasor = 0.0, 0j
    estimator.reset(counts_at(home, 0.0))
    settle = round(0.03 / dt_s)
    for tick in range(1, settle + per_period + 1):
        t_s = tick * dt_s
        angle = 0.01 * np.sin(omega * t_s)
        q, qd, _, _ = estimator.update(counts_at(home, angle), dt_s)
        _, _, volts = core.demand(q=q, qd=qd, q_sd=home, qd_sd=(0, 0, 0), dr_ohm=DR_OHM)
        if tick > settle:
            phasor += drive.k_t * current * np.exp(-1j * omega * t_s)
        back_emf = drive.k_t * rho * 0.01 * omega * np.cos(omega * (t_s + dt_s / 2))
        current = decay * current + (1 - decay) * (volts[joint] - back_emf) / drive.d_r
    torque = 2 * phasor / per_period
    angle_phasor = -1j * 0.01 * rho
    assert torque / angle_phasor == pytest.approx(drive.k_theta(1j * omega), rel=0.02)


def counts_at(home: np.ndarray, angle_rad: float) -> list[int]:
    """Counts of a finely graduated joint 1 turned by an angle from home."""
    return [round(value * 1e12) for value in home + np.array([0.0, angle_rad, 0.0])]


def test_virtual_coupling_is_a_spring_and_a_damper_at_the_tip() -> None:
    core, drive = TorqueDrive(device_json(HHD)), device(HHD)["drive"]
    q = np.array(device(HHD)["joints"]["home_rad"])
    kinematics = Kinematics(device_json(HHD))
    x_sd = kinematics.forward(q) + np.array([0, 0.001, 0])
    torque, force = core.demand(q=q, qd=(0, 0, 0), x_sd=x_sd, xd_sd=(0, 0.1, 0))
    expected = drive["stiffness_n_per_m"] * 0.001 + drive["damping_n_s_per_m"] * 0.1
    assert force == pytest.approx((0, expected, 0), abs=1e-9)
    assert torque == pytest.approx(np.array(kinematics.jacobian(q)).T @ force, abs=1e-9)


def test_drive_of_the_other_kind_is_refused() -> None:
    with pytest.raises(ValueError, match="torque drives"):
        SpringDrive(device_json(HHD))
    with pytest.raises(ValueError, match="spring drives"):
        TorqueDrive(device_json(PHANTOM))
