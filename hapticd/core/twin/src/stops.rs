//! Mechanical stops.

use crate::model::StopModel;
use hapticd_control::linear::V3;
use hapticd_control::model::{JointModel, KinematicsModel};

/// Stops of each joint and of the angle between two joints.
#[derive(Clone, Copy, Debug)]
pub struct Stops {
    model: StopModel,
    min_rad: V3,
    max_rad: V3,
    /// Joints (i, k) whose difference q_k − q_i is stopped.
    pair: (usize, usize),
    pair_min_rad: f64,
    pair_max_rad: f64,
}

impl Stops {
    /// Stops `model.margin_rad` behind the limits of the device model.
    #[must_use]
    pub fn new(model: &StopModel, joints: &JointModel, kinematics: &KinematicsModel) -> Self {
        let (pair, low, high) = match *kinematics {
            KinematicsModel::Phantom {
                coupling_min_rad,
                coupling_max_rad,
                ..
            } => ((1, 2), coupling_min_rad, coupling_max_rad),
            KinematicsModel::Rhombus {
                opening_min_rad,
                opening_max_rad,
                ..
            } => ((0, 1), opening_min_rad, opening_max_rad),
        };
        Self {
            model: *model,
            min_rad: V3::from(joints.min_rad).add_scalar(-model.margin_rad),
            max_rad: V3::from(joints.max_rad).add_scalar(model.margin_rad),
            pair,
            pair_min_rad: low - model.margin_rad,
            pair_max_rad: high + model.margin_rad,
        }
    }

    /// Torque of the stops on the joints, N·m.
    #[must_use]
    pub fn torque(&self, q: &V3, qd: &V3) -> V3 {
        let mut torque =
            V3::from_fn(|i, _| self.push(q[i], qd[i], self.min_rad[i], self.max_rad[i]));
        let (i, k) = self.pair;
        let opening = self.push(
            q[k] - q[i],
            qd[k] - qd[i],
            self.pair_min_rad,
            self.pair_max_rad,
        );
        torque[k] += opening;
        torque[i] -= opening;
        torque
    }

    /// One stop pair: spring and damper that only push, N·m.
    fn push(&self, angle: f64, speed: f64, min: f64, max: f64) -> f64 {
        let spring = self.model.stiffness_nm_per_rad;
        let damping = self.model.damping_nm_s_per_rad * speed;
        if angle < min {
            (spring * (min - angle) - damping).max(0.0)
        } else if angle > max {
            (spring * (max - angle) - damping).min(0.0)
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const STOPS: Stops = Stops {
        model: StopModel {
            margin_rad: 0.0,
            stiffness_nm_per_rad: 100.0,
            damping_nm_s_per_rad: 1.0,
        },
        min_rad: V3::new(-1.0, -1.0, -1.0),
        max_rad: V3::new(1.0, 1.0, 1.0),
        pair: (1, 2),
        pair_min_rad: -0.5,
        pair_max_rad: 0.5,
    };

    #[test]
    fn stops_are_silent_inside_the_limits() {
        let torque = STOPS.torque(&V3::new(0.9, 0.2, 0.6), &V3::repeat(3.0));
        assert_eq!(torque, V3::zeros());
    }

    #[test]
    fn a_stop_pushes_back_and_never_pulls() {
        let outward = STOPS.torque(&V3::new(1.1, 0.0, 0.0), &V3::new(0.5, 0.0, 0.0));
        assert!((outward[0] + 10.5).abs() < 1e-12);
        let leaving = STOPS.torque(&V3::new(1.1, 0.0, 0.0), &V3::new(-50.0, 0.0, 0.0));
        assert_eq!(leaving[0], 0.0);
    }

    #[test]
    fn the_stop_between_two_joints_pushes_them_apart_equally() {
        let torque = STOPS.torque(&V3::new(0.0, -0.4, 0.2), &V3::zeros());
        assert!((torque[2] + 10.0).abs() < 1e-12);
        assert_eq!(torque[1], -torque[2]);
    }
}
