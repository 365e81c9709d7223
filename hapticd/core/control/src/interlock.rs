//! Interlocks: what keeps a device from being enabled, why, and what to do about it. A set of
//! them is a `u64` with one bit each, in the order of [`INTERLOCKS`].

/// No connection to the device.
pub const OFFLINE: u64 = 1 << 0;
/// The E-stop is latched.
pub const ESTOP_LATCHED: u64 = 1 << 1;
/// The E-stop input of the device is open.
pub const ESTOP_INPUT: u64 = 1 << 2;
/// A fault is latched.
pub const FAULT_LATCHED: u64 = 1 << 3;
/// The joint zero is unknown.
pub const NOT_HOMED: u64 = 1 << 4;
/// Real-time scheduling is required and was not obtained.
pub const REALTIME_MISSING: u64 = 1 << 5;
/// A procedure owns the device.
pub const BUSY: u64 = 1 << 6;
/// The front's heartbeat is missing.
pub const FRONT_MISSING: u64 = 1 << 7;
/// Only an enabled device can be paused. Refuses a pause, never an enabling.
pub const NOT_ENABLED: u64 = 1 << 8;

/// What is known about an interlock.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InterlockInfo {
    /// Its bit.
    pub bit: u64,
    /// Name in the API.
    pub slug: &'static str,
    /// What is wrong while it is open.
    pub why: &'static str,
    /// What closes it.
    pub cure: &'static str,
}

macro_rules! interlocks {
    ($( $bit:ident, $slug:literal, $why:literal, $cure:literal; )*) => {
        /// Every interlock, in bit order.
        pub const INTERLOCKS: &[InterlockInfo] = &[ $( InterlockInfo {
            bit: $bit, slug: $slug, why: $why, cure: $cure,
        }, )* ];
    };
}

interlocks! {
    OFFLINE, "offline", "There is no connection to the device.", "Check power and cable; the driver reconnects by itself.";
    ESTOP_LATCHED, "estop-latched", "The E-stop is latched.", "Make the device safe, then acknowledge the E-stop.";
    ESTOP_INPUT, "estop-input", "The E-stop input of the device is open.", "Release the E-stop button, then acknowledge the E-stop.";
    FAULT_LATCHED, "fault-latched", "A fault is latched.", "Cure the fault as its entry says, then acknowledge it.";
    NOT_HOMED, "not-homed", "The joint zero is unknown.", "Home the device.";
    REALTIME_MISSING, "realtime-missing", "Real-time scheduling is required for this device and was not obtained.", "Give the servo real-time rights (hapticd doctor says how) or set realtime = \"preferred\".";
    BUSY, "busy", "A procedure owns the device.", "Wait for the procedure to end, or cancel it.";
    FRONT_MISSING, "front-missing", "The front process sends no heartbeat.", "Start the front process; it attaches to the servo by itself.";
    NOT_ENABLED, "not-enabled", "Only an enabled device can be paused.", "Enable the device first.";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table_is_in_bit_order() {
        for (bit, info) in INTERLOCKS.iter().enumerate() {
            assert_eq!(info.bit, 1 << bit, "{}", info.slug);
        }
    }
}
