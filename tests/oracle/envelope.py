"""The Moreau envelope of several walls by trying every set of active walls (physics §3.4)."""

from dataclasses import dataclass
from itertools import chain, combinations

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

SLACK_M = 1e-12


@dataclass(frozen=True)
class Walls:
    """Unit normals (n, 3), offsets (n,) m and η (n,) of some walls."""

    normals: Vector
    offsets_m: Vector
    eta: Vector

    def rows(self) -> list[tuple[list[float], float, float]]:
        """As the core takes them."""
        return list(zip(self.normals.tolist(), self.offsets_m.tolist(), self.eta.tolist(), strict=True))


def random_walls(rng: np.random.Generator, count: int, *, rigid: float) -> Walls:
    """Walls about the origin, a share of them rigid; rigid ones leave the origin free."""
    normals = rng.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    offsets = rng.uniform(-0.03, 0.03, count)
    eta = np.where(rng.random(count) < rigid, 0.0, rng.uniform(0.01, 1.0, count))
    return Walls(normals, np.where(eta == 0.0, -np.abs(offsets), offsets), eta)


def set_point(walls: Walls, x: Vector) -> Vector:
    """x_Sd: rigid walls as exact constraints, soft ones as springs of weight (1−η)/η."""
    rigid, soft = np.flatnonzero(walls.eta == 0), np.flatnonzero(walls.eta > 0)
    candidates = (
        z
        for holding in subsets(rigid, 3)
        for pushing in subsets(soft, len(soft))
        if (z := candidate(walls, x, holding, pushing)) is not None
    )
    return min(candidates, key=lambda z: objective(walls, x, z))


def subsets(items: NDArray[np.intp], most: int) -> chain[tuple[int, ...]]:
    """All subsets of at most `most` items."""
    sizes = range(min(most, len(items)) + 1)
    return chain.from_iterable(combinations(items.tolist(), size) for size in sizes)


def candidate(walls: Walls, x: Vector, holding: tuple[int, ...], pushing: tuple[int, ...]) -> Vector | None:
    """Optimum for one guess of the active walls, or None where the guess contradicts itself."""
    a, d = walls.normals, walls.offsets_m
    weights = np.array([(1 - walls.eta[i]) / walls.eta[i] for i in pushing])
    springs, rests = a[list(pushing)], d[list(pushing)]
    hessian = np.eye(3) + springs.T @ (weights[:, None] * springs)
    rigid, count = a[list(holding)], len(holding)
    system = np.block([[hessian, -rigid.T], [rigid, np.zeros((count, count))]])
    right = np.concatenate([x + springs.T @ (weights * rests), d[list(holding)]])
    if np.linalg.cond(system) > 1e10:
        return None
    solution = np.linalg.solve(system, right)
    z, multipliers = solution[:3], solution[3:]
    feasible = np.all(d[walls.eta == 0] - a[walls.eta == 0] @ z <= SLACK_M)
    return z if feasible and np.all(multipliers >= -SLACK_M) else None


def objective(walls: Walls, x: Vector, z: Vector) -> float:
    """½|z−x|² + Σ wᵢ/2 max(0, dᵢ−nᵢᵀz)² over the soft walls."""
    soft = walls.eta > 0
    weights = (1 - walls.eta[soft]) / walls.eta[soft]
    violation = np.maximum(0, walls.offsets_m[soft] - walls.normals[soft] @ z)
    return float((z - x) @ (z - x) + weights @ violation**2) / 2


def superposed(walls: Walls, x: Vector) -> Vector:
    """The tempting wrong way, for rigid-corner contact with all walls touched: scale each rigid
    wall's own multiplier by 1−η. Not the gradient of any potential."""
    a = walls.normals
    multipliers = np.linalg.solve(a @ a.T, walls.offsets_m - a @ x)
    return x + a.T @ ((1 - walls.eta) * multipliers)
