"""What the address of the simple telemetry socket asks for."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field
from starlette.datastructures import QueryParams

from hapticd_api.document import checked
from hapticd_api.stream.message import Rate

DEFAULT_SIGNALS = ("state", "tip_position_m", "tip_force_n", "contact_depth_m")


def _split(names: object) -> object:
    return tuple(filter(None, names.split(","))) if isinstance(names, str) else names


SignalList = Annotated[tuple[str, ...], BeforeValidator(_split), Field(min_length=1, max_length=100)]


class QuickLook(BaseModel):
    """Which signals, how often, and whether every tick or the newest."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    signals: SignalList = DEFAULT_SIGNALS
    rate_hz: Rate = 60.0
    mode: Literal["latest", "batch"] = "latest"

    @classmethod
    def asked(cls, query: QueryParams) -> QuickLook:
        """The wishes in a query string. Raises `Problem`, which names the parameter."""
        return checked(cls, dict(query))
