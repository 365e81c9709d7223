//! Faults: what keeps a device from rendering, why, and what to do about it.

/// How a fault acts on the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Severity {
    /// Outputs go to zero in this tick.
    StopNow,
    /// Outputs fade to zero.
    SoftStop,
    /// Enabling is refused; what runs goes on.
    BlocksEnabling,
}

/// One latched reason for not rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Fault {
    /// No new observation for too many ticks.
    ObservationMissing,
    /// An observation held a NaN or an infinity.
    ObservationNotFinite,
    /// An encoder moved further in one tick than the device can.
    EncoderJump,
    /// The tip is faster than the device can be.
    SpeedImplausible,
    /// A joint is past its limit.
    OutsideWorkspace,
    /// The force sensor is at the end of its range.
    SensorSaturated,
    /// The force sensor's value is too old.
    SensorStale,
    /// The device clock or frame counter went backwards.
    SequenceBroken,
    /// The driver lost the device.
    DeviceLost,
    /// An amplifier reports a fault.
    Amplifier,
    /// The board's watchdog expired.
    BoardWatchdog,
    /// An encoder reports an error.
    Encoder,
    /// Too many ticks in a row were late.
    DeadlineMissed,
    /// The front's heartbeat stopped.
    FrontLost,
    /// The control core made a value that is not finite.
    OutputNotFinite,
    /// A motor's winding is too hot.
    MotorHot,
    /// Outputs were commanded, the board did not drive them.
    OutputsNotLive,
}

/// What is known about a fault.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaultInfo {
    /// The fault.
    pub fault: Fault,
    /// Name in the API.
    pub slug: &'static str,
    /// How it acts.
    pub severity: Severity,
    /// Why it happens.
    pub cause: &'static str,
    /// What cures it.
    pub cure: &'static str,
}

macro_rules! faults {
    ($( $fault:ident, $slug:literal, $severity:ident, $cause:literal, $cure:literal; )*) => {
        /// Every fault, in bit order.
        pub const FAULTS: &[FaultInfo] = &[ $( FaultInfo {
            fault: Fault::$fault, slug: $slug, severity: Severity::$severity, cause: $cause, cure: $cure,
        }, )* ];
    };
}

faults! {
    ObservationMissing, "observation-missing", StopNow, "The device sent no valid frame for several ticks in a row.", "Check cable, power and the driver's frame counters, then acknowledge.";
    ObservationNotFinite, "observation-not-finite", StopNow, "A sensor value was NaN or infinite.", "Check the force sensor and the driver's scaling, then acknowledge.";
    EncoderJump, "encoder-jump", StopNow, "An encoder moved further in one tick than the device can.", "Check encoder cable and counts per radian, home the device, then acknowledge.";
    SpeedImplausible, "speed-implausible", StopNow, "The tip was faster than the configured largest speed.", "Let the device rest; raise limits.tip_speed_m_per_s if the motion was real, then acknowledge.";
    OutsideWorkspace, "outside-workspace", StopNow, "A joint was past its limit by more than the margin.", "Move the device back by hand or check the joint zero, then acknowledge.";
    SensorSaturated, "sensor-saturated", SoftStop, "The force sensor was at the end of its range.", "Unload the tip and check the sensor's bias, then acknowledge.";
    SensorStale, "sensor-stale", SoftStop, "The force sensor stopped sending.", "Check the sensor's cable and rate, then acknowledge.";
    SequenceBroken, "sequence-broken", StopNow, "The device's clock or frame counter went backwards.", "The board restarted: check its supply, then acknowledge.";
    DeviceLost, "device-lost", StopNow, "The driver lost the device.", "Check power and cable; the driver reconnects by itself, then acknowledge.";
    Amplifier, "amplifier", StopNow, "An amplifier reported a fault.", "Check supply, current limit and temperature of the amplifier, then acknowledge.";
    BoardWatchdog, "board-watchdog", StopNow, "The I/O board heard no command in time and made its outputs safe.", "Check the link's rate and the tick statistics, then acknowledge.";
    Encoder, "encoder", StopNow, "An encoder reported an error.", "Check the encoder's cable and supply, then acknowledge.";
    DeadlineMissed, "deadline-missed", SoftStop, "The loop missed its deadline several times in a row.", "See /api/v1/system/realtime: give the servo real-time rights or lower the rate, then acknowledge.";
    FrontLost, "front-lost", SoftStop, "The front process stopped sending its heartbeat while outputs were live.", "Check the front's log; it is restarted by itself, then acknowledge.";
    OutputNotFinite, "output-not-finite", StopNow, "The control core made a value that is not finite.", "Keep the black box and report it, then acknowledge.";
    MotorHot, "motor-hot", SoftStop, "A winding passed its temperature limit.", "Let the motor cool, then acknowledge.";
    OutputsNotLive, "outputs-not-live", StopNow, "Outputs were commanded but the board did not drive them.", "Check the board's enable sequence and latched faults, then acknowledge.";
}

/// A set of faults, one bit each in the order of [`FAULTS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FaultSet(u64);

impl FaultSet {
    /// The set with the given bits.
    #[must_use]
    pub const fn from_bits(bits: u64) -> Self {
        Self(bits)
    }
    /// The set of one fault.
    #[must_use]
    pub const fn of(fault: Fault) -> Self {
        Self(1 << fault as u8)
    }
    /// The bits of the set.
    #[must_use]
    pub const fn bits(self) -> u64 {
        self.0
    }
    /// Adds a fault.
    pub fn insert(&mut self, fault: Fault) {
        self.0 |= 1 << fault as u8;
    }
    /// Whether a fault is in the set.
    #[must_use]
    pub const fn contains(self, fault: Fault) -> bool {
        self.0 & (1 << fault as u8) != 0
    }
    /// Whether the set is empty.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }
    /// The gravest severity in the set.
    #[must_use]
    pub fn severity(self) -> Option<Severity> {
        let among = |severity| {
            FAULTS
                .iter()
                .any(|info| info.severity == severity && self.contains(info.fault))
        };
        [
            Severity::StopNow,
            Severity::SoftStop,
            Severity::BlocksEnabling,
        ]
        .into_iter()
        .find(|severity| among(*severity))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_in_bit_order() {
        for (bit, info) in FAULTS.iter().enumerate() {
            assert_eq!(info.fault as usize, bit);
        }
    }
}
