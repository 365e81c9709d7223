//! A twin: a plant behind the face a driver shows to the loop.

use crate::delay::Delay;
use crate::error::TwinError;
use crate::hhd::HhdPlant;
use crate::impairment::Impairments;
use crate::injection::Injection;
use crate::model::TwinModel;
use crate::noise::Noise;
use crate::phantom::PhantomPlant;
use crate::plant::Plant;
use crate::script::Script;
use crate::truth::Truth;
use hapticd_control::io::{Command, Exchange, Observation};
use hapticd_control::model::DeviceModel;

/// A simulated device with its operator. Same models, rate, seed and inputs: same run, bit by bit.
#[derive(Debug)]
pub struct Twin {
    plant: Box<dyn Plant>,
    impairments: Impairments,
    commands: Delay<Command>,
    noise: Noise,
    period_s: f64,
    ticks: u64,
    /// The last observation that arrived.
    observation: Observation,
    truth: Truth,
}

impl Twin {
    /// A twin at rest in the home pose, the hand off.
    ///
    /// # Errors
    /// [`TwinError`] when the models do not fit each other or a value makes no sense.
    pub fn new(
        device: &DeviceModel,
        model: &TwinModel,
        rate_hz: f64,
        seed: u64,
    ) -> Result<Self, TwinError> {
        model.check(device, rate_hz)?;
        let period_s = 1.0 / rate_hz;
        let plant: Box<dyn Plant> = match model {
            TwinModel::Phantom(model) => Box::new(PhantomPlant::new(device, model, period_s)?),
            TwinModel::Hhd(model) => Box::new(HhdPlant::new(device, model, period_s)?),
        };
        Ok(Self {
            truth: plant.truth(),
            plant,
            impairments: Impairments::new(
                rate_hz,
                device.joints.counts_per_rad[0],
                model.sensor_range_n(),
            ),
            commands: Delay::new(model.command_delay_ticks() as usize, Command::default()),
            noise: Noise::new(seed),
            period_s,
            ticks: 0,
            observation: Observation::default(),
        })
    }

    /// One exchange: latches the observation, then lives through one tick under `command`.
    ///
    /// So an observation never knows the command it is exchanged for, as on a real board. While
    /// nothing new arrives the observation is the last one.
    pub fn step(&mut self, command: &Command) -> (Exchange, Observation) {
        self.truth = self.plant.truth();
        let latched = self.latch();
        let exchange = self.impairments.exchange(&mut self.noise);
        if exchange == Exchange::Fresh {
            self.observation = latched;
        }
        let command = self.commands.pass(*command);
        self.plant.advance(&self.impairments.command(&command));
        self.impairments.tick();
        self.ticks += 1;
        (exchange, self.observation)
    }

    /// The sensors now, spoiled by what is injected.
    fn latch(&mut self) -> Observation {
        let mut observation = Observation {
            seq: self.ticks + 1,
            t_device_ns: (self.ticks as f64 * self.period_s * 1e9).round() as u64,
            ..Observation::default()
        };
        self.plant.observe(&mut observation, &mut self.noise);
        self.impairments.spoil(&mut observation);
        observation
    }

    /// Tells the hand what to do; an invalid script is ignored.
    pub fn hand(&mut self, script: Script) {
        self.plant.hand_mut().begin(script);
    }

    /// Injects a fault; an invalid injection is ignored.
    pub fn inject(&mut self, injection: Injection) {
        self.impairments.begin(injection);
    }

    /// The true state at the latch of the last observation.
    #[must_use]
    pub fn truth(&self) -> Truth {
        self.truth
    }
}
