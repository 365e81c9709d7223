"""Device files: strict, overridable by dotted keys, every mistake named."""

import json
from pathlib import Path

import pytest

from hapticd.model import DEVICES_DIR, load_model, model_names


def edited(tmp_path: Path, old: str, new: str) -> Path:
    """A copy of the HHD's file with one text replaced."""
    text = (DEVICES_DIR / "hhd.toml").read_text(encoding="utf-8")
    assert old in text
    path = tmp_path / "edited.toml"
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    return path


@pytest.mark.parametrize("name", model_names())
def test_every_shipped_model_loads_with_its_twin(name: str) -> None:
    model = load_model(name)
    assert model.name == name
    assert model.dof in (2, 3)
    assert json.loads(model.twin_json)["type"] in ("phantom", "hhd")
    assert "twin" not in json.loads(model.device_json)


def test_an_override_replaces_one_value_and_no_other() -> None:
    plain = json.loads(load_model("hhd").device_json)
    changed = json.loads(load_model("hhd", {"limits.tip_force_n": 50.0}).device_json)
    assert changed["limits"].pop("tip_force_n") == 50.0
    del plain["limits"]["tip_force_n"]
    assert changed == plain


def test_an_override_reaches_the_twin() -> None:
    model = load_model("phantom-1.0", {"twin.hand.mass_kg": 0.3})
    assert json.loads(model.twin_json)["hand"]["mass_kg"] == 0.3


def test_an_unknown_override_is_refused_with_the_nearest_keys() -> None:
    with pytest.raises(ValueError, match=r"limits\.tip_forc_n.*limits\.tip_force_n"):
        load_model("hhd", {"limits.tip_forc_n": 1.0})


def test_a_table_cannot_be_overridden_as_a_whole() -> None:
    with pytest.raises(ValueError, match="no key 'limits'"):
        load_model("hhd", {"limits": {}})


def test_a_value_that_makes_no_sense_is_refused_by_its_key() -> None:
    with pytest.raises(ValueError, match=r"limits\.tip_force_n"):
        load_model("hhd", {"limits.tip_force_n": -1.0})
    with pytest.raises(ValueError, match=r"twin\.hand\.mass_kg"):
        load_model("hhd", {"twin.hand.mass_kg": 0.0})


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("limits.tip_force_n", "50"),
        ("brakes.release_on_stop", 1),
        ("joints.home_rad", [0.5, 2.6]),
        ("name", 3),
    ],
)
def test_a_value_of_another_kind_is_refused_by_its_key(key: str, value: object) -> None:
    with pytest.raises(ValueError, match=key):
        load_model("hhd", {key: value})


def test_a_whole_number_is_a_number() -> None:
    changed = json.loads(load_model("hhd", {"limits.tip_force_n": 50}).device_json)
    assert changed["limits"]["tip_force_n"] == 50


def test_an_unknown_model_is_refused_with_the_known_ones() -> None:
    with pytest.raises(ValueError, match=r"hhd, phantom-1\.0"):
        load_model("phantom-2.0")


def test_an_unknown_key_in_a_file_is_refused_by_its_name(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="tip_colour"):
        load_model(edited(tmp_path, "tip_force_n = 105.0", "tip_force_n = 105.0\ntip_colour = 1"))


def test_a_missing_key_in_a_file_is_refused_by_its_name(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="tip_force_n"):
        load_model(edited(tmp_path, "tip_force_n = 105.0", ""))


def test_a_file_that_is_no_toml_is_refused_by_its_path(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"edited\.toml"):
        load_model(edited(tmp_path, "[limits]", "[limits"))


def test_a_device_file_without_a_twin_loads(tmp_path: Path) -> None:
    text = (DEVICES_DIR / "hhd.toml").read_text(encoding="utf-8")
    path = tmp_path / "bare.toml"
    path.write_text(text[: text.index("[twin]")], encoding="utf-8")
    assert load_model(path).twin_json == "null"
