//! What only the twin knows.

use hapticd_control::io::Axes;

/// The plant's true state at the last encoder latch. Three wide, unused axes zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Truth {
    /// Where the operator's hand is; the tip when the hand is off, m.
    pub hand_position_m: Axes,
    /// Force of the hand on the device, N.
    pub hand_force_n: Axes,
    /// Joint angles, rad.
    pub joint_position_rad: Axes,
    /// Joint velocities, rad/s.
    pub joint_velocity_rad_per_s: Axes,
    /// Tip position, m.
    pub tip_position_m: Axes,
    /// Tip velocity, m/s.
    pub tip_velocity_m_per_s: Axes,
    /// Motor currents; zero for torque drives, A.
    pub motor_current_a: Axes,
    /// Motor torques at the joints, N·m.
    pub motor_torque_nm: Axes,
    /// Torque the brakes and their drag give at the joints, N·m, signed.
    pub brake_torque_nm: Axes,
    /// Winding temperatures; zero for torque drives, °C.
    pub winding_c: Axes,
}
