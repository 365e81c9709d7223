use crate::rig::{Report, Rig, SILENCE_NS};
use hapticd_control::interlock;
use hapticd_control::record::flag;
use hapticd_control::state::State;
use hapticd_servo::ack::Outcome;
use hapticd_servo::event::What;
use hapticd_servo::front::SendError;
use hapticd_servo::request::Request;
use hapticd_servo::scheduling::Realtime;
use std::sync::atomic::Ordering;

const ENABLE: &str = r#"{"type":"desired","desired":"enabled"}"#;
const DISABLE: &str = r#"{"type":"desired","desired":"disabled"}"#;

fn scene(revision: u64) -> String {
    format!(
        r#"{{"type":"scene","scene":{{"revision":{revision},"fade_s":0.01,"mapping":"transpose","stiffness":"pose",
            "allocation":"motor_only","walls":[{{"key":1,"shape":{{"type":"plane","normal":[0,0,1],"offset_m":-0.5}},"law":{{"type":"motion","eta":0}}}}]}}}}"#
    )
}

/// Runs a loop that sends `requests`, one each ten ticks from tick 20 on.
fn run(rig: &Rig, requests: &[&str]) -> Report {
    let last = 20 + 10 * requests.len() as u64;
    rig.run(|moment| {
        if moment.n == last {
            moment.stop.store(true, Ordering::Relaxed);
        } else if moment.n >= 20 && moment.n % 10 == 0 {
            moment.send(requests[(moment.n as usize - 20) / 10]);
        }
    })
}

fn outcomes(report: &Report) -> Vec<Outcome> {
    report.acks.iter().map(|ack| ack.outcome).collect()
}

#[test]
fn a_scene_is_in_force_at_the_tick_its_ack_names() {
    let report = run(&Rig::new(), &[&scene(7)]);
    let ack = report.acks[0];
    assert_eq!((ack.id, ack.outcome), (1, Outcome::Applied));
    let tick = ack.tick as usize;
    assert_eq!(tick, 21, "requests wait for the next tick, and no longer");
    assert_eq!(report.field(tick - 1, "scene_revision"), 0);
    assert_eq!(report.field(tick, "scene_revision"), 7);
    assert_eq!(report.field(tick, "request_id"), 1);
    assert_eq!(report.field(tick, "t_mono_ns"), ack.t_mono_ns);
}

#[test]
fn enabling_and_disabling_change_the_state_that_the_ack_tells() {
    let report = run(&Rig::new(), &[ENABLE, DISABLE]);
    assert_eq!(outcomes(&report), [Outcome::Applied; 2]);
    assert_eq!(report.acks[0].state, State::Enabled as u64);
    assert_eq!(report.acks[1].state, State::Disabled as u64);
    let (from, to) = (State::Disabled as u64, State::Enabled as u64);
    assert!(report.tells(What::State { from, to }));
}

#[test]
fn enabling_without_the_required_scheduling_is_refused_with_the_interlock() {
    let mut rig = Rig::new();
    rig.realtime = Realtime::Required;
    let report = run(&rig, &[ENABLE]);
    assert_eq!(outcomes(&report), [Outcome::Refused]);
    assert_ne!(report.acks[0].interlocks & interlock::REALTIME_MISSING, 0);
}

#[test]
fn an_estop_latches_until_it_is_acknowledged() {
    let requests = [
        r#"{"type":"estop"}"#,
        ENABLE,
        r#"{"type":"estop_ack"}"#,
        ENABLE,
    ];
    let report = run(&Rig::new(), &requests);
    let expected = [
        Outcome::Applied,
        Outcome::Refused,
        Outcome::Applied,
        Outcome::Applied,
    ];
    assert_eq!(outcomes(&report), expected);
    assert_ne!(report.acks[1].interlocks & interlock::ESTOP_LATCHED, 0);
    let latched = report.field(report.acks[0].tick as usize, "flags");
    assert_ne!(latched & flag::ESTOP, 0);
}

#[test]
fn a_superseded_lease_cannot_enable_but_can_still_disable() {
    let requests = [
        r#"{"type":"desired","desired":"enabled","epoch":5}"#,
        r#"{"type":"desired","desired":"disabled","epoch":4}"#,
        r#"{"type":"desired","desired":"enabled","epoch":4}"#,
        ENABLE,
    ];
    let report = run(&Rig::new(), &requests);
    let expected = [
        Outcome::Applied,
        Outcome::Applied,
        Outcome::StaleEpoch,
        Outcome::Applied,
    ];
    assert_eq!(outcomes(&report), expected);
    assert_eq!(report.acks[2].state, State::Disabled as u64);
}

#[test]
fn real_hardware_has_no_hand_and_no_faults_to_inject() {
    let mut rig = Rig::new();
    rig.has_twin = false;
    let requests = [
        r#"{"type":"hand","script":{"type":"hold"}}"#,
        r#"{"type":"inject","injection":{"type":"silence","duration_s":1}}"#,
    ];
    assert_eq!(outcomes(&run(&rig, &requests)), [Outcome::Unsupported; 2]);
}

#[test]
fn an_injected_silence_becomes_a_fault() {
    let inject = r#"{"type":"inject","injection":{"type":"silence","duration_s":0.5}}"#;
    let report = Rig::new().run(|moment| match moment.n {
        20 => {
            moment.send(ENABLE);
        }
        50 => {
            moment.send(inject);
        }
        150 => moment.stop.store(true, Ordering::Relaxed),
        _ => {}
    });
    assert_eq!(outcomes(&report), [Outcome::Applied; 2]);
    assert_eq!(report.field(149, "state"), State::Fault as u64);
    assert_ne!(report.field(149, "faults"), 0);
}

#[test]
fn a_burst_of_requests_is_worked_off_in_order_a_few_a_tick() {
    let report = Rig::new().run(|moment| match moment.n {
        20 => (0..10).for_each(|_| {
            moment.send(DISABLE);
        }),
        30 => moment.stop.store(true, Ordering::Relaxed),
        _ => {}
    });
    let answered: Vec<_> = report.acks.iter().map(|ack| (ack.id, ack.tick)).collect();
    let expected: Vec<_> = (0..10).map(|k| (k + 1, 21 + k / 4)).collect();
    assert_eq!(answered, expected);
}

#[test]
fn a_full_queue_says_so_and_takes_requests_again_once_it_is_worked_off() {
    let rig = Rig::new();
    let report = rig.run(|moment| match moment.n {
        20 => {
            let fill = || moment.front.send(Request::Stop, None);
            while fill().is_ok() {}
            assert_eq!(fill(), Err(SendError::Full));
        }
        _ => assert!(moment.n < 30, "the loop ignored {} stops", moment.n),
    });
    assert!(report.acks.len() <= 256);
    assert_eq!(report.acks[0].outcome, Outcome::Applied);
}

#[test]
fn a_front_that_falls_silent_is_told_of_and_takes_the_device_out_of_enabled() {
    let report = Rig::new().run(|moment| {
        moment.beat = !(100..200).contains(&moment.n);
        match moment.n {
            20 => {
                moment.send(ENABLE);
            }
            150 => moment.clock.spend(SILENCE_NS),
            300 => moment.stop.store(true, Ordering::Relaxed),
            _ => {}
        }
    });
    assert!(report.tells(What::Front { alive: false }));
    assert_eq!(report.field(99, "state"), State::Enabled as u64);
    assert_ne!(report.field(200, "state"), State::Enabled as u64);
    assert_ne!(report.field(299, "state"), State::Enabled as u64);
}
