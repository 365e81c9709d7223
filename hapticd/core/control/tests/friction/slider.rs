//! A mass on a rubbing wall in closed loop: counts of an encoder, ticks, a tick of delay, a lag.

use crate::rubber::{wall, PERIOD_S};
use hapticd_control::estimate::JointState;
use hapticd_control::friction::FrictionRenderer;
use hapticd_control::linear::V3;
use hapticd_control::model::{DeviceModel, DriveModel};

const SUBSTEPS: usize = 20;

/// The tip of a device along one line, with a little friction of its own.
struct Slider {
    friction: FrictionRenderer,
    state: JointState,
    mass_kg: f64,
    viscous: f64,
    quantum_m: f64,
    lag_s: f64,
    keep: f64,
    position: f64,
    velocity: f64,
    given_n: f64,
    asked_n: f64,
    asked_next_n: f64,
}

impl Slider {
    fn new(model: &DeviceModel, mass_kg: f64, viscous: f64) -> Self {
        let home = V3::from(model.joints.home_rad);
        let lag_s = match &model.drive {
            DriveModel::Torque(drive) => drive.lag_s,
            DriveModel::Spring(drive) => drive.l_h[0] / (drive.r_25_ohm[0] - drive.r_hat_ohm[0]),
        };
        let radius_m = match model.dof {
            2 => 0.2,
            _ => 0.14,
        };
        let mut state = JointState::at(&model.kinematics, home, V3::zeros());
        state.x = V3::zeros();
        Self {
            friction: FrictionRenderer::new(model, PERIOD_S),
            state,
            mass_kg,
            viscous,
            quantum_m: radius_m / model.joints.counts_per_rad[1],
            lag_s,
            keep: (-model.estimator.lambda_rad_per_s * PERIOD_S).exp(),
            position: 0.0,
            velocity: 0.0,
            given_n: 0.0,
            asked_n: 0.0,
            asked_next_n: 0.0,
        }
    }

    /// One tick under a normal force and a pull of the hand that depends on the tip, N.
    fn tick(&mut self, normal_n: f64, pull_n: impl Fn(f64, f64) -> f64) {
        let counted = (self.position / self.quantum_m).floor() * self.quantum_m;
        let step = counted - self.state.x.x;
        self.state.xd.x = self.keep * self.state.xd.x + (1.0 - self.keep) * step / PERIOD_S;
        self.state.x.x = counted;
        let walls = [wall(1, V3::y(), normal_n)];
        self.asked_n = self.asked_next_n;
        self.asked_next_n = self.friction.force(&walls, &self.state, None).motor_n.x;
        let h = PERIOD_S / SUBSTEPS as f64;
        for _ in 0..SUBSTEPS {
            self.given_n += (self.asked_n - self.given_n) * (1.0 - (-h / self.lag_s).exp());
            let pull_n = pull_n(self.position, self.velocity);
            let force_n = self.given_n + pull_n - self.viscous * self.velocity;
            self.velocity += force_n / self.mass_kg * h;
            self.position += self.velocity * h;
        }
    }

    fn held_j(&self) -> f64 {
        0.5 * self.mass_kg * self.velocity * self.velocity
    }
}

fn hhd() -> Slider {
    Slider::new(&crate::rubber::hhd(), 1.0, 3.0)
}

fn phantom() -> Slider {
    // The grip's mass goes with the tip.
    Slider::new(&crate::rubber::phantom(), 0.1, 1.0)
}

/// Peak to peak of the position over the last ticks of a steady pull, and where it ends, m.
fn under_pull(slider: &mut Slider, normal_n: f64, pull_n: f64) -> (f64, f64) {
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for tick in 0..3000 {
        let risen = pull_n * (f64::from(tick) / 500.0).min(1.0);
        slider.tick(normal_n, |_, _| risen);
        if tick >= 2000 {
            low = low.min(slider.position);
            high = high.max(slider.position);
        }
    }
    (high - low, slider.position)
}

#[test]
fn steady_pull_below_the_static_force_neither_chatters_nor_drifts() {
    for (mut slider, normal_n) in [(hhd(), 20.0), (phantom(), 3.0)] {
        let (swing_m, before_m) = under_pull(&mut slider, normal_n, 0.5 * normal_n);
        assert!(swing_m < 2.0 * slider.quantum_m, "{swing_m}");
        let (_, after_m) = under_pull(&mut slider, normal_n, 0.5 * normal_n);
        assert!((after_m - before_m).abs() < 2.0 * slider.quantum_m);
    }
}

#[test]
fn pull_past_the_static_force_slides_against_the_kinetic_one() {
    for (mut slider, normal_n) in [(hhd(), 20.0), (phantom(), 3.0)] {
        let _ = under_pull(&mut slider, normal_n, 0.65 * normal_n);
        let before = slider.velocity;
        for _ in 0..100 {
            slider.tick(normal_n, |_, _| 0.65 * normal_n);
        }
        let damped_n = slider.viscous * 0.5 * (slider.velocity + before);
        let net_n = slider.mass_kg * (slider.velocity - before) / 0.1;
        let friction_n = 0.65 * normal_n - damped_n - net_n;
        assert!(
            (friction_n - 0.4 * normal_n).abs() < 0.03 * normal_n,
            "{friction_n}"
        );
    }
}

#[test]
fn tip_let_go_in_motion_stops_and_returns_no_more_than_the_anchor_held() {
    for (mut slider, normal_n) in [(hhd(), 20.0), (phantom(), 3.0)] {
        slider.velocity = 0.3;
        let mut furthest = 0.0_f64;
        let stretch_m = 2.0 * 0.6 * normal_n / 1000.0;
        let (mut anchor_j, mut least_j) = (0.0_f64, f64::INFINITY);
        for _ in 0..2000 {
            slider.tick(normal_n, |_, _| 0.0);
            furthest = furthest.max(slider.position);
            anchor_j = anchor_j.max(slider.friction.energy_j());
            least_j = least_j.min(slider.held_j());
            assert!(slider.held_j() <= least_j + anchor_j, "{}", slider.held_j());
        }
        let rest_m = slider.position;
        for _ in 0..500 {
            slider.tick(normal_n, |_, _| 0.0);
            let moved_m = (slider.position - rest_m).abs();
            assert!(moved_m < 2.0 * slider.quantum_m, "{moved_m}");
        }
        assert!(
            furthest - slider.position < stretch_m,
            "{furthest} {}",
            slider.position
        );
        let stopping_m = slider.mass_kg * 0.09 / 2.0 / (0.4 * normal_n);
        assert!(furthest < 1.1 * stopping_m, "{furthest} of {stopping_m}");
        assert!(furthest > 0.7 * stopping_m, "{furthest} of {stopping_m}");
    }
}

#[test]
fn slow_drag_by_a_soft_hand_sticks_and_slips() {
    let mut slider = hhd();
    let mut slips = 0;
    let mut before_n = 0.0;
    for tick in 0..6000 {
        let led_m = 0.01 * f64::from(tick) * PERIOD_S;
        slider.tick(20.0, |x, v| 800.0 * (led_m - x) + 10.0 * (0.01 - v));
        let force_n = slider.asked_next_n.abs();
        slips += u32::from(before_n > 11.0 && force_n < 9.0);
        before_n = force_n;
    }
    assert!((2..60).contains(&slips), "{slips} slips in 6 s");
}
