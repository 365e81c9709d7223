//! What a driver hands in and takes away each tick.

/// Axes every fixed-size array carries. A two-joint device leaves the third at zero.
pub const AXES: usize = 3;

/// One value per joint, or per base-frame coordinate. SI.
pub type Axes = [f64; AXES];

/// Bits of [`Observation::status`].
pub mod status {
    /// `force_n` holds a measured force of the hand on the device.
    pub const FORCE_PRESENT: u64 = 1 << 0;
    /// `motor_current_a` holds measured currents.
    pub const CURRENT_PRESENT: u64 = 1 << 1;
    /// The board drives its outputs.
    pub const OUTPUTS_LIVE: u64 = 1 << 2;
    /// The E-stop input is open.
    pub const ESTOP_INPUT: u64 = 1 << 3;
    /// An amplifier reports a fault.
    pub const AMPLIFIER_FAULT: u64 = 1 << 4;
    /// The board's own watchdog has expired.
    pub const BOARD_WATCHDOG: u64 = 1 << 5;
    /// An encoder reports an error.
    pub const ENCODER_ERROR: u64 = 1 << 6;
    /// The force sensor is at the end of its range.
    pub const SENSOR_SATURATED: u64 = 1 << 7;
    /// Counts are absolute: the zero needs no homing.
    pub const HOMED: u64 = 1 << 8;
}

/// One reading of the device, as raw as the board gives it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Observation {
    /// Source's frame counter, unwrapped; +1 per frame the source made.
    pub seq: u64,
    /// Source's clock at the encoder latch, ns.
    pub t_device_ns: u64,
    /// Encoder counts, accumulated.
    pub counts: [i64; AXES],
    /// Force of the hand on the device in the base frame, N. Valid with `FORCE_PRESENT`.
    pub force_n: Axes,
    /// Age of `force_n` at the latch, s.
    pub force_age_s: f64,
    /// Motor currents, A. Valid with `CURRENT_PRESENT`.
    pub motor_current_a: Axes,
    /// Bits of [`status`].
    pub status: u64,
}

/// What the actuators are asked for until the next tick. Unused channels are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Command {
    /// Amplifiers enabled. When false every other field is zero.
    pub enable: bool,
    /// e_W of each spring drive, V (WN eq. 6).
    pub motor_v: Axes,
    /// Torque of each torque-drive motor, at the joint, N·m.
    pub motor_torque_nm: Axes,
    /// Torque asked of each brake, at the joint, N·m, never negative.
    pub brake_torque_nm: Axes,
}

/// Outcome of one exchange with the hardware.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Exchange {
    /// A new observation was written.
    Fresh,
    /// Nothing new arrived in this tick; the observation is the last one.
    #[default]
    Missing,
    /// The device is gone; the driver reconnects on its own schedule.
    Down,
}
