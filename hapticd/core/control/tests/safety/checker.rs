//! The laws, restated from the record, the command and the model alone: nothing here calls the
//! bounding layer.

use crate::rig::{is_zero, Rig, RATE_HZ};
use hapticd_control::fault::{FaultSet, Severity};
use hapticd_control::io::Command;
use hapticd_control::linear::{M3, V3};
use hapticd_control::model::{DeviceModel, DriveModel, SpringDriveModel};
use hapticd_control::record::{flag, limit, TickRecord};

const PERIOD_S: f64 = 1.0 / RATE_HZ;
const ENABLED: u64 = 2;
const OFFLINE: u64 = 0;
const ROUNDING: f64 = 1.0 + 1e-9;

/// Memory of the checker from tick to tick.
#[derive(Default)]
pub struct Checker {
    idle_ticks: usize,
    before: Option<(Command, TickRecord)>,
}

impl Checker {
    pub fn check(&mut self, rig: &Rig) {
        let tick = Tick::new(rig);
        tick.law_1_finite_and_within_limits();
        self.law_2_zero_unless_enabled(&tick);
        tick.law_3_slew();
        self.law_3_ramp_and_brakes(&tick);
        tick.law_6_no_joint_stiffer_than_tuned();
        tick.law_7_brakes_only_dissipate();
        tick.stops_are_immediate();
        self.before = Some((rig.command, rig.record));
    }

    fn law_2_zero_unless_enabled(&mut self, tick: &Tick<'_>) {
        let enabled = tick.record.state == ENABLED;
        self.idle_ticks = if enabled { 0 } else { self.idle_ticks + 1 };
        let bound = (2.0 * tick.model.limits.fade_s * RATE_HZ).ceil() as usize + 2;
        if self.idle_ticks > bound {
            assert_eq!(
                tick.motor_nm.map(|nm| nm * tick.live()),
                V3::zeros(),
                "law 2: motors"
            );
            assert!(
                is_zero(tick.command) || tick.holds_brakes(),
                "law 2: still enabled"
            );
        }
    }

    fn law_3_ramp_and_brakes(&self, tick: &Tick<'_>) {
        let Some((command, record)) = &self.before else {
            return;
        };
        let ramp = PERIOD_S / tick.model.limits.ramp_s;
        assert!(
            tick.record.gain <= record.gain + ramp * ROUNDING,
            "law 3: ramp"
        );
        let rise_nm = tick.model.limits.brake_slew_nm_per_s * PERIOD_S;
        for i in 0..3 {
            let rose_nm = tick.command.brake_torque_nm[i] - command.brake_torque_nm[i];
            assert!(
                rose_nm <= rise_nm * ROUNDING,
                "law 3: brake rose by {rose_nm}"
            );
        }
    }
}

/// One tick, with what follows from it by the model.
struct Tick<'a> {
    model: &'a DeviceModel,
    record: &'a TickRecord,
    command: &'a Command,
    jacobian: M3,
    jacobian_inverse: M3,
    /// Static torque of the command, N·m.
    motor_nm: V3,
    /// Share of the present torque left after a period.
    retain: V3,
}

impl<'a> Tick<'a> {
    fn new(rig: &'a Rig) -> Self {
        let (record, command) = (&rig.record, &rig.command);
        let q = V3::from(record.joint_position_rad);
        let (motor_nm, retain) = match &rig.model.drive {
            DriveModel::Spring(drive) => spring(drive, record, command),
            DriveModel::Torque(drive) => (
                command.motor_torque_nm.into(),
                V3::repeat((-PERIOD_S / drive.lag_s).exp()),
            ),
        };
        Self {
            model: &rig.model,
            record,
            command,
            jacobian: rig.model.kinematics.jacobian(&q),
            jacobian_inverse: rig
                .model
                .kinematics
                .jacobian_inverse(&q)
                .unwrap_or_default(),
            motor_nm,
            retain,
        }
    }

    /// 1 while the amplifiers are on. A spring drive's zero volts brake; off, they do nothing.
    fn live(&self) -> f64 {
        f64::from(u8::from(self.command.enable))
    }

    fn holds_brakes(&self) -> bool {
        self.model
            .brakes
            .is_some_and(|brakes| !brakes.release_on_stop)
    }

    fn tip_force_n(&self, torque_nm: &V3) -> f64 {
        self.jacobian_inverse.tr_mul(torque_nm).norm()
    }

    fn law_1_finite_and_within_limits(&self) {
        let command = self.command;
        let outputs = [
            command.motor_v,
            command.motor_torque_nm,
            command.brake_torque_nm,
        ];
        assert!(
            outputs.iter().flatten().all(|value| value.is_finite()),
            "law 1: finite"
        );
        if !command.enable {
            return;
        }
        let force_n = self.tip_force_n(&self.motor_nm);
        let max_n = self.model.limits.tip_force_n;
        assert!(
            force_n <= max_n * (1.0 + 1e-6),
            "law 1: tip force {force_n} of {max_n}"
        );
        for i in 0..3 {
            let peak_nm = self.peak_nm(i) * (1.0 + 1e-6) + 1e-9;
            assert!(
                self.motor_nm[i].abs() <= peak_nm,
                "law 1: torque {}",
                self.motor_nm[i]
            );
            let brake_max_nm = self
                .model
                .brakes
                .map_or(0.0, |brakes| brakes.torque_max_nm[i]);
            let brake_nm = command.brake_torque_nm[i];
            assert!(
                (0.0..=brake_max_nm).contains(&brake_nm),
                "law 1: brake {brake_nm}"
            );
            let max_v = match &self.model.drive {
                DriveModel::Spring(drive) => drive.voltage_max_v[i],
                DriveModel::Torque(_) => 0.0,
            };
            assert!(command.motor_v[i].abs() <= max_v, "law 1: volts");
        }
    }

    /// Peak torque, folded to continuous from 80 % to 100 % of the I²t budget.
    fn peak_nm(&self, i: usize) -> f64 {
        let fold = ((self.record.motor_i2t[i] - 0.8) / 0.2).clamp(0.0, 1.0);
        let folded = |peak: f64, continuous: f64| peak + fold * (continuous - peak);
        match &self.model.drive {
            DriveModel::Spring(drive) => {
                let max_a = folded(drive.current_max_a[i], drive.current_continuous_a[i]);
                max_a * drive.k_t_nm_per_a[i] * drive.ratio[i]
            }
            DriveModel::Torque(drive) => {
                folded(drive.torque_max_nm[i], drive.torque_continuous_nm[i])
            }
        }
    }

    /// A step beyond the slew limit is only taken where law 1 pulled the torque in.
    fn law_3_slew(&self) {
        if !self.command.enable {
            return;
        }
        let step_nm = self.motor_nm - V3::from(self.record.motor_torque_estimate_nm);
        let predicted_nm = step_nm - self.retain.component_mul(&step_nm);
        let step_n = self.tip_force_n(&predicted_nm);
        let slew_n = self.model.limits.tip_slew_n_per_s * PERIOD_S;
        let pulled_in = limit::VOLTAGE | limit::MOTOR_TORQUE | limit::TIP_FORCE;
        let excused = self.record.limits & pulled_in != 0;
        assert!(
            excused || step_n <= slew_n + 1e-6,
            "law 3: {step_n} of {slew_n}"
        );
    }

    /// K_q − k_c JᵀJ has no negative direction, K_q being what the drive was tuned to.
    fn law_6_no_joint_stiffer_than_tuned(&self) {
        let DriveModel::Spring(drive) = &self.model.drive else {
            return;
        };
        let softness = V3::from_fn(|i, _| tuned_stiffness(drive, i).sqrt().recip());
        let scaled = M3::from_fn(|i, j| {
            let entry = self.jacobian.column(i).dot(&self.jacobian.column(j));
            entry * self.record.stiffness_n_per_m * softness[i] * softness[j]
        });
        let stiffest = scaled.symmetric_eigenvalues().max();
        assert!(
            stiffest <= 1.0 + 1e-6,
            "law 6: {stiffest} times as stiff as tuned"
        );
    }

    fn law_7_brakes_only_dissipate(&self) {
        let Some(brakes) = self.model.brakes else {
            return;
        };
        let holding = self.holds_brakes() && self.record.state != ENABLED;
        for i in 0..3 {
            let qd = self.record.joint_velocity_rad_per_s[i];
            let parts_nm = [self.record.shared_torque_nm, self.record.hold_torque_nm];
            let along = parts_nm.iter().all(|part_nm| part_nm[i] * qd >= 0.0);
            let moving = qd.abs() > brakes.omega_off_rad_per_s;
            let braked = self.command.brake_torque_nm[i] > 0.0;
            assert!(
                !(braked && moving && along) || holding,
                "law 7: brake {i} along {qd}"
            );
        }
    }

    /// E-stop, grave faults and a lost device leave nothing on, in the same tick.
    fn stops_are_immediate(&self) {
        let faults = FaultSet::from_bits(self.record.faults);
        let stopped = self.record.flags & flag::ESTOP != 0
            || faults.severity() == Some(Severity::StopNow)
            || self.record.state == OFFLINE;
        assert!(!stopped || is_zero(self.command), "a stop left outputs on");
    }
}

fn residual_ohm(drive: &SpringDriveModel, i: usize, winding_c: f64) -> f64 {
    let r = drive.r_25_ohm[i] * (1.0 + 0.00393 * (winding_c - 25.0));
    (r - drive.r_hat_ohm[i]).max(0.01 * drive.r_25_ohm[i])
}

fn tuned_stiffness(drive: &SpringDriveModel, i: usize) -> f64 {
    let dr = drive.r_25_ohm[i] - drive.r_hat_ohm[i];
    drive.ratio[i].powi(2) * drive.k_t_nm_per_a[i] * drive.k_p_v_per_rad[i] / dr
}

/// τ = ρ k_T/dR (e_W − k_T ρ q̇) and a = e^(−T dR/L).
fn spring(drive: &SpringDriveModel, record: &TickRecord, command: &Command) -> (V3, V3) {
    let dr = V3::from_fn(|i, _| residual_ohm(drive, i, record.motor_temperature_c[i]));
    let torque_nm = V3::from_fn(|i, _| {
        let lever = drive.ratio[i] * drive.k_t_nm_per_a[i];
        let emf_v = lever * record.joint_velocity_rad_per_s[i];
        lever / dr[i] * (command.motor_v[i] - emf_v)
    });
    let retain = V3::from_fn(|i, _| (-PERIOD_S * dr[i] / drive.l_h[i]).exp());
    (torque_nm, retain)
}
