"""Where the core's proxy rests on each shape, against closest points found another way."""

import json

import numpy as np
import pytest

from hapticd._core import Proxy
from hapticd.flat_wall import rigid_plane
from tests.oracle.shapes import Ball, Box, Capsule, Point, Shape, inner_point, random_shape

KINDS = [Ball, Box, Capsule]
SETTLED = 20


def proxy_of(shape: Shape, *, hollow: bool) -> Proxy:
    wall = rigid_plane([0.0, 0.0, 1.0], 0.0) | {"shape": shape.flat(hollow)}
    return Proxy(json.dumps([wall]))


def settled(proxy: Proxy, x: Point) -> tuple[Point, list[tuple[int, list[float], float]]]:
    for _ in range(SETTLED):
        point, facings = proxy.follow(x)
    return np.array(point), facings


def beyond(shape: Shape, x: Point, distance_m: float) -> Point:
    """The point above an inner point, so far out of the surface."""
    surface = shape.surface(x)
    return surface + distance_m * (surface - x) / np.linalg.norm(surface - x)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("hollow", [False, True])
def test_tip_pushed_straight_in_leaves_the_proxy_at_the_closest_point(
    kind: type[Shape], hollow: bool
) -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        shape = random_shape(rng, kind)
        x = inner_point(rng, shape)
        proxy = proxy_of(shape, hollow=hollow)
        proxy.follow(beyond(shape, x, 0.01))
        point, facings = settled(proxy, x)
        surface = shape.surface(x)
        assert point == pytest.approx(surface, abs=1e-8)
        depth_m = np.linalg.norm(surface - x)
        [(wall, normal, offset_m)] = facings
        assert wall == 0
        assert np.array(normal) == pytest.approx((surface - x) / depth_m, abs=1e-5)
        assert offset_m - np.array(normal) @ x == pytest.approx(depth_m, abs=1e-8)


@pytest.mark.parametrize("kind", KINDS)
def test_tip_that_leaves_a_shell_from_inside_is_held_at_the_closest_point(kind: type[Shape]) -> None:
    rng = np.random.default_rng(2)
    for _ in range(100):
        shape = random_shape(rng, kind)
        inside = inner_point(rng, shape)
        x = beyond(shape, inside, 0.01) + rng.uniform(-0.005, 0.005, 3)
        proxy = proxy_of(shape, hollow=True)
        proxy.follow(inside)
        point, facings = settled(proxy, x)
        assert point == pytest.approx(shape.surface(x), abs=1e-8)
        assert facings


@pytest.mark.parametrize("kind", KINDS)
def test_tip_outside_is_where_its_proxy_is(kind: type[Shape]) -> None:
    rng = np.random.default_rng(3)
    for _ in range(100):
        shape = random_shape(rng, kind)
        x = beyond(shape, inner_point(rng, shape), 0.005)
        point, facings = settled(proxy_of(shape, hollow=False), x)
        assert (point.tolist(), facings) == (x.tolist(), [])


def test_walls_that_are_none_are_refused() -> None:
    with pytest.raises(ValueError, match="shape"):
        Proxy('[{"key": 1}]')
