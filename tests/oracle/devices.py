"""The shipped device models as plain dictionaries, and random poses inside their limits."""

import json
import tomllib
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

FOLDER = Path(__file__).parents[2] / "hapticd" / "devices"

PHANTOM = "phantom-1.0"
HHD = "hhd"
BOTH = (PHANTOM, HHD)


def device(name: str) -> dict[str, Any]:
    """One device file without its twin."""
    table = tomllib.loads((FOLDER / f"{name}.toml").read_text())
    table.pop("twin", None)
    return table


def device_json(name: str) -> str:
    """One device as the core reads it."""
    return json.dumps(device(name))


def poses(name: str, count: int, seed: int) -> NDArray[np.float64]:
    """Random joint angles inside every limit, (count, 3), rad."""
    model, rng = device(name), np.random.default_rng(seed)
    low, high = np.array(model["joints"]["min_rad"]), np.array(model["joints"]["max_rad"])
    geometry = model["kinematics"]
    kind = "coupling" if name == PHANTOM else "opening"
    pair = slice(1, 3) if name == PHANTOM else slice(0, 2)
    found: list[NDArray[np.float64]] = []
    while len(found) < count:
        q = rng.uniform(low, high)
        difference = float(np.diff(q[pair])[0])
        if geometry[f"{kind}_min_rad"] <= difference <= geometry[f"{kind}_max_rad"]:
            found.append(q)
    return np.array(found)
