"""What settles on the twin, and the tables of it on disk."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path

import pytest

from hapticd.analysis import settling_library
from hapticd.analysis.settling import SETTLED_M, home_wall, push
from hapticd.analysis.settling_child import settling_table_apart
from hapticd.analysis.settling_library import SettlingLibrary, key_of
from hapticd.analysis.settling_table import Abandoned, SettlingTable, delay_ticks, settling_table
from tests.hapticd.analysis.slow_tables import HHD, PHANTOM, RATE_HZ, files, phantom_table


def test_wall_of_the_hhd_lies_across_its_lightest_direction() -> None:
    wall = home_wall(HHD)
    assert wall.normal == pytest.approx((0.0, 1.0, 0.0), abs=1e-4)
    assert wall.offset_m == pytest.approx(0.19, abs=1e-4)


def test_shipped_coupling_settles_and_one_four_times_as_stiff_does_not() -> None:
    assert push(HHD, RATE_HZ).settled(SETTLED_M)
    assert not push(HHD.changed({"drive.stiffness_n_per_m": 240e3}), RATE_HZ).settled(SETTLED_M)


def test_a_soft_wall_that_still_gives_way_counts_as_settled() -> None:
    soft = {"drive.stiffness_n_per_m": 1000.0, "drive.damping_n_s_per_m": 400.0}
    assert push(HHD.changed(soft), RATE_HZ).settled(SETTLED_M)


def test_a_device_that_cannot_be_enabled_does_not_settle() -> None:
    outside = HHD.changed({"joints.max_rad": [0.2, 3.84, 0.0]})
    assert push(outside, RATE_HZ).faulty


def test_table_brackets_the_stiffness_that_settles() -> None:
    limit = phantom_table().largest_stiffness_n_per_m(0.0)
    assert 2099.0 < limit < 12_000.0
    k_p, k_c = 6.43, 2099.04
    for share, settles in ((0.98, True), (1.1, False)):
        tuned = PHANTOM.changed({"drive.k_p_v_per_rad": [share * limit / k_c * k_p] * 3})
        assert push(tuned, RATE_HZ).settled(phantom_table().bound_m) is settles


def test_table_interpolates_damping_and_says_zero_beyond() -> None:
    table = SettlingTable((0.0, 100.0), (1000.0, 3000.0), SETTLED_M)
    assert table.largest_stiffness_n_per_m(50.0) == pytest.approx(2000.0)
    assert table.largest_stiffness_n_per_m(101.0) == 0.0


@pytest.mark.parametrize(("delay_s", "ticks"), [(1e-3, 0), (1.09e-3, 0), (1.2e-3, 1), (3e-3, 2), (0.0, 0)])
def test_delay_is_rounded_up_to_ticks_with_a_tenth_to_spare(delay_s: float, ticks: int) -> None:
    assert delay_ticks(1000.0, delay_s) == ticks


def test_simulation_ends_when_nobody_waits_any_more() -> None:
    with pytest.raises(Abandoned):
        settling_table(HHD, RATE_HZ, 0, lambda: False)


def test_a_model_without_a_twin_is_not_simulated() -> None:
    with pytest.raises(ValueError, match="twin"):
        settling_table(replace(HHD, twin_json="null"), RATE_HZ, 0)


def test_library_reads_back_what_another_one_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(settling_library, "settling_table", lambda *_: phantom_table())
    made = SettlingLibrary(tmp_path).table(PHANTOM, RATE_HZ, 0)
    assert files(tmp_path) == [f"{key_of(PHANTOM, RATE_HZ, 0)}.json"]
    monkeypatch.setattr(settling_library, "settling_table", None)  # must not be needed again
    assert SettlingLibrary(tmp_path).find(PHANTOM, RATE_HZ, 0) == made
    assert SettlingLibrary(tmp_path).table(PHANTOM, RATE_HZ, 0) == made


def test_library_makes_a_damaged_table_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / f"{key_of(PHANTOM, RATE_HZ, 0)}.json").write_text('{"damping_n_s_per_m": [0.0]')
    monkeypatch.setattr(settling_library, "settling_table", lambda *_: phantom_table())
    library = SettlingLibrary(tmp_path)
    assert library.find(PHANTOM, RATE_HZ, 0) is None
    assert library.table(PHANTOM, RATE_HZ, 0) == phantom_table()


def test_any_change_that_could_matter_asks_for_another_table() -> None:
    stiffer = PHANTOM.changed({"twin.hand.mass_kg": 0.3})
    keys = {
        key_of(model, rate, ticks)
        for model in (PHANTOM, stiffer, HHD)
        for rate in (1000.0, 2000.0)
        for ticks in (0, 1)
    }
    assert len(keys) == 12


def test_library_prepares_in_the_background_once_and_only_while_open(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made, begun = [], threading.Event()

    def table(*_: object) -> SettlingTable:
        made.append(threading.current_thread().name)
        begun.set()
        return phantom_table()

    monkeypatch.setattr(settling_library, "settling_table_apart", table)
    library = SettlingLibrary(tmp_path)
    library.prepare(PHANTOM, RATE_HZ, 0)
    assert made == []
    library.open()
    library.prepare(PHANTOM, RATE_HZ, 0)
    library.prepare(PHANTOM, RATE_HZ, 0)
    assert begun.wait(10.0)
    library.close()
    assert made == ["settling"]
    assert library.find(PHANTOM, RATE_HZ, 0) == phantom_table()


def test_table_of_another_process_is_the_same() -> None:
    assert settling_table_apart(HHD, RATE_HZ, 0) == settling_table(HHD, RATE_HZ, 0)


def test_process_of_a_table_that_is_not_wanted_is_ended() -> None:
    with pytest.raises(Abandoned):
        settling_table_apart(HHD, RATE_HZ, 0, lambda: False)


def test_other_process_says_why_a_model_is_not_simulated() -> None:
    with pytest.raises(ValueError, match="twin"):
        settling_table_apart(replace(HHD, twin_json="null"), RATE_HZ, 0)
