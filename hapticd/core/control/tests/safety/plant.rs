//! A device small enough to count its energy: a point mass at the tip, exact motors, a hand.

use crate::rig::{Rig, RATE_HZ};
use hapticd_control::estimate::JointState;
use hapticd_control::io::{status, Command};
use hapticd_control::linear::{M3, V3};
use hapticd_control::model::{DeviceModel, DriveModel};
use std::collections::VecDeque;

const SUBSTEPS: usize = 20;
/// Time in which a path sets out, s.
const BEGIN_S: f64 = 0.1;
/// How fast a firm hand makes up for being off its path, 1/s.
const CLOSING_PER_S: f64 = 50.0;
const STEP_S: f64 = 1.0 / (RATE_HZ * SUBSTEPS as f64);

/// What holds the tip.
#[derive(Clone, Debug)]
pub enum Hand {
    /// A mass on a grip that is led along a path by an arm of limited stiffness.
    Compliant {
        mass_kg: f64,
        grip_n_per_m: f64,
        grip_n_s_per_m: f64,
        arm_n_per_m: f64,
        arm_n_s_per_m: f64,
    },
    /// A hand that no force turns aside.
    Firm,
}

/// Where the hand wants to be: sines about a point, m.
#[derive(Clone, Debug)]
pub struct Path {
    pub center_m: V3,
    pub swings: Vec<(V3, f64, f64)>,
}

impl Path {
    pub fn at(&self, t_s: f64) -> V3 {
        let swing = |(amplitude, omega, phase): &(V3, f64, f64)| {
            amplitude * ((omega * t_s + phase).sin() - phase.sin())
        };
        let begun = (t_s / BEGIN_S).min(1.0);
        let begun = begun * begun * (3.0 - 2.0 * begun);
        self.center_m + begun * self.swings.iter().map(swing).sum::<V3>()
    }
}

/// Where the device is not as its controller believes.
#[derive(Clone, Copy, Debug)]
pub struct Truth {
    pub extra_ticks: usize,
    pub mass_scale: f64,
    pub lag_scale: f64,
    pub friction_n: f64,
    pub damping_n_s_per_m: f64,
}

/// Tip, motors and hand, with the energy that the motors took from the tip.
pub struct Plant {
    model: DeviceModel,
    truth: Truth,
    hand: Hand,
    path: Path,
    commands: VecDeque<Command>,
    q: V3,
    xd: V3,
    hand_m: V3,
    hand_m_per_s: V3,
    torque_nm: V3,
    t_s: f64,
    pub taken_j: f64,
    /// The smallest it ever was.
    pub least_j: f64,
    /// Largest product of the motors' force and the acceleration that the hand gives the tip.
    pub pulled_w_per_s: f64,
    /// Largest power of the spring drives' series dampers k_T²/dR; zero for torque drives.
    pub drag_w: f64,
}

impl Plant {
    pub fn new(model: &DeviceModel, truth: Truth, hand: Hand, path: Path) -> Self {
        let q = V3::from(model.joints.home_rad);
        Self {
            model: model.clone(),
            truth,
            hand_m: path.at(0.0),
            hand,
            path,
            commands: VecDeque::from(vec![Command::default(); truth.extra_ticks]),
            q,
            xd: V3::zeros(),
            hand_m_per_s: V3::zeros(),
            torque_nm: V3::zeros(),
            t_s: 0.0,
            taken_j: 0.0,
            least_j: 0.0,
            pulled_w_per_s: 0.0,
            drag_w: 0.0,
        }
    }

    /// Latches the sensors, lets the controller tick, and lives through the tick under the
    /// command of the one before.
    pub fn tick(&mut self, rig: &mut Rig) {
        rig.place(&self.q);
        if let DriveModel::Spring(drive) = &self.model.drive {
            rig.observation.status |= status::CURRENT_PRESENT;
            for i in 0..3 {
                let per_ampere = drive.ratio[i] * drive.k_t_nm_per_a[i];
                rig.observation.motor_current_a[i] = self.torque_nm[i] / per_ampere;
            }
        }
        self.commands.push_back(rig.command);
        rig.step();
        let command = self.commands.pop_front().expect("one was just put in");
        for _ in 0..SUBSTEPS {
            self.step(&command);
        }
    }

    fn step(&mut self, command: &Command) {
        let pose = JointState::at(&self.model.kinematics, self.q, V3::zeros());
        let inverse = pose.jacobian_inverse;
        let qd = inverse * self.xd;
        self.drive(command, &qd);
        self.accelerate(&inverse);
        let step_rad = inverse * self.xd * STEP_S;
        self.q += step_rad;
        self.taken_j -= self.torque_nm.dot(&step_rad);
        self.least_j = self.least_j.min(self.taken_j);
        self.t_s += STEP_S;
    }

    fn drive(&mut self, command: &Command, qd: &V3) {
        let mut drag_w = 0.0;
        for i in 0..self.model.dof {
            let (target_nm, lag_s) = match &self.model.drive {
                DriveModel::Torque(drive) => (command.motor_torque_nm[i], drive.lag_s),
                DriveModel::Spring(drive) => {
                    let residual_ohm = drive.r_25_ohm[i] - drive.r_hat_ohm[i];
                    let per_ampere = drive.ratio[i] * drive.k_t_nm_per_a[i];
                    drag_w += (per_ampere * qd[i]).powi(2) / residual_ohm;
                    let across_v = command.motor_v[i] - per_ampere * qd[i];
                    let on = f64::from(u8::from(command.enable));
                    (
                        on * per_ampere * across_v / residual_ohm,
                        drive.l_h[i] / residual_ohm,
                    )
                }
            };
            let kept = (-STEP_S / (lag_s * self.truth.lag_scale)).exp();
            self.torque_nm[i] = target_nm + kept * (self.torque_nm[i] - target_nm);
        }
        self.drag_w = self.drag_w.max(drag_w);
    }

    fn accelerate(&mut self, inverse: &M3) {
        let tip_m = self.model.kinematics.forward(&self.q);
        let before = self.path.at(self.t_s);
        let led_m_per_s = (self.path.at(self.t_s + STEP_S) - before) / STEP_S;
        let mass_kg = self.truth.mass_scale * self.model.tip.mass_kg;
        match self.hand {
            Hand::Firm => {
                let xd = led_m_per_s + CLOSING_PER_S * (before - tip_m);
                self.pull(inverse, &((xd - self.xd) / STEP_S));
                self.xd = xd;
            }
            Hand::Compliant {
                mass_kg: hand_kg,
                grip_n_per_m,
                grip_n_s_per_m,
                arm_n_per_m,
                arm_n_s_per_m,
            } => {
                let grip_n = grip_n_per_m * (self.hand_m - tip_m)
                    + grip_n_s_per_m * (self.hand_m_per_s - self.xd);
                let arm_n = arm_n_per_m * (before - self.hand_m)
                    + arm_n_s_per_m * (led_m_per_s - self.hand_m_per_s);
                self.hand_m_per_s += STEP_S * (arm_n - grip_n) / hand_kg;
                self.hand_m += STEP_S * self.hand_m_per_s;
                self.pull(inverse, &(grip_n / mass_kg));
                let force_n = grip_n + inverse.tr_mul(&self.torque_nm)
                    - self.truth.damping_n_s_per_m * self.xd;
                let free = self.xd + STEP_S * force_n / mass_kg;
                let stuck = STEP_S * self.truth.friction_n / mass_kg;
                let left = (free.norm() - stuck).max(0.0);
                self.xd = if left > 0.0 {
                    free.normalize() * left
                } else {
                    V3::zeros()
                };
            }
        }
    }

    /// Notes how the hand accelerates the tip along the motors' force.
    fn pull(&mut self, inverse: &M3, m_per_s2: &V3) {
        let along = inverse.tr_mul(&self.torque_nm).dot(m_per_s2);
        self.pulled_w_per_s = self.pulled_w_per_s.max(along);
    }
}
