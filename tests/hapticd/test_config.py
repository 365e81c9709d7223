"""The configuration: every key is read, and what is wrong is named."""

from pathlib import Path

import pytest

from hapticd.config import ApiConfig, Config, DeviceConfig, PathsConfig, load_config
from hapticd.problem import Problem


@pytest.fixture(autouse=True)
def no_configuration_of_this_machine(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    for variable in ("HAPTICD_CONFIG", "HAPTICD_API__PORT", "HAPTICD_PATHS__STATE_DIR"):
        monkeypatch.delenv(variable, raising=False)
    for variable in ("XDG_CONFIG_HOME", "XDG_STATE_HOME", "XDG_RUNTIME_DIR"):
        monkeypatch.setenv(variable, str(tmp_path / variable.lower()))


def load(tmp_path: Path, text: str) -> Config:
    file = tmp_path / "hapticd.toml"
    file.write_text(text)
    return load_config(file)


def refusal(tmp_path: Path, text: str) -> Problem:
    with pytest.raises(Problem) as caught:
        load(tmp_path, text)
    assert caught.value.slug == "config-invalid"
    assert "hapticd.toml" in caught.value.detail
    return caught.value


def test_without_a_file_both_devices_run_as_twins(tmp_path: Path) -> None:
    config = load_config()
    assert [(device.id, device.model, device.is_twin) for device in config.devices] == [
        ("phantom", "phantom-1.0", True),
        ("hhd", "hhd", True),
    ]
    assert (config.api.host, config.api.port) == ("127.0.0.1", 8420)
    assert config.paths.state_dir == tmp_path / "xdg_state_home" / "hapticd"
    assert config.paths.runtime_dir == tmp_path / "xdg_runtime_dir" / "hapticd"


def test_every_key_is_read(tmp_path: Path) -> None:
    config = load(
        tmp_path,
        """
        [api]
        host = "::1"
        port = 9000
        [paths]
        state_dir = "/var/lib/hapticd"
        runtime_dir = "/run/hapticd"
        [[devices]]
        id = "bench"
        model = "hhd"
        driver = "hapticd_io"
        rate_hz = 4000
        realtime = "required"
        priority = 70
        cpu = 1
        on_loss = "hold"
        options = { port = "/dev/ttyACM0" }
        overrides = { "limits.tip_force_n" = 20.0 }
        seed = 7
        """,
    )
    (device,) = config.devices
    assert (config.api.host, config.api.port) == ("::1", 9000)
    assert (str(config.paths.state_dir), str(config.paths.runtime_dir)) == (
        "/var/lib/hapticd",
        "/run/hapticd",
    )
    assert device.model_dump() == {
        "id": "bench",
        "model": "hhd",
        "driver": "hapticd_io",
        "rate_hz": 4000.0,
        "realtime": "required",
        "priority": 70,
        "cpu": 1,
        "on_loss": "hold",
        "options": {"port": "/dev/ttyACM0"},
        "overrides": {"limits.tip_force_n": 20.0},
        "seed": 7,
    }
    assert device.model_overrides == {"limits.tip_force_n": 20.0, "brakes.release_on_stop": False}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[api]\nprot = 1", "api.prot is not a key. Did you mean port?"),
        ("[apy]\nport = 1", "apy is not a key. Did you mean api?"),
        ("colour = 'red'", "colour is not a key. Known: api, devices, paths."),
        ("[api]\nport = 70000", "api.port: Input should be less than or equal to 65535."),
        ("[api]\nhost = '0.0.0.0'", "api.host: '0.0.0.0' is not a loop-back address"),
        ("devices = []", "devices: "),
        ("[[devices]]\nid = 'a'", "devices.0.model: Field required."),
        ("[[devices]]\nid = 'A b'\nmodel = 'hhd'", "devices.0.id: "),
        (
            "[[devices]]\nid = 'a'\nmodel = 'hhd'\nrate = 1",
            "devices.0.rate is not a key. Did you mean rate_hz?",
        ),
        ("[[devices]]\nid = 'a'\nmodel = 'hhd'\nrate_hz = 20", "devices.0.rate_hz: "),
        ("[[devices]]\nid = 'a'\nmodel = 'hhd'\nrealtime = 'yes'", "devices.0.realtime: "),
        ("[[devices]]\nid='a'\nmodel='hhd'\n[[devices]]\nid='a'\nmodel='hhd'", "Two devices have the id 'a'"),
        ("[api\nport = 1", "is not valid TOML"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, words: str) -> None:
    assert words in refusal(tmp_path, text).detail


def test_every_wrong_key_is_named_at_once(tmp_path: Path) -> None:
    detail = refusal(tmp_path, "[api]\nport = -1\nhots = 'x'").detail
    assert "api.port" in detail
    assert "api.hots is not a key. Did you mean host?" in detail


def test_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(Problem, match=r"absent\.toml cannot be read: No such file"):
        load_config(tmp_path / "absent.toml")


def test_environment_wins_over_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HAPTICD_API__PORT", "9100")
    config = load(tmp_path, "[api]\nport = 9000\nhost = 'localhost'")
    assert (config.api.port, config.api.host) == (9100, "localhost")


@pytest.mark.parametrize(
    ("variable", "words"),
    [
        ("HAPTICD_APY__PORT", "HAPTICD_APY__PORT is unknown. Did you mean HAPTICD_API?"),
        ("HAPTICD_API__PROT", "api.prot is not a key. Did you mean port?"),
    ],
)
def test_unknown_variable_is_named(monkeypatch: pytest.MonkeyPatch, variable: str, words: str) -> None:
    monkeypatch.setenv(variable, "1")
    with pytest.raises(Problem) as caught:
        load_config()
    assert words in caught.value.detail


def test_file_named_in_the_environment_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "named.toml").write_text("[api]\nport = 9200")
    monkeypatch.setenv("HAPTICD_CONFIG", str(tmp_path / "named.toml"))
    assert load_config().api.port == 9200


def test_file_in_the_default_place_is_read(tmp_path: Path) -> None:
    place = tmp_path / "xdg_config_home" / "hapticd"
    place.mkdir(parents=True)
    (place / "config.toml").write_text("[api]\nport = 9300")
    assert load_config().api.port == 9300


def test_twins_take_the_place_of_hardware_and_its_options(tmp_path: Path) -> None:
    text = "[[devices]]\nid='a'\nmodel='hhd'\ndriver='hapticd_io'\noptions={port='/dev/x'}\nseed=3"
    (device,) = load(tmp_path, text).on_twins().devices
    assert device.is_twin
    assert (device.options, device.seed, device.model) == ({}, 3, "hhd")


def test_page_on_the_configuration_is_valid_and_names_every_key(tmp_path: Path) -> None:
    page = (Path(__file__).parents[2] / "docs" / "configuration.md").read_text()
    example = page.split("```toml\n")[1].split("```")[0]
    config = load(tmp_path, example)
    assert config.api.model_fields_set == set(ApiConfig.model_fields)
    assert config.paths.model_fields_set == set(PathsConfig.model_fields)
    assert config.devices[0].model_fields_set == set(DeviceConfig.model_fields)
