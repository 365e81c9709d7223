"""What a device with a locked tip shows of the stiffness over frequency."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hapticd.analysis.rendered_stiffness import SpringDrives
from hapticd.experiments.bode_on_device import BodeOnDevice
from hapticd.experiments.claims import judged
from hapticd.experiments.experiment import Claim

STATIC_SHARE = 0.15
"""Residual dR = R/20: half a percent of the winding's resistance, as of its brushes, is a tenth of k_c."""

WITHIN_DB = 1.0
WITHIN_DEG = 10.0

COUPLING = "k + jωb of the device file, through the motors' lag"


def claims_on_device(found: BodeOnDevice) -> tuple[Claim, ...]:
    """Static end, magnitude and phase by the motors; what the servo's ticks change; the sensor's view."""
    spring = isinstance(found.form, SpringDrives)
    claims = (
        _static(found, "WN eq. 13, 29" if spring else COUPLING),
        _magnitude(found, "WN eq. 10–12" if spring else COUPLING),
        _phase(found, "WN eq. 10–12" if spring else COUPLING),
        *((_continuous(found),) if spring else ()),
        *((_sensed(found),) if "sensor" in found.series else ()),
    )
    if found.doubt is None:
        return claims
    return tuple(replace(claim, verdict="undecidable", reason=found.doubt) for claim in claims)


def _static(found: BodeOnDevice, source: str) -> Claim:
    motors = found.motors
    share = motors.static_n_per_m / found.k_c - 1
    return judged(
        "The static end is k_c, the stiffness of a rigid wall at this pose",
        source,
        f"{found.k_c:.0f} N/m within {100 * STATIC_SHARE:.0f} %",
        f"{motors.static_n_per_m:.0f} N/m at {motors.frequency_hz[0]:.2g} Hz, {100 * share:+.1f} %, "
        f"by {motors.force_from}",
        holds=abs(share) < STATIC_SHARE,
    )


def _magnitude(found: BodeOnDevice, source: str) -> Claim:
    motors = found.motors
    return judged(
        "The magnitude follows the closed form with the tick's hold",
        source,
        f"within {WITHIN_DB:g} dB up to {motors.frequency_hz[-1]:.0f} Hz at {found.rate_hz:g} Hz",
        f"{motors.off_db:.2f} dB off at worst, {motors.shape_off_db:.2f} dB from the static end on, "
        f"by {motors.force_from}",
        holds=motors.off_db < WITHIN_DB,
    )


def _phase(found: BodeOnDevice, source: str) -> Claim:
    motors = found.motors
    return judged(
        "The phase follows the closed form with the tick's hold and delay",
        source,
        f"within {WITHIN_DEG:g}° up to {motors.frequency_hz[-1]:.0f} Hz",
        f"{motors.phase_off_deg:.1f}° off at worst, as of {1e3 * motors.later_s:+.2f} ms more delay, "
        f"by {motors.force_from}",
        holds=motors.phase_off_deg < WITHIN_DEG,
    )


def _continuous(found: BodeOnDevice) -> Claim:
    motors = found.motors
    ratio = np.abs(motors.stiffness / found.form.continuous(motors.frequency_hz))
    off_db = float(np.max(np.abs(20 * np.log10(ratio))))
    return judged(
        "(12) is the stiffness that is rendered",
        "WN eq. 12",
        f"within {WITHIN_DB:g} dB up to half the rate",
        f"{off_db:.1f} dB off at worst at {found.rate_hz:g} Hz, by {motors.force_from}",
        holds=off_db < WITHIN_DB,
    )


def _sensed(found: BodeOnDevice) -> Claim:
    sensor = found.series["sensor"]
    share = sensor.static_n_per_m / found.k_c - 1
    return judged(
        "The force sensor at the locked tip sees the static end too",
        COUPLING,
        f"{found.k_c:.0f} N/m within {100 * STATIC_SHARE:.0f} %",
        f"{sensor.static_n_per_m:.0f} N/m, {100 * share:+.1f} %: what friction holds does not reach it",
        holds=abs(share) < STATIC_SHARE,
    )
