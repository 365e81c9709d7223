//! A controller whose tip is put where the workload says.

use crate::timing::{timed, Tick};
use hapticd_control::controller::{Controller, Event, TickInput};
use hapticd_control::io::{status, Exchange, Observation, AXES};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_control::record::TickRecord;
use hapticd_control::scene::Scene;

/// An enabled device among walls.
pub struct Driven {
    model: DeviceModel,
    controller: Box<Controller>,
    observation: Observation,
    record: Box<TickRecord>,
}

impl Driven {
    pub fn new(model: &DeviceModel, scene: &Scene) -> Self {
        let mut controller = Box::new(Controller::new(model, 1000.0).expect("model is sound"));
        controller.adopt(scene);
        Self {
            model: model.clone(),
            controller,
            observation: Observation {
                status: status::HOMED | status::FORCE_PRESENT | status::OUTPUTS_LIVE,
                ..Observation::default()
            },
            record: Box::default(),
        }
    }

    /// One tick with the tip at `x`, m.
    pub fn tick(&mut self, tick: u64, x: &V3) -> Tick {
        self.observation.seq += 1;
        self.observation.t_device_ns += 1_000_000;
        self.observation.counts = self.counts(x);
        if tick == 1 {
            let enabled = self.controller.event(Event::Enable);
            enabled.expect("nothing is in the way");
        }
        let input = TickInput {
            tick,
            t_mono_ns: tick * 1_000_000,
            exchange: Exchange::Fresh,
            observation: &self.observation,
            front_alive: true,
            late: false,
            realtime_ok: true,
        };
        let (_, time_ns) = timed(|| self.controller.tick(&input, &mut self.record));
        assert_eq!(self.record.faults, 0, "the run ended in a fault");
        Tick {
            time_ns,
            touching: self.record.contact_count > 0,
        }
    }

    /// Counts of the joints at `x`, m.
    fn counts(&self, x: &V3) -> [i64; AXES] {
        let joints = &self.model.joints;
        let q = self.model.kinematics.inverse(x);
        let q = q.expect("the tip is in reach");
        core::array::from_fn(|i| ((q[i] - joints.zero_rad[i]) * joints.counts_per_rad[i]) as i64)
    }
}
