//! Energy between the hand and the outputs: exact for torques that are held, lag and delay
//! included, for the device and for each wall.

use crate::actuator::settle;
use crate::linear::V3;

/// Delays reckoned with, in ticks: a torque acts at once, or one … three ticks after the command.
/// The exchange alone takes one: a command goes out at the latch after it was made.
pub const DELAYS: usize = 4;

/// The delay of every exchange, ticks.
pub const EXCHANGE_TICKS: usize = 1;

/// Walls whose energy is kept at the same time; all further ones share the last account.
pub const ACCOUNTS: usize = 32;

/// Time without touch after which a wall's energy counts from zero again, s (physics §6).
pub const SEPARATION_S: f64 = 0.05;

/// Exponent T/lag below which the mean over a period is the mean of its ends to 1e-9.
const SHORT: f64 = 1e-4;

/// Mean torque of a period, N·m, that begins with `before_nm`, ends with `after_nm` and follows
/// a first-order lag that leaves the share `retain` of a torque after one period.
///
/// With a = `retain` and the torque it tends to, (τ₁ − a τ₀)/(1 − a), the mean is
/// (τ₁ − a τ₀)/(1 − a) + (τ₀ − τ₁)/ln(1/a). Needs neither command nor motion.
#[must_use]
pub fn mean_nm(before_nm: &V3, after_nm: &V3, retain: &V3) -> V3 {
    V3::from_fn(|i, _| mean(before_nm[i], after_nm[i], retain[i]))
}

fn mean(before: f64, after: f64, a: f64) -> f64 {
    let exponent = -a.ln();
    if a <= 0.0 {
        after
    } else if exponent < SHORT {
        0.5 * (before + after)
    } else {
        (after - a * before) / (1.0 - a) + (before - after) / exponent
    }
}

/// What the motors did in the period that ends now.
#[derive(Clone, Copy, Debug, Default)]
pub struct Span {
    /// Joint torque at its start, N·m.
    pub before_nm: V3,
    /// Joint torque at its end, N·m.
    pub after_nm: V3,
    /// Share of a torque that is left after one period.
    pub retain: V3,
    /// Whether the torques are measured; by the model they are still to be delayed.
    pub measured: bool,
}

/// Torque of one cause on its way: through the lag, then through every delay reckoned with.
#[derive(Clone, Copy, Debug, Default)]
pub struct Course {
    /// Asked for in the last command, N·m.
    pub sent_nm: V3,
    /// What the lag makes of it at the end of its period, N·m.
    pub state_nm: V3,
    /// Mean torques of the last periods, newest first, N·m.
    pub means_nm: [V3; DELAYS],
    /// Sums of them since the last frame, N·m, one per delay.
    sums_nm: [V3; DELAYS],
}

impl Course {
    fn advance(&mut self, retain: &V3) {
        let before_nm = self.state_nm;
        self.state_nm = settle(&before_nm, &self.sent_nm, retain);
        self.push(mean_nm(&before_nm, &self.state_nm, retain));
    }

    fn push(&mut self, mean_nm: V3) {
        self.means_nm.copy_within(..DELAYS - 1, 1);
        self.means_nm[0] = mean_nm;
        for (sum_nm, mean_nm) in self.sums_nm.iter_mut().zip(&self.means_nm) {
            *sum_nm += mean_nm;
        }
    }

    /// Mean torques since the last frame, `periods` ago, N·m, one per delay; begins anew.
    fn take(&mut self, periods: f64) -> [V3; DELAYS] {
        core::mem::take(&mut self.sums_nm).map(|sum_nm| sum_nm / periods)
    }
}

/// The energy of one wall.
#[derive(Clone, Copy, Debug, Default)]
pub struct Account {
    /// Key of the wall.
    pub key: u64,
    /// Its torque.
    pub course: Course,
    /// Energy it took from the hand in this contact, less what it gave back, J; with the delay
    /// of the exchange alone.
    pub energy_j: f64,
    /// Energy it may give back, J, for each delay. Passivity control caps it; debts stay.
    pub reserve_j: [f64; DELAYS],
    /// What it asks for in this tick.
    pub touch: Touch,
    /// Time since it was touched, s.
    free_s: f64,
}

/// What one wall asks for in one tick, summed over its surfaces and over scenes in cross-fade.
#[derive(Clone, Copy, Debug, Default)]
pub struct Touch {
    /// Key of the wall.
    pub key: u64,
    /// Its index in the newest scene.
    pub wall: usize,
    /// Force on the tip, N.
    pub force_n: V3,
    /// Depth, m.
    pub depth_m: f64,
    /// Whether passivity control guards it.
    pub guarded: bool,
}

impl Account {
    fn of(key: u64) -> Self {
        Self {
            key,
            ..Self::default()
        }
    }

    /// How much of the torques that no wall asked for it answers for.
    fn weight(&self) -> f64 {
        self.course.state_nm.amax() + self.course.sent_nm.amax()
    }

    fn pay(&mut self, delay: usize, returned_j: f64) {
        self.reserve_j[delay] -= returned_j;
        if delay == EXCHANGE_TICKS {
            self.energy_j -= returned_j;
        }
    }

    fn rest(&mut self, period_s: f64) {
        self.free_s += period_s;
        if self.free_s >= SEPARATION_S {
            self.energy_j = 0.0;
            self.reserve_j = self.reserve_j.map(|reserve_j| reserve_j.min(0.0));
        }
    }
}

/// The energies of one device and its walls.
#[derive(Clone, Debug)]
pub struct Ledger {
    period_s: f64,
    motors: Course,
    device_j: f64,
    measured: bool,
    /// Periods since the last frame.
    periods: u32,
    count: usize,
    accounts: [Account; ACCOUNTS],
}

impl Ledger {
    /// A ledger that nothing was booked in, used every `period_s`.
    #[must_use]
    pub fn new(period_s: f64) -> Self {
        Self {
            period_s,
            motors: Course::default(),
            device_j: 0.0,
            measured: false,
            periods: 0,
            count: 0,
            accounts: [Account::default(); ACCOUNTS],
        }
    }

    /// Energy the motors took from the hand since start, less what they gave back, J.
    #[must_use]
    pub fn device_j(&self) -> f64 {
        self.device_j
    }

    /// The accounts in use.
    #[must_use]
    pub fn accounts(&self) -> &[Account] {
        &self.accounts[..self.count]
    }

    /// Lets the period pass in which the last command was sent. To be called every tick.
    pub fn advance(&mut self, span: &Span) {
        self.periods += 1;
        self.measured = span.measured;
        self.motors
            .push(mean_nm(&span.before_nm, &span.after_nm, &span.retain));
        for account in &mut self.accounts[..self.count] {
            account.course.advance(&span.retain);
            account.rest(self.period_s);
        }
    }

    /// Books what the joints moved since the last frame, `step_rad`: E −= Στ̄Δq, in full for the
    /// device, and split among the walls by what each had asked for. Brakes that have built up
    /// `brake_nm` take Σĉ|Δq| beside that, for the walls alone: motors make up for them.
    pub fn book(&mut self, step_rad: &V3, brake_nm: &V3) {
        let braked_j = brake_nm.dot(&step_rad.abs());
        let periods = f64::from(self.periods.max(1));
        self.periods = 0;
        let motors_nm = self.motors.take(periods);
        let known = if self.measured { 0 } else { EXCHANGE_TICKS };
        self.device_j -= motors_nm[known].dot(step_rad);
        let mut walls_nm = [[V3::zeros(); DELAYS]; ACCOUNTS];
        for (torques_nm, account) in walls_nm.iter_mut().zip(&mut self.accounts[..self.count]) {
            *torques_nm = account.course.take(periods);
        }
        for delay in 0..DELAYS {
            let total_nm = motors_nm[if self.measured { 0 } else { delay }];
            let returned_j = total_nm.dot(step_rad) - braked_j;
            self.share(delay, returned_j, &walls_nm, step_rad);
        }
    }

    /// Books one delay. What is left of the total goes to the walls by their weight.
    fn share(
        &mut self,
        delay: usize,
        returned_j: f64,
        walls_nm: &[[V3; DELAYS]; ACCOUNTS],
        step_rad: &V3,
    ) {
        let own_nm = |wall: usize| walls_nm[wall][delay];
        let asked_nm: V3 = (0..self.count).map(own_nm).sum();
        let left_j = returned_j - asked_nm.dot(step_rad);
        let weight = |wall: usize| own_nm(wall).amax();
        let weights: f64 = (0..self.count).map(weight).sum();
        if weights > 0.0 {
            for (wall, account) in self.accounts[..self.count].iter_mut().enumerate() {
                let own_j = walls_nm[wall][delay].dot(step_rad);
                let part = walls_nm[wall][delay].amax() / weights;
                account.pay(delay, own_j + part * left_j);
            }
        }
    }

    /// Begins a tick: no wall asks for anything yet.
    pub fn withdraw(&mut self) {
        for account in &mut self.accounts[..self.count] {
            account.touch = Touch::default();
            account.course.sent_nm = V3::zeros();
        }
    }

    /// Notes what a wall asks for. Walls that share an account ask together.
    pub fn ask(&mut self, asked: &Touch) {
        let slot = self.slot(asked.key);
        let account = &mut self.accounts[slot];
        account.free_s = 0.0;
        account.touch = Touch {
            key: asked.key,
            wall: asked.wall,
            force_n: account.touch.force_n + asked.force_n,
            depth_m: account.touch.depth_m.max(asked.depth_m),
            guarded: account.touch.guarded || asked.guarded,
        };
    }

    /// The accounts in use, to be changed.
    pub fn accounts_mut(&mut self) -> &mut [Account] {
        &mut self.accounts[..self.count]
    }

    /// The present account, else a new one, else that of the wall longest left alone, else the
    /// last, which further walls share.
    fn slot(&mut self, key: u64) -> usize {
        if let Some(slot) = self.accounts().iter().position(|kept| kept.key == key) {
            return slot;
        }
        if self.count < ACCOUNTS {
            self.accounts[self.count] = Account::of(key);
            self.count += 1;
            return self.count - 1;
        }
        let mut longest = ACCOUNTS - 1;
        for (slot, account) in self.accounts.iter().enumerate() {
            if account.free_s > self.accounts[longest].free_s {
                longest = slot;
            }
        }
        if self.accounts[longest].free_s >= SEPARATION_S {
            self.accounts[longest] = Account::of(key);
            longest
        } else {
            ACCOUNTS - 1
        }
    }

    /// Takes over what went out: `sent_nm` of the motors where `demand_nm` was wanted. Each wall
    /// answers for the share of its own torque that came through; the rest, such as friction,
    /// damping and slew, goes to the walls by their weight.
    pub fn send(&mut self, demand_nm: &V3, sent_nm: &V3) {
        let share = came_through(demand_nm, sent_nm);
        let mut left_nm = *sent_nm;
        let mut weights = 0.0;
        for account in &mut self.accounts[..self.count] {
            account.course.sent_nm *= share;
            left_nm -= account.course.sent_nm;
            weights += account.weight();
        }
        if weights > 0.0 {
            for account in &mut self.accounts[..self.count] {
                let part = account.weight() / weights;
                account.course.sent_nm += part * left_nm;
            }
        }
    }
}

/// The share s that brings s·demand nearest to what was sent.
fn came_through(demand_nm: &V3, sent_nm: &V3) -> f64 {
    let square = demand_nm.norm_squared();
    if square > 0.0 {
        sent_nm.dot(demand_nm) / square
    } else {
        0.0
    }
}
