use crate::models::{device_and_pose, hhd, phantom, pose, vector};
use hapticd_control::environment::SetPoint;
use hapticd_control::estimate::JointState;
use hapticd_control::linear::{M3, V3};
use hapticd_control::mapping::{isotropic_stiffness, joint_set_point, workspace_stiffness};
use hapticd_control::model::DeviceModel;
use hapticd_control::scene::Mapping;
use proptest::prelude::*;

/// Joint stiffnesses around the PHANTOM's, unequal, N·m/rad.
fn joint_stiffness(dof: usize) -> impl Strategy<Value = V3> {
    prop::array::uniform3(20.0..200.0_f64)
        .prop_map(move |k| V3::from_fn(|i, _| if i < dof { k[i] } else { 0.0 }))
}

prop_compose! {
    fn situation()((model, q) in device_and_pose())(
        k_q in joint_stiffness(model.dof),
        qd in vector(model.dof, 2.0),
        away in vector(model.dof, 0.01),
        xd_sd in vector(model.dof, 0.5),
        state in Just(JointState::at(&model.kinematics, q, V3::zeros())),
        model in Just(model),
    ) -> (DeviceModel, JointState, V3, SetPoint) {
        let state = JointState::at(&model.kinematics, state.q, qd);
        let set_point = SetPoint { x_sd: state.x + away, xd_sd };
        (model, state, k_q, set_point)
    }
}

proptest! {
    #[test]
    fn bound_is_the_smallest_eigenvalue_of_the_tip_stiffness((model, state, k_q, _) in situation()) {
        prop_assume!(state.singularity_margin > 0.01);
        let inverse = state.jacobian_inverse;
        let mut k_x = inverse.transpose() * M3::from_diagonal(&k_q) * inverse;
        if model.dof == 2 {
            k_x[(2, 2)] = f64::MAX;
        }
        let smallest = if model.dof == 2 {
            k_x.fixed_view::<2, 2>(0, 0).into_owned().symmetric_eigenvalues().min()
        } else {
            k_x.symmetric_eigenvalues().min()
        };
        let bound = isotropic_stiffness(&state.jacobian, &k_q);
        prop_assert!((bound - smallest).abs() <= 1e-6 * smallest);
    }

    #[test]
    fn no_joint_direction_is_stiffer_than_tuned((_, state, k_q, _) in situation()) {
        let k_c = isotropic_stiffness(&state.jacobian, &k_q);
        let rendered = k_c * state.jacobian.tr_mul(&state.jacobian);
        let slack = (M3::from_diagonal(&k_q) - rendered).symmetric_eigenvalues().min();
        prop_assert!(slack >= -1e-6 * k_q.max());
    }

    #[test]
    fn transpose_asks_for_the_force_of_an_isotropic_spring((model, state, k_q, wanted) in situation()) {
        let k_c = isotropic_stiffness(&state.jacobian, &k_q);
        let found = joint_set_point(Mapping::Transpose, &model.kinematics, &state, &wanted, &k_q, k_c);
        let torque = k_q.component_mul(&(found.q_sd - state.q));
        let expected = state.jacobian.tr_mul(&(k_c * (wanted.x_sd - state.x)));
        prop_assert!((torque - expected).norm() <= 1e-9 * (1.0 + expected.norm()));
        let rate = k_q.component_mul(&(found.qd_sd - state.qd));
        let expected = state.jacobian.tr_mul(&(k_c * (wanted.xd_sd - state.xd)));
        prop_assert!((rate - expected).norm() <= 1e-9 * (1.0 + expected.norm()));
    }

    #[test]
    fn inverse_puts_the_joints_where_the_tip_is_wanted((model, state, k_q, wanted) in situation()) {
        prop_assume!(state.singularity_margin > 0.2);
        let found = joint_set_point(Mapping::Inverse, &model.kinematics, &state, &wanted, &k_q, 1.0);
        if model.kinematics.inverse(&wanted.x_sd).is_some() {
            let reached = model.kinematics.forward(&found.q_sd);
            prop_assert!((reached - wanted.x_sd).norm() < 1e-9);
        }
        prop_assert!((state.jacobian * found.qd_sd - wanted.xd_sd).norm() < 1e-9);
    }

    #[test]
    fn free_space_leaves_the_joints_alone((model, state, k_q, _) in situation()) {
        prop_assume!(state.singularity_margin > 0.01);
        let free = SetPoint { x_sd: state.x, xd_sd: state.xd };
        for mapping in [Mapping::Transpose, Mapping::Inverse] {
            let found = joint_set_point(mapping, &model.kinematics, &state, &free, &k_q, 3000.0);
            prop_assert!((found.q_sd - state.q).norm() < 1e-9);
            prop_assert_eq!(found.qd_sd, state.qd);
        }
    }

    #[test]
    fn workspace_stiffness_is_within_the_bound_of_every_pose(
        q in pose(&phantom()), k_q in joint_stiffness(3),
    ) {
        let model = phantom();
        let bound = isotropic_stiffness(&model.kinematics.jacobian(&q), &k_q);
        prop_assert!(workspace_stiffness(&model, &k_q) <= bound * 1.001);
    }
}

#[test]
fn workspace_stiffness_of_equal_joints_is_found_at_the_end_of_the_coupling() {
    let k = 100.0;
    let model = hhd();
    let opening_max: f64 = 2.740;
    let sigma_max = 0.2 * std::f64::consts::SQRT_2 * (opening_max / 2.0).sin();
    let found = workspace_stiffness(&model, &V3::new(k, k, 0.0));
    assert!((found - k / sigma_max.powi(2)).abs() < 1e-6 * found);
}

#[test]
fn joint_without_stiffness_allows_none_at_the_tip() {
    let jacobian = phantom()
        .kinematics
        .jacobian(&phantom().joints.home_rad.into());
    assert_eq!(
        isotropic_stiffness(&jacobian, &V3::new(100.0, 0.0, 100.0)),
        0.0
    );
    assert_eq!(isotropic_stiffness(&M3::zeros(), &V3::repeat(100.0)), 0.0);
}

#[test]
fn set_point_out_of_reach_is_followed_as_far_as_the_linkage_shows() {
    let model = hhd();
    let state = JointState::at(&model.kinematics, V3::new(0.7, 1.4, 0.0), V3::zeros());
    let beyond = SetPoint {
        x_sd: state.x.normalize(),
        xd_sd: V3::zeros(),
    };
    let found = joint_set_point(
        Mapping::Inverse,
        &model.kinematics,
        &state,
        &beyond,
        &V3::zeros(),
        0.0,
    );
    let expected = state.q + state.jacobian_inverse * (beyond.x_sd - state.x);
    assert_eq!(found.q_sd, expected);
}

#[test]
fn singular_pose_is_left_alone_by_the_inverse_mapping() {
    let model = hhd();
    let state = JointState::at(
        &model.kinematics,
        V3::new(1.0, 1.0, 0.0),
        V3::new(0.3, 0.1, 0.0),
    );
    let beyond = SetPoint {
        x_sd: V3::new(1.0, 1.0, 0.0),
        xd_sd: V3::zeros(),
    };
    let found = joint_set_point(
        Mapping::Inverse,
        &model.kinematics,
        &state,
        &beyond,
        &V3::zeros(),
        0.0,
    );
    assert_eq!((found.q_sd, found.qd_sd), (state.q, state.qd));
}
