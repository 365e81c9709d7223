"""What KS Fig. 5 says about compression and release, and whether it is so."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from hapticd.experiments.brake_release_poses import ReleasePose
from hapticd.experiments.brake_release_press import Press
from hapticd.experiments.claims import judged
from hapticd.experiments.experiment import Claim


def claims(cases: Mapping[str, Press], poses: Sequence[ReleasePose]) -> tuple[Claim, ...]:
    """The statements of KS §3 on the direction of the force."""
    return (
        _compression(cases["one_of_each"]),
        _release(cases["one_of_each"], poses),
        _both(cases["motors_and_brakes"]),
        _passive(cases["one_of_each"]),
    )


def _compression(press: Press) -> Claim:
    return judged(
        "While the wall is pressed, motor and brake together push along its normal",
        "KS §3, Fig. 5(a)",
        "off the normal by less than 2°",
        f"at most {press.held_deg:.2f}°, the brake's joint holding "
        f"{press.numbers()['brake_held_nm']:.1f} N·m",
        holds=press.held_deg < 2.0,
    )


def _release(press: Press, poses: Sequence[ReleasePose]) -> Claim:
    numbers = press.numbers()
    found, median = numbers["release_max_deg"], numbers["release_median_deg"]
    angles = ", ".join(f"{pose.release_deg:.0f}°" for pose in poses)
    return judged(
        "While it is let go, the resultant is not perpendicular to the wall",
        "KS §3, Fig. 5(b)",
        f"off the normal; {angles} at three poses in closed form, if the brake kept its torque",
        f"up to {found:.0f}°, median {median:.0f}° once the brake is let go",
        holds=found > 20.0,
    )


def _both(press: Press) -> Claim:
    found = press.numbers()
    return judged(
        "With motor and brake on every joint the force stays on the normal in release too",
        "KS §1, §3: the reason for pairing them",
        "off the normal by less than 5°",
        f"at most {found['compression_max_deg']:.1f}° pressed, {found['release_max_deg']:.1f}° in release",
        holds=max(found["compression_max_deg"], found["release_max_deg"]) < 5.0,
    )


def _passive(press: Press) -> Claim:
    torque = press.release["brake_torque_nm"][:, 1]
    pushes = press.release["joint_torque_demand_nm"][:, 1] * press.release["joint_velocity_rad_per_s"][:, 1]
    asked = bool(((torque > 0.0) & (pushes > 0.0) & _moving(press)).any())
    return judged(
        "A brake gives torque only against its motion",
        "KS §1, §3",
        "no brake is asked for torque in its direction of motion",
        "one was asked" if asked else "none was asked, in any tick of the release",
        holds=not asked,
    )


def _moving(press: Press) -> object:
    return abs(press.release["joint_velocity_rad_per_s"][:, 1]) > 0.06
