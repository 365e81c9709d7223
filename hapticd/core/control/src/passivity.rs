//! Passivity: no guarded wall gives back more energy than it took (physics §6).
//!
//! A time-domain observer and controller (Hannaford & Ryu 2002) on the energy of the force that
//! was really applied, with two additions that make it a guarantee. The damping that it adds on
//! the way in follows a reference energy (Ryu et al.): the wall takes what an ideal spring would
//! store, although its force comes late. On the way out damping alone could not keep the promise,
//! because it acts when the energy is already spent; there the force is limited beforehand by
//! what the wall has stored.

use crate::energy::{Account, Course, Ledger, DELAYS, EXCHANGE_TICKS};
use crate::estimate::JointState;
use crate::linear::V3;
use crate::model::{DeviceModel, DriveModel};

/// Quanta of the encoders, at the tip, that no estimate resolves.
const QUANTA: f64 = 2.0;

/// Share of the tip's mass that is reckoned with: its velocity is known half a tick late, which
/// in the horizon of two ticks and lag weighs as much as a third of the mass.
const MASS_SHARE: f64 = 0.75;

/// Share of m/h, the damping past which a damper that acts h late turns the tip round.
const DAMPING_SHARE: f64 = 0.5;

/// Ticks at most in which the slew limit lets a force be withdrawn.
const SLEW_TICKS: u32 = 32;

/// Share of the force by which it must be changed to count as control.
const NOTABLE: f64 = 1e-3;

/// What passivity control does in one tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relief {
    /// Force to be added at the tip, N.
    pub force_n: V3,
    /// The wall it changes most, as index in the newest scene.
    pub wall: Option<usize>,
    /// The damping that this change amounts to, N·s/m.
    pub damping_n_s_per_m: f64,
}

/// Passivity control of one device.
#[derive(Clone, Copy, Debug)]
pub struct Passivity {
    period_s: f64,
    /// Longest delay reckoned with, ticks.
    last_delay: usize,
    /// Mass that the hand may leave to the wall, kg.
    mass_kg: f64,
    /// Largest force at the tip, N.
    force_max_n: f64,
    /// Joint stiffness that the motors have by nature, ρ² k_T²/L, N·m/rad; zero for torque drives.
    natural_nm_per_rad: V3,
    /// Energy below what the encoders resolve, J: a wall may owe it.
    tolerance_j: f64,
    /// Speed below which the estimate is noise, m/s.
    speed_min_m_per_s: f64,
    /// Largest change of the tip's force in one tick, N.
    slew_n: f64,
    /// Largest damping, N·s/m.
    damping_max_n_s_per_m: f64,
}

impl Passivity {
    /// Passivity control of a device that is used every `period_s`.
    ///
    /// The tolerance is the largest force over two encoder quanta; the smallest speed is two
    /// quanta a tick behind the velocity filter; the largest damping is half of m/h with h the
    /// periods, lag and filter between a motion and the force that answers it.
    #[must_use]
    pub fn new(model: &DeviceModel, period_s: f64) -> Self {
        let quantum_m = quantum_m(model);
        let lambda = model.estimator.lambda_rad_per_s;
        let passed = 1.0 - (-lambda * period_s).exp();
        let (natural_nm_per_rad, lag_s) = drive(&model.drive);
        let last_delay = (EXCHANGE_TICKS + model.limits.delay_spare_ticks).min(DELAYS - 1);
        let late_s = (1 + last_delay) as f64 * period_s + lag_s + lambda.recip();
        Self {
            period_s,
            last_delay,
            mass_kg: MASS_SHARE * model.tip.mass_kg,
            force_max_n: model.limits.tip_force_n,
            natural_nm_per_rad,
            tolerance_j: QUANTA * quantum_m * model.limits.tip_force_n,
            speed_min_m_per_s: QUANTA * quantum_m / period_s * passed,
            slew_n: model.limits.tip_slew_n_per_s * period_s,
            damping_max_n_s_per_m: DAMPING_SHARE * model.tip.mass_kg / late_s,
        }
    }

    /// Energy that a wall may owe at most while the hand's own pull is slower than the delay, J.
    #[must_use]
    pub fn tolerance_j(&self) -> f64 {
        self.tolerance_j
    }

    /// Largest damping, N·s/m.
    #[must_use]
    pub fn damping_max_n_s_per_m(&self) -> f64 {
        self.damping_max_n_s_per_m
    }

    /// Decides for every wall that asked, and notes in the ledger what each will answer for. `qd`
    /// are the joint velocities since the last frame, rad/s: late by half a tick where the filter
    /// is later. `retain` is the share of a torque left after one period.
    pub fn control(&self, ledger: &mut Ledger, state: &JointState, qd: &V3, retain: &V3) -> Relief {
        let mut relief = Relief::default();
        if ledger.accounts().is_empty() {
            return relief;
        }
        let now = Now {
            state,
            xd: state.jacobian * qd,
            lag_s: retain.map(|a| lag_s(a, self.period_s)),
            slew_n: self.slew_n / (1.0 - retain.min()),
        };
        let mut largest_n = 0.0;
        for account in ledger.awake_mut() {
            let asked_n = account.touch.force_n.norm();
            if asked_n <= 0.0 {
                self.forget(account);
                continue;
            }
            let normal = account.touch.force_n / asked_n;
            let change = self.decide(account, &normal, &now);
            let given_n = account.touch.force_n + change.force_n * normal;
            account.course.sent_nm = state.jacobian.tr_mul(&given_n);
            relief.force_n += change.force_n * normal;
            if change.force_n.abs() > NOTABLE * self.force_max_n && change.force_n.abs() > largest_n
            {
                largest_n = change.force_n.abs();
                relief.wall = Some(account.touch.wall);
                relief.damping_n_s_per_m = change.damping_n_s_per_m;
            }
        }
        relief
    }

    /// A wall that asks for nothing has nothing stored but what is still on its way.
    fn forget(&self, account: &mut Account) {
        let on_its_way_j =
            self.force_max_n * self.force_max_n * self.period_s * self.period_s / self.mass_kg;
        for reserve_j in &mut account.reserve_j {
            *reserve_j = reserve_j.min(on_its_way_j);
        }
        account.doze();
    }

    fn decide(&self, account: &mut Account, normal: &V3, now: &Now<'_>) -> Change {
        let ask = Ask {
            force_n: account.touch.force_n.norm(),
            depth_m: account.touch.depth_m,
            max_n: self.force_max_n,
        };
        let per_metre = now.state.jacobian_inverse * normal;
        let outward = normal.dot(&now.state.xd).max(normal.dot(&now.xd));
        let mut limit_n = f64::INFINITY;
        let mut taken_j = f64::INFINITY;
        for delay in EXCHANGE_TICKS..=self.last_delay {
            let flight = self.flight(&account.course, &per_metre, delay, now);
            let back_j = self.back_j(&flight, outward);
            let reserve_j = &mut account.reserve_j[delay];
            *reserve_j = reserve_j.min(ask.stored_j() + back_j);
            if !account.touch.guarded {
                *reserve_j = reserve_j.max(0.0);
                continue;
            }
            limit_n = limit_n.min(self.limit_n(*reserve_j, &flight, outward));
            taken_j = taken_j.min(*reserve_j - flight.impulse_n_s * outward.min(0.0));
        }
        if account.touch.guarded {
            self.change(&ask, limit_n, ask.stored_j() - taken_j, outward)
        } else {
            Change::default()
        }
    }

    /// The PO/PC damping on the way in, and the limit on everything.
    fn change(&self, ask: &Ask, limit_n: f64, missing_j: f64, outward: f64) -> Change {
        let inward = (-outward).max(0.0);
        let speed = outward.abs().max(self.speed_min_m_per_s);
        let wanted = missing_j.max(0.0) / (self.period_s * speed * speed);
        let damping = wanted.min(self.damping_max_n_s_per_m);
        let given_n = ask.held_n() + damping * inward;
        if limit_n < given_n {
            let force_n = limit_n - ask.force_n;
            return Change {
                force_n,
                damping_n_s_per_m: (ask.held_n() - limit_n).max(0.0) / speed,
            };
        }
        Change {
            force_n: damping * inward,
            damping_n_s_per_m: if inward > 0.0 { damping } else { 0.0 },
        }
    }

    /// What commands of the past will still do under `delay`.
    fn flight(&self, course: &Course, per_metre: &V3, delay: usize, now: &Now<'_>) -> Flight {
        let on_its_way: V3 = course.means_nm[..delay].iter().sum();
        let impulse = self.period_s * on_its_way + now.lag_s.component_mul(&course.state_nm);
        let forces_n = course.means_nm[..delay]
            .iter()
            .map(|mean| per_metre.dot(mean));
        Flight {
            impulse_n_s: per_metre.dot(&impulse).max(0.0),
            force_n: forces_n.fold(per_metre.dot(&course.state_nm).max(0.0), f64::max),
            stiffness_n_per_m: self
                .natural_nm_per_rad
                .dot(&per_metre.component_mul(per_metre)),
            slew_n: now.slew_n,
        }
    }

    /// Energy, J, that the impulse on its way gives back if the hand lets go now: what it adds
    /// to the kinetic energy of the bare tip, or what its motors' own spring can hold.
    fn back_j(&self, flight: &Flight, outward: f64) -> f64 {
        let moving_j = flight.impulse_n_s * outward.max(0.0);
        moving_j + (flight.impulse_n_s.powi(2) / (2.0 * self.mass_kg)).min(flight.spring_j())
    }

    /// Largest force for one tick, N, that together with what is on its way does not give the
    /// bare tip, moving out at `outward`, m/s, more energy than the wall has.
    ///
    /// Kinetic: ½m((v + I/m)² − v²) ≤ A for the impulse I = J + FT; it bounds I·v, the energy
    /// given to a hand too heavy to be accelerated, as well. By the motors' own spring K_L, whose
    /// force falls as it moves: I v + F²/2K_L ≤ A.
    fn limit_n(&self, reserve_j: f64, flight: &Flight, outward: f64) -> f64 {
        let (m, t) = (self.mass_kg, self.period_s);
        let available_j = (reserve_j + self.tolerance_j).max(0.0);
        let v = outward.max(0.0);
        let gained = m * ((v * v + 2.0 * available_j / m).sqrt() - outward);
        let kinetic_n = withdrawable_n((gained - flight.impulse_n_s) / t, flight.slew_n);
        let k = flight.stiffness_n_per_m;
        let spare_j = available_j - flight.impulse_n_s * v;
        let spring_n = if k > 0.0 && spare_j > 0.0 {
            k * ((t * t * v * v + 2.0 * spare_j / k).sqrt() - t * v)
        } else {
            0.0
        };
        kinetic_n.max(spring_n).max(0.0)
    }
}

/// The tip in one tick.
struct Now<'a> {
    state: &'a JointState,
    /// Velocity since the last frame, m/s, not filtered.
    xd: V3,
    /// First-order lag of the motors, s.
    lag_s: V3,
    /// Step of a commanded force that the slew limit lets pass in one tick, N.
    slew_n: f64,
}

/// Force added along the normal, N, and the damping it amounts to.
#[derive(Clone, Copy, Default)]
struct Change {
    force_n: f64,
    damping_n_s_per_m: f64,
}

/// What is on its way to the tip along a normal.
struct Flight {
    impulse_n_s: f64,
    force_n: f64,
    /// Of the motors by nature.
    stiffness_n_per_m: f64,
    /// Step of a commanded force that the slew limit lets pass in one tick.
    slew_n: f64,
}

impl Flight {
    fn spring_j(&self) -> f64 {
        if self.stiffness_n_per_m > 0.0 {
            self.force_n * self.force_n / (2.0 * self.stiffness_n_per_m)
        } else {
            f64::INFINITY
        }
    }
}

/// What a wall asks for.
struct Ask {
    force_n: f64,
    depth_m: f64,
    max_n: f64,
}

impl Ask {
    /// Force that the device can give of it, N.
    fn held_n(&self) -> f64 {
        self.force_n.min(self.max_n)
    }

    /// Energy of a spring with this force at this depth that yields at the device's largest
    /// force, J: F d − F²/2K with K = F_asked/d.
    fn stored_j(&self) -> f64 {
        let held_n = self.held_n();
        held_n * self.depth_m * (1.0 - 0.5 * held_n / self.force_n)
    }
}

/// Largest force, N, that together with what the slew limit leaves of it afterwards, falling by
/// `slew_n` a tick, is a sum of `sum_n`: (n+1) F − s n(n+1)/2 = Σ with n s ≤ F ≤ (n+1) s.
fn withdrawable_n(sum_n: f64, slew_n: f64) -> f64 {
    let mut force_n = sum_n;
    for n in 1..SLEW_TICKS {
        let n = f64::from(n);
        if force_n <= n * slew_n {
            break;
        }
        force_n = (sum_n + 0.5 * slew_n * n * (n + 1.0)) / (n + 1.0);
    }
    force_n
}

/// First-order lag that leaves `a` of a torque after `period_s`, s.
fn lag_s(a: f64, period_s: f64) -> f64 {
    if a > 0.0 {
        period_s / -a.ln()
    } else {
        0.0
    }
}

/// Largest motion of the tip in the home pose by one count, m.
fn quantum_m(model: &DeviceModel) -> f64 {
    let jacobian = model.kinematics.jacobian(&model.joints.home_rad.into());
    (0..model.dof)
        .map(|i| jacobian.column(i).norm() / model.joints.counts_per_rad[i].abs())
        .fold(0.0, f64::max)
}

/// The motors' own joint stiffness, N·m/rad, and the longest lag, s, at 25 °C.
fn drive(drive: &DriveModel) -> (V3, f64) {
    match drive {
        DriveModel::Torque(drive) => (V3::zeros(), drive.lag_s),
        DriveModel::Spring(drive) => {
            let mut natural = V3::zeros();
            let mut lag_s: f64 = 0.0;
            for i in 0..3 {
                if drive.l_h[i] > 0.0 {
                    let ratio_k_t = drive.ratio[i] * drive.k_t_nm_per_a[i];
                    natural[i] = ratio_k_t * ratio_k_t / drive.l_h[i];
                    let residual = drive.r_25_ohm[i] - drive.r_hat_ohm[i];
                    lag_s = lag_s.max(drive.l_h[i] / residual);
                }
            }
            (natural, lag_s)
        }
    }
}
