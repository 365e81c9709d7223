use crate::models::{hhd, phantom, pose, spring_drive, torque_drive, vector};
use crate::walls::walls;
use hapticd_control::couple::JointDemand;
use hapticd_control::couple::{dc_stiffness, spring_demand, torque_demand, torque_per_volt};
use hapticd_control::environment::set_point;
use hapticd_control::estimate::JointState;
use hapticd_control::facing::Facing;
use hapticd_control::linear::V3;
use hapticd_control::mapping::JointSetPoint;
use hapticd_control::model::TorqueDriveModel;
use proptest::prelude::*;

const DR_OHM: V3 = V3::new(0.109, 0.2, 0.05);

fn phantom_state() -> impl Strategy<Value = JointState> {
    let model = phantom();
    (pose(&model), vector(3, 3.0)).prop_map(move |(q, qd)| JointState::at(&model.kinematics, q, qd))
}

fn hhd_state() -> impl Strategy<Value = JointState> {
    let model = hhd();
    (pose(&model), vector(2, 3.0)).prop_map(move |(q, qd)| JointState::at(&model.kinematics, q, qd))
}

/// What the virtual coupling asks for towards a set-point.
fn coupled(drive: &TorqueDriveModel, state: &JointState, x_sd: &V3, xd_sd: &V3) -> JointDemand {
    let spring_n = drive.stiffness_n_per_m * (x_sd - state.x);
    let damper_n = drive.damping_n_s_per_m * (xd_sd - state.xd);
    torque_demand(&state.jacobian, &spring_n, &damper_n)
}

/// Walls that stand upright on the HHD's plane, around the middle of its workspace.
fn upright_walls() -> impl Strategy<Value = Vec<Facing>> {
    walls(4).prop_map(|mut walls| {
        for wall in &mut walls {
            let flat = V3::new(wall.normal[0], wall.normal[1] + 1e-3, 0.0).normalize();
            wall.normal = flat.into();
            wall.offset_m += flat.y * 0.25;
        }
        walls
    })
}

proptest! {
    #[test]
    fn resting_spring_drive_gives_its_stiffness_times_the_error(
        state in phantom_state(), error in vector(3, 0.05),
    ) {
        let drive = spring_drive();
        let state = JointState { qd: V3::zeros(), ..state };
        let set_point = JointSetPoint { q_sd: state.q + error, qd_sd: V3::zeros() };
        let demand = spring_demand(&drive, &state, &set_point, &DR_OHM);
        let expected = dc_stiffness(&drive, &DR_OHM).component_mul(&error);
        prop_assert!((demand.torque_nm - expected).norm() < 1e-9);
    }

    #[test]
    fn free_spring_drive_cancels_its_back_emf_and_gives_no_torque(state in phantom_state()) {
        let drive = spring_drive();
        let following = JointSetPoint { q_sd: state.q, qd_sd: state.qd };
        let demand = spring_demand(&drive, &state, &following, &DR_OHM);
        let back_emf = V3::from_fn(|i, _| drive.k_t_nm_per_a[i] * drive.ratio[i] * state.qd[i]);
        prop_assert!((demand.motor_v - back_emf).norm() < 1e-12);
        prop_assert!(demand.torque_nm.norm() < 1e-9);
    }

    #[test]
    fn voltage_follows_the_drift_compensation_law(
        state in phantom_state(), error in vector(3, 0.05), qd_sd in vector(3, 2.0), k_d in 0.0..0.1_f64,
    ) {
        let mut drive = spring_drive();
        drive.k_d_v_s_per_rad = [k_d; 3];
        let set_point = JointSetPoint { q_sd: state.q + error, qd_sd };
        let demand = spring_demand(&drive, &state, &set_point, &DR_OHM);
        for i in 0..3 {
            let (k_t, k_p, rho) = (drive.k_t_nm_per_a[i], drive.k_p_v_per_rad[i], drive.ratio[i]);
            let slip = rho * (qd_sd[i] - state.qd[i]);
            let e_w = k_t * rho * qd_sd[i] + k_d * slip + k_p * rho * error[i];
            prop_assert!((demand.motor_v[i] - e_w).abs() < 1e-12);
            let current = (e_w - k_t * rho * state.qd[i]) / DR_OHM[i];
            prop_assert!((demand.torque_nm[i] - rho * k_t * current).abs() < 1e-9);
        }
    }

    #[test]
    fn tip_force_of_the_spring_drive_balances_its_torque(
        state in phantom_state(), error in vector(3, 0.05),
    ) {
        prop_assume!(state.singularity_margin > 0.05);
        let set_point = JointSetPoint { q_sd: state.q + error, qd_sd: V3::zeros() };
        let demand = spring_demand(&spring_drive(), &state, &set_point, &DR_OHM);
        let balance = state.jacobian.tr_mul(&demand.force_n) - demand.torque_nm;
        prop_assert!(balance.norm() <= 1e-9 * (1.0 + demand.torque_nm.norm()));
    }

    #[test]
    fn virtual_coupling_never_pulls_towards_the_wall(
        state in hhd_state(), walls in upright_walls(), stiffness in 0.2..1.0_f64,
    ) {
        let mut drive = torque_drive();
        drive.stiffness_n_per_m *= stiffness;
        let wanted = set_point(&walls, &state.x, &state.xd);
        let demand = coupled(&drive, &state, &wanted.x_sd, &wanted.xd_sd);
        prop_assert!(demand.force_n.dot(&(wanted.x_sd - state.x)) >= -1e-12);
        if wanted.x_sd == state.x {
            prop_assert_eq!(demand.force_n, V3::zeros());
        }
    }

    #[test]
    fn damper_of_the_virtual_coupling_never_gives_energy(
        state in hhd_state(), walls in upright_walls(),
    ) {
        let drive = torque_drive();
        let wanted = set_point(&walls, &state.x, &state.xd);
        let demand = coupled(&drive, &state, &wanted.x_sd, &wanted.xd_sd);
        let spring = drive.stiffness_n_per_m * (wanted.x_sd - state.x);
        prop_assert!((demand.force_n - spring).dot(&state.xd) <= 1e-9);
    }
}

#[test]
fn coupling_is_spring_and_damper_while_the_tip_goes_in() {
    let drive = torque_drive();
    let state = JointState {
        x: V3::new(0.0, 0.2, 0.0),
        xd: V3::new(0.0, -0.1, 0.0),
        ..JointState::default()
    };
    let demand = coupled(&drive, &state, &V3::new(0.0, 0.201, 0.0), &V3::zeros());
    let expected = drive.stiffness_n_per_m * 0.001 + drive.damping_n_s_per_m * 0.1;
    assert!((demand.force_n.y - expected).abs() < 1e-9);
}

#[test]
fn axis_without_residual_resistance_gives_no_torque() {
    let gain = torque_per_volt(&spring_drive(), &V3::new(0.1, 0.0, -0.1));
    assert!(gain.x > 0.0);
    assert_eq!((gain.y, gain.z), (0.0, 0.0));
}
