"""The devices as Prometheus metrics, read when they are asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import get_args

from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, HistogramMetricFamily, Metric
from prometheus_client.registry import Collector

from hapticd.device import Device
from hapticd.realtime import Histogram, RealtimeReport
from hapticd.snapshot import DeviceSnapshot, DeviceState
from hapticd.station import Station

NS_PER_S = 1e9

_GAUGES: tuple[tuple[str, str, Callable[[DeviceSnapshot], float]], ...] = (
    ("hapticd_device_online", "Whether the servo answers", lambda device: device.health.online),
    ("hapticd_device_estop", "Whether the emergency stop is latched", lambda device: device.flags.estop),
    ("hapticd_device_contact", "Whether a wall is touched", lambda device: device.flags.contact),
    ("hapticd_device_faults", "Latched faults", lambda device: len(device.faults)),
    ("hapticd_scene_walls", "Walls in the scene", lambda device: device.walls),
    ("hapticd_scene_revision", "Revision of the scene", lambda device: device.scene_revision),
)


class DeviceMetrics(Collector):
    """Slow values alone: what changes every tick belongs to the stream and to recordings."""

    def __init__(self, station: Station) -> None:
        self._station = station

    def collect(self) -> Iterable[Metric]:
        """Every metric of every device, as it is now."""
        devices = list(self._station.devices.values())
        snapshots = [device.snapshot() for device in devices]
        yield from (_gauge(name, text, value, snapshots) for name, text, value in _GAUGES)
        yield _states(snapshots)
        yield from _timing([report for report in map(Device.realtime, devices) if report is not None])


def _gauge(
    name: str, text: str, value: Callable[[DeviceSnapshot], float], snapshots: Iterable[DeviceSnapshot]
) -> Metric:
    family = GaugeMetricFamily(name, text, labels=("device",))
    for snapshot in snapshots:
        family.add_metric((snapshot.id,), float(value(snapshot)))
    return family


def _states(snapshots: Iterable[DeviceSnapshot]) -> Metric:
    labels = ("device", "state")
    family = GaugeMetricFamily("hapticd_device_state", "1 for the state a device is in", labels=labels)
    for snapshot in snapshots:
        for state in get_args(DeviceState):
            family.add_metric((snapshot.id, state), float(snapshot.state == state))
    return family


def _timing(reports: Iterable[RealtimeReport]) -> Iterator[Metric]:
    ticks = CounterMetricFamily("hapticd_ticks", "Ticks of the loop", labels=("device",))
    missed = CounterMetricFamily("hapticd_ticks_missed", "Deadlines missed", labels=("device",))
    realtime = GaugeMetricFamily("hapticd_realtime", "Whether scheduling is real-time", labels=("device",))
    phases = HistogramMetricFamily(
        "hapticd_tick_phase_seconds",
        "Lateness of the wake-up, time in the driver's exchange, time in the control core",
        labels=("device", "phase"),
    )
    for report in reports:
        device = (report.device_id,)
        ticks.add_metric(device, report.tick)
        missed.add_metric(device, report.missed_ticks)
        realtime.add_metric(device, float(report.scheduling.realtime_ok))
        for phase in ("lateness", "exchange", "compute"):
            histogram: Histogram = getattr(report, phase)
            phases.add_metric((*device, phase), _buckets(histogram), histogram.sum_ns / NS_PER_S)
    yield from (ticks, missed, realtime, phases)


def _buckets(histogram: Histogram) -> list[tuple[str, float]]:
    """Prometheus buckets: cumulative, named by their upper edge in seconds, each at least twice the last."""
    total, last_ns = 0, 0.0
    buckets = []
    for upper_ns, count in zip(histogram.edges_ns[1:], histogram.counts, strict=False):
        total += count
        if upper_ns >= 2 * last_ns:
            buckets.append((repr(upper_ns / NS_PER_S), float(total)))
            last_ns = upper_ns
    return [*buckets, ("+Inf", float(histogram.count))]
