"""Both linkages from rotations and circles; Jacobians by the complex step, inverses by Newton."""

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.oracle.devices import PHANTOM, device

Forward = Callable[[NDArray[Any]], NDArray[Any]]
Vector = NDArray[np.float64]


def forward_of(name: str) -> Forward:
    """Forward kinematics of a shipped device: (3,) rad → (3,) m."""
    geometry = device(name)["kinematics"]
    if name == PHANTOM:
        return lambda q: phantom(q, geometry["l1_m"], geometry["l2_m"])
    return lambda q: rhombus(q, geometry["l_m"])


def phantom(q: NDArray[Any], l1: float, l2: float) -> NDArray[Any]:
    """Upper link raised by q2, forearm hanging and swung out by q3, both turned by q1 about z."""
    upper = raised_by(q[1]) @ np.array([l1, 0, 0])
    forearm = raised_by(q[2]) @ np.array([0, 0, -l2])
    return np.asarray(turned_by(q[0]) @ (upper + forearm))


def raised_by(angle: Any) -> NDArray[Any]:
    """Rotation that lifts the x axis towards z."""
    sin, cos = np.sin(angle), np.cos(angle)
    return np.array([[cos, 0, -sin], [0, 1, 0], [sin, 0, cos]])


def turned_by(angle: Any) -> NDArray[Any]:
    """Rotation about z."""
    sin, cos = np.sin(angle), np.cos(angle)
    return np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])


def rhombus(q: NDArray[Any], link: float) -> NDArray[Any]:
    """The outer crossing of two circles about the elbows (physics §4.1, d = 0)."""
    elbow_a = link * np.array([np.cos(q[0]), np.sin(q[0])])
    elbow_b = link * np.array([np.cos(q[1]), np.sin(q[1])])
    middle, between = (elbow_a + elbow_b) / 2, elbow_b - elbow_a
    apart = np.sqrt(between @ between)
    outward = np.array([between[1], -between[0]]) / apart
    tip = middle + np.sqrt(link**2 - apart**2 / 4) * outward
    return np.array([tip[0], tip[1], 0])


def jacobian(forward: Forward, q: Vector) -> Vector:
    """∂x/∂q by the complex step: exact to rounding."""
    step = 1e-30
    columns = [np.imag(forward(q + 1j * step * axis)) / step for axis in np.eye(3)]
    return np.stack(columns, axis=1)


def inverse(forward: Forward, x: Vector, start: Vector) -> Vector:
    """Joint angles of x by Newton's method from a nearby pose."""
    q = start.copy()
    for _ in range(50):
        q = q + np.linalg.pinv(jacobian(forward, q)) @ (x - forward(q))
    return q
