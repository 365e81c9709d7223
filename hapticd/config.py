"""The configuration: one strict TOML file, overridden by ``HAPTICD_…`` variables.

``HAPTICD_API__PORT=9000`` overrides ``port`` of ``[api]``. Every key is read; one that nobody knows is an
error that names it, with the nearest key that exists.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator
from pydantic_settings import BaseSettings, PydanticBaseSettingsSource, SettingsConfigDict

from hapticd.config_problem import Sections, config_problem, nearest
from hapticd.places import default_runtime_dir, default_state_dir, xdg
from hapticd.problem import Problem

ENV_PREFIX = "HAPTICD_"
CONFIG_VARIABLE = "HAPTICD_CONFIG"
"""Names the configuration file, where the command line does not."""

CLIENT_VARIABLES = frozenset({"HAPTICD_URL"})
"""Variables of the client, which mean nothing here."""

TWIN_DRIVER = "twin"


class Section(BaseModel):
    """A table of the configuration file."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class ApiConfig(Section):
    """``[api]``: where the daemon listens. Loop-back alone: whoever reaches the port may move the devices."""

    host: str = "127.0.0.1"
    port: int = Field(8420, ge=0, le=65535, description="0 takes any free port")

    @field_validator("host")
    @classmethod
    def _loop_back(cls, host: str) -> str:
        if host != "localhost" and not _is_loop_back(host):
            raise ValueError(
                f"{host!r} is not a loop-back address; the API has no tokens, so use 127.0.0.1 or ::1."
            )
        return host


class PathsConfig(Section):
    """``[paths]``: where the daemon keeps things. ``~`` is the home directory."""

    state_dir: Path = Field(default_factory=default_state_dir, description="Scenes and events")
    runtime_dir: Path = Field(
        default_factory=default_runtime_dir, description="Shared memory; best on a tmpfs"
    )

    @field_validator("state_dir", "runtime_dir")
    @classmethod
    def _absolute(cls, path: Path) -> Path:
        return path.expanduser().absolute()


class DeviceConfig(Section):
    """One ``[[devices]]``: a device, its model and its driver."""

    id: Annotated[str, Field(pattern=r"^[a-z0-9][a-z0-9_-]{0,31}$")]
    model: str = Field(description="A model in hapticd/devices, or the path of a TOML file")
    driver: str = Field(TWIN_DRIVER, description="twin, or the name of an installed driver")
    rate_hz: float = Field(1000.0, ge=100.0, le=10000.0)
    realtime: Literal["off", "preferred", "required"] = Field(
        "preferred", description="required refuses to enable without real-time scheduling"
    )
    priority: int = Field(80, ge=1, le=98, description="SCHED_FIFO priority")
    cpu: int | None = Field(None, ge=0, description="Processor to pin the loop to")
    on_loss: Literal["release", "hold"] | None = Field(
        None, description="Brakes once outputs are withdrawn, also when the daemon dies; default: the model's"
    )
    options: dict[str, Any] = Field(default_factory=dict, description="Options of the driver")
    overrides: dict[str, Any] = Field(
        default_factory=dict, description='Values of the model by dotted key, such as "limits.tip_force_n"'
    )
    seed: int = Field(1, ge=0, description="Seed of the twin's noise")

    @property
    def is_twin(self) -> bool:
        return self.driver == TWIN_DRIVER

    @property
    def model_overrides(self) -> dict[str, Any]:
        """``overrides``, with ``on_loss`` as the key of the model it stands for."""
        if self.on_loss is None:
            return dict(self.overrides)
        return {**self.overrides, "brakes.release_on_stop": self.on_loss == "release"}


DEFAULT_DEVICES = (DeviceConfig(id="phantom", model="phantom-1.0"), DeviceConfig(id="hhd", model="hhd"))


class Config(BaseSettings):
    """Everything the daemon is told. See :func:`load_config`."""

    model_config = SettingsConfigDict(
        env_prefix=ENV_PREFIX, env_nested_delimiter="__", extra="forbid", frozen=True
    )

    api: ApiConfig = ApiConfig()
    paths: PathsConfig = Field(default_factory=PathsConfig)
    devices: Annotated[tuple[DeviceConfig, ...], Field(min_length=1)] = DEFAULT_DEVICES

    @field_validator("devices")
    @classmethod
    def _unique_ids(cls, devices: tuple[DeviceConfig, ...]) -> tuple[DeviceConfig, ...]:
        ids = [device.id for device in devices]
        for device_id in ids:
            if ids.count(device_id) > 1:
                raise ValueError(f"Two devices have the id {device_id!r}; ids must be unique.")
        return devices

    @classmethod
    def settings_customise_sources(
        cls,
        settings_cls: type[BaseSettings],
        init_settings: PydanticBaseSettingsSource,
        env_settings: PydanticBaseSettingsSource,
        dotenv_settings: PydanticBaseSettingsSource,
        file_secret_settings: PydanticBaseSettingsSource,
    ) -> tuple[PydanticBaseSettingsSource, ...]:
        """The environment wins over the file, which arrives as keyword arguments."""
        return env_settings, init_settings

    def on_twins(self) -> Self:
        """The same devices, each with its twin in place of the hardware."""
        twins = tuple(
            device.model_copy(update={"driver": TWIN_DRIVER, "options": {}}) for device in self.devices
        )
        return self.model_copy(update={"devices": twins})


SECTIONS: Sections = {"": Config, "api": ApiConfig, "paths": PathsConfig, "devices": DeviceConfig}
"""The model of each table, the file itself under the empty name."""


def load_config(path: Path | None = None) -> Config:
    """The configuration in ``path``, else in ``$HAPTICD_CONFIG``, else in a default place, else two twins.

    Raises ``Problem`` (config-invalid), which names file and key.
    """
    file = path or _default_file()
    _refuse_unknown_variables(os.environ)
    table = _read_toml(file) if file else {}
    try:
        return Config(**table)
    except ValidationError as error:
        raise config_problem(error, file, SECTIONS) from None


def _is_loop_back(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def _default_file() -> Path | None:
    if named := os.environ.get(CONFIG_VARIABLE):
        return Path(named)
    places = (
        xdg("XDG_CONFIG_HOME", "~/.config") / "hapticd" / "config.toml",
        Path("/etc/hapticd/config.toml"),
    )
    return next((place for place in places if place.is_file()), None)


def _read_toml(file: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(file.read_text(encoding="utf-8"))
    except OSError as error:
        raise Problem("config-invalid", f"{file} cannot be read: {error.strerror}.") from None
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise Problem("config-invalid", f"{file} is not valid TOML: {error}.") from None


def _refuse_unknown_variables(environment: Mapping[str, str]) -> None:
    known = {ENV_PREFIX + name.upper() for name in Config.model_fields} | {CONFIG_VARIABLE} | CLIENT_VARIABLES
    for variable in environment:
        if variable.startswith(ENV_PREFIX) and variable.split("__")[0] not in known:
            detail = f"The environment variable {variable} is unknown.{nearest(variable, known)}"
            raise Problem("config-invalid", detail)
