//! A twin of either shipped device with the few questions that tests ask.

use crate::models;
use hapticd_control::io::{Command, Exchange, Observation};
use hapticd_control::linear::V3;
use hapticd_control::model::DeviceModel;
use hapticd_twin::{Script, Twin, TwinModel};

pub const RATE_HZ: f64 = 1000.0;

pub struct Rig {
    pub twin: Twin,
    pub device: DeviceModel,
}

impl Rig {
    pub fn new((device, model): (DeviceModel, TwinModel), seed: u64) -> Self {
        let twin = Twin::new(&device, &model, RATE_HZ, seed).expect("shipped models fit");
        Self { twin, device }
    }

    pub fn phantom() -> Self {
        Self::new(models::phantom(), 1)
    }

    pub fn hhd() -> Self {
        Self::new(models::hhd(), 1)
    }

    pub fn tip(&self) -> V3 {
        self.twin.truth().tip_position_m.into()
    }

    pub fn hand_force(&self) -> V3 {
        self.twin.truth().hand_force_n.into()
    }

    pub fn push(&mut self, direction: [f64; 3], force_n: f64) {
        self.twin.hand(Script::Push {
            direction,
            force_n,
            speed_m_per_s: 0.1,
        });
    }

    /// Runs under one command; the last exchange.
    pub fn run(&mut self, duration_s: f64, command: &Command) -> (Exchange, Observation) {
        let mut last = self.twin.step(command);
        for _ in 1..(duration_s * RATE_HZ).round() as u64 {
            last = self.twin.step(command);
        }
        last
    }

    /// Runs with outputs off.
    pub fn rest(&mut self, duration_s: f64) -> (Exchange, Observation) {
        self.run(duration_s, &Command::default())
    }
}

/// A command with the brakes at a torque (N·m).
pub fn brakes(torque_nm: f64) -> Command {
    Command {
        enable: true,
        brake_torque_nm: [torque_nm, torque_nm, 0.0],
        ..Command::default()
    }
}
