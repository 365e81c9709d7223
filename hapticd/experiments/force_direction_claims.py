"""What WN say about the direction of the force, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from hapticd.analysis.phantom_pose import PhantomPose
from hapticd.experiments.claims import judged, undecidable
from hapticd.experiments.direction_bandwidth import Bandwidth
from hapticd.experiments.direction_series import Series
from hapticd.experiments.experiment import Claim

if TYPE_CHECKING:
    from hapticd.experiments.direction_on_device import OnDevice

ACCURATE_DEG = 0.1
"""What the transpose mapping may err on the ideal twin: encoder counts and the clamp's give."""

HAND_HZ = 30.0
THRESHOLD_DEG = 25.0
"""Bandwidth of kinesthesia and threshold of direction, as WN quote them ([7], [2])."""

WALL_ABOVE_DEG = 270.0
"""A horizontal wall above the device has its normal downwards (WN Fig. 5)."""


def claims(
    pose: PhantomPose,
    ideal: Mapping[str, Series],
    imperfect: Mapping[str, Series],
    moving: Bandwidth | None,
) -> tuple[Claim, ...]:
    """Every statement of WN §VI and of the end of §V that a number can decide."""
    return (
        _accurate(ideal["transpose"]),
        _peak(pose, ideal["inverse"]),
        _periodic(ideal["inverse"]),
        _fig_5(ideal),
        _robust(imperfect),
        _scatter(imperfect["transpose"]),
        *(_in_motion(moving) if moving else ()),
        _fig_6(ideal["inverse"]),
    )


def _accurate(transpose: Series) -> Claim:
    return judged(
        "Jacobian transpose produces an accurately directed force",
        "WN §VI, Fig. 5, 6",
        f"error below {ACCURATE_DEG}° for every wall, without brush ripple and friction",
        f"{transpose.max_abs_error_deg:.4f}° at most over {len(transpose.angle_rad)} walls",
        holds=transpose.max_abs_error_deg < ACCURATE_DEG,
    )


def _peak(pose: PhantomPose, inverse: Series) -> Claim:
    expected = float(np.degrees(np.abs(inverse.expected_rad).max()))
    return judged(
        "Jacobian inverse produces large errors",
        "WN §VI, Fig. 6",
        f"{expected:.1f}° at most for these walls, by the closed form; |q3 − q2| = "
        f"{abs(np.degrees(pose.coupling_rad)):.1f}°",
        f"{inverse.max_abs_error_deg:.1f}° at most, {inverse.rms_error_deg:.1f}° rms",
        holds=abs(inverse.max_abs_error_deg - expected) < 1.0 and expected > 5.0,
    )


def _periodic(inverse: Series) -> Claim:
    return judged(
        "The errors of Jacobian inverse are periodic in the wall normal, as of an elliptical stiffness",
        "WN §VI, Fig. 6",
        "atan2((κ−1) sin ψ cos ψ, cos² ψ + κ sin² ψ) at every wall within 1°",
        f"{inverse.max_off_expected_deg:.2f}° off at most; {100 * inverse.periodic_share:.1f} % of the "
        "variance has the period of half a turn",
        holds=inverse.max_off_expected_deg < 1.0 and inverse.periodic_share > 0.95,
    )


def _fig_5(ideal: Mapping[str, Series]) -> Claim:
    transpose, inverse = (ideal[name].at(WALL_ABOVE_DEG) for name in ("transpose", "inverse"))
    return judged(
        "Under a horizontal wall above the device, transpose is accurate and inverse deviates significantly",
        "WN Fig. 5",
        "transpose along the dotted line; no number for inverse",
        f"transpose {transpose:+.3f}°, inverse {inverse:+.1f}°",
        holds=abs(transpose) < ACCURATE_DEG and abs(inverse) > 5.0,
    )


def _robust(imperfect: Mapping[str, Series]) -> Claim:
    transpose, inverse = imperfect["transpose"], imperfect["inverse"]
    return judged(
        "Jacobian transpose keeps its errors low with brush ripple and friction",
        "WN §VI, Fig. 6",
        "rms below a quarter of that of Jacobian inverse",
        f"{transpose.rms_error_deg:.1f}° rms and {transpose.max_abs_error_deg:.1f}° at most, against "
        f"{inverse.rms_error_deg:.1f}° and {inverse.max_abs_error_deg:.1f}°",
        holds=transpose.rms_error_deg < 0.25 * inverse.rms_error_deg,
    )


def _scatter(transpose: Series) -> Claim:
    return judged(
        "The errors of Jacobian transpose are not well correlated with the wall normal",
        "WN §VI, Fig. 6",
        "less than half of the variance with the period of half a turn",
        f"{100 * transpose.periodic_share:.0f} %: in one pose ripple makes one joint stiffer than the "
        "other, and friction is as periodic",
        holds=transpose.periodic_share < 0.5,
    )


def _in_motion(moving: Bandwidth) -> tuple[Claim, Claim, Claim]:
    fast, locked = np.degrees(moving.error_rad[-1]), np.degrees(moving.locked_rad[-1])
    hand = moving.largest_below_deg(HAND_HZ)
    past = moving.frequency_hz[np.degrees(moving.error_rad) > ACCURATE_DEG * 50]
    from_hz = f"{past[0]:g} Hz" if len(past) else "nowhere"
    return (
        judged(
            "The shape compensation has no infinite bandwidth: K_inv returns at high frequency",
            "WN §V, end",
            f"{locked:.0f}° at {moving.frequency_hz[-1]:g} Hz, that of locked joints",
            f"{fast:.0f}°; above 5° from {from_hz}",
            holds=bool(fast > 0.5 * locked),
        ),
        judged(
            "Within the bandwidth of kinesthesia the error stays below the threshold of direction",
            "WN §V, end",
            f"below {THRESHOLD_DEG:g}° up to {HAND_HZ:g} Hz",
            f"{hand:.1f}° at most",
            holds=hand < THRESHOLD_DEG,
        ),
        undecidable(
            "The discrepancies at high frequency are not perceptible",
            "WN §V, end",
            "people's judgement",
            f"{np.degrees(moving.error_rad.max()):.0f}° at most",
            "it is informal experience with the device; nobody feels a twin",
        ),
    )


def _fig_6(inverse: Series) -> Claim:
    return undecidable(
        "The amplitude of Fig. 6 is that of the configuration of Fig. 3 and 4",
        "WN Fig. 3, 4, 6",
        "the peak of Fig. 6, which is |q3 − q2| for equal links and joints",
        f"{inverse.max_abs_error_deg:.1f}° in this pose",
        "the text names neither the configuration nor the amplitude",
    )


def claims_on_device(found: OnDevice) -> tuple[Claim, ...]:
    """What a device with a locked tip can show."""
    transpose, inverse = found.series["transpose"], found.series["inverse"]
    by = f"by {found.force_from}"
    claims = (
        judged(
            "Jacobian transpose keeps the force near the wall normal",
            "WN §VI, Fig. 6",
            "rms below a quarter of that of Jacobian inverse, or below 5°",
            f"{transpose.rms_error_deg:.2f}° rms, {transpose.max_abs_error_deg:.2f}° at most, {by}",
            holds=transpose.rms_error_deg < max(5.0, 0.25 * inverse.rms_error_deg),
        ),
        judged(
            "Jacobian inverse errs as the closed form says",
            "WN §VI, Fig. 6",
            f"{np.degrees(np.abs(inverse.expected_rad).max()):.1f}° at most, within 5° at every wall",
            f"{inverse.max_abs_error_deg:.1f}° at most, {inverse.max_off_expected_deg:.1f}° off, {by}",
            holds=inverse.max_off_expected_deg < 5.0,
        ),
    )
    if found.locked:
        return claims
    reason = f"the tip is not locked: it moved by {1e3 * found.moved_m:.2f} mm"
    return tuple(replace(claim, verdict="undecidable", reason=reason) for claim in claims)
