//! The loop. One tick is: sleep, requests, exchange, control, publish. Nothing here allocates,
//! locks or calls the kernel, but for the sleep, the clock and the driver's exchange.

use crate::ack::{Ack, Outcome};
use crate::cadence::Cadence;
use crate::clock::{Clock, SECOND_NS};
use crate::driver::Driver;
use crate::ending::Ending;
use crate::event::{Miss, ServoEvent, StopReason, TickPart, What};
use crate::lease::LeaseGuard;
use crate::port::Port;
use crate::request::{Envelope, Request};
use crate::scheduling::{Obtained, Wish};
use crate::status::{Phase, Status, Timings};
use crate::watch::Watch;
use hapticd_control::controller::{Controller, TickInput};
use hapticd_control::io::{Command, Exchange, Observation};
use hapticd_control::record::TickRecord;
use hapticd_control::state::Event;
use std::sync::atomic::{AtomicBool, Ordering};

/// Requests taken in one tick: a burst is worked off over several ticks.
const REQUESTS_PER_TICK: usize = 4;
/// Time between two status blocks.
const STATUS_NS: u64 = SECOND_NS / 10;

/// What the loop was told before it started.
#[derive(Clone, Copy, Debug)]
pub struct Terms {
    /// Rate, Hz.
    pub rate_hz: f64,
    /// Time without a heartbeat after which the front counts as lost, ns.
    pub heartbeat_ns: u64,
    /// Time without a front after which the servo ends, ns; `None`: never.
    pub orphan_ns: Option<u64>,
    /// Scheduling asked for.
    pub wish: Wish,
    /// Scheduling in force.
    pub obtained: Obtained,
}

/// Durations of one tick, ns.
#[derive(Clone, Copy, Debug, Default)]
struct Durations {
    lateness_ns: u64,
    exchange_ns: u64,
    compute_ns: u64,
}

/// One device's loop on its way through time.
pub struct Loop<'r, D, C> {
    terms: Terms,
    clock: C,
    driver: D,
    controller: Controller,
    port: Port<'r>,
    cadence: Cadence,
    lease: LeaseGuard,
    watch: Watch,
    ending: Ending,
    timings: Timings,
    last: Durations,
    tick: u64,
    missed: u64,
    skipped: u64,
    applied: u64,
    request_id: u64,
    started_ns: u64,
    reported_ns: u64,
    observation: Observation,
    command: Command,
    record: TickRecord,
}

impl<'r, D: Driver, C: Clock> Loop<'r, D, C> {
    /// A loop at rest; the first tick is due one period from now.
    pub fn new(
        terms: Terms,
        controller: Controller,
        driver: D,
        port: Port<'r>,
        mut clock: C,
    ) -> Self {
        let started_ns = clock.now_ns();
        Self {
            terms,
            clock,
            driver,
            controller,
            port,
            cadence: Cadence::new((SECOND_NS as f64 / terms.rate_hz) as u64, started_ns),
            lease: LeaseGuard::default(),
            watch: Watch::default(),
            ending: Ending::default(),
            timings: Timings::default(),
            last: Durations::default(),
            tick: 0,
            missed: 0,
            skipped: 0,
            applied: 0,
            request_id: 0,
            started_ns,
            reported_ns: 0,
            observation: Observation::default(),
            command: Command::default(),
            record: TickRecord::default(),
        }
    }

    /// Ticks until `stop` is set, a request says so, or the front stays away; outputs fade first.
    pub fn run(&mut self, stop: &AtomicBool) -> StopReason {
        self.port.beat(self.started_ns);
        self.tell(What::Started, self.started_ns);
        self.port.set_phase(Phase::Running);
        loop {
            let now_ns = self.tick(stop.load(Ordering::Relaxed));
            if let Some(reason) = self.ending.due(self.command.enable, now_ns) {
                self.finish(reason, now_ns);
                return reason;
            }
        }
    }

    /// One tick. Returns the time at its end, ns.
    fn tick(&mut self, stop: bool) -> u64 {
        let deadline_ns = self.cadence.deadline_ns();
        self.clock.sleep_until_ns(deadline_ns);
        let woke_ns = self.clock.now_ns();
        self.port.beat(woke_ns);
        let front_alive = self.look_after_front(stop, woke_ns);
        self.take_requests(woke_ns);
        let mut durations = Durations {
            lateness_ns: woke_ns.saturating_sub(deadline_ns),
            ..Durations::default()
        };
        let exchange = self.exchange(&mut durations);
        self.control(woke_ns, exchange, front_alive, &mut durations);
        self.port.publish(&self.record);
        for what in self.watch.changes(&self.record, exchange, front_alive) {
            self.tell(what, woke_ns);
        }
        self.report_when_due(woke_ns);
        self.close(woke_ns, durations)
    }

    /// Whether the front is alive; begins the end where there is a reason to.
    fn look_after_front(&mut self, stop: bool, now_ns: u64) -> bool {
        let silence_ns = self.port.front_silence_ns(now_ns);
        let alone_ns = silence_ns.unwrap_or(now_ns - self.started_ns);
        if stop {
            self.end(StopReason::Requested, now_ns);
        } else if self
            .terms
            .orphan_ns
            .is_some_and(|limit_ns| alone_ns > limit_ns)
        {
            self.end(StopReason::Orphaned, now_ns);
        }
        silence_ns.is_some_and(|silence_ns| silence_ns <= self.terms.heartbeat_ns)
    }

    fn end(&mut self, reason: StopReason, now_ns: u64) {
        if self.ending.begin(reason, now_ns) {
            self.port.set_phase(Phase::Stopping);
            // Disabling is never refused.
            let _ = self.controller.event(Event::Disable);
        }
    }

    fn take_requests(&mut self, now_ns: u64) {
        for _ in 0..REQUESTS_PER_TICK {
            match self.port.take_request() {
                Ok(None) => return,
                Ok(Some(Ok(envelope))) => self.answer(&envelope, now_ns),
                Ok(Some(Err(id))) => self.acknowledge(id, Outcome::Malformed, 0, now_ns),
                Err(_) => self.tell(What::Garbled, now_ns),
            }
        }
    }

    fn answer(&mut self, envelope: &Envelope, now_ns: u64) {
        let withdrawal = envelope.request.is_withdrawal();
        let (outcome, interlocks) = if withdrawal || self.lease.admits(envelope.epoch) {
            self.apply(&envelope.request, now_ns)
        } else {
            (Outcome::StaleEpoch, 0)
        };
        self.request_id = envelope.id;
        self.applied += u64::from(outcome == Outcome::Applied);
        self.acknowledge(envelope.id, outcome, interlocks, now_ns);
    }

    /// Carries out a request; returns what became of it and the interlocks against it.
    fn apply(&mut self, request: &Request, now_ns: u64) -> (Outcome, u64) {
        match request {
            Request::Event(event) => match self.controller.event(*event) {
                Ok(()) => return (Outcome::Applied, 0),
                Err(refusal) => return (Outcome::Refused, refusal.interlocks),
            },
            Request::Scene(scene) => self.controller.adopt(scene),
            Request::Stop => self.end(StopReason::Requested, now_ns),
            Request::Hand(script) => match self.driver.twin() {
                Some(twin) => twin.hand(*script),
                None => return (Outcome::Unsupported, 0),
            },
            Request::Inject(injection) => match self.driver.twin() {
                Some(twin) => twin.inject(*injection),
                None => return (Outcome::Unsupported, 0),
            },
        }
        (Outcome::Applied, 0)
    }

    fn acknowledge(&mut self, id: u64, outcome: Outcome, interlocks: u64, now_ns: u64) {
        self.port.acknowledge(&Ack {
            id,
            tick: self.tick,
            t_mono_ns: now_ns,
            outcome,
            interlocks,
            state: self.controller.state() as u64,
        });
    }

    fn exchange(&mut self, durations: &mut Durations) -> Exchange {
        let before_ns = self.clock.now_ns();
        let exchange = self.driver.exchange(&self.command, &mut self.observation);
        durations.exchange_ns = self.clock.now_ns() - before_ns;
        exchange
    }

    fn control(
        &mut self,
        woke_ns: u64,
        exchange: Exchange,
        front_alive: bool,
        durations: &mut Durations,
    ) {
        let before_ns = self.clock.now_ns();
        let input = TickInput {
            tick: self.tick,
            t_mono_ns: woke_ns,
            exchange,
            observation: &self.observation,
            front_alive,
            late: self.skipped > 0,
            realtime_ok: self.terms.obtained.satisfies(self.terms.wish.realtime),
        };
        self.command = self.controller.tick(&input, &mut self.record);
        self.fill_record(durations.lateness_ns);
        durations.compute_ns = self.clock.now_ns() - before_ns;
    }

    /// The fields of the record that are the servo's.
    fn fill_record(&mut self, lateness_ns: u64) {
        let hand = self.driver.twin().map(|twin| twin.hand_truth());
        let (hand_position_m, hand_force_n) = hand.unwrap_or_default();
        self.record.request_id = self.request_id;
        self.record.hand_position_m = hand_position_m;
        self.record.hand_force_n = hand_force_n;
        self.record.lateness_ns = lateness_ns;
        self.record.exchange_ns = self.last.exchange_ns;
        self.record.compute_ns = self.last.compute_ns;
        self.record.missed_ticks = self.missed;
    }

    /// Counts the tick's durations and moves on to the next deadline.
    fn close(&mut self, woke_ns: u64, durations: Durations) -> u64 {
        self.timings.lateness.record(durations.lateness_ns);
        self.timings.exchange.record(durations.exchange_ns);
        self.timings.compute.record(durations.compute_ns);
        self.last = durations;
        let end_ns = self.clock.now_ns();
        self.skipped = self.cadence.advance(end_ns);
        if self.skipped > 0 {
            self.missed += self.skipped;
            let miss = durations.miss(self.skipped, end_ns - woke_ns);
            self.tell(What::Miss(miss), woke_ns);
        }
        self.tick += 1;
        end_ns
    }

    fn tell(&mut self, what: What, t_mono_ns: u64) {
        self.port.tell(&ServoEvent {
            tick: self.tick,
            t_mono_ns,
            what,
        });
    }

    fn report_when_due(&mut self, now_ns: u64) {
        if now_ns >= self.reported_ns + STATUS_NS {
            self.report(now_ns);
        }
    }

    fn report(&mut self, now_ns: u64) {
        self.reported_ns = now_ns;
        self.port.report(&Status {
            tick: self.tick,
            t_mono_ns: now_ns,
            state: self.controller.state() as u64,
            interlocks: self.controller.interlocks(),
            missed_ticks: self.missed,
            requests_applied: self.applied,
            wish: self.terms.wish,
            obtained: self.terms.obtained,
            timings: self.timings.clone(),
        });
    }

    /// The last words: outputs off to the device, then to the front.
    fn finish(&mut self, reason: StopReason, now_ns: u64) {
        self.driver
            .exchange(&Command::default(), &mut self.observation);
        self.tell(What::Stopped(reason), now_ns);
        self.report(now_ns);
        self.port.set_phase(Phase::Stopped);
    }
}

impl Durations {
    /// The context of deadlines missed in a tick that ended `awake_ns` after it woke.
    fn miss(&self, skipped: u64, awake_ns: u64) -> Miss {
        let parts = [
            (self.lateness_ns, TickPart::Wake),
            (self.exchange_ns, TickPart::Exchange),
            (self.compute_ns, TickPart::Compute),
            (
                awake_ns.saturating_sub(self.exchange_ns + self.compute_ns),
                TickPart::Rest,
            ),
        ];
        let longest = parts
            .into_iter()
            .max_by_key(|(duration_ns, _)| *duration_ns);
        Miss {
            skipped,
            part: longest.map_or(TickPart::Rest, |(_, part)| part),
            lateness_ns: self.lateness_ns,
            exchange_ns: self.exchange_ns,
            compute_ns: self.compute_ns,
        }
    }
}
