"""Spring drive against current amplifier: limits and a contact against numbers worked out by hand."""

from dataclasses import replace

import numpy as np
import pytest

from hapticd.analysis.linear_loop import LinearLoop
from hapticd.analysis.one_axis_contact import Axis, DigitalWall, Operator, meet
from hapticd.experiments.drive_limits import Bench, best_damped
from hapticd.experiments.experiment import Outcome
from hapticd.experiments.run import Run
from hapticd.experiments.settings import resolve
from hapticd.experiments.spring_vs_current import EXPERIMENT, bench_of

NO_HAND = Operator(1e6, 1e-9, 0.0, 1e-9, 0.0, 0.02, 1e9)
"""A hand that neither pushes nor moves."""


STRONGER = "Spring drives give stronger position feedback than current amplifiers can, "


def run_of(**values: object) -> Run:
    return Run(EXPERIMENT, resolve(EXPERIMENT, values))


@pytest.fixture(scope="module")
def outcome() -> Outcome:
    return EXPERIMENT.run(run_of(rates=4))


@pytest.fixture(scope="module")
def bench() -> Bench:
    return bench_of(run_of())


def limit(bench: Bench, name: str, rate_hz: float, delay_ticks: int) -> float:
    columns = ("spring_stable", "spring_passive", "current_stable", "current_undamped", "current_passive")
    return bench.largest(rate_hz, delay_ticks)[columns.index(name)]


@pytest.mark.parametrize(
    ("rate_hz", "delay_ticks", "n_per_mm"), [(1000, 0, 4.8), (1000, 1, 3.6), (2000, 0, 5.2), (5000, 0, 5.6)]
)
def test_the_stable_stiffness_of_the_spring_drive_is_as_tabulated(
    bench: Bench, rate_hz: float, delay_ticks: int, n_per_mm: float
) -> None:
    found = limit(bench, "spring_stable", rate_hz, delay_ticks)
    assert found / 1e3 == pytest.approx(n_per_mm, abs=0.06)


def test_the_spring_of_the_inductance_is_five_and_three_quarter_newtons_a_millimetre(bench: Bench) -> None:
    assert bench.series_n_per_m / 1e3 == pytest.approx(5.75, abs=0.01)


@pytest.mark.parametrize("rate_hz", [500.0, 1000.0, 8000.0])
def test_the_passive_stiffness_of_the_current_drive_is_two_b_over_t(bench: Bench, rate_hz: float) -> None:
    assert limit(bench, "current_passive", rate_hz, 0) == pytest.approx(2 * 0.1 * rate_hz, rel=0.01)


def test_resolution_allows_two_f_c_over_a_count(bench: Bench) -> None:
    assert bench.by_resolution_n_per_m / 1e3 == pytest.approx(2.58, abs=0.01)


def test_the_best_damped_current_drive_is_as_stiff_as_jury_allows() -> None:
    # z³ + … of a mass under K + B(z−1)/(Tz): K < m/T² β(2−β)/(1+β/2), β = BT/m, largest at β = 2√2 − 2.
    beta = 2 * np.sqrt(2) - 2
    expected = 0.075e6 * beta * (2 - beta) / (1 + beta / 2)
    loop = LinearLoop(0.075, 1e-6, 1000.0, 0.0, 0.0, 1e7)
    assert best_damped(loop)[0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("delay_ticks", [0, 1])
def test_the_passive_spring_drive_takes_energy_from_every_motion_with_all_its_images(
    bench: Bench, delay_ticks: int
) -> None:
    stiffness = limit(bench, "spring_passive", 1000.0, delay_ticks)
    assert smallest_resistance(bench, 0.95 * stiffness, delay_ticks) > 0
    assert smallest_resistance(bench, 1.05 * stiffness, delay_ticks) < 0


def smallest_resistance(bench: Bench, stiffness: float, delay_ticks: int, period_s: float = 1e-3) -> float:
    """Smallest eigenvalue of the port's Hermitian part over frequencies, with 30 images either side."""
    found = []
    for angle in np.linspace(0.05, np.pi, 24):
        omega = (angle + 2 * np.pi * np.arange(-30, 31)) / period_s
        lag = 1 + 1j * omega * bench.series_lag_s
        damper = bench.series_n_per_m * bench.series_lag_s
        port = np.diag(bench.viscous_n_s_per_m + damper / lag)
        held = (1 - np.exp(-1j * angle)) / (1j * omega * period_s)
        late = np.exp(-1j * omega * delay_ticks * period_s)
        port = port + stiffness * np.outer(held * late / lag, 1 / (1j * omega))
        found.append(np.linalg.eigvalsh((port + port.conj().T) / 2)[0])
    return float(min(found))


def test_the_spring_drive_is_passively_stiffer_and_the_damped_current_drive_not(
    outcome: Outcome,
) -> None:
    for row in outcome.results["compared"]:
        assert row["spring_passive_n_per_m"] > 10 * row["current_passive_n_per_m"]
        assert row["current_stable_n_per_m"] > row["spring_stable_n_per_m"]


def test_a_hand_rests_on_the_spring_drive_and_swings_on_a_bare_digital_spring(
    outcome: Outcome,
) -> None:
    contact = outcome.results["contact"]
    assert contact["spring_drive"]["residual_m"] < 1e-4
    assert contact["current_bare"]["residual_m"] > 1e-3
    assert contact["current_bare"]["returned_over_received"] > 1.0
    # Equal static stiffness under an equal hand: an equal force, Coulomb friction aside.
    forces = [contact[name]["steady_force_n"] for name in ("spring_drive", "current_damped")]
    assert forces[0] == pytest.approx(forces[1], abs=0.1)


def test_a_mass_on_a_digital_spring_swings_at_its_own_frequency() -> None:
    axis = Axis(mass_kg=0.1, viscous_n_s_per_m=0.0, coulomb_n=0.0, lag_s=0.0)
    wall = DigitalWall(1000.0, 0.0, 20000.0, 0, 1e-9, 1e6, 1e9)
    thrown = replace(NO_HAND, grip_stiffness_n_per_m=100.0, travel_m=-0.02)
    contact = meet(axis, wall, thrown, 0.2)
    # It begins 10 mm deep, at rest, and the hand holds it there with 100 N/m beside the wall's 1000.
    leaves = contact.time_s[np.argmax(contact.depth_m < 10e-3 * (1 - 0.9999 * 1000 / 1100))]
    assert leaves == pytest.approx(np.pi / 2 / np.sqrt(1100 / 0.1), rel=0.02)


def test_the_wall_never_pulls_and_never_exceeds_its_largest_force() -> None:
    axis = Axis(0.1, 0.0, 0.0, 0.0)
    wall = DigitalWall(5000.0, 100.0, 1000.0, 1, 30e-6, 1256.0, 2.0)
    pushed = Operator(0.2, 800.0, 4.0, 300.0, 10.0, 0.03, 0.2)
    force = meet(axis, wall, pushed, 0.5).force_n
    assert force.min() >= 0.0
    assert force.max() == pytest.approx(2.0)


def test_which_statements_of_the_paper_fail(outcome: Outcome) -> None:
    failing = [claim.claim for claim in outcome.claims if claim.verdict == "fails"]
    assert failing == [
        STRONGER + "as a stable linear loop, without delay",
        STRONGER + "as a stable linear loop, with delay",
        "The tuning locked in place is a passive coupling, its sampling and delay included",
    ]
