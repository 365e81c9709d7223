//! What the twin measures: encoder counts and the force at the tip.

use crate::model::ForceSensorModel;
use crate::noise::Noise;
use hapticd_control::linear::V3;
use hapticd_control::model::JointModel;

/// Encoder counts at joint angles `q` (rad); an axis without an encoder reads zero.
#[must_use]
pub fn counts(joints: &JointModel, q: &V3) -> [i64; 3] {
    core::array::from_fn(|i| {
        ((q[i] - joints.zero_rad[i]) * joints.counts_per_rad[i]).round() as i64
    })
}

/// Force sensor with bandwidth, bias, noise, resolution and range.
#[derive(Clone, Copy, Debug)]
pub struct ForceSensor {
    model: ForceSensorModel,
    /// Share of the way to the true force in one step.
    approach: f64,
    filtered: V3,
}

impl ForceSensor {
    /// An unloaded sensor in steps of `h` (s).
    #[must_use]
    pub fn new(model: &ForceSensorModel, h: f64) -> Self {
        let approach = 1.0 - (-core::f64::consts::TAU * model.bandwidth_hz * h).exp();
        Self {
            model: *model,
            approach,
            filtered: V3::zeros(),
        }
    }

    /// One step under the true force, N.
    pub fn step(&mut self, force: &V3) {
        self.filtered += (force - self.filtered) * self.approach;
    }

    /// A reading on the first `axes` axes, N, and whether one of them is at the end of the range.
    pub fn read(&self, axes: usize, noise: &mut Noise) -> (V3, bool) {
        let mut reading = V3::zeros();
        for i in 0..axes {
            let force =
                self.filtered[i] + self.model.bias_n[i] + self.model.noise_n * noise.normal();
            reading[i] = (force / self.model.lsb_n).round() * self.model.lsb_n;
        }
        let range = self.model.range_n;
        let saturated = reading.iter().any(|force| force.abs() >= range);
        (reading.map(|force| force.clamp(-range, range)), saturated)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ForceSensorModel = ForceSensorModel {
        bandwidth_hz: 300.0,
        noise_n: 0.0,
        lsb_n: 0.1,
        bias_n: [0.2, 0.0, 0.0],
        range_n: 300.0,
    };

    #[test]
    fn a_steady_force_reads_with_bias_in_whole_steps() {
        let mut sensor = ForceSensor::new(&MODEL, 1e-4);
        for _ in 0..1000 {
            sensor.step(&V3::new(10.04, -3.0, 5.0));
        }
        let (reading, saturated) = sensor.read(2, &mut Noise::new(1));
        assert!((reading - V3::new(10.2, -3.0, 0.0)).norm() < 1e-9);
        assert!(!saturated);
    }

    #[test]
    fn a_force_past_the_range_is_clipped_and_flagged() {
        let mut sensor = ForceSensor::new(&MODEL, 1.0);
        sensor.step(&V3::new(0.0, -400.0, 0.0));
        let (reading, saturated) = sensor.read(2, &mut Noise::new(1));
        assert!((reading[1] + 300.0).abs() < 1e-9);
        assert!(saturated);
    }

    #[test]
    fn noise_has_the_configured_size() {
        let noisy = ForceSensorModel {
            noise_n: 0.5,
            lsb_n: 1e-6,
            bias_n: [0.0; 3],
            ..MODEL
        };
        let sensor = ForceSensor::new(&noisy, 1e-4);
        let mut noise = Noise::new(3);
        let n = 20_000;
        let squares: f64 = (0..n)
            .map(|_| sensor.read(2, &mut noise).0[1].powi(2))
            .sum();
        assert!((squares / f64::from(n) - 0.25).abs() < 0.01);
    }
}
