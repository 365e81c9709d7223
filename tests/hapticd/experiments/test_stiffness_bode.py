"""WN Fig. 2 on the twin against numbers worked out apart from the code under test."""

from typing import Any

import numpy as np
import pytest

from hapticd.analysis.spring_drive import SpringDrive
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.stiffness_bode import EXPERIMENT
from hapticd.model import load_model
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
