"""The analogue outputs of an emulated board: clamp, slew and safe values, which no host can exceed."""

from __future__ import annotations

from hapticd_drivers.hapticd_io.protocol import AO_CHANNELS, AO_FULL_SCALE, Config, Item, Result


class OutputStage:
    """Eight outputs, LSB."""

    def __init__(self, channels: int) -> None:
        self._channels = channels
        self._clamp = [(-AO_FULL_SCALE, AO_FULL_SCALE)] * AO_CHANNELS
        self._safe = [0] * AO_CHANNELS
        self._slew = [0] * AO_CHANNELS
        self.values = [0] * AO_CHANNELS
        self.clamped = False

    def configure(self, setting: Config) -> Result:
        """Takes a clamp, safe value or slew limit."""
        channel, low, high = setting.channel, setting.a, setting.b
        if channel >= self._channels:
            return Result.NO_SUCH_CHANNEL
        if not all(-AO_FULL_SCALE <= value <= AO_FULL_SCALE for value in (low, high)):
            return Result.OUT_OF_RANGE
        if setting.item == Item.AO_CLAMP and low <= high:
            self._clamp[channel] = (low, high)
        elif setting.item == Item.AO_SAFE:
            self._safe[channel] = low
        elif setting.item == Item.AO_SLEW and low >= 0:
            self._slew[channel] = low
        else:
            return Result.OUT_OF_RANGE
        return Result.OK

    def make_safe(self) -> None:
        """Safe values, at once."""
        self.values = list(self._safe)
        self.clamped = False

    def drive(self, wanted: tuple[int, ...], enable_mask: int) -> None:
        """One tick towards `wanted`; channels that are not enabled stay safe."""
        self.clamped = False
        for channel in range(self._channels):
            if enable_mask >> channel & 1:
                self.values[channel] = self._bounded(channel, wanted[channel])
            else:
                self.values[channel] = self._safe[channel]

    def _bounded(self, channel: int, wanted: int) -> int:
        low, high = self._clamp[channel]
        value = min(max(wanted, low), high)
        self.clamped = self.clamped or value != wanted
        if slew := self._slew[channel]:
            now = self.values[channel]
            value = min(max(value, now - slew), now + slew)
        return value
