//! The tick renders what the scene asks for.

use crate::models::{hhd, phantom, torque_drive};
use crate::rig::Rig;
use hapticd_control::linear::V3;

#[test]
fn rigid_wall_pushes_back_along_its_normal_with_k_c() {
    let rig = Rig::pressing(phantom(), 0.001);
    let force_n = V3::from(rig.record.tip_force_n);
    let normal = V3::from(rig.record.contact_normal);
    let expected_n = rig.record.stiffness_n_per_m * rig.record.contact_depth_m;
    assert!(
        (force_n - expected_n * normal).norm() < 1e-3 * expected_n,
        "{force_n}"
    );
    assert!(expected_n > 1.0);
}

#[test]
fn virtual_coupling_pushes_back_along_the_normal() {
    let rig = Rig::pressing(hhd(), 0.001);
    let normal = V3::from(rig.record.contact_normal);
    let force_n = V3::from(rig.record.tip_force_command_n);
    let expected_n = torque_drive().stiffness_n_per_m * 0.001 * normal;
    assert!(
        (force_n - expected_n).norm() < 0.02 * expected_n.norm(),
        "{force_n}"
    );
}

#[test]
fn free_space_asks_for_no_force() {
    for model in [phantom(), hhd()] {
        let mut rig = Rig::running(model);
        let q = rig.home() + V3::new(0.001, 0.002, 0.0);
        rig.place(&q);
        rig.steps(5);
        assert!(V3::from(rig.record.tip_force_command_n).norm() < 1e-9);
    }
}
