"""Units from the names of quantities."""

from __future__ import annotations

import pytest

from hapticd.experiments.unit import unit_of


@pytest.mark.parametrize(
    ("name", "unit"),
    [
        ("stiffness_n_per_m", "N/m"),
        ("viscous_nm_s_per_rad", "N·m·s/rad"),
        ("rotor_kg_m2", "kg·m²"),
        ("k_t_nm_per_a", "N·m/A"),
        ("counts_per_rad", "1/rad"),
        ("gravity_m_per_s2", "m/s²"),
        ("coefficient_n_s3_per_m3", "N·s³/m³"),
        ("l_m", "m"),
        ("lag_scale", "1"),
        ("brace", "1"),
    ],
)
def test_the_suffix_of_a_name_is_its_unit(name: str, unit: str) -> None:
    assert unit_of(name) == unit
