"""Budgets and admission: what is passive, stable or refused, and what force grants."""

from __future__ import annotations

from typing import Any

import pytest
from pydantic import TypeAdapter

from hapticd.admission import admit
from hapticd.analysis import settling_library
from hapticd.analysis.device_stability import DeviceStability
from hapticd.analysis.settling_library import SettlingLibrary
from hapticd.analysis.settling_table import SettlingTable
from hapticd.analysis.stability import StabilityBudget
from hapticd.laws import Law
from hapticd.model import Model
from hapticd.problem import Problem
from tests.hapticd.analysis.slow_tables import HHD, PHANTOM, RATE_HZ

TABLES = {
    HHD.name: SettlingTable((0.0, 300.0), (100e3, 190e3), 50e-6),
    PHANTOM.name: SettlingTable((0.0, 20.0), (4900.0, 5500.0), 118e-6),
}


def stability(model: Model, *, simulated: bool = True, delay_s: float = 1e-3) -> DeviceStability:
    """A device whose table is there, or not."""
    library = SettlingLibrary()
    made = DeviceStability(model, RATE_HZ, lambda: delay_s, library)
    if simulated:
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(settling_library, "settling_table", lambda model, *_: TABLES[model.name])
            library.table(model, RATE_HZ, 0)
    return made


def law(kind: str, **fields: Any) -> Law:
    found: Law = TypeAdapter(Law).validate_python({"type": kind, **fields})
    return found


def spring(stiffness: float, damping: float = 0.0) -> Law:
    return law("spring", stiffness_n_per_m=stiffness, damping_n_s_per_m=damping)


def budget(model: Model, asked: Law, **changes: Any) -> StabilityBudget:
    return stability(model, **changes).budget(asked)


def test_rigid_walls_of_both_devices_are_let_in_as_they_ship() -> None:
    for model in (HHD, PHANTOM):
        for simulated in (True, False):
            admission = admit(stability(model, simulated=simulated), law("motion", eta=0.0), force=False)
            assert admission.budget.verdict == "stable"
            assert admission.passivity is False


def test_a_soft_wall_is_passive_and_a_stiffer_one_stable() -> None:
    soft, stiff = budget(HHD, spring(1000.0)), budget(HHD, spring(50e3))
    assert (soft.verdict, stiff.verdict) == ("passive", "stable")
    assert soft.largest_passive_n_per_m == stiff.largest_passive_n_per_m
    assert 1000.0 < soft.largest_passive_n_per_m < 2 * 2.4 * RATE_HZ
    assert stiff.margin == pytest.approx(2.0)
    assert stiff.binding == "simulated"


def test_half_the_coupling_asks_for_half_the_stiffness() -> None:
    asked = budget(HHD, law("motion", eta=0.5))
    assert asked.requested_n_per_m == pytest.approx(30e3)
    assert asked.requested_n_s_per_m == pytest.approx(100.0)


def test_a_wall_past_the_limit_is_refused_with_the_numbers_and_the_cure() -> None:
    with pytest.raises(Problem) as refused:
        admit(stability(HHD), spring(150e3), force=False, pointer="/walls/3/law")
    problem = refused.value
    assert problem.slug == "over-stability-budget"
    assert problem.pointer == "/walls/3/law/stiffness_n_per_m"
    assert "1.5e+05 N/m" in problem.detail
    assert "1e+05 N/m" in problem.detail
    assert "force=true" in problem.hint
    assert "damping_n_s_per_m" in problem.hint


def test_force_lets_it_in_under_passivity() -> None:
    admission = admit(stability(HHD), spring(150e3), force=True)
    assert admission.forced
    assert admission.passivity
    assert admission.granted_n_per_m == 150e3


def test_force_changes_nothing_where_it_is_not_needed() -> None:
    admission = admit(stability(HHD), spring(800.0), force=True)
    assert (admission.forced, admission.passivity) == (False, False)


def test_before_the_table_is_there_the_linear_limit_decides_and_says_so() -> None:
    found = budget(HHD, spring(800.0), simulated=False)
    assert found.largest_simulated_n_per_m is None
    assert found.note is not None
    assert "linear" in found.note


def test_before_the_table_is_there_one_push_may_still_let_a_wall_in() -> None:
    settles, does_not = (budget(HHD, spring(k, 20.0), simulated=False) for k in (50e3, 400e3))
    assert settles.largest_linear_n_per_m < 50e3
    assert (settles.verdict, does_not.verdict) == ("stable", "unstable")


def test_the_phantom_grants_no_more_than_its_tuning() -> None:
    found = budget(PHANTOM, spring(100e3, 5.0))
    assert found.requested_n_per_m == 100e3
    assert found.granted_n_per_m == pytest.approx(2099.0, rel=0.01)
    assert (found.verdict, found.binding) == ("stable", "tuning")


def test_spring_drive_tuned_past_its_limits_is_refused() -> None:
    overtuned = PHANTOM.changed({"drive.k_p_v_per_rad": [25.0, 25.0, 25.0]})
    found = budget(overtuned, law("motion", eta=0.0))
    assert found.granted_n_per_m is not None
    assert found.granted_n_per_m > 4900.0
    assert found.verdict == "unstable"


def test_a_damper_is_let_in_up_to_what_sampling_bears() -> None:
    limit = budget(HHD, law("damper", damping_n_s_per_m=1.0)).largest_damping_n_s_per_m
    assert budget(HHD, law("damper", damping_n_s_per_m=0.99 * limit)).verdict == "stable"
    assert budget(HHD, law("damper", damping_n_s_per_m=1.01 * limit)).verdict == "unstable"
    assert budget(HHD, law("damper", damping_n_s_per_m=1.0)).verdict == "passive"


def test_the_cubic_damper_chatters_as_printed_and_not_in_its_implicit_form() -> None:
    """Physics §6: at the saturation of 105 N the printed law's slope is ten times what sampling bears."""
    printed = budget(HHD, law("cubic_damper", form="explicit", coefficient_n_s3_per_m3=1.6e6))
    assert printed.verdict == "unstable"
    assert printed.requested_n_s_per_m == pytest.approx(3 * 1.6e6 ** (1 / 3) * 105.0 ** (2 / 3))
    assert budget(HHD, law("cubic_damper")).verdict == "stable"


@pytest.mark.parametrize("model", [HHD, PHANTOM], ids=["hhd", "phantom"])
def test_advice_is_true_of_the_rate(model: Model) -> None:
    device = stability(model)
    asked = law("motion", eta=0.0)
    advice = {each.parameter: each for each in device.budget(asked, advice=True).advice}
    faster = device.budget(asked, device.loop(rate_hz=2000.0))
    assert faster.largest_linear_n_per_m == pytest.approx(advice["rate_hz"].limit_then, rel=1e-3)
    assert all(each.limit_then > each.limit_now for each in advice.values())


def test_more_delay_never_raises_a_limit() -> None:
    limits = [
        (each.largest_passive_n_per_m, each.largest_linear_n_per_m)
        for each in (budget(HHD, spring(800.0), delay_s=d) for d in (1e-3, 1.3e-3, 2e-3, 3e-3))
    ]
    assert limits == sorted(limits, reverse=True)


def test_equal_questions_get_equal_answers() -> None:
    assert budget(PHANTOM, spring(800.0)) == budget(PHANTOM, spring(800.0))
