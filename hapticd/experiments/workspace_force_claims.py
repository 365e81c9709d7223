"""What KS say about the workspace and the force in it, and whether it is so."""

from __future__ import annotations

import numpy as np

from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.experiment import Claim
from hapticd.experiments.workspace_map import WorkspaceMap
from hapticd.experiments.workspace_pushes import Pushes

JOINT_RANGE_DEG = np.array([[-40.0, 110.0], [70.0, 220.0]])
"""KS §2.1."""


def claims(survey: WorkspaceMap, pushes: Pushes) -> tuple[Claim, ...]:
    """Every statement of KS §2.1 and §2.2 that a number can decide."""
    return (
        _reach(survey),
        _no_singularity(survey),
        _motors(survey),
        _motors_on_the_twin(pushes),
        _major_portion(survey),
        _brakes(survey),
    )


def _reach(survey: WorkspaceMap) -> Claim:
    found = np.degrees([survey.q_rad.min(axis=0), survey.q_rad.max(axis=0)]).T
    inside = (found[:, 0] >= JOINT_RANGE_DEG[:, 0]).all() and (found[:, 1] <= JOINT_RANGE_DEG[:, 1]).all()
    return judged(
        "The joint ranges reach x −190…190 mm, y 90…320 mm",
        "KS §2.1, Fig. 1",
        "θ1 within −40…110°, θ2 within 70…220°",
        f"θ1 {found[0, 0]:.1f}…{found[0, 1]:.1f}°, θ2 {found[1, 0]:.1f}…{found[1, 1]:.1f}°",
        holds=bool(inside),
    )


def _no_singularity(survey: WorkspaceMap) -> Claim:
    margin = float(survey.margin.min())
    return judged(
        "No singularity exists within the workspace",
        "KS §2.1",
        "sin(θ2 − θ1) > 0 everywhere in the rectangle",
        f"at least {margin:.3f}, condition of J at most {survey.condition.max():.2f}; "
        "the joint ranges outside the rectangle do hold singularities, at θ1 = θ2 and at 180°",
        holds=margin > 0.1,
    )


def _motors(survey: WorkspaceMap) -> Claim:
    ball = float(survey.smallest_n(survey.motor_nm).min())
    box = float(survey.box_n(survey.motor_nm).min())
    return judged(
        "Motors give more than 80 N in all directions over the whole workspace",
        "KS §2.2, Fig. 2",
        "> 80 N",
        f"{ball:.1f} N if the torques share one bound, as the ellipse draws it; "
        f"{box:.0f} N if each motor has its own",
        holds=ball > 80.0,
    )


def _motors_on_the_twin(pushes: Pushes) -> Claim:
    return judged(
        "The same on the twin: the force that arrives at a clamped tip",
        "KS §2.2",
        "> 80 N",
        f"at least {pushes.along_n.min():.1f} N in {len(pushes.along_n)} pushes",
        holds=bool(pushes.along_n.min() > 80.0),
    )


def _major_portion(survey: WorkspaceMap) -> Claim:
    pairs = float(np.mean(survey.ball_n(survey.motor_nm) >= 100.0))
    points = float(np.mean(survey.smallest_n(survey.motor_nm) >= 100.0))
    return judged(
        "100 N in a major portion of the workspace",
        "KS §4",
        "more than half",
        f"{100 * pairs:.0f} % of poses and directions, {100 * points:.0f} % of poses in every direction",
        holds=pairs > 0.5,
    )


def _brakes(survey: WorkspaceMap) -> Claim:
    found = {
        name: float(survey.smallest_n(torque_nm).min())
        for name, torque_nm in survey.brake_readings_nm.items()
    }
    readings = survey.brake_readings_nm
    return undecidable(
        "Brakes give more than 36 N in all directions over the whole workspace",
        "KS §2.2",
        "> 36 N",
        f"{found['before_the_pulley']:.1f} N with the brake before the pulley "
        f"({readings['before_the_pulley']:g} N·m at the joint), "
        f"{found['at_the_joint']:.1f} N with it at the joint ({readings['at_the_joint']:g} N·m), "
        f"{found['inferred']:.1f} N with {readings['inferred']:g} N·m",
        "neither reading of 4 N·m and of Fig. 4 gives 36 N; 10 N·m at the joint would",
    )
