//! Injected faults at work between plant and loop.

use crate::injection::{Injection, InjectionKind, INJECTION_KINDS};
use crate::noise::Noise;
use hapticd_control::io::{status, Command, Exchange, Observation};

/// How far [`Injection::EncoderJump`] shifts the first joint, rad.
const JUMP_RAD: f64 = 0.5;

/// The injected faults that have not healed yet.
#[derive(Clone, Copy, Debug)]
pub struct Impairments {
    rate_hz: f64,
    /// Encoder counts of [`JUMP_RAD`] on the first joint.
    jump_counts: i64,
    sensor_range_n: f64,
    remaining_ticks: [u64; INJECTION_KINDS],
    drop_fraction: f64,
}

impl Impairments {
    /// Nothing injected; ticks at `rate_hz`, the first encoder with `counts_per_rad`.
    #[must_use]
    pub fn new(rate_hz: f64, counts_per_rad: f64, sensor_range_n: f64) -> Self {
        Self {
            rate_hz,
            jump_counts: (JUMP_RAD * counts_per_rad).round() as i64,
            sensor_range_n,
            remaining_ticks: [0; INJECTION_KINDS],
            drop_fraction: 0.0,
        }
    }

    /// Begins a fault, or restarts it; an invalid one is ignored.
    pub fn begin(&mut self, injection: Injection) {
        if !injection.is_valid() {
            return;
        }
        let ticks = (injection.duration_s() * self.rate_hz).ceil() as u64;
        self.remaining_ticks[injection.kind() as usize] = ticks;
        if let Injection::DropFrames { fraction, .. } = injection {
            self.drop_fraction = fraction;
        }
    }

    fn active(&self, kind: InjectionKind) -> bool {
        self.remaining_ticks[kind as usize] > 0
    }

    /// What arrives of this tick's frame.
    pub fn exchange(&self, noise: &mut Noise) -> Exchange {
        if self.active(InjectionKind::Unplug) {
            return Exchange::Down;
        }
        let dropped =
            self.active(InjectionKind::DropFrames) && noise.uniform() < self.drop_fraction;
        if dropped || self.active(InjectionKind::Silence) {
            Exchange::Missing
        } else {
            Exchange::Fresh
        }
    }

    /// Spoils a true observation.
    pub fn spoil(&self, observation: &mut Observation) {
        if self.active(InjectionKind::NotFinite) {
            observation.force_n = [f64::NAN; 3];
            observation.motor_current_a = [f64::NAN; 3];
        }
        if self.active(InjectionKind::EncoderJump) {
            observation.counts[0] += self.jump_counts;
        }
        if self.active(InjectionKind::EstopInput) {
            observation.status |= status::ESTOP_INPUT;
        }
        if self.active(InjectionKind::SensorSaturated) {
            observation.status |= status::SENSOR_SATURATED;
            observation.force_n[0] = self.sensor_range_n;
        }
        if self.active(InjectionKind::AmplifierFault) {
            observation.status |= status::AMPLIFIER_FAULT;
        }
    }

    /// The command that really reaches the actuators.
    #[must_use]
    pub fn command(&self, command: &Command) -> Command {
        if self.active(InjectionKind::Unplug) || self.active(InjectionKind::AmplifierFault) {
            Command::default()
        } else {
            *command
        }
    }

    /// Ends one tick.
    pub fn tick(&mut self) {
        for remaining in &mut self.remaining_ticks {
            *remaining = remaining.saturating_sub(1);
        }
    }
}
