//! What the motors give: a first-order model of each, its heat and its budget.

use crate::budget::{Budget, Rating};
use crate::couple::torque_per_volt;
use crate::io::Command;
use crate::linear::{invert_axes, V3};
use crate::model::{DriveModel, SpringDriveModel, TorqueDriveModel};
use crate::thermal::Thermal;

/// Joint torque, N·m, that counts as none: it keeps a torque that dies away out of the denormal
/// numbers, whose arithmetic is slow.
const TORQUE_MIN_NM: f64 = 1e-12;

/// Share of the present torque that is left after `period_s`, for the residual circuit
/// e_W − k_T θ̇ = dR i + L i̇ of a spring drive: a = e^(−T dR/L) (physics §2).
#[must_use]
pub fn spring_retention(drive: &SpringDriveModel, dr_ohm: &V3, period_s: f64) -> V3 {
    let per_henry = invert_axes(&drive.l_h.into());
    (-period_s * dr_ohm.component_mul(&per_henry)).map(f64::exp)
}

/// Share of the present torque that is left after `period_s` with a torque lag: a = e^(−T/lag).
#[must_use]
pub fn torque_retention(drive: &TorqueDriveModel, period_s: f64) -> V3 {
    // Without lag the exponent is −∞ and nothing is left.
    V3::repeat((-period_s / drive.lag_s).exp())
}

/// Torque after one period: τ⁺ = τ + (1−a)(τ_cmd − τ).
#[must_use]
pub fn settle(present_nm: &V3, command_nm: &V3, retain: &V3) -> V3 {
    let settled_nm = command_nm + retain.component_mul(&(present_nm - command_nm));
    settled_nm.map(|torque| {
        if torque.abs() < TORQUE_MIN_NM {
            0.0
        } else {
            torque
        }
    })
}

/// Back-EMF k_T ρ q̇, V.
#[must_use]
pub fn back_emf_v(drive: &SpringDriveModel, qd: &V3) -> V3 {
    V3::from_fn(|i, _| drive.k_t_nm_per_a[i] * drive.ratio[i] * qd[i])
}

/// How a torque asked for becomes volts: e_W = k_T θ̇ + τ dR/(ρ k_T), the inverse of
/// τ = ρ k_T/dR (e_W − k_T θ̇).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supply {
    /// Back-EMF k_T θ̇, V.
    pub emf_v: V3,
    /// dR/(ρ k_T), V/(N·m).
    pub v_per_nm: V3,
    /// Largest |e_W|, V.
    pub max_v: V3,
}

impl Supply {
    /// e_W that settles to `torque_nm`, V, clipped to the supply (law 1).
    #[must_use]
    pub fn voltage_v(&self, torque_nm: &V3) -> V3 {
        let wanted = self.emf_v + self.v_per_nm.component_mul(torque_nm);
        wanted.zip_map(&self.max_v, |volts, max| volts.clamp(-max, max))
    }
}

/// The motors of one device.
#[derive(Clone, Copy, Debug)]
pub struct Motors {
    drive: DriveModel,
    period_s: f64,
    budget: Budget,
    thermal: Option<Thermal>,
    residual_ohm: V3,
    retain: V3,
    torque_nm: V3,
    current_a: V3,
}

impl Motors {
    /// Motors at rest and cold, stepped every `period_s`.
    #[must_use]
    pub fn new(drive: &DriveModel, period_s: f64) -> Self {
        let thermal = match drive {
            DriveModel::Spring(drive) => Some(Thermal::new(drive, period_s)),
            DriveModel::Torque(_) => None,
        };
        let mut motors = Self {
            drive: *drive,
            period_s,
            budget: Budget::new(rating(drive), period_s),
            thermal,
            residual_ohm: V3::zeros(),
            retain: V3::zeros(),
            torque_nm: V3::zeros(),
            current_a: V3::zeros(),
        };
        motors.follow_temperature();
        motors
    }

    /// One period in which `command` was in force and the joints moved at `qd`, rad/s. `driven`
    /// says whether the device passed the command on; `measured_a` are measured currents.
    pub fn step(&mut self, command: &Command, qd: &V3, driven: bool, measured_a: Option<V3>) {
        self.torque_nm = if driven {
            settle(
                &self.torque_nm,
                &self.static_torque_nm(command, qd),
                &self.retain,
            )
        } else {
            V3::zeros()
        };
        self.current_a = measured_a.unwrap_or_else(|| self.modelled_current_a());
        if let Some(thermal) = &mut self.thermal {
            thermal.step(&self.current_a);
            self.budget.step(&self.current_a);
        } else {
            self.budget.step(&self.torque_nm);
        }
        self.follow_temperature();
    }

    fn follow_temperature(&mut self) {
        if let Some(thermal) = &self.thermal {
            self.residual_ohm = thermal.residual_ohm();
        }
        self.retain = match &self.drive {
            DriveModel::Spring(drive) => spring_retention(drive, &self.residual_ohm, self.period_s),
            DriveModel::Torque(drive) => torque_retention(drive, self.period_s),
        };
    }

    /// Joint torque the motors give, N·m, by the model.
    #[must_use]
    pub fn torque_nm(&self) -> V3 {
        self.torque_nm
    }

    /// Joint torque the motors give, N·m: by the currents where they are measured, else by the
    /// model.
    #[must_use]
    pub fn given_nm(&self) -> V3 {
        match &self.drive {
            DriveModel::Spring(drive) => torque_per_ampere(drive).component_mul(&self.current_a),
            DriveModel::Torque(_) => self.torque_nm,
        }
    }

    /// Currents, A: measured, or by the model. Zero where the drive takes torque.
    #[must_use]
    pub fn current_a(&self) -> V3 {
        self.current_a
    }

    /// Winding temperatures, °C; zero where the drive takes torque and no winding is known.
    #[must_use]
    pub fn winding_c(&self) -> V3 {
        self.thermal
            .map_or_else(V3::zeros, |thermal| thermal.winding_c())
    }

    /// Residual resistances dR, Ω; zero where the drive takes torque.
    #[must_use]
    pub fn residual_ohm(&self) -> V3 {
        self.residual_ohm
    }

    /// The I²t budget.
    #[must_use]
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Largest joint torque allowed now, N·m: the peak, folded back by the I²t budget (law 1).
    #[must_use]
    pub fn limit_nm(&self) -> V3 {
        match &self.drive {
            DriveModel::Spring(drive) => {
                self.budget.limit().component_mul(&torque_per_ampere(drive))
            }
            DriveModel::Torque(_) => self.budget.limit(),
        }
    }

    /// Whether a winding is past its temperature or its budget.
    #[must_use]
    pub fn hot(&self) -> bool {
        self.thermal.is_some_and(|thermal| thermal.hot()) || self.budget.overdrawn()
    }

    /// Share of the present torque that is left after one period.
    #[must_use]
    pub fn retain(&self) -> V3 {
        self.retain
    }

    /// How torque becomes volts with the joints at `qd`, rad/s. `None` where the drive takes
    /// torque.
    #[must_use]
    pub fn supply(&self, qd: &V3) -> Option<Supply> {
        match &self.drive {
            DriveModel::Spring(drive) => Some(Supply {
                emf_v: back_emf_v(drive, qd),
                v_per_nm: invert_axes(&torque_per_volt(drive, &self.residual_ohm)),
                max_v: drive.voltage_max_v.into(),
            }),
            DriveModel::Torque(_) => None,
        }
    }

    /// Torque that `command` settles to, N·m.
    fn static_torque_nm(&self, command: &Command, qd: &V3) -> V3 {
        match &self.drive {
            DriveModel::Spring(drive) => {
                let across_dr_v = V3::from(command.motor_v) - back_emf_v(drive, qd);
                torque_per_volt(drive, &self.residual_ohm).component_mul(&across_dr_v)
            }
            DriveModel::Torque(_) => command.motor_torque_nm.into(),
        }
    }

    fn modelled_current_a(&self) -> V3 {
        match &self.drive {
            DriveModel::Spring(drive) => {
                invert_axes(&torque_per_ampere(drive)).component_mul(&self.torque_nm)
            }
            DriveModel::Torque(_) => V3::zeros(),
        }
    }
}

/// ρ k_T, N·m/A at the joint.
fn torque_per_ampere(drive: &SpringDriveModel) -> V3 {
    V3::from_fn(|i, _| drive.ratio[i] * drive.k_t_nm_per_a[i])
}

fn rating(drive: &DriveModel) -> Rating {
    match drive {
        DriveModel::Spring(drive) => Rating {
            peak: drive.current_max_a,
            continuous: drive.current_continuous_a,
            peak_time_s: drive.peak_time_s,
        },
        DriveModel::Torque(drive) => Rating {
            peak: drive.torque_max_nm,
            continuous: drive.torque_continuous_nm,
            peak_time_s: drive.peak_time_s,
        },
    }
}
