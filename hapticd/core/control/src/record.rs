//! The tick record: everything one tick knew and did, and the schema that describes it.
//!
//! Every field is one or three 8-byte words, so that the record can be copied word by word
//! through shared memory and read as a numpy structured array.

use crate::io::{Axes, AXES};

/// How the words of a field are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// `f64`.
    Float,
    /// `u64`.
    Unsigned,
}

/// One field of [`TickRecord`], for readers in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Name, unit included.
    pub name: &'static str,
    /// Word type.
    pub kind: Kind,
    /// Words: 1 or 3.
    pub words: usize,
    /// SI unit, empty where dimensionless.
    pub unit: &'static str,
    /// What it is.
    pub meaning: &'static str,
}

/// Rust types a record may hold.
trait Word {
    const KIND: Kind;
    const WORDS: usize;
    fn put(self, out: &mut [u64]);
}
impl Word for f64 {
    const KIND: Kind = Kind::Float;
    const WORDS: usize = 1;
    fn put(self, out: &mut [u64]) {
        out[0] = self.to_bits();
    }
}
impl Word for Axes {
    const KIND: Kind = Kind::Float;
    const WORDS: usize = 3;
    fn put(self, out: &mut [u64]) {
        for (word, value) in out.iter_mut().zip(self) {
            *word = value.to_bits();
        }
    }
}
impl Word for u64 {
    const KIND: Kind = Kind::Unsigned;
    const WORDS: usize = 1;
    fn put(self, out: &mut [u64]) {
        out[0] = self;
    }
}
impl Word for [u64; AXES] {
    const KIND: Kind = Kind::Unsigned;
    const WORDS: usize = 3;
    fn put(self, out: &mut [u64]) {
        out.copy_from_slice(&self);
    }
}

macro_rules! record {
    ($( $name:ident : $type:ty, $unit:literal, $meaning:literal; )*) => {
        /// Everything about one tick. Meanings and units: [`FIELDS`].
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        #[repr(C)]
        pub struct TickRecord { $( #[doc = $meaning] pub $name: $type, )* }

        /// The fields of [`TickRecord`] in memory order.
        pub const FIELDS: &[Field] = &[ $( Field {
            name: stringify!($name),
            kind: <$type as Word>::KIND,
            words: <$type as Word>::WORDS,
            unit: $unit,
            meaning: $meaning,
        }, )* ];

        impl TickRecord {
            /// The record word by word, in the order of [`FIELDS`].
            #[must_use]
            pub fn words(&self) -> [u64; RECORD_WORDS] {
                let mut words = [0; RECORD_WORDS];
                let mut at = 0;
                $(
                    let size = <$type as Word>::WORDS;
                    self.$name.put(&mut words[at..at + size]);
                    at += size;
                )*
                debug_assert_eq!(at, RECORD_WORDS);
                words
            }
        }
    };
}

record! {
    tick: u64, "", "Tick number since the servo started";
    t_mono_ns: u64, "ns", "CLOCK_MONOTONIC at the start of the tick";
    t_device_ns: u64, "ns", "Device clock at the encoder latch";
    state: u64, "", "Device state: 0 offline, 1 disabled, 2 enabled, 3 paused, 4 fault";
    flags: u64, "", "Bits: 0 homed, 1 busy, 2 estop latched, 3 fading, 4 fresh observation, 5 in contact, 6 passivity control acts, 7 friction sticks";
    faults: u64, "", "Latched faults, one bit each (fault table)";
    scene_revision: u64, "", "Revision of the scene in force";
    request_id: u64, "", "Last request taken from the front";
    observation_seq: u64, "", "Source's frame counter";
    observation_status: u64, "", "Status bits of the observation";
    observation_missing: u64, "", "Ticks in a row without a new observation";
    observation_lost: u64, "", "Frames lost since start, by gaps of the frame counter";
    joint_position_rad: Axes, "rad", "Joint angles q";
    joint_velocity_rad_per_s: Axes, "rad/s", "Filtered joint velocities";
    tip_position_m: Axes, "m", "Tip position in the base frame";
    tip_velocity_m_per_s: Axes, "m/s", "Tip velocity in the base frame";
    singularity_margin: f64, "", "sin of the angle to the nearest singularity";
    setpoint_position_m: Axes, "m", "x_Sd, where the scene wants the tip (WN eq. 30)";
    setpoint_velocity_m_per_s: Axes, "m/s", "Velocity of the set-point";
    contact_count: u64, "", "Walls in contact";
    contact_wall: u64, "", "Index of the deepest wall in contact; all ones when free";
    contact_depth_m: f64, "m", "Depth in the deepest wall";
    contact_normal: Axes, "", "Normal of the deepest wall, zero when free";
    proxy_position_m: Axes, "m", "Where the tip would be if every wall of the newest scene were rigid";
    touched_walls: [u64; AXES], "", "Indices of the walls touched, deepest first; all ones where there are fewer";
    touched_force_n: Axes, "N", "Normal force each of them asks for";
    touched_energy_j: Axes, "J", "Energy each of them took from the hand, less what it gave back";
    device_energy_j: f64, "J", "Energy the device's outputs took from the hand, less what they gave back";
    passivity_wall: u64, "", "Index of the wall that passivity control acts for; all ones when it does not";
    passivity_damping_n_s_per_m: f64, "N·s/m", "Damping that passivity control adds";
    friction_force_n: Axes, "N", "Friction force that is asked for";
    friction_state: u64, "", "Friction: 0 none, 1 sticks, 2 slips";
    stiffness_n_per_m: f64, "N/m", "k_c: tip stiffness of a rigid wall at this pose and temperature";
    tip_force_demand_n: Axes, "N", "Tip force the scene asks for, before the bounding layer";
    tip_force_command_n: Axes, "N", "Tip force of the motor commands that went out";
    tip_force_n: Axes, "N", "Tip force the motors and brakes give, by the actuator model";
    sensor_force_n: Axes, "N", "Force of the hand on the device, measured; zero without a sensor";
    joint_torque_demand_nm: Axes, "N·m", "Joint torque asked for, before allocation";
    shared_torque_nm: Axes, "N·m", "Part of it that motors and brakes may share";
    hold_torque_nm: Axes, "N·m", "Joint torque that brakes alone may add, before allocation";
    motor_torque_nm: Axes, "N·m", "Joint torque asked of the motors";
    motor_torque_estimate_nm: Axes, "N·m", "Joint torque the motors give, by the actuator model";
    motor_v: Axes, "V", "e_W of each spring drive";
    motor_current_a: Axes, "A", "Motor currents, by the actuator model";
    motor_temperature_c: Axes, "degC", "Winding temperatures, by the thermal model";
    motor_i2t: Axes, "", "Thermal budget used, 0 to 1";
    brake_torque_nm: Axes, "N·m", "Joint torque asked of the brakes";
    brake_torque_estimate_nm: Axes, "N·m", "Joint torque the brakes can give, by the brake model";
    brake_usable: u64, "", "Bit per joint: the brake may act in the direction wanted";
    gain: f64, "", "Ramp and fade factor, 0 to 1";
    limits: u64, "", "Bits of the limits that acted: 0 voltage, 1 motor torque, 2 tip force, 3 slew, 4 thermal, 5 brake, 6 singularity, 7 non-finite";
    hand_position_m: Axes, "m", "Twin only: where the operator's hand is";
    hand_force_n: Axes, "N", "Twin only: true force of the hand on the device";
    lateness_ns: u64, "ns", "How late the tick woke";
    exchange_ns: u64, "ns", "Time in the driver's exchange, previous tick";
    compute_ns: u64, "ns", "Time in the control core, previous tick";
    missed_ticks: u64, "", "Deadlines missed since start";
}

/// Bits of [`TickRecord::flags`].
pub mod flag {
    /// The joint zero is known.
    pub const HOMED: u64 = 1 << 0;
    /// A procedure owns the device.
    pub const BUSY: u64 = 1 << 1;
    /// The E-stop is latched.
    pub const ESTOP: u64 = 1 << 2;
    /// A ramp, fade or scene cross-fade is running.
    pub const FADING: u64 = 1 << 3;
    /// The observation of this tick is new.
    pub const FRESH: u64 = 1 << 4;
    /// At least one wall is touched.
    pub const CONTACT: u64 = 1 << 5;
    /// Passivity control acts.
    pub const PASSIVITY: u64 = 1 << 6;
    /// Friction sticks.
    pub const STICK: u64 = 1 << 7;
}

/// Bits of [`TickRecord::limits`].
pub mod limit {
    /// |e_W| at the supply's limit.
    pub const VOLTAGE: u64 = 1 << 0;
    /// Motor torque or current at its limit.
    pub const MOTOR_TORQUE: u64 = 1 << 1;
    /// Tip force at its limit.
    pub const TIP_FORCE: u64 = 1 << 2;
    /// Slew rate at its limit.
    pub const SLEW: u64 = 1 << 3;
    /// Thermal budget folds the motor limit back.
    pub const THERMAL: u64 = 1 << 4;
    /// Brake torque or slew at its limit.
    pub const BRAKE: u64 = 1 << 5;
    /// Near a singularity.
    pub const SINGULARITY: u64 = 1 << 6;
    /// A non-finite value was stopped.
    pub const NON_FINITE: u64 = 1 << 7;
}

/// Index of a wall where there is none.
pub const NO_WALL: u64 = u64::MAX;

/// 8-byte words in a record.
pub const RECORD_WORDS: usize = core::mem::size_of::<TickRecord>() / 8;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn schema_covers_every_word_of_the_record() {
        let words: usize = FIELDS.iter().map(|field| field.words).sum();
        assert_eq!(words, RECORD_WORDS);
    }

    #[test]
    fn words_keep_the_order_of_the_schema() {
        let record = TickRecord {
            tick: 7,
            tip_position_m: [1.0, 2.0, 3.0],
            missed_ticks: 9,
            ..TickRecord::default()
        };
        let words = record.words();
        let at = |name: &str| -> usize {
            let before = FIELDS.iter().take_while(|field| field.name != name);
            before.map(|field| field.words).sum()
        };
        let tip = at("tip_position_m");
        assert_eq!(words[0], 7);
        assert_eq!(words[tip..tip + 3], [1.0, 2.0, 3.0].map(f64::to_bits));
        assert_eq!(words[RECORD_WORDS - 1], 9);
    }
}
