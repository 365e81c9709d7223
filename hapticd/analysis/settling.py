"""The stiffest wall that settles on the twin, under the hand of its model pushing gently."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.device_loop import DeviceLoop
from hapticd.flat_wall import flat_plane
from hapticd.model import Model
from hapticd.twin import Refused, TwinRun

RIGID: Mapping[str, Any] = {"type": "motion", "eta": 0.0}

SETTLED_M = 50e-6
"""Peak-to-peak motion that counts as rest: half of KS' smallest bounce (KS Fig. 8) …"""

SETTLED_QUANTA = 3.0
"""… or this many quanta of the tip's position where those are coarser."""

PUSH_SHARE = 0.25
"""Force of the push, of the device's largest: KS' weak contact on the HHD, 2 N on the PHANTOM."""

SPEED_M_PER_S = 0.25
"""Speed of the advance: KS' weak contact."""

GAP_M = 0.01
"""Way of the tip to the wall."""

PUSH_S = 1.0
WATCHED_S = 0.2
"""Length of the push, and the last part of it in which the tip must rest."""


@dataclass(frozen=True, slots=True)
class Wall:
    """A rigid plane close to the tip's home: ``normal`` (3,) points away from it, against the push."""

    normal: tuple[float, float, float]
    offset_m: float


@dataclass(frozen=True, slots=True)
class Contact:
    """How a push into the wall went.

    ``motion_m`` is peak to peak across the wall in the watched part, less a parabola: a soft wall that still
    gives way under its damper is no oscillation.
    """

    motion_m: float
    touching: bool
    faulty: bool

    def settled(self, bound_m: float) -> bool:
        """Whether the tip came to rest in the wall."""
        return self.touching and not self.faulty and self.motion_m < bound_m


def bound_m(loop: DeviceLoop) -> float:
    """Peak-to-peak motion below which this device rests, m."""
    return max(SETTLED_M, SETTLED_QUANTA * loop.tip.quantum_m)


def push(
    model: Model,
    rate_hz: float,
    seed: int = 1,
    *,
    share: float = PUSH_SHARE,
    law: Mapping[str, Any] = RIGID,
    passivity: bool = False,
) -> Contact:
    """Lets the hand of the twin push into a wall. About 10 ms of work.

    ``law`` is the wall's as the core takes it, rigid by default, and ``passivity`` whether passivity watches
    it; ``share`` is the force of the push, of the device's largest.
    """
    wall, force_n = home_wall(model), share * json.loads(model.device_json)["limits"]["tip_force_n"]
    plane = flat_plane(wall.normal, wall.offset_m, law, passivity=passivity)
    run = TwinRun(model, rate_hz=rate_hz, seed=seed)
    run.scene({"allocation": "motor_only", "walls": [plane]})
    try:
        run.enable()
    except Refused:
        return Contact(np.inf, touching=False, faulty=True)
    run.run(2 * json.loads(model.device_json)["limits"]["ramp_s"])
    against = [-component for component in wall.normal]
    run.hand({"type": "push", "direction": against, "force_n": force_n, "speed_m_per_s": SPEED_M_PER_S})
    return _contact(run.run(PUSH_S)[-round(WATCHED_S * rate_hz) :], wall)


def _contact(watched: NDArray[Any], wall: Wall) -> Contact:
    across_m = watched["tip_position_m"] @ np.array(wall.normal)
    time = np.linspace(-1.0, 1.0, len(across_m))
    drift_m = np.polynomial.polynomial.polyfit(time, across_m, 2)
    return Contact(
        motion_m=float(np.ptp(across_m - np.polynomial.polynomial.polyval(time, drift_m))),
        touching=bool(np.all(watched["contact_count"] > 0)),
        faulty=bool(np.any(watched["faults"])),
    )


@lru_cache(maxsize=64)
def home_wall(model: Model) -> Wall:
    """The wall across the direction in which the tip is lightest at home; it lies towards the base."""
    home = json.loads(model.device_json)["joints"]["home_rad"]
    kinematics = _core.Kinematics(model.device_json)
    jacobian, tip = np.array(kinematics.jacobian(home)), np.array(kinematics.forward(home))
    inertia = np.array(_core.mass_matrix(model.device_json, model.twin_json, home))
    mobility = jacobian @ np.linalg.solve(inertia, jacobian.T)
    normal = np.linalg.eigh(mobility)[1][:, -1]
    normal *= np.copysign(1.0, normal @ tip)
    x, y, z = normal.tolist()
    return Wall((x, y, z), float(normal @ tip) - GAP_M)
