use crate::models::{device_and_pose, hhd, phantom};
use hapticd_control::linear::{M3, V3};
use proptest::prelude::*;

const DIFFERENCE_RAD: f64 = 1e-6;

proptest! {
    #[test]
    fn jacobian_is_the_derivative_of_the_tip((model, q) in device_and_pose()) {
        let jacobian = model.kinematics.jacobian(&q);
        for joint in 0..model.dof {
            let step = DIFFERENCE_RAD * V3::ith(joint, 1.0);
            let ahead = model.kinematics.forward(&(q + step));
            let behind = model.kinematics.forward(&(q - step));
            let column = (ahead - behind) / (2.0 * DIFFERENCE_RAD);
            prop_assert!((jacobian.column(joint) - column).norm() < 1e-9);
        }
    }

    #[test]
    fn inverse_undoes_forward_inside_the_limits((model, q) in device_and_pose()) {
        prop_assume!(model.kinematics.singularity_margin(&q) > 0.01);
        let found = model.kinematics.inverse(&model.kinematics.forward(&q));
        prop_assert!((found.unwrap() - q).norm() < 1e-9);
    }

    #[test]
    fn inverse_jacobian_undoes_the_jacobian((model, q) in device_and_pose()) {
        prop_assume!(model.kinematics.singularity_margin(&q) > 0.01);
        let inverse = model.kinematics.jacobian_inverse(&q).unwrap();
        let used = V3::from_fn(|i, _| if i < model.dof { 1.0 } else { 0.0 });
        let product = inverse * model.kinematics.jacobian(&q);
        prop_assert!((product - M3::from_diagonal(&used)).norm() < 1e-9);
    }

    #[test]
    fn limits_hold_exactly_the_poses_inside((model, q) in device_and_pose(), joint in 0..2_usize) {
        let inside = |q: &V3, margin| model.kinematics.inside(&model.joints, q, margin);
        prop_assert!(inside(&q, 0.0));
        let mut past = q;
        past[joint] = model.joints.max_rad[joint] + 0.05;
        prop_assert!(!inside(&past, 0.04));
    }
}

#[test]
fn tips_at_home_are_where_the_device_files_say() {
    let tip = |model: hapticd_control::model::DeviceModel| {
        model.kinematics.forward(&model.joints.home_rad.into())
    };
    assert!((tip(phantom()) - V3::new(0.1967, 0.0, 0.0226)).norm() < 1e-3);
    assert!((tip(hhd()) - V3::new(0.0, 0.2, 0.0)).norm() < 1e-4);
}

#[test]
fn singular_poses_have_no_margin_and_no_inverse() {
    let right_angle = std::f64::consts::FRAC_PI_2;
    let stretched = V3::new(0.0, 0.3, 0.3 + right_angle);
    let behind_the_axis = V3::new(0.0, 1.5, -0.5);
    for q in [stretched, behind_the_axis] {
        assert!(phantom().kinematics.singularity_margin(&q) < 1e-12);
        assert_eq!(phantom().kinematics.jacobian_inverse(&q), None);
    }
    let folded = V3::new(1.0, 1.0, 0.0);
    assert_eq!(hhd().kinematics.singularity_margin(&folded), 0.0);
    assert_eq!(hhd().kinematics.jacobian_inverse(&folded), None);
}

#[test]
fn perpendicular_links_are_as_far_from_singular_as_can_be() {
    let home = |model: &hapticd_control::model::DeviceModel| V3::from(model.joints.home_rad);
    let margin = phantom().kinematics.singularity_margin(&home(&phantom()));
    assert!(margin > 0.99);
    let open = V3::new(0.0, std::f64::consts::FRAC_PI_2, 0.0);
    assert_eq!(hhd().kinematics.singularity_margin(&open), 1.0);
}

#[test]
fn points_out_of_reach_have_no_joint_angles() {
    let unreachable = [V3::new(0.5, 0.0, 0.0), V3::zeros(), V3::repeat(f64::NAN)];
    for x in unreachable {
        assert_eq!(phantom().kinematics.inverse(&x), None);
        assert_eq!(hhd().kinematics.inverse(&x), None);
    }
    let on_the_base_axis = V3::new(0.0, 0.0, 0.1);
    assert_eq!(phantom().kinematics.inverse(&on_the_base_axis), None);
}

#[test]
fn difference_of_coupled_joints_is_limited() {
    let model = phantom();
    let q = V3::new(0.0, 0.0, 1.2);
    assert!(!model.kinematics.inside(&model.joints, &q, 0.1));
    assert!(model.kinematics.inside(&model.joints, &q, 0.3));
}

#[test]
fn not_a_number_is_never_inside() {
    for joint in 0..3 {
        let mut q = V3::from(phantom().joints.home_rad);
        q[joint] = f64::NAN;
        assert!(!phantom().kinematics.inside(&phantom().joints, &q, 1.0));
    }
}
