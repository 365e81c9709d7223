"""WN Fig. 2 on the twin against numbers worked out apart from the code under test."""

from typing import Any

import numpy as np
import pytest

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.bode_on_device import FORCE_FROM
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.stiffness_bode import EXPERIMENT
from hapticd.model import load_model
from hapticd.twin import TwinRun
from tests.hapticd.experiments.twin_bench import TwinBench
from tests.oracle.spring_drive import Drive

TIP_PER_ROTOR = 2500.0
"""(ρ/l)² = (7/0.14)², 1/m²."""


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    settings = resolve(EXPERIMENT, {"points": 5, "rate_hz": 4000.0, "lowest_hz": 3.0, "highest_hz": 1700.0})
    return EXPERIMENT.run(Run(EXPERIMENT, settings))


def curve(outcome: Outcome, name: str) -> dict[str, Any]:
    found: dict[str, Any] = outcome.results["curves"][name]
    return found


def nominal(k_p: float, k_d: float = 0.0) -> SpringDrive:
    return SpringDrive.of_model(load_model("phantom-1.0"), 1).compensated(k_p, k_d)


def test_the_high_end_is_the_spring_of_the_inductance(outcome: Outcome) -> None:
    # 0.0234² / 0.000238 = 2.301 N·m/rad, 5.75 N/mm at the tip
    assert curve(outcome, "spring_drive")["magnitude_nm_per_rad"][-1] == pytest.approx(2.301, rel=0.01)
    assert nominal(6.43).k_hf * TIP_PER_ROTOR == pytest.approx(5750, rel=0.01)


def test_the_low_end_of_the_bare_motor_is_its_damper(outcome: Outcome) -> None:
    # 2π·3 Hz · 0.0234²/2.18 = 4.734e-3 N·m/rad
    assert curve(outcome, "motor")["magnitude_nm_per_rad"][0] == pytest.approx(4.734e-3, rel=0.01)


def test_the_low_end_with_p_is_its_share_of_the_high_end(outcome: Outcome) -> None:
    assert curve(outcome, "p")["magnitude_nm_per_rad"][0] == pytest.approx(0.6 * 2.301, rel=0.02)


@pytest.mark.parametrize(("k_p", "n_per_mm"), [(2.0, 1.07), (5.0, 2.68)])
def test_k_dc_at_the_tip_is_as_tabulated(k_p: float, n_per_mm: float) -> None:
    assert nominal(k_p).k_dc * TIP_PER_ROTOR / 1e3 == pytest.approx(n_per_mm, rel=0.005)


def test_every_curve_is_the_closed_form_with_hold_and_delay(outcome: Outcome) -> None:
    for name in ("motor", "spring_drive", "p", "pd", "p_servo"):
        assert curve(outcome, name)["max_deviation_from_sampled_form"] < 0.04, name
        assert curve(outcome, name)["limits"] == 0, name


def test_the_closed_form_is_the_oracle_of_eq_12() -> None:
    drive = nominal(6.43, 0.02)
    oracle = Drive(drive.k_t, drive.inductance, drive.d_r, drive.k_p, drive.k_d, drive.lam)
    frequency_hz = np.geomspace(0.1, 1e4, 50)
    expected = [oracle.k_theta(2j * np.pi * f) for f in frequency_hz]
    np.testing.assert_allclose(drive.printed(frequency_hz), expected, rtol=1e-12)
    np.testing.assert_allclose(drive.stiffness(frequency_hz), -np.array(expected), rtol=1e-12)


def test_sampling_without_end_is_the_continuous_form() -> None:
    frequency_hz = np.array([1.0, 30.0, 300.0])
    drive = nominal(6.43, 0.02)
    np.testing.assert_allclose(drive.sampled(frequency_hz, 1e-7, 0), drive.stiffness(frequency_hz), rtol=1e-3)


@pytest.mark.parametrize("k_d", [0.0, 0.001, 0.003])
def test_the_coupling_stops_being_passive_where_its_margin_says(k_d: float) -> None:
    limit = nominal(0.0).k_p_flat - nominal(0.0).lam * k_d
    frequency_hz = np.geomspace(1e-2, 1e7, 4000)
    assert np.angle(nominal(0.999 * limit, k_d).stiffness(frequency_hz)).min() > 0
    assert np.angle(nominal(1.001 * limit, k_d).stiffness(frequency_hz)).min() < 0


def test_a_compliant_wall_keeps_one_minus_eta_and_a_loose_drive_drifts(outcome: Outcome) -> None:
    assert outcome.results["compliant"]["share_of_rigid"] == pytest.approx(0.7, abs=0.01)
    # 0.0234²/0.109 · 2500 = 12.6 N·s/m
    assert outcome.results["drift"]["damping_n_s_per_m"] == pytest.approx(12.6, rel=0.05)


def test_free_space_weighs_what_filter_hold_and_delay_make_of_it(outcome: Outcome) -> None:
    # 12.56 N·s/m · (1/1257 s + half a tick of the difference, half of the hold, one of delay at 1 kHz)
    assert outcome.results["free_space"]["added_mass_kg"] == pytest.approx(0.0301, rel=0.05)


def test_only_known_statements_of_the_paper_fail(outcome: Outcome) -> None:
    failing = [claim.claim for claim in outcome.claims if claim.verdict == "fails"]
    assert failing == [
        "(13) and (14) are the values of (12) at its two ends, sign included",
        "(12) is the stiffness that is rendered, at the servo's rate",
        "The coupling stiffness is a passive coupling, with PD",
        "The static stiffness is reduced by the factor η, read as multiplied by η",
    ]


async def on_device(bench: TwinBench) -> Outcome:
    settings = resolve(EXPERIMENT, {"points": 6, "lowest_hz": 1.0})
    return await EXPERIMENT.run_on(Run(EXPERIMENT, settings), bench)


async def test_a_locked_phantom_renders_k_c_and_the_closed_form_by_its_currents() -> None:
    smooth = {"twin.winding.brush_ripple": 0.0, "joints.home_rad": [0.4, 0.1, 0.5]}
    bench = TwinBench(TwinRun("phantom-1.0", overrides=smooth))
    outcome = await on_device(bench)
    seen = outcome.results["currents"]
    assert outcome.results["force_from"] == FORCE_FROM["currents"]
    k_c = bench.twin.run(0.001)["stiffness_n_per_m"][0]
    assert seen["magnitude_n_per_m"][0] == pytest.approx(k_c, rel=0.03)
    # By hand: a zero at K_P/(2π k_T) = 43.7 Hz and a pole at dR/(2π L) = 72.9 Hz.
    f = seen["frequency_hz"][3]
    assert f == pytest.approx(37.8, abs=0.1)
    by_hand = k_c * np.sqrt((1 + (f / 43.7) ** 2) / (1 + (f / 72.9) ** 2))
    assert seen["magnitude_n_per_m"][3] == pytest.approx(by_hand, rel=0.03)
    assert seen["max_shape_deviation_db"] < 1.0
    assert seen["max_phase_deviation_deg"] < 5.0
    assert outcome.results["limits"] == 0
    assert bench.scenes[-1] == {"walls": []}


async def test_half_of_the_current_is_seen_where_the_motors_are_half_as_strong_as_modelled() -> None:
    weak = {"twin.winding.brush_ripple": 0.0, "twin.winding.r_hat_scale": [0.95] * 3}
    outcome = await on_device(TwinBench(TwinRun("phantom-1.0", overrides=weak)))
    # dR rises from 0.109 Ω to 0.109 + 0.05·2.071 = 0.2126 Ω.
    share = outcome.results["currents"]["magnitude_n_per_m"][0] / outcome.results["stiffness_n_per_m"]
    assert share == pytest.approx(0.109 / 0.21255, rel=0.02)
    assert outcome.claims[0].verdict == "fails"


async def test_a_locked_hhd_renders_its_coupling_and_its_sensor_misses_what_friction_holds() -> None:
    outcome = await on_device(TwinBench(TwinRun("hhd")))
    seen = outcome.results["estimate"]
    assert seen["magnitude_n_per_m"][0] == pytest.approx(60000.0, rel=0.01)
    f = np.array(seen["frequency_hz"])
    z = np.exp(2j * np.pi * f / 1000.0)
    by_hand = (60000.0 + 2j * np.pi * f * 200.0) * (1 - np.exp(-2)) / (z - np.exp(-2))
    np.testing.assert_allclose(seen["magnitude_n_per_m"], np.abs(by_hand), rtol=0.01)
    np.testing.assert_allclose(seen["phase_deg"], np.degrees(np.angle(by_hand)), atol=1.0)
    # 18 N are asked for, and friction and the brakes' drag hold up to 8 N of them.
    assert 0.5 < outcome.results["sensor"]["magnitude_n_per_m"][0] / 60000.0 < 0.8
    assert outcome.claims[-1].verdict == "fails"


@pytest.mark.parametrize("model", ["phantom-1.0", "hhd"])
async def test_a_loose_tip_ends_the_sweep_and_decides_nothing(model: str) -> None:
    bench = TwinBench(TwinRun(model), is_twin=False)
    outcome = await on_device(bench)
    assert {claim.verdict for claim in outcome.claims} == {"undecidable"}
    assert all("not locked" in (claim.reason or "") for claim in outcome.claims)
    assert np.ptp(bench.twin.run(0.5)["tip_position_m"], axis=0).max() < 5e-3
    assert len(outcome.results["estimate"]["frequency_hz"]) < 6
