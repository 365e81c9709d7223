//! The state machine over every state, every latch and every event.

use hapticd_control::fault::{Fault, FaultSet, FAULTS};
use hapticd_control::interlock::{self, INTERLOCKS};
use hapticd_control::state::{Event, Machine, Output, State, Surroundings};

const STATES: [State; 5] = [
    State::Offline,
    State::Disabled,
    State::Enabled,
    State::Paused,
    State::Fault,
];
const CLEAR: Surroundings = Surroundings {
    front_alive: true,
    realtime_ok: true,
    estop_input: false,
};

fn machine(state: State) -> Machine {
    let faults = if state == State::Fault {
        FaultSet::of(Fault::EncoderJump)
    } else {
        FaultSet::default()
    };
    Machine {
        state,
        homed: true,
        faults,
        ..Machine::default()
    }
}

fn events() -> [Event; 7] {
    [
        Event::Enable,
        Event::Disable,
        Event::Pause,
        Event::EstopEngage,
        Event::EstopAcknowledge,
        Event::FaultAcknowledge(FaultSet::of(Fault::EncoderJump)),
        Event::FaultAcknowledge(FaultSet::of(Fault::MotorHot)),
    ]
}

/// One row per state, one column per event of `events`; `None` is a refusal.
fn expected(state: State) -> [Option<State>; 7] {
    use State::{Disabled, Enabled, Fault, Offline, Paused};
    let at = Some;
    match state {
        Offline => [
            None,
            at(Offline),
            None,
            at(Offline),
            at(Offline),
            at(Offline),
            at(Offline),
        ],
        Disabled => [
            at(Enabled),
            at(Disabled),
            None,
            at(Disabled),
            at(Disabled),
            at(Disabled),
            at(Disabled),
        ],
        Enabled => [
            at(Enabled),
            at(Disabled),
            at(Paused),
            at(Disabled),
            at(Enabled),
            at(Enabled),
            at(Enabled),
        ],
        Paused => [
            at(Enabled),
            at(Disabled),
            at(Paused),
            at(Disabled),
            at(Paused),
            at(Paused),
            at(Paused),
        ],
        Fault => [
            None,
            at(Fault),
            None,
            at(Fault),
            at(Fault),
            at(Disabled),
            at(Fault),
        ],
    }
}

#[test]
fn every_event_leads_from_every_state_where_the_table_says() {
    for state in STATES {
        for (event, next) in events().into_iter().zip(expected(state)) {
            let reached = machine(state).handle(event, CLEAR).ok();
            assert_eq!(
                reached.map(|machine| machine.state),
                next,
                "{state:?} {event:?}"
            );
        }
    }
}

#[test]
fn every_fault_leads_from_every_state_where_its_severity_says() {
    for state in STATES {
        for info in FAULTS {
            let raised = machine(state).raise(FaultSet::of(info.fault));
            let next = if state == State::Offline {
                state
            } else {
                State::Fault
            };
            assert_eq!(raised.state, next, "{state:?} {}", info.slug);
            assert!(raised.faults.contains(info.fault));
            let kept = raised.faults.bits() & machine(state).faults.bits();
            assert_eq!(kept, machine(state).faults.bits(), "a fault was dropped");
        }
    }
}

#[test]
fn raising_nothing_changes_nothing() {
    for state in STATES {
        let before = machine(state);
        assert_eq!(before.raise(FaultSet::default()), before);
    }
}

#[test]
fn connecting_never_makes_anything_livelier_than_disabled() {
    for state in STATES {
        let next = if state == State::Offline {
            State::Disabled
        } else {
            state
        };
        assert_eq!(machine(state).connect().state, next);
    }
}

#[test]
fn losing_the_device_is_offline_from_everywhere_and_a_fault_unless_it_was_never_there() {
    for state in STATES {
        let lost = machine(state).lose();
        assert_eq!(lost.state, State::Offline);
        assert_eq!(
            lost.faults.contains(Fault::DeviceLost),
            state != State::Offline
        );
    }
}

#[test]
fn reconnecting_keeps_the_fault_of_the_loss_against_enabling() {
    let back = machine(State::Enabled).lose().connect();
    assert_eq!(back.state, State::Disabled);
    assert_eq!(back.output(), Output::Cut);
    let refusal = back
        .handle(Event::Enable, CLEAR)
        .expect_err("a fault is latched");
    assert_eq!(refusal.interlocks, interlock::FAULT_LATCHED);
    let cured = back
        .handle(
            Event::FaultAcknowledge(FaultSet::of(Fault::DeviceLost)),
            CLEAR,
        )
        .and_then(|machine| machine.handle(Event::Enable, CLEAR));
    assert_eq!(cured.map(|machine| machine.state), Ok(State::Enabled));
}

#[test]
fn each_interlock_alone_refuses_enabling_and_names_itself() {
    type Open = fn(&mut Machine, &mut Surroundings);
    let openers: [(u64, Open); 8] = [
        (interlock::OFFLINE, |machine, _| {
            machine.state = State::Offline
        }),
        (interlock::ESTOP_LATCHED, |machine, _| machine.estop = true),
        (interlock::ESTOP_INPUT, |_, around| {
            around.estop_input = true
        }),
        (interlock::FAULT_LATCHED, |machine, _| {
            machine.faults = FaultSet::of(Fault::MotorHot);
        }),
        (interlock::NOT_HOMED, |machine, _| machine.homed = false),
        (interlock::REALTIME_MISSING, |_, around| {
            around.realtime_ok = false
        }),
        (interlock::BUSY, |machine, _| machine.busy = true),
        (interlock::FRONT_MISSING, |_, around| {
            around.front_alive = false
        }),
    ];
    for (bit, open) in openers {
        let (mut device, mut around) = (machine(State::Disabled), CLEAR);
        assert_eq!(device.interlocks(around), 0);
        open(&mut device, &mut around);
        assert_eq!(device.interlocks(around), bit);
        let refusal = device
            .handle(Event::Enable, around)
            .expect_err("an interlock is open");
        assert_eq!(refusal.interlocks, bit);
    }
}

#[test]
fn every_refusal_names_interlocks_of_the_table() {
    let known = INTERLOCKS.iter().fold(0, |bits, info| bits | info.bit);
    for state in STATES {
        for event in events() {
            if let Err(refusal) = machine(state).handle(event, Surroundings::default()) {
                assert_ne!(refusal.interlocks, 0);
                assert_eq!(refusal.interlocks & !known, 0);
            }
        }
    }
}

#[test]
fn pause_is_refused_as_not_enabled() {
    let refusal = machine(State::Disabled).handle(Event::Pause, CLEAR);
    assert_eq!(
        refusal.expect_err("not enabled").interlocks,
        interlock::NOT_ENABLED
    );
}

#[test]
fn estop_cuts_from_every_state_until_it_is_acknowledged() {
    for state in STATES {
        let mut stopped = machine(state).engage_estop();
        assert!(!matches!(stopped.state, State::Enabled | State::Paused));
        for event in events() {
            if event != Event::EstopAcknowledge {
                stopped = stopped.handle(event, CLEAR).unwrap_or(stopped);
                assert!(stopped.estop, "{event:?} cleared the latch");
                assert_eq!(stopped.output(), Output::Cut);
            }
        }
        let cleared = stopped.handle(Event::EstopAcknowledge, CLEAR);
        assert!(cleared.is_ok_and(|machine| !machine.estop));
    }
}

#[test]
fn estop_is_not_acknowledged_while_its_input_is_open() {
    let open = Surroundings {
        estop_input: true,
        ..CLEAR
    };
    let refusal = machine(State::Disabled)
        .engage_estop()
        .handle(Event::EstopAcknowledge, open);
    assert_eq!(
        refusal.expect_err("input is open").interlocks,
        interlock::ESTOP_INPUT
    );
}

#[test]
fn outputs_are_driven_in_enabled_alone() {
    for state in STATES {
        let output = machine(state).output();
        assert_eq!(
            output == Output::Drive,
            state == State::Enabled,
            "{state:?}"
        );
    }
    assert_eq!(machine(State::Disabled).output(), Output::Fade);
    assert_eq!(machine(State::Paused).output(), Output::Fade);
    assert_eq!(machine(State::Offline).output(), Output::Cut);
}

#[test]
fn soft_stops_fade_and_hard_stops_cut() {
    let soft = machine(State::Enabled).raise(FaultSet::of(Fault::SensorStale));
    assert_eq!(soft.output(), Output::Fade);
    let hard = soft.raise(FaultSet::of(Fault::Amplifier));
    assert_eq!(hard.output(), Output::Cut);
    let eased = hard.handle(
        Event::FaultAcknowledge(FaultSet::of(Fault::Amplifier)),
        CLEAR,
    );
    assert_eq!(eased.map(|machine| machine.output()), Ok(Output::Fade));
}

#[test]
fn fault_is_left_only_with_its_last_stopping_fault() {
    let two = machine(State::Fault).raise(FaultSet::of(Fault::SensorStale));
    let one = two.handle(
        Event::FaultAcknowledge(FaultSet::of(Fault::EncoderJump)),
        CLEAR,
    );
    assert_eq!(one.map(|machine| machine.state), Ok(State::Fault));
}

#[test]
fn losing_the_joint_zero_in_use_is_a_fault_and_at_rest_an_interlock() {
    for state in STATES {
        let lost = machine(state).home(false);
        let in_use = matches!(state, State::Enabled | State::Paused);
        assert_eq!(lost.faults.contains(Fault::Encoder), in_use, "{state:?}");
        assert_ne!(lost.interlocks(CLEAR) & interlock::NOT_HOMED, 0);
        assert_eq!(machine(state).home(true), machine(state));
    }
}
