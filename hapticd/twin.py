"""A twin with its controller, faster than real time: for experiments and tests."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.model import Model, load_model
from hapticd.record import record_dtype

EMPTY_SCENE: Mapping[str, Any] = {
    "revision": 0,
    "fade_s": 0.0,
    "mapping": "transpose",
    "stiffness": "pose",
    "allocation": "motor_and_brake",
    "walls": [],
}
"""A scene without walls, in the form the core takes; what a scene leaves out is as here."""


class Refused(RuntimeError):
    """The device did not take an event; ``interlocks`` are the slugs of what stands against it."""

    def __init__(self, desired: str, bits: int) -> None:
        table = enumerate(_core.interlock_table())
        self.interlocks = [entry["slug"] for bit, entry in table if bits >> bit & 1]
        super().__init__(f"{desired} was refused: {', '.join(self.interlocks)}")


class TwinRun:
    """One device with its operator's hand, in closed loop. Equal arguments and calls: equal records."""

    def __init__(
        self,
        model: str | Model = "phantom-1.0",
        *,
        rate_hz: float = 1000.0,
        seed: int = 1,
        overrides: Mapping[str, Any] | None = None,
    ) -> None:
        self.model = (
            model.changed(overrides or {}) if isinstance(model, Model) else load_model(model, overrides)
        )
        self.rate_hz = rate_hz
        self._simulation = _core.Simulation(self.model.device_json, self.model.twin_json, rate_hz, seed)
        self._revision = 0
        self.run(1.0 / rate_hz)  # the first observation connects the device

    def scene(self, scene: Mapping[str, Any]) -> None:
        """Renders a scene, flat as the core takes it; see ``EMPTY_SCENE`` for what may be left out."""
        self._revision += 1
        self._request({"type": "scene", "scene": {**EMPTY_SCENE, "revision": self._revision, **scene}})

    def enable(self) -> None:
        """Outputs follow the scene. ``Refused`` while an interlock is open."""
        self._desire("enabled")

    def disable(self) -> None:
        """Outputs fade to zero."""
        self._desire("disabled")

    def pause(self) -> None:
        """Outputs fade to zero and wait. ``Refused`` unless enabled."""
        self._desire("paused")

    def estop(self) -> None:
        """Zero in the next tick, latched."""
        self._request({"type": "estop"})

    def acknowledge_estop(self) -> None:
        """Clears the E-stop latch. ``Refused`` while its input is open."""
        if bits := self._request({"type": "estop_ack"}):
            raise Refused("acknowledging the E-stop", bits)

    def acknowledge_faults(self) -> None:
        """Clears every latched fault whose cause is gone."""
        every = (1 << len(_core.fault_table())) - 1
        self._request({"type": "fault_ack", "faults": every})

    def hand(self, script: Mapping[str, Any]) -> None:
        """Tells the operator's hand what to do, for example ``{"type": "hold"}``."""
        self._request({"type": "hand", "script": dict(script)})

    def inject(self, injection: Mapping[str, Any]) -> None:
        """Injects a fault, for example ``{"type": "unplug", "duration_s": 0.5}``."""
        self._request({"type": "inject", "injection": dict(injection)})

    def run(self, duration_s: float) -> NDArray[Any]:
        """Runs for a while; the tick records, shape (ticks,), of ``record_dtype()``."""
        ticks = round(duration_s * self.rate_hz)
        return np.frombuffer(self._simulation.run(ticks), record_dtype())

    def truth(self) -> dict[str, NDArray[np.float64]]:
        """The plant's true state at the last tick, each of shape (3,)."""
        return {name: np.asarray(value) for name, value in self._simulation.truth().items()}

    def _desire(self, desired: str) -> None:
        if bits := self._request({"type": "desired", "desired": desired}):
            raise Refused(desired, bits)

    def _request(self, request: dict[str, Any]) -> int:
        return self._simulation.request(json.dumps(request))
