"""Walls as documents, and what builds them.

box("block", center_m=[0.2, 0, 0], size_m=[0.1, 0.1, 0.02], law=spring(800), friction=friction(0.4, 0.3))
"""

from __future__ import annotations

from typing import Literal, NotRequired, TypedDict, Unpack

Vector = list[float]
Form = Literal["implicit", "explicit"]


class Plane(TypedDict):
    """A half-space; the unit normal points into free space."""

    type: Literal["plane"]
    point_m: Vector
    normal: Vector


class Sphere(TypedDict):
    """A ball, or a disc; hollow is a thin shell."""

    type: Literal["sphere"]
    center_m: Vector
    radius_m: float
    hollow: NotRequired[bool]


class Box(TypedDict):
    """A cuboid turned by a unit quaternion (w, x, y, z), or a rectangle turned by an angle."""

    type: Literal["box"]
    center_m: Vector
    size_m: Vector
    orientation: NotRequired[Vector | None]
    angle_rad: NotRequired[float | None]
    hollow: NotRequired[bool]


class Capsule(TypedDict):
    """Everything within a radius of a segment."""

    type: Literal["capsule"]
    from_m: Vector
    to_m: Vector
    radius_m: float
    hollow: NotRequired[bool]


Shape = Plane | Sphere | Box | Capsule


class Switches(TypedDict, total=False):
    """What every law can be asked for; brake null is wherever the device has brakes."""

    passivity: bool
    brake: bool | None


class Motion(Switches):
    """The set-point gives way by eta times the depth: 0 is rigid, 1 is free."""

    type: Literal["motion"]
    eta: float


class Spring(Switches):
    """A spring with a damper."""

    type: Literal["spring"]
    stiffness_n_per_m: float
    damping_n_s_per_m: NotRequired[float]


class Damper(Switches):
    """A damper."""

    type: Literal["damper"]
    damping_n_s_per_m: float


class CubicDamper(Switches):
    """F = C v³; without a coefficient the form's own."""

    type: Literal["cubic_damper"]
    form: NotRequired[Form]
    coefficient_n_s3_per_m3: NotRequired[float | None]


Law = Motion | Spring | Damper | CubicDamper


class Friction(TypedDict):
    """Coulomb friction with stick."""

    static: float
    kinetic: float
    actuator: NotRequired[Literal["auto", "motor", "brake"]]


class Wall(TypedDict):
    """One wall."""

    id: str
    shape: Shape
    law: Law
    friction: NotRequired[Friction | None]
    enabled: NotRequired[bool]
    fade_s: NotRequired[float]


class Surface(TypedDict, total=False):
    """How a wall is felt: its law (else motion with ``eta``, rigid), friction, and when."""

    law: Law
    eta: float
    friction: Friction | None
    enabled: bool
    fade_s: float


def motion(eta: float = 0.0, **switches: Unpack[Switches]) -> Motion:
    """Gives way by ``eta`` times the depth; 0 is rigid."""
    return {"type": "motion", "eta": eta, **switches}


def spring(stiffness_n_per_m: float, damping_n_s_per_m: float = 0.0, **switches: Unpack[Switches]) -> Spring:
    """A spring with a damper."""
    return {
        "type": "spring",
        "stiffness_n_per_m": stiffness_n_per_m,
        "damping_n_s_per_m": damping_n_s_per_m,
        **switches,
    }


def damper(damping_n_s_per_m: float, **switches: Unpack[Switches]) -> Damper:
    """A damper."""
    return {"type": "damper", "damping_n_s_per_m": damping_n_s_per_m, **switches}


def cubic_damper(
    form: Form = "implicit", coefficient_n_s3_per_m3: float | None = None, **switches: Unpack[Switches]
) -> CubicDamper:
    """F = C v³; without a coefficient the form's own."""
    return {
        "type": "cubic_damper",
        "form": form,
        "coefficient_n_s3_per_m3": coefficient_n_s3_per_m3,
        **switches,
    }


def friction(static: float, kinetic: float, actuator: Literal["auto", "motor", "brake"] = "auto") -> Friction:
    """Coulomb friction with stick; ``kinetic`` is at most ``static``."""
    return {"static": static, "kinetic": kinetic, "actuator": actuator}


def plane(wall_id: str, *, point_m: Vector, normal: Vector, **surface: Unpack[Surface]) -> Wall:
    """A half-space: solid behind ``point_m``, free where the unit ``normal`` points."""
    return wall(wall_id, {"type": "plane", "point_m": point_m, "normal": normal}, **surface)


def sphere(
    wall_id: str, *, center_m: Vector, radius_m: float, hollow: bool = False, **surface: Unpack[Surface]
) -> Wall:
    """A ball, on a two-dimensional device a disc."""
    shape: Sphere = {"type": "sphere", "center_m": center_m, "radius_m": radius_m, "hollow": hollow}
    return wall(wall_id, shape, **surface)


def box(
    wall_id: str,
    *,
    center_m: Vector,
    size_m: Vector,
    orientation: Vector | None = None,
    angle_rad: float | None = None,
    hollow: bool = False,
    **surface: Unpack[Surface],
) -> Wall:
    """A cuboid turned by ``orientation`` (w, x, y, z), on a two-dimensional device by ``angle_rad``."""
    shape: Box = {"type": "box", "center_m": center_m, "size_m": size_m, "hollow": hollow}
    if orientation is not None:
        shape["orientation"] = orientation
    if angle_rad is not None:
        shape["angle_rad"] = angle_rad
    return wall(wall_id, shape, **surface)


def capsule(
    wall_id: str,
    *,
    from_m: Vector,
    to_m: Vector,
    radius_m: float,
    hollow: bool = False,
    **surface: Unpack[Surface],
) -> Wall:
    """Everything within ``radius_m`` of a segment."""
    shape: Capsule = {
        "type": "capsule",
        "from_m": from_m,
        "to_m": to_m,
        "radius_m": radius_m,
        "hollow": hollow,
    }
    return wall(wall_id, shape, **surface)


def wall(wall_id: str, shape: Shape, **surface: Unpack[Surface]) -> Wall:
    """A wall of any shape."""
    return {
        "id": wall_id,
        "shape": shape,
        "law": surface.get("law", motion(surface.get("eta", 0.0))),
        "friction": surface.get("friction"),
        "enabled": surface.get("enabled", True),
        "fade_s": surface.get("fade_s", 0.2),
    }
