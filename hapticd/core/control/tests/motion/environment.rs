use crate::walls::{any_wall, unit, wall, walls};
use hapticd_control::environment::{set_point, shares};
use hapticd_control::facing::Facing;
use hapticd_control::linear::{M3, V3};
use hapticd_control::scene::MAX_WALLS;
use proptest::prelude::*;

fn point() -> impl Strategy<Value = V3> {
    prop::array::uniform3(-0.1..0.1_f64).prop_map(V3::from)
}

fn x_sd(walls: &[Facing], x: &V3) -> V3 {
    set_point(walls, x, &V3::zeros()).x_sd
}

fn pull(walls: &[Facing], x: &V3) -> V3 {
    x_sd(walls, x) - x
}

/// D, column by column.
fn derivative(walls: &[Facing], x: &V3) -> M3 {
    let column = |i| set_point(walls, x, &V3::ith(i, 1.0)).xd_sd;
    M3::from_columns(&[column(0), column(1), column(2)])
}

/// Gradient of the envelope's objective at its claimed minimum; zero there and only there.
fn residual(walls: &[Facing], x: &V3) -> f64 {
    let z = x_sd(walls, x);
    let solid = walls.iter().filter(|wall| wall.eta < 1.0);
    let push = solid.map(|wall| {
        let n = V3::from(wall.normal);
        (1.0 - wall.eta) / wall.eta * (wall.offset_m - n.dot(&z)).max(0.0) * n
    });
    (z - x - push.sum::<V3>()).norm()
}

/// Soft enough for rounding to leave the gradient readable.
fn soft(walls: &[Facing]) -> Vec<Facing> {
    let soften = |w: &Facing| Facing {
        eta: w.eta.max(0.01),
        ..*w
    };
    walls.iter().map(soften).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(512))]

    #[test]
    fn one_wall_gives_the_blend_of_the_paper(
        n in unit(), offset_m in -0.05..0.05_f64, eta in 0.0..=1.0_f64, x in point(), xd in point(),
    ) {
        let found = set_point(&[wall(n, offset_m, eta)], &x, &xd);
        let depth = (offset_m - n.dot(&x)).max(0.0);
        let closing = if depth > 0.0 { n.dot(&xd) } else { 0.0 };
        prop_assert!((found.x_sd - (x + (1.0 - eta) * depth * n)).norm() < 1e-7 * 0.2);
        prop_assert!((found.xd_sd - (xd - (1.0 - eta) * closing * n)).norm() < 1e-7);
    }

    #[test]
    fn free_space_returns_the_tip_itself(walls in walls(8), x in point(), xd in point()) {
        let far: Vec<Facing> = walls.iter().map(|w| Facing { offset_m: -1.0, ..*w }).collect();
        let free: Vec<Facing> = walls.iter().map(|w| Facing { eta: 1.0, ..*w }).collect();
        for walls in [far, free] {
            let found = set_point(&walls, &x, &xd);
            prop_assert_eq!((found.x_sd, found.xd_sd), (x, xd));
        }
    }

    #[test]
    fn set_point_of_soft_walls_minimises_the_envelope(walls in walls(24), x in point()) {
        prop_assert!(residual(&soft(&walls), &x) < 1e-7);
    }

    #[test]
    fn shares_of_the_walls_add_up_to_the_pull(walls in walls(24), x in point()) {
        for walls in [soft(&walls), rigid_room(&walls)] {
            let found = set_point(&walls, &x, &V3::zeros());
            let mut share_m = vec![f64::NAN; walls.len()];
            shares(&walls, &found, &mut share_m);
            let normals = walls.iter().map(|wall| V3::from(wall.normal));
            let total: V3 = share_m.iter().zip(normals).map(|(share, n)| *share * n).sum();
            prop_assert!((total - (found.x_sd - x)).norm() < 1e-7);
            prop_assert!(share_m.iter().all(|share| *share >= 0.0));
        }
    }

    #[test]
    fn derivative_is_symmetric_between_zero_and_one(walls in walls(12), x in point()) {
        let d = derivative(&walls, &x);
        prop_assert!((d - d.transpose()).norm() < 1e-12);
        let eigenvalues = d.symmetric_eigenvalues();
        prop_assert!(eigenvalues.min() > 0.0 && eigenvalues.max() < 1.0 + 1e-12);
    }

    #[test]
    fn set_point_velocity_is_its_derivative(walls in walls(6), x in point(), xd in point()) {
        const DT_S: f64 = 1e-7;
        let ahead = x + DT_S * xd;
        let (here, there) = (derivative(&walls, &x), derivative(&walls, &ahead));
        prop_assume!(here == there);
        let slope = (x_sd(&walls, &ahead) - x_sd(&walls, &x)) / DT_S;
        prop_assert!((slope - set_point(&walls, &x, &xd).xd_sd).norm() < 1e-6);
    }

    #[test]
    fn stiffness_between_any_two_points_stays_below_one_rigid_wall(
        walls in walls(12), a in point(), b in point(),
    ) {
        let change = pull(&walls, &a) - pull(&walls, &b);
        prop_assert!(change.norm() <= (a - b).norm() + 1e-9);
    }

    /// A force field is the gradient of a convex potential, and so gives no energy around any
    /// loop in either sense, exactly when it is cyclically monotone (Rockafellar 1970, §24).
    #[test]
    fn no_energy_is_gained_around_any_closed_loop(
        walls in walls(5), corners in prop::collection::vec(point(), 2..9),
    ) {
        let following = corners.iter().cycle().skip(1);
        let (mut leaving, mut arriving) = (0.0, 0.0);
        for (from, to) in corners.iter().zip(following) {
            leaving += pull(&walls, from).dot(&(to - from));
            arriving += pull(&walls, to).dot(&(to - from));
        }
        prop_assert!(leaving > -1e-10 && arriving < 1e-10);
    }
}

/// Rigid walls that all leave the origin free.
fn rigid_room(walls: &[Facing]) -> Vec<Facing> {
    let solid = |w: &Facing| wall(w.normal.into(), -w.offset_m.abs(), 0.0);
    walls.iter().map(solid).collect()
}

/// The farthest point of a rigid room from the origin in one direction, at most `reach` away.
fn farthest(room: &[Facing], direction: &V3, reach: f64) -> V3 {
    let distance = room.iter().fold(reach, |distance, wall| {
        let closing = -V3::from(wall.normal).dot(direction);
        let depth = -wall.offset_m;
        if closing * distance > depth {
            depth / closing
        } else {
            distance
        }
    });
    distance * direction
}

/// The projection p of x on a convex room is the point inside it with (x−p)·(y−p) ≤ 0 for every
/// y inside it.
fn assert_projection(room: &[Facing], x: &V3, directions: &[V3]) -> Result<(), TestCaseError> {
    let p = x_sd(room, x);
    for wall in room {
        let depth = wall.offset_m - V3::from(wall.normal).dot(&p);
        prop_assert!(depth < 1e-6 * x.norm());
    }
    for direction in directions {
        let y = farthest(room, direction, 0.2);
        prop_assert!((x - p).dot(&(y - p)) < 1e-7);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn rigid_walls_hold_the_set_point_at_the_nearest_free_point(
        walls in walls(8), x in point(), directions in prop::collection::vec(unit(), 64),
    ) {
        assert_projection(&rigid_room(&walls), &x, &directions)?;
    }

    #[test]
    fn hundreds_of_rigid_walls_still_hold_the_nearest_free_point(
        walls in prop::collection::vec(any_wall(), MAX_WALLS),
        x in point(),
        directions in prop::collection::vec(unit(), 16),
    ) {
        assert_projection(&rigid_room(&walls), &x, &directions)?;
    }

    #[test]
    fn nearly_parallel_rigid_walls_still_hold_the_nearest_free_point(
        n in unit(), tilts in prop::collection::vec((unit(), -0.05..0.0_f64), 64), x in point(),
        directions in prop::collection::vec(unit(), 16),
    ) {
        let tilted = |(tilt, offset): &(V3, f64)| wall((n + 1e-4 * tilt).normalize(), *offset, 0.0);
        let room: Vec<Facing> = tilts.iter().map(tilted).collect();
        assert_projection(&room, &x, &directions)?;
    }

    #[test]
    fn hundreds_of_soft_walls_are_still_minimised(
        walls in prop::collection::vec(any_wall(), MAX_WALLS), x in point(),
    ) {
        prop_assert!(residual(&soft(&walls), &x) < 1e-7);
    }
}

#[test]
fn rigid_wall_holds_the_set_point_on_its_surface() {
    let z = x_sd(&[wall(V3::z(), 0.0, 0.0)], &V3::new(0.02, 0.0, -0.01));
    assert!((z - V3::new(0.02, 0.0, 0.0)).norm() < 2e-9);
}

#[test]
fn rigid_corner_holds_the_set_point_on_its_edge_and_in_its_vertex() {
    let walls = [V3::x(), V3::y(), V3::z()].map(|n| wall(n, 0.0, 0.0));
    let edge = x_sd(&walls, &V3::new(-0.01, -0.02, 0.03));
    let vertex = x_sd(&walls, &V3::new(-0.01, -0.02, -0.03));
    assert!((edge - V3::new(0.0, 0.0, 0.03)).norm() < 5e-9);
    assert!(vertex.norm() < 5e-9);
}

#[test]
fn many_copies_of_a_rigid_wall_are_one_rigid_wall() {
    let walls = [wall(V3::z(), 0.0, 0.0); MAX_WALLS];
    let found = set_point(&walls, &V3::new(0.0, 0.0, -0.01), &V3::new(1.0, 0.0, -1.0));
    assert!((found.x_sd - V3::zeros()).norm() < 1e-9);
    assert!((found.xd_sd - V3::x()).norm() < 1e-6);
}

#[test]
fn contradicting_rigid_walls_meet_in_the_middle() {
    let walls = [wall(V3::z(), 0.01, 0.0), wall(-V3::z(), 0.01, 0.0)];
    let found = x_sd(&walls, &V3::new(0.0, 0.0, 0.005));
    assert!(found.norm() < 1e-8);
}

#[test]
fn rigid_wall_that_the_set_point_only_grazes_has_no_share() {
    let walls = [
        wall(
            V3::new(-0.3629, -0.57006, 0.73711).normalize(),
            -0.0032484,
            0.0,
        ),
        wall(
            V3::new(0.83459, 0.10953, -0.53988).normalize(),
            -9.5326e-5,
            0.0,
        ),
        wall(V3::new(0.74555, 0.0, 0.66645).normalize(), -0.0051167, 0.0),
    ];
    let x = V3::new(0.031262, 0.055323, -0.069981);
    let found = set_point(&walls, &x, &V3::zeros());
    let mut share_m = [f64::NAN; 3];
    shares(&walls, &found, &mut share_m);
    let total: V3 = (0..3).map(|i| share_m[i] * V3::from(walls[i].normal)).sum();
    assert!((total - (found.x_sd - x)).norm() < 1e-7, "{share_m:?}");
}
