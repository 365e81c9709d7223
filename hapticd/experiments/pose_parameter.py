"""The pose of a PHANTOM as a parameter of an experiment."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.experiments.drive_tuning import MODEL
from hapticd.experiments.experiment import Parameter
from hapticd.experiments.parameter_value import refused
from hapticd.experiments.run import Run

POSE = Parameter(
    "pose_rad",
    (0.0, np.pi / 6),
    "rad",
    "Joint angles q2, q3, the base straight ahead; the links are perpendicular where they are equal",
    "chosen: WN Fig. 3 and 4 give no numbers",
    minimum=-0.9,
    maximum=1.7,
)


def pose_of(run: Run) -> NDArray[np.float64]:
    """q1, q2, q3 of ``POSE``, (3,) rad. ``Problem`` (parameter-invalid) outside of the joints' limits."""
    q2, q3 = run.vector(POSE.name)
    q = np.array([0.0, q2, q3])
    if not _core.Kinematics(run.model(MODEL).device_json).inside(q, 0.0):
        raise refused(POSE.name, [q2, q3], f"it is outside of the joint limits of {MODEL}")
    return q
