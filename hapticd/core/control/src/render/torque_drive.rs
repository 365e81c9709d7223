//! Torque-commanded motors: every wall is a force.

use super::blend::{reference_n_per_m, soften, Answers, Blend, Rigid};
use super::walls::{Demanded, Walls};
use crate::couple::torque_demand;
use crate::environment::SetPoint;
use crate::estimate::JointState;
use crate::law::spring::damper_share;
use crate::linear::V3;
use crate::model::TorqueDriveModel;

/// What the scenes demand at `state`. Springs meet in one Moreau envelope whose stiffness is that
/// of the stiffest wall, and the motion law is a spring of the virtual coupling.
pub fn demand(walls: &mut Walls, drive: &TorqueDriveModel, state: &JointState) -> Demanded {
    let rigid = Rigid {
        stiffness_n_per_m: drive.stiffness_n_per_m,
        damping_n_s_per_m: drive.damping_n_s_per_m,
    };
    let k_c = rigid.stiffness_n_per_m;
    walls.layers.follow(&state.x, |scene, facings| {
        let reference = reference_n_per_m(scene, k_c);
        soften(scene, facings, k_c, reference);
    });
    let mut blend = Blend::default();
    let mut xd_sd = V3::zeros();
    let mut probe = SetPoint::default();
    for layer in walls.layers.weighted() {
        let answers = Answers {
            state,
            tip: &walls.tip,
            rigid,
            reference_n_per_m: reference_n_per_m(layer.1, k_c),
        };
        let springs = answers.add(layer, &mut blend, &mut walls.touches, &mut walls.scratch);
        let excitation = walls.excitation(layer.1);
        probe.x_sd += layer.0 * excitation.x_sd;
        probe.xd_sd += layer.0 * excitation.xd_sd;
        xd_sd += layer.0 * answers.reference_n_per_m / k_c * (springs.xd_sd - state.xd);
    }
    let mut demand = torque_demand(&state.jacobian, &blend.spring_n, &blend.damper_n);
    let probe_n = k_c * probe.x_sd + rigid.damping_n_s_per_m * probe.xd_sd;
    demand.add_shared(&state.jacobian, &(blend.explicit_n + probe_n));
    Demanded {
        set_point: SetPoint {
            x_sd: state.x + blend.spring_n / k_c + probe.x_sd,
            xd_sd: state.xd + xd_sd + probe.xd_sd,
        },
        stiffness_n_per_m: k_c,
        demand,
        probe_n,
        damper_share: damper_share(&blend.spring_n, &blend.damper_n),
    }
}
