"""What would raise a stability limit: each parameter changed by itself, and the analysis made again."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from hapticd.analysis.device_loop import DeviceLoop
from hapticd.analysis.passivity_limit import abbott_okamura_n_per_m
from hapticd.analysis.stability import Advice, LimitName
from hapticd.analysis.wall_law import WallLaw

WORTHWHILE = 1.02
"""Ratio by which a limit must rise for a parameter to be worth a mention."""

DAMPING_STEPS = 8
MOST = 6
"""Proposals at most."""


@dataclass(frozen=True, slots=True)
class _Change:
    parameter: str
    present: float
    proposed: float
    unit: str
    words: str
    loop: DeviceLoop


def advise(loop: DeviceLoop, law: WallLaw) -> list[Advice]:
    """The changes that raise the linear limit of this law, best first; for a damper the limit of damping.

    Finite differences of the linear analysis: doubled rate, halved lag and so on. About 20 ms.
    """
    damper = law.stiffness_n_per_m == 0.0
    name: LimitName = "damping" if damper else "linear"
    now = _limit(loop, law, damper)
    found = [
        Advice(
            parameter=change.parameter,
            present=change.present,
            proposed=change.proposed,
            unit=change.unit,
            limit=name,
            limit_now=now,
            limit_then=_limit(change.loop, law, damper),
            words=change.words,
        )
        for change in _changes(loop)
    ]
    if not damper:
        found += [_damping(loop, law, now), *_tuning(loop), *_resolution(loop)]
    worthwhile = [each for each in found if each.limit_then > WORTHWHILE * each.limit_now]
    return sorted(worthwhile, key=_gain, reverse=True)[:MOST]


def _gain(advice: Advice) -> float:
    return advice.limit_then / max(advice.limit_now, 1.0)


def _limit(loop: DeviceLoop, law: WallLaw, damper: bool) -> float:
    if damper:
        return loop.linear.largest_damping_n_s_per_m()
    return loop.linear.largest_stiffness_n_per_m(law.damping_n_s_per_m)


def _changes(loop: DeviceLoop) -> Iterator[_Change]:
    tick_s, rate_hz = 1.0 / loop.rate_hz, loop.rate_hz
    faster = replace(loop, rate_hz=2 * rate_hz, delay_s=loop.delay_s - tick_s / 2)
    yield _Change("rate_hz", rate_hz, 2 * rate_hz, "Hz", "Run the loop twice as fast.", faster)
    if loop.delay_s > 1.05 * tick_s:
        prompt = replace(loop, delay_s=tick_s)
        yield _Change("delay_s", loop.delay_s, tick_s, "s", "Shorten the exchange with the board.", prompt)
    fast = 2 * loop.lambda_rad_per_s
    yield _Change(
        "estimator.lambda_rad_per_s",
        loop.lambda_rad_per_s,
        fast,
        "rad/s",
        "Filter velocity less; finer encoders keep it as quiet.",
        replace(loop, lambda_rad_per_s=fast),
    )
    lag_s = loop.coupling.lag_s
    if not loop.coupling.is_spring_drive and lag_s > 0.0:
        quick = replace(loop, coupling=replace(loop.coupling, lag_s=lag_s / 2))
        yield _Change("drive.lag_s", lag_s, lag_s / 2, "s", "Use a faster current loop.", quick)
    friction = loop.tip.viscous_n_s_per_m
    damped = replace(loop, tip=replace(loop.tip, viscous_n_s_per_m=2 * friction))
    yield _Change("friction", friction, 2 * friction, "N·s/m", "Add viscous friction to the device.", damped)


def _damping(loop: DeviceLoop, law: WallLaw, now: float) -> Advice:
    """The damping of the wall that bears the stiffest spring."""
    largest = loop.linear.largest_damping_n_s_per_m()
    tried = [largest * step / DAMPING_STEPS for step in range(DAMPING_STEPS)]
    limits = [loop.linear.largest_stiffness_n_per_m(damping) for damping in tried]
    best = max(range(DAMPING_STEPS), key=limits.__getitem__)
    return Advice(
        parameter="damping_n_s_per_m",
        present=law.damping_n_s_per_m,
        proposed=tried[best],
        unit="N·s/m",
        limit="linear",
        limit_now=now,
        limit_then=limits[best],
        words="Give the wall this damping.",
    )


def _tuning(loop: DeviceLoop) -> Iterator[Advice]:
    """K_P and R̂ of a spring drive: k_c up to K_HF, and dR from which lag and damping in series follow."""
    if not loop.coupling.is_spring_drive:
        return
    k_c, k_hf = loop.coupling.stiffness_n_per_m, loop.coupling.series_n_per_m
    yield Advice(
        parameter="drive.k_p_v_per_rad",
        present=k_c / k_hf,
        proposed=1.0,
        unit="of k_T dR/L",
        limit="tuning",
        limit_now=k_c,
        limit_then=k_hf,
        words="Raise K_P: the drive is passive up to K_DC = K_HF; mind the limits of sampling.",
    )
    closer = replace(loop, coupling=replace(loop.coupling, lag_s=2 * loop.coupling.lag_s))
    yield Advice(
        parameter="drive.r_hat_ohm",
        present=1.0 / loop.coupling.lag_s,
        proposed=0.5 / loop.coupling.lag_s,
        unit="rad/s of dR/L",
        limit="linear",
        limit_now=loop.linear.largest_stiffness_n_per_m(0.0),
        limit_then=closer.linear.largest_stiffness_n_per_m(0.0),
        words="Cancel more of the resistance (raise R̂/R), lower K_P alike; a cold winding must stay above R̂.",
    )


def _resolution(loop: DeviceLoop) -> Iterator[Advice]:
    """Encoders twice as fine, where their steps are what limits passivity."""
    tip = loop.tip
    now = abbott_okamura_n_per_m(tip.coulomb_n, tip.quantum_m)
    if now < loop.coupling.stiffness_n_per_m:
        yield Advice(
            parameter="joints.counts_per_rad",
            present=tip.quantum_m,
            proposed=tip.quantum_m / 2,
            unit="m at the tip",
            limit="resolution",
            limit_now=now,
            limit_then=2 * now,
            words="Use encoders of twice the resolution.",
        )
