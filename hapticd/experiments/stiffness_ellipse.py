"""WN Fig. 3: how stiff the tip is in every direction, with inverse and with transpose mapping."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from hapticd import _core
from hapticd.analysis.phantom_pose import PhantomPose, workspace
from hapticd.analysis.stiffness import alpha_bound, locked_joints, principal, transposed
from hapticd.experiments.clamped_phantom import IDEAL
from hapticd.experiments.drive_tuning import MODEL, RESIDUAL, TUNING, tuned
from hapticd.experiments.experiment import Outcome, Parameter
from hapticd.experiments.pose_parameter import POSE, pose_of
from hapticd.experiments.run import Run
from hapticd.experiments.stiffness_ellipse_claims import claims
from hapticd.experiments.stiffness_ellipse_figure import draw
from hapticd.experiments.stiffness_probe import Probe, probe

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Vector = NDArray[np.float64]

OTHER_POSE_RAD = np.array([0.0, 0.9, 0.9])
"""Links perpendicular: where a stiffness that is the same everywhere is measured once more."""

MISMATCH = (0.05, 0.1, 0.2)
"""By how much one joint may be stiffer than the law believes."""

SPHERE = 2000
"""Directions in which the error of a stiffness matrix is looked for."""


class StiffnessEllipse:
    """K_inv and K_trans at a pose, in closed form and from the twin; α at the pose and for the workspace."""

    name = "stiffness-ellipse"
    title = "Stiffness of the tip by direction"
    source = "WN Fig. 3, eq. 18–30"
    models = (MODEL,)
    overrides: Mapping[str, Any] = IDEAL
    uncertain = ("kinematics.l1_m", "kinematics.l2_m", "drive.ratio", "drive.l_h", "drive.k_t_nm_per_a")
    on_device = False
    parameters = (
        POSE,
        RESIDUAL,
        TUNING,
        Parameter("displacement_m", 2.5e-4, "m", "How far the clamp pulls the tip", "chosen", 5e-5, 2e-3),
        Parameter("directions", 12, "1", "Directions in which it pulls", "chosen", 3, 72),
        Parameter("steps", 60, "1", "Steps a joint in the map of the workspace", "chosen", 5, 300),
    )

    def run(self, run: Run) -> Outcome:
        """Pulls the tip under both mappings, and compares with the matrices of the paper."""
        pose_rad = pose_of(run)
        model = run.model(MODEL, tuned(run))
        pose = PhantomPose.of_model(model, pose_rad)
        probes = {
            "inverse": probe(run, pose_rad, {"mapping": "inverse"}),
            "transpose": probe(run, pose_rad, {"mapping": "transpose"}),
            "workspace": probe(run, pose_rad, {"mapping": "transpose", "stiffness": "workspace"}),
            "workspace_elsewhere": probe(
                run, OTHER_POSE_RAD, {"mapping": "transpose", "stiffness": "workspace"}
            ),
        }
        everywhere = list(workspace(model, run.integer("steps")))
        found = map_of(everywhere)
        smallest = _core.Kinematics(model.device_json).workspace_stiffness(pose.k_q)
        results = {
            "pose": at_pose(pose, probes),
            "workspace": {**spans(found), "global_stiffness_n_per_m": smallest},
            "unequal_joints": unequal(everywhere),
            "mismatch_error_deg": {str(share): mismatch_error_deg(pose, share) for share in MISMATCH},
        }

        def figure(figure: Figure) -> None:
            draw(figure, pose, probes, everywhere, found)

        traces = {"workspace": found, **{name: _trace(one) for name, one in probes.items()}}
        return Outcome(results, claims(results), figure, traces)


def at_pose(pose: PhantomPose, probes: Mapping[str, Probe]) -> dict[str, Any]:
    """Both stiffnesses of the linkage with its base locked, closed form beside twin."""
    k_inv = locked_joints(pose.plane_jacobian, pose.plane_k_q)
    k_c = _core.isotropic_stiffness(pose.jacobian, pose.k_q)
    return {
        "tip_m": pose.tip.tolist(),
        "coupling_deg": float(np.degrees(pose.coupling_rad)),
        "alpha_plane_per_m2": alpha_bound(pose.plane_jacobian),
        "alpha_per_m2": alpha_bound(pose.jacobian),
        "k_c_n_per_m": k_c,
        "k_inv_n_per_m": k_inv.tolist(),
        "k_inv_principal_n_per_m": principal(k_inv)[0].tolist(),
        **{f"{name}_twin_n_per_m": one.stiffness.tolist() for name, one in probes.items()},
    }


def map_of(poses: list[PhantomPose]) -> dict[str, Vector]:
    """Bounds of every pose: of WN eq. 29 with the base locked and free, and of unequal joints."""
    loops = [_loop_gain(pose, _core.isotropic_stiffness(pose.jacobian, pose.k_q)) for pose in poses]
    return {
        "x_m": np.array([pose.tip[0] for pose in poses]),
        "z_m": np.array([pose.tip[2] for pose in poses]),
        "alpha_plane_per_m2": np.array([alpha_bound(pose.plane_jacobian) for pose in poses]),
        "alpha_per_m2": np.array([alpha_bound(pose.jacobian) for pose in poses]),
        "k_c_n_per_m": np.array([_core.isotropic_stiffness(pose.jacobian, pose.k_q) for pose in poses]),
        "softest_locked_n_per_m": np.array(
            [principal(locked_joints(pose.jacobian, pose.k_q))[0][0] for pose in poses]
        ),
        "loop_gain": np.array(loops),
    }


def spans(found: Mapping[str, Vector]) -> dict[str, Any]:
    """Smallest and largest of each bound over the workspace."""
    return {
        "poses": len(found["x_m"]),
        **{name: [float(column.min()), float(column.max())] for name, column in found.items()},
    }


def unequal(poses: list[PhantomPose]) -> dict[str, float]:
    """What the paper's law, one α for all joints, does with joints of different stiffness."""
    share = poses[0].k_q / poses[0].k_q.min()
    errors = [
        largest_error_rad(transposed(pose.jacobian, pose.k_q, np.full(3, alpha_bound(pose.jacobian))))
        for pose in poses
    ]
    return {
        "stiffest_over_softest_joint": float(share.max()),
        "largest_error_deg": float(np.degrees(max(errors))),
    }


def mismatch_error_deg(pose: PhantomPose, share: float) -> float:
    """Largest error of direction when joint 2 is stiffer by ``share`` than the transpose law believes, °."""
    truth = pose.plane_k_q * np.array([1.0 + share, 1.0])
    stiffness = transposed(pose.plane_jacobian, truth, 1.0 / pose.plane_k_q)
    angle = np.linspace(0.0, np.pi, SPHERE)
    moves = np.stack([np.cos(angle), np.sin(angle)])
    return float(np.degrees(_angles(stiffness, moves).max()))


def largest_error_rad(stiffness: NDArray[np.float64]) -> float:
    """Largest angle between a displacement and its force, over the sphere, rad."""
    index = np.arange(SPHERE) + 0.5
    height, turn = 1 - index / SPHERE, np.pi * (1 + np.sqrt(5)) * index
    radius = np.sqrt(1 - height**2)
    return float(_angles(stiffness, np.stack([radius * np.cos(turn), radius * np.sin(turn), height])).max())


def _angles(stiffness: NDArray[np.float64], moves: NDArray[np.float64]) -> Vector:
    forces = stiffness @ moves
    cosine = np.sum(forces * moves, axis=0) / np.linalg.norm(forces, axis=0)
    return np.asarray(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _loop_gain(pose: PhantomPose, k_c: float) -> float:
    """Largest gain of a joint loop against its own: λ_max(K_q^−½ Jᵀ k_c J K_q^−½)."""
    scaled = pose.jacobian / np.sqrt(pose.k_q)
    return float(k_c * np.linalg.norm(scaled, 2) ** 2)


def _trace(one: Probe) -> dict[str, Vector]:
    return {
        "x_m": one.displacement_m[:, 0],
        "z_m": one.displacement_m[:, 1],
        "force_x_n": one.force_n[:, 0],
        "force_z_n": one.force_n[:, 1],
    }


EXPERIMENT = StiffnessEllipse()
