//! How walls answer penetration: each law pushes along the normal of its wall, and never pulls.

pub mod cubic;
pub mod damper;
pub mod motion;
pub mod sampled_loop;
pub mod spring;

use crate::linear::V3;
use crate::model::{DeviceModel, DriveModel, SpringDriveModel};
use crate::scene::Law;
use crate::thermal::tuned_residual_ohm;
use sampled_loop::SampledLoop;

/// Largest η of a wall that has no spring, or none here: it is touched, and pulls by the last bit
/// of a number. Only a motion law's η = 1 makes a wall that does not exist.
const ETA_TOUCHED: f64 = 1.0 - f64::EPSILON;

/// What one wall asks for in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Push {
    /// Index of the surface among those of its scene that face the tip.
    pub facing: usize,
    /// Index of the wall in its scene.
    pub wall: usize,
    /// The wall's stable number.
    pub key: u64,
    /// Unit normal into free space.
    pub normal: V3,
    /// Depth of the tip, m.
    pub depth_m: f64,
    /// Force along the normal, N, not negative: springs and dampers.
    pub force_n: f64,
}

/// The tip and the loop behind it, as the dampers see them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tip {
    /// m/T_e, N·s/m: the hardest damper that period, drive and velocity filter can damp the tip's
    /// mass with.
    pub damping_max_n_s_per_m: f64,
    /// Largest force, N.
    pub force_max_n: f64,
}

impl Tip {
    /// The tip of `model`, ticked every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        let lag_s = match &model.drive {
            DriveModel::Spring(drive) => electrical_lag_s(drive),
            DriveModel::Torque(drive) => drive.lag_s,
        };
        let behind = SampledLoop {
            period_s,
            lag_s,
            lambda_rad_per_s: model.estimator.lambda_rad_per_s,
        };
        Self {
            damping_max_n_s_per_m: model.tip.mass_kg * behind.damping_max_per_s(),
            force_max_n: model.limits.tip_force_n,
        }
    }
}

/// Largest L/dR, s: how late a commanded voltage becomes current.
fn electrical_lag_s(drive: &SpringDriveModel) -> f64 {
    let dr_ohm = tuned_residual_ohm(drive);
    let lag_s = |i: usize| {
        if dr_ohm[i] > 0.0 {
            drive.l_h[i] / dr_ohm[i]
        } else {
            0.0
        }
    };
    (0..3).map(lag_s).fold(0.0, f64::max)
}

/// Stiffness of a wall's spring, N/m, where that of a rigid one is `rigid_n_per_m`.
#[must_use]
pub fn stiffness(law: &Law, rigid_n_per_m: f64) -> f64 {
    match *law {
        Law::Motion { eta } => motion::rigid_part(eta) * rigid_n_per_m,
        Law::Spring {
            stiffness_n_per_m, ..
        } => stiffness_n_per_m,
        Law::Damper { .. } | Law::CubicDamper { .. } => 0.0,
    }
}

/// Share of the penetration that a wall lets pass where the stiffest of its neighbours has
/// `reference_n_per_m` and a rigid one `rigid_n_per_m`: η of a motion law (WN eq. 30).
#[must_use]
pub fn eta(law: &Law, rigid_n_per_m: f64, reference_n_per_m: f64) -> f64 {
    match *law {
        Law::Motion { eta } if rigid_n_per_m >= reference_n_per_m => eta,
        _ if reference_n_per_m > 0.0 => {
            (1.0 - stiffness(law, rigid_n_per_m) / reference_n_per_m).clamp(0.0, ETA_TOUCHED)
        }
        _ => ETA_TOUCHED,
    }
}

/// Damping beside a wall's spring, N·s/m, acting inwards and outwards; that of a rigid motion
/// wall is `rigid_n_s_per_m`.
#[must_use]
pub fn damping(law: &Law, rigid_n_s_per_m: f64) -> f64 {
    match *law {
        Law::Motion { eta } => motion::rigid_part(eta) * rigid_n_s_per_m,
        Law::Spring {
            damping_n_s_per_m, ..
        } => damping_n_s_per_m,
        Law::Damper { .. } | Law::CubicDamper { .. } => 0.0,
    }
}

/// Whether a wall has no spring: it answers the speed of penetration alone, and a brake may hold
/// the hand in it (KS Fig. 6).
#[must_use]
pub fn is_damper(law: &Law) -> bool {
    matches!(law, Law::Damper { .. } | Law::CubicDamper { .. })
}

/// Force of a wall without spring, N, on a tip that goes in at `closing_m_per_s`; none outwards.
#[must_use]
pub fn damper_force(law: &Law, closing_m_per_s: f64, tip: &Tip) -> f64 {
    match *law {
        Law::Damper { damping_n_s_per_m } => {
            damper::force(damping_n_s_per_m, closing_m_per_s, tip.force_max_n)
        }
        Law::CubicDamper {
            coefficient_n_s3_per_m3,
            form,
        } => cubic::force(coefficient_n_s3_per_m3, form, closing_m_per_s, tip),
        Law::Motion { .. } | Law::Spring { .. } => 0.0,
    }
}

/// Whether a wall answers at all: one that lets everything pass does not exist.
#[must_use]
pub fn exists(law: &Law) -> bool {
    !matches!(law, Law::Motion { eta } if *eta >= 1.0)
}
