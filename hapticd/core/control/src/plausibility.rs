//! Whether an observation can be true (law 4): one that cannot is a fault, never a value.

use crate::estimate::JointState;
use crate::fault::{Fault, FaultSet, Severity};
use crate::io::{status, Exchange, Observation};
use crate::linear::V3;
use crate::model::{DeviceModel, JointModel, KinematicsModel, LimitModel};

/// What the loop may do with this tick's observation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reading {
    /// Use it: it is the first one, and the device counts as at rest.
    First,
    /// Use it: it lies `dt_s` after the one before.
    Fresh {
        /// Time between the encoder latches, s.
        dt_s: f64,
    },
    /// Nothing new: go on with the last command.
    Coast,
    /// There was none, and nothing to go on with.
    Nothing,
    /// There is one, and it cannot be true.
    Disbelieved,
}

/// A reading, and the faults found in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verdict {
    /// What to do.
    pub reading: Reading,
    /// What is wrong.
    pub faults: FaultSet,
}

/// The last observation that was believed.
#[derive(Clone, Copy, Debug)]
struct Believed {
    seq: u64,
    t_device_ns: u64,
    counts: [i64; 3],
    t_mono_ns: u64,
    ticks_ago: u32,
}

/// Judge of the observations of one device.
#[derive(Clone, Debug)]
pub struct Plausibility {
    kinematics: KinematicsModel,
    joints: JointModel,
    limits: LimitModel,
    period_s: f64,
    believed: Option<Believed>,
    missing: u32,
    lost: u64,
}

impl Plausibility {
    /// A judge that has seen nothing, called every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            kinematics: model.kinematics,
            joints: model.joints,
            limits: model.limits,
            period_s,
            believed: None,
            missing: 0,
            lost: 0,
        }
    }

    /// Ticks in a row without a new observation.
    #[must_use]
    pub fn missing(&self) -> u32 {
        self.missing
    }

    /// Frames lost since the start, by gaps of the frame counter.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// Judges one exchange, made at `t_mono_ns`. A frame seen before counts as missing, however
    /// fresh the driver calls it.
    pub fn judge(
        &mut self,
        exchange: Exchange,
        observation: &Observation,
        t_mono_ns: u64,
    ) -> Verdict {
        let repeated = self
            .believed
            .is_some_and(|believed| believed.seq == observation.seq);
        match exchange {
            Exchange::Down => self.forget(),
            Exchange::Fresh if !repeated => self.fresh(observation, t_mono_ns),
            Exchange::Fresh | Exchange::Missing => self.absent(),
        }
    }

    /// Faults in the motion that was estimated: faster, or further out, than the device can be.
    #[must_use]
    pub fn judge_motion(&self, state: &JointState) -> FaultSet {
        let mut faults = FaultSet::default();
        let slow = state.xd.norm() <= self.limits.tip_speed_m_per_s;
        raise(&mut faults, Fault::SpeedImplausible, !slow);
        let inside = self
            .kinematics
            .inside(&self.joints, &state.q, self.limits.joint_margin_rad);
        raise(&mut faults, Fault::OutsideWorkspace, !inside);
        faults
    }

    fn forget(&mut self) -> Verdict {
        self.believed = None;
        self.missing = 0;
        Verdict {
            reading: Reading::Nothing,
            faults: FaultSet::default(),
        }
    }

    fn absent(&mut self) -> Verdict {
        let mut faults = FaultSet::default();
        let Some(believed) = &mut self.believed else {
            return self.forget();
        };
        believed.ticks_ago = believed.ticks_ago.saturating_add(1);
        self.missing = self.missing.saturating_add(1);
        let gone = self.missing > self.limits.missing_ticks;
        raise(&mut faults, Fault::ObservationMissing, gone);
        Verdict {
            reading: Reading::Coast,
            faults,
        }
    }

    fn fresh(&mut self, observation: &Observation, t_mono_ns: u64) -> Verdict {
        self.missing = 0;
        let mut faults = self.judge_values(observation);
        let mut reading = Reading::First;
        if let Some(believed) = self.believed {
            let here_s = self.elapsed_here_s(&believed, t_mono_ns);
            let dt_s = self.elapsed_s(&believed, observation, here_s);
            reading = Reading::Fresh { dt_s };
            self.judge_clock(&believed, observation, here_s, &mut faults);
            self.judge_step(&believed, observation, dt_s, &mut faults);
        }
        if faults.severity() == Some(Severity::StopNow) {
            // The next observation starts anew: this one says nothing about where it will be.
            self.believed = None;
            reading = Reading::Disbelieved;
        } else {
            self.believe(observation, t_mono_ns);
        }
        Verdict { reading, faults }
    }

    fn believe(&mut self, observation: &Observation, t_mono_ns: u64) {
        if let Some(believed) = self.believed {
            let gap = observation.seq.saturating_sub(believed.seq + 1);
            self.lost = self.lost.saturating_add(gap);
        }
        self.believed = Some(Believed {
            seq: observation.seq,
            t_device_ns: observation.t_device_ns,
            counts: observation.counts,
            t_mono_ns,
            ticks_ago: 1,
        });
    }

    /// Time between two exchanges by our own clocks, s. The loop may have overrun, so that more
    /// time than the ticks passed.
    fn elapsed_here_s(&self, believed: &Believed, t_mono_ns: u64) -> f64 {
        let mono_s = t_mono_ns.saturating_sub(believed.t_mono_ns) as f64 * 1e-9;
        mono_s.max(f64::from(believed.ticks_ago) * self.period_s)
    }

    /// Time between two latches by the device's clock, s, as far as `here_s` bears it out: a
    /// clock that stands or leaps must not make a jump look slow.
    fn elapsed_s(&self, believed: &Believed, observation: &Observation, here_s: f64) -> f64 {
        device_s(believed, observation).clamp(0.5 * self.period_s, here_s + self.period_s)
    }

    fn judge_clock(
        &self,
        believed: &Believed,
        observation: &Observation,
        here_s: f64,
        faults: &mut FaultSet,
    ) {
        let backwards =
            observation.seq < believed.seq || observation.t_device_ns < believed.t_device_ns;
        raise(faults, Fault::SequenceBroken, backwards);
        let slack_s = f64::from(self.limits.missing_ticks) * self.period_s;
        let leapt = device_s(believed, observation) > here_s + slack_s;
        raise(faults, Fault::ObservationMissing, leapt);
    }

    fn judge_values(&self, observation: &Observation) -> FaultSet {
        let mut faults = FaultSet::default();
        let has = |bit: u64| observation.status & bit != 0;
        raise(&mut faults, Fault::Encoder, has(status::ENCODER_ERROR));
        let currents_finite = finite(&observation.motor_current_a);
        let bad_current = has(status::CURRENT_PRESENT) && !currents_finite;
        raise(&mut faults, Fault::ObservationNotFinite, bad_current);
        let present = has(status::FORCE_PRESENT);
        let force_finite = finite(&observation.force_n) && observation.force_age_s.is_finite();
        let bad_force = present && !force_finite;
        raise(&mut faults, Fault::ObservationNotFinite, bad_force);
        if self.limits.sensor_force_n > 0.0 {
            self.judge_sensor(observation, present, &mut faults);
        }
        faults
    }

    /// The force sensor of a device that has one: it speaks, lately, and within its range.
    fn judge_sensor(&self, observation: &Observation, present: bool, faults: &mut FaultSet) {
        let force_n = V3::from(observation.force_n).norm();
        let saturated = force_n >= self.limits.sensor_force_n
            || observation.status & status::SENSOR_SATURATED != 0;
        raise(faults, Fault::SensorSaturated, present && saturated);
        let current = (0.0..=self.limits.sensor_age_s).contains(&observation.force_age_s);
        raise(faults, Fault::SensorStale, !(present && current));
    }

    fn judge_step(
        &self,
        believed: &Believed,
        observation: &Observation,
        dt_s: f64,
        faults: &mut FaultSet,
    ) {
        let allowed_rad = self.limits.joint_jump_rad * (dt_s / self.period_s).max(1.0);
        let jumped = (0..3).any(|i| {
            let step = observation.counts[i] as f64 - believed.counts[i] as f64;
            step.abs() > allowed_rad * self.joints.counts_per_rad[i].abs()
        });
        raise(faults, Fault::EncoderJump, jumped);
    }
}

/// Time between two latches by the device's clock, s; zero where it ran backwards.
fn device_s(believed: &Believed, observation: &Observation) -> f64 {
    let elapsed_ns = observation.t_device_ns.saturating_sub(believed.t_device_ns);
    elapsed_ns as f64 * 1e-9
}

fn raise(faults: &mut FaultSet, fault: Fault, holds: bool) {
    if holds {
        faults.insert(fault);
    }
}

fn finite(values: &[f64; 3]) -> bool {
    values.iter().all(|value| value.is_finite())
}
