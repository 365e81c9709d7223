//! Energy and passivity in the tick: what the motors did is booked, what the walls ask for is
//! relieved, what goes out is noted.

use crate::brake::Brakes;
use crate::couple::JointDemand;
use crate::energy::{Ledger, Span, Touch};
use crate::estimate::JointState;
use crate::linear::V3;
use crate::model::DeviceModel;
use crate::passivity::{Passivity, Relief};
use crate::record::{TickRecord, NO_WALL};
use crate::render::touch::Touch as Touched;
use crate::stage::Stage;

/// The energies of one device, and the passivity control that watches them.
#[derive(Clone, Debug)]
pub struct Bookkeeper {
    ledger: Ledger,
    passivity: Passivity,
    relief: Relief,
    /// Joint torque of the motors at the last tick, N·m.
    before_nm: V3,
    /// Joint angles that were booked last, rad.
    booked_rad: Option<V3>,
    /// Joint velocities since then, rad/s, not filtered.
    qd: V3,
    /// Periods since then.
    periods: u32,
    period_s: f64,
    demand_nm: V3,
}

impl Bookkeeper {
    /// Nothing booked yet; used every `period_s`.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        Self {
            ledger: Ledger::new(period_s),
            passivity: Passivity::new(model, period_s),
            relief: Relief::default(),
            before_nm: V3::zeros(),
            booked_rad: None,
            qd: V3::zeros(),
            periods: 0,
            period_s,
            demand_nm: V3::zeros(),
        }
    }

    /// Books the period that ends now: the motors as `stage` has settled them, `measured` where
    /// their currents are, and the joints at `q` where there is a new frame.
    pub fn book(&mut self, stage: &Stage, measured: bool, q: Option<&V3>) {
        let motors = stage.motors();
        let after_nm = motors.given_nm();
        self.ledger.advance(&Span {
            before_nm: self.before_nm,
            after_nm,
            retain: motors.retain(),
            measured,
        });
        self.before_nm = after_nm;
        self.periods += 1;
        if let Some(q) = q {
            let before_rad = self.booked_rad.replace(*q).unwrap_or(*q);
            let brake_nm = stage.brakes().map_or_else(V3::zeros, Brakes::torque_nm);
            let step_rad = q - before_rad;
            self.ledger.book(&step_rad, &brake_nm);
            self.qd = step_rad / (f64::from(self.periods) * self.period_s);
            self.periods = 0;
        }
    }

    /// Forgets where the joints were: the next frame is a first one.
    pub fn begin(&mut self) {
        self.booked_rad = None;
    }

    /// Lets passivity control change what `touches` ask of `demand`.
    pub fn relieve(
        &mut self,
        touches: &[Touched],
        state: &JointState,
        stage: &Stage,
        demand: &mut JointDemand,
    ) {
        self.ledger.withdraw();
        for touched in touches {
            self.ledger.ask(&asked(touched));
        }
        let retain = stage.motors().retain();
        self.relief = self
            .passivity
            .control(&mut self.ledger, state, &self.qd, &retain);
        demand.add_motor_only(&state.jacobian, &self.relief.force_n);
        self.demand_nm = demand.torque_nm;
    }

    /// Notes what `stage` has put out of a new demand.
    pub fn note(&mut self, stage: &Stage) {
        self.ledger.send(&self.demand_nm, &stage.sent().motor_nm);
    }

    /// Whether passivity control acts.
    #[must_use]
    pub fn acts(&self) -> bool {
        self.relief.wall.is_some()
    }

    /// Fills in the energies; `touches` say which walls the record names.
    pub fn publish(&self, touches: &[Touched], record: &mut TickRecord) {
        record.device_energy_j = self.ledger.device_j();
        record.passivity_wall = self.relief.wall.map_or(NO_WALL, |wall| wall as u64);
        record.passivity_damping_n_s_per_m = self.relief.damping_n_s_per_m;
        for (place, wall) in record.touched_walls.iter().enumerate() {
            let touched = touches
                .iter()
                .find(|touched| touched.push.wall as u64 == *wall);
            let energy_j = touched.and_then(|touched| self.ledger.account(touched.push.key));
            record.touched_energy_j[place] = energy_j.map_or(0.0, |account| account.energy_j);
        }
    }
}

fn asked(touched: &Touched) -> Touch {
    let push = &touched.push;
    Touch {
        key: push.key,
        wall: push.wall,
        force_n: push.force_n * push.normal,
        depth_m: push.depth_m,
        guarded: touched.passivity,
    }
}
