//! A magnetic particle brake: hysteresis, dead time, lag, drag and ripple.

use crate::delay::Delay;
use crate::model::BrakeTwinModel;
use hapticd_control::model::BrakeModel;

/// The torque a brake can hold, behind the torque it is asked for.
#[derive(Clone, Debug)]
pub struct Brake {
    rated_nm: f64,
    half_width: f64,
    drag_nm: f64,
    ripple: f64,
    ripple_per_rad: f64,
    /// Share of the way to the new torque in one step.
    approach: f64,
    dead: Delay<f64>,
    /// Magnetisation z, fraction of rated.
    play: f64,
    torque_nm: f64,
}

impl Brake {
    /// The brake of joint `axis`, released; ticks of `period_s` in steps of `h` (s).
    #[must_use]
    pub fn new(
        nominal: &BrakeModel,
        model: &BrakeTwinModel,
        axis: usize,
        period_s: f64,
        h: f64,
    ) -> Self {
        let dead_ticks = (model.dead_time_s / period_s).round() as usize;
        Self {
            rated_nm: nominal.torque_max_nm[axis] * model.torque_scale[axis],
            half_width: nominal.hysteresis * model.hysteresis_scale,
            drag_nm: nominal.drag_nm[axis],
            ripple: model.ripple,
            ripple_per_rad: model.ripple_per_rad,
            approach: 1.0 - (-h / (nominal.lag_s * model.lag_scale)).exp(),
            dead: Delay::new(dead_ticks, 0.0),
            play: 0.0,
            torque_nm: 0.0,
        }
    }

    /// Takes the torque asked of the brake for this tick, as a fraction of rated.
    pub fn ask(&mut self, fraction: f64) {
        let u = self.dead.pass(fraction.clamp(0.0, 1.0));
        // Play operator: the output follows only when pushed by the edge of the loop.
        self.play = self.play.clamp(u - self.half_width, u + self.half_width);
    }

    /// One step; returns the torque the brake can hold at joint angle `q` (rad), N·m.
    pub fn step(&mut self, q: f64) -> f64 {
        self.torque_nm += self.approach * (self.rated_nm * self.play.max(0.0) - self.torque_nm);
        self.torque_nm
            * (1.0 + self.ripple * (core::f64::consts::TAU * self.ripple_per_rad * q).sin())
            + self.drag_nm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOMINAL: BrakeModel = BrakeModel {
        torque_max_nm: [10.0, 10.0, 0.0],
        lag_s: 0.05,
        dead_time_s: 0.0,
        hysteresis: 0.05,
        drag_nm: [0.4, 0.4, 0.0],
        omega_on_rad_per_s: 0.06,
        omega_off_rad_per_s: 0.02,
        hand_torque_min_nm: 0.15,
        release_on_stop: true,
    };
    const EXACT: BrakeTwinModel = BrakeTwinModel {
        torque_scale: [1.0; 3],
        lag_scale: 1.0,
        dead_time_s: 0.0,
        hysteresis_scale: 0.0,
        ripple: 0.0,
        ripple_per_rad: 0.0,
    };

    /// Torque beyond drag after each millisecond of a request.
    fn response(model: &BrakeTwinModel, requests: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut brake = Brake::new(&NOMINAL, model, 0, 1e-3, 1e-3);
        requests
            .map(|u| {
                brake.ask(u);
                brake.step(0.0) - NOMINAL.drag_nm[0]
            })
            .collect()
    }

    #[test]
    fn torque_rises_with_the_lag_of_the_data_sheet() {
        let torque = response(&EXACT, core::iter::repeat_n(1.0, 200));
        for (ms, share) in [(14, 0.25), (35, 0.5), (69, 0.75), (115, 0.9)] {
            assert!(
                (torque[ms - 1] / 10.0 - share).abs() < 0.01,
                "{ms} ms: {}",
                torque[ms - 1]
            );
        }
    }

    #[test]
    fn nothing_happens_during_the_dead_time() {
        let late = BrakeTwinModel {
            dead_time_s: 0.058,
            ..EXACT
        };
        let torque = response(&late, core::iter::repeat_n(1.0, 100));
        assert!(torque[..58].iter().all(|t| *t == 0.0));
        assert!(torque[58] > 0.0);
    }

    #[test]
    fn half_current_gives_less_on_the_way_up_than_on_the_way_down() {
        let wide = BrakeTwinModel {
            hysteresis_scale: 1.0,
            ..EXACT
        };
        let up_and_down = core::iter::repeat_n(0.5, 1000)
            .chain(core::iter::repeat_n(1.0, 1000))
            .chain(core::iter::repeat_n(0.5, 1000));
        let torque = response(&wide, up_and_down);
        assert!((torque[999] - 4.5).abs() < 1e-6);
        assert!((torque[2999] - 5.5).abs() < 1e-6);
    }

    #[test]
    fn residual_torque_stays_after_release() {
        let wide = BrakeTwinModel {
            hysteresis_scale: 1.0,
            ..EXACT
        };
        let torque = response(
            &wide,
            core::iter::repeat_n(1.0, 1000).chain(core::iter::repeat_n(0.0, 1000)),
        );
        assert!((torque[1999] - 0.5).abs() < 1e-6);
    }
}
