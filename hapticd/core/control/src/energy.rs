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

/// What a first-order lag makes of a torque in one period.
#[derive(Clone, Copy, Debug)]
struct Lag {
    /// Share that is left at its end.
    retain: V3,
    /// Share of the torque at its start in the mean.
    before: V3,
    /// Share of the torque at its end in the mean.
    after: V3,
}

impl Lag {
    fn new(retain: &V3) -> Self {
        let shares = retain.map(shares);
        Self {
            retain: *retain,
            before: shares.map(|(before, _)| before),
            after: shares.map(|(_, after)| after),
        }
    }

    fn mean_nm(&self, before_nm: &V3, after_nm: &V3) -> V3 {
        self.before.component_mul(before_nm) + self.after.component_mul(after_nm)
    }
}

/// Shares of the torques at both ends in the mean of a period with the lag's retention `a`.
///
/// With the torque it tends to, (τ₁ − a τ₀)/(1 − a), the mean is
/// (τ₁ − a τ₀)/(1 − a) + (τ₀ − τ₁)/ln(1/a). Needs neither command nor motion.
fn shares(a: f64) -> (f64, f64) {
    let exponent = -a.ln();
    if a <= 0.0 {
        (0.0, 1.0)
    } else if exponent < SHORT {
        (0.5, 0.5)
    } else {
        let before = exponent.recip() - a / (1.0 - a);
        (before, 1.0 - before)
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
    fn advance(&mut self, lag: &Lag) {
        let before_nm = self.state_nm;
        self.state_nm = settle(&before_nm, &self.sent_nm, &lag.retain);
        self.push(lag.mean_nm(&before_nm, &self.state_nm));
    }

    fn push(&mut self, mean_nm: V3) {
        self.means_nm.copy_within(..DELAYS - 1, 1);
        self.means_nm[0] = mean_nm;
        for (sum_nm, mean_nm) in self.sums_nm.iter_mut().zip(&self.means_nm) {
            *sum_nm += mean_nm;
        }
    }

    /// Makes the sums since the last frame, `periods` ago, means.
    fn average(&mut self, periods: f64) {
        self.sums_nm
            .iter_mut()
            .for_each(|sum_nm| *sum_nm /= periods);
    }

    /// Begins a new frame.
    fn begin(&mut self) {
        self.sums_nm = [V3::zeros(); DELAYS];
    }

    /// Whether nothing of it is on its way.
    fn is_still(&self) -> bool {
        let ends = [&self.sent_nm, &self.state_nm].into_iter();
        let mut all = ends.chain(&self.means_nm).chain(&self.sums_nm);
        all.all(|torque_nm| *torque_nm == V3::zeros())
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
    /// Whether nothing changes any more until it is touched again.
    asleep: bool,
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

    /// Falls asleep once the contact is over and nothing is on its way.
    pub(crate) fn doze(&mut self) {
        self.asleep = self.free_s >= SEPARATION_S && self.course.is_still();
    }

    fn pay(&mut self, delay: usize, returned_j: f64) {
        self.reserve_j[delay] -= returned_j;
        if delay == EXCHANGE_TICKS {
            self.energy_j -= returned_j;
        }
    }

    fn rest(&mut self) {
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
    /// Keys of the accounts, side by side for the search.
    keys: [u64; ACCOUNTS],
    accounts: [Account; ACCOUNTS],
    /// Whether in this period no account was found that could give way.
    crowded: bool,
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
            keys: [0; ACCOUNTS],
            accounts: [Account::default(); ACCOUNTS],
            crowded: false,
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
        self.crowded = false;
        let lag = Lag::new(&span.retain);
        self.motors
            .push(lag.mean_nm(&span.before_nm, &span.after_nm));
        for account in &mut self.accounts[..self.count] {
            account.free_s += self.period_s;
            if !account.asleep {
                account.course.advance(&lag);
                account.rest();
            }
        }
    }

    /// Books what the joints moved since the last frame, `step_rad`: E −= Στ̄Δq, in full for the
    /// device, and split among the walls by what each had asked for. Brakes that have built up
    /// `brake_nm` take Σĉ|Δq| beside that, for the walls alone: motors make up for them.
    pub fn book(&mut self, step_rad: &V3, brake_nm: &V3) {
        let braked_j = brake_nm.dot(&step_rad.abs());
        let periods = f64::from(self.periods.max(1));
        self.periods = 0;
        self.motors.average(periods);
        let motors_nm = self.motors.sums_nm;
        self.motors.begin();
        let measured = self.measured;
        let known = if measured { 0 } else { EXCHANGE_TICKS };
        self.device_j -= motors_nm[known].dot(step_rad);
        let returned_j = core::array::from_fn(|delay| {
            let total_nm = motors_nm[if measured { 0 } else { delay }];
            total_nm.dot(step_rad) - braked_j
        });
        self.share(&returned_j, periods, step_rad);
    }

    /// Books one total for each delay. What is left of it goes to the walls by their weight.
    fn share(&mut self, returned_j: &[f64; DELAYS], periods: f64, step_rad: &V3) {
        let mut left_j = *returned_j;
        let mut weights = [0.0; DELAYS];
        for account in self.awake_mut() {
            account.course.average(periods);
            for (delay, own_nm) in account.course.sums_nm.iter().enumerate() {
                left_j[delay] -= own_nm.dot(step_rad);
                weights[delay] += own_nm.amax();
            }
        }
        for account in self.awake_mut() {
            for delay in (0..DELAYS).filter(|delay| weights[*delay] > 0.0) {
                let own_nm = account.course.sums_nm[delay];
                let part = own_nm.amax() / weights[delay];
                account.pay(delay, own_nm.dot(step_rad) + part * left_j[delay]);
            }
            account.course.begin();
        }
    }

    /// Begins a tick: no wall asks for anything yet.
    pub fn withdraw(&mut self) {
        for account in self.awake_mut() {
            account.touch = Touch::default();
            account.course.sent_nm = V3::zeros();
        }
    }

    /// Notes what a wall asks for. Walls that share an account ask together.
    pub fn ask(&mut self, asked: &Touch) {
        let slot = self.slot(asked.key);
        let account = &mut self.accounts[slot];
        account.free_s = 0.0;
        account.asleep = false;
        account.touch = Touch {
            key: asked.key,
            wall: asked.wall,
            force_n: account.touch.force_n + asked.force_n,
            depth_m: account.touch.depth_m.max(asked.depth_m),
            guarded: account.touch.guarded || asked.guarded,
        };
    }

    /// The accounts in use in which something may change.
    pub fn awake_mut(&mut self) -> impl Iterator<Item = &mut Account> {
        let used = self.accounts[..self.count].iter_mut();
        used.filter(|account| !account.asleep)
    }

    /// The account of a wall.
    #[must_use]
    pub fn account(&self, key: u64) -> Option<&Account> {
        self.find(key).map(|slot| &self.accounts[slot])
    }

    fn find(&self, key: u64) -> Option<usize> {
        self.keys[..self.count].iter().position(|kept| *kept == key)
    }

    fn open(&mut self, slot: usize, key: u64) -> usize {
        self.keys[slot] = key;
        self.accounts[slot] = Account::of(key);
        slot
    }

    /// The present account, else a new one, else that of the wall longest left alone, else the
    /// last, which further walls share.
    fn slot(&mut self, key: u64) -> usize {
        if let Some(slot) = self.find(key) {
            return slot;
        }
        if self.count < ACCOUNTS {
            self.count += 1;
            return self.open(self.count - 1, key);
        }
        if self.crowded {
            return ACCOUNTS - 1;
        }
        let mut longest = ACCOUNTS - 1;
        for (slot, account) in self.accounts.iter().enumerate() {
            if account.free_s > self.accounts[longest].free_s {
                longest = slot;
            }
        }
        self.crowded = self.accounts[longest].free_s < SEPARATION_S;
        if self.crowded {
            ACCOUNTS - 1
        } else {
            self.open(longest, key)
        }
    }

    /// Takes over what went out: `sent_nm` of the motors where `demand_nm` was wanted. Each wall
    /// answers for the share of its own torque that came through; the rest, such as friction,
    /// damping and slew, goes to the walls by their weight.
    pub fn send(&mut self, demand_nm: &V3, sent_nm: &V3) {
        let share = came_through(demand_nm, sent_nm);
        let mut left_nm = *sent_nm;
        let mut weights = 0.0;
        for account in self.awake_mut() {
            account.course.sent_nm *= share;
            left_nm -= account.course.sent_nm;
            weights += account.weight();
        }
        if weights > 0.0 {
            for account in self.awake_mut() {
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
