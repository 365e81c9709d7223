//! The eight laws over random devices, motions, scenes, edits, events and failures.

use crate::checker::Checker;
use crate::models::any_model;
use crate::rig::{is_zero, scene, Rig};
use hapticd_control::controller::{Event, State};
use hapticd_control::fault::{Fault, FaultSet};
use hapticd_control::io::{status, Exchange};
use hapticd_control::linear::V3;
use hapticd_control::record::flag;
use hapticd_control::scene::{
    Allocation, CubicForm, Friction, FrictionActuator, Law, Mapping, Scene, Shape, StiffnessScope,
    Wall,
};
use proptest::prelude::*;

/// One thing that happens to a device.
#[derive(Clone, Debug)]
enum Act {
    Move { velocity: V3, ticks: usize },
    Push { force_n: V3 },
    Ask(Event),
    Recover,
    Edit(Box<Scene>),
    Silence { ticks: usize },
    Unplug { ticks: usize },
    Late { ticks: usize },
    FrontDead { ticks: usize },
    Bits { bits: u64, ticks: usize },
    Jump { joint: usize },
    Rewind,
    NotFinite,
}

fn vector(size: f64) -> impl Strategy<Value = V3> {
    prop::array::uniform3(-size..size).prop_map(V3::from)
}

fn any_law() -> impl Strategy<Value = Law> {
    let damping = || prop_oneof![Just(0.0), 1.0..3000.0_f64];
    let cubic = (3.0..9.0_f64, any::<bool>()).prop_map(|(exponent, implicit)| Law::CubicDamper {
        coefficient_n_s3_per_m3: 10_f64.powf(exponent),
        form: if implicit {
            CubicForm::Implicit
        } else {
            CubicForm::Explicit
        },
    });
    prop_oneof![
        3 => (0.0..=1.0_f64).prop_map(|eta| Law::Motion { eta }),
        2 => (1.0..3e5_f64, damping()).prop_map(|(stiffness_n_per_m, damping_n_s_per_m)| {
            Law::Spring { stiffness_n_per_m, damping_n_s_per_m }
        }),
        1 => damping().prop_map(|damping_n_s_per_m| Law::Damper { damping_n_s_per_m }),
        2 => cubic,
    ]
}

fn any_friction() -> impl Strategy<Value = Friction> {
    let actuators = [
        FrictionActuator::Auto,
        FrictionActuator::Motor,
        FrictionActuator::Brake,
    ];
    let rough =
        (0.0..1.5_f64, 0.0..1.0_f64, 0..3_usize).prop_map(move |(static_, share, i)| Friction {
            static_,
            kinetic: share * static_,
            actuator: actuators[i],
        });
    prop_oneof![Just(Friction::default()), rough]
}

/// Shapes near the home poses of both devices, around them and beside them.
fn any_shape() -> impl Strategy<Value = Shape> {
    let unit = || {
        vector(1.0)
            .prop_filter("normal has a length", |normal| normal.norm() > 0.1)
            .prop_map(|normal| normal.normalize())
    };
    let near = || vector(0.15).prop_map(|center| center + V3::new(0.05, 0.1, 0.0));
    let size = || 0.01..0.15_f64;
    prop_oneof![
        3 => (unit(), -0.25..0.05_f64).prop_map(|(normal, offset_m)| Shape::Plane {
            normal: normal.into(),
            offset_m,
        }),
        1 => (near(), size(), any::<bool>()).prop_map(|(center_m, radius_m, hollow)| {
            Shape::Sphere { center_m: center_m.into(), radius_m, hollow }
        }),
        1 => (near(), -3.0..3.0_f64, [size(), size(), size()], any::<bool>()).prop_map(
            |(center_m, turn, half_m, hollow)| Shape::Box {
                center_m: center_m.into(),
                axes: [
                    [turn.cos(), turn.sin(), 0.0],
                    [-turn.sin(), turn.cos(), 0.0],
                    [0.0, 0.0, 1.0],
                ],
                half_m,
                hollow,
            }
        ),
        1 => (near(), near(), size(), any::<bool>()).prop_map(|(from_m, to_m, radius_m, hollow)| {
            Shape::Capsule {
                from_m: from_m.into(),
                to_m: to_m.into(),
                radius_m,
                hollow,
            }
        }),
    ]
}

fn wall() -> impl Strategy<Value = Wall> {
    let switches = (any::<bool>(), any::<bool>());
    (any_shape(), any_law(), any_friction(), switches).prop_map(
        |(shape, law, friction, (passivity, brake))| Wall {
            key: 0,
            shape,
            law,
            passivity,
            brake,
            friction,
        },
    )
}

/// Walls numbered from `first` on, so that some survive an edit and some do not.
fn numbered(walls: &[Wall], first: u64) -> Vec<Wall> {
    let number = |(i, wall): (usize, &Wall)| Wall {
        key: first + i as u64,
        ..*wall
    };
    walls.iter().enumerate().map(number).collect()
}

fn edit() -> impl Strategy<Value = Act> {
    let choices = (0..3_usize, any::<bool>(), any::<bool>(), 0..3_u64);
    let fade = prop_oneof![Just(0.0), 0.0..0.05_f64];
    (prop::collection::vec(wall(), 0..5), fade, choices).prop_map(|(walls, fade_s, choices)| {
        let allocations = [
            Allocation::MotorOnly,
            Allocation::MotorAndBrake,
            Allocation::BrakeOnly,
        ];
        Act::Edit(Box::new(Scene {
            allocation: allocations[choices.0],
            mapping: if choices.1 {
                Mapping::Inverse
            } else {
                Mapping::Transpose
            },
            stiffness: if choices.2 {
                StiffnessScope::Workspace
            } else {
                StiffnessScope::Pose
            },
            ..scene(&numbered(&walls, choices.3), fade_s)
        }))
    })
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => Just(Event::Enable),
        2 => Just(Event::Disable),
        2 => Just(Event::Pause),
        1 => Just(Event::EstopEngage),
        3 => Just(Event::EstopAcknowledge),
        5 => Just(Event::FaultAcknowledge(FaultSet::from_bits(u64::MAX))),
    ]
}

fn act() -> impl Strategy<Value = Act> {
    let ticks = |most: usize| 1..most;
    prop_oneof![
        10 => (vector(3.0), ticks(80)).prop_map(|(velocity, ticks)| Act::Move { velocity, ticks }),
        4 => vector(60.0).prop_map(|force_n| Act::Push { force_n }),
        10 => event().prop_map(Act::Ask),
        16 => Just(Act::Recover),
        8 => edit(),
        2 => ticks(8).prop_map(|ticks| Act::Silence { ticks }),
        1 => ticks(4).prop_map(|ticks| Act::Unplug { ticks }),
        1 => ticks(30).prop_map(|ticks| Act::Late { ticks }),
        1 => ticks(40).prop_map(|ticks| Act::FrontDead { ticks }),
        1 => (any::<u8>(), ticks(4))
            .prop_map(|(bits, ticks)| Act::Bits { bits: u64::from(bits) & BAD_BITS, ticks }),
        1 => (0..2_usize).prop_map(|joint| Act::Jump { joint }),
        1 => Just(Act::Rewind),
        1 => Just(Act::NotFinite),
    ]
}

const BAD_BITS: u64 = status::ESTOP_INPUT
    | status::AMPLIFIER_FAULT
    | status::BOARD_WATCHDOG
    | status::ENCODER_ERROR
    | status::SENSOR_SATURATED;

/// A rig whose every tick is checked.
struct Run {
    rig: Rig,
    checker: Checker,
    estop: bool,
}

impl Run {
    fn play(&mut self, act: &Act) {
        match act {
            Act::Move { velocity, ticks } => self.travel(velocity, *ticks),
            Act::Push { force_n } => self.push(*force_n),
            Act::Ask(event) => self.ask(*event),
            Act::Recover => self.recover(),
            Act::Edit(scene) => self.rig.controller.adopt(scene),
            Act::Silence { ticks } => self.without(Exchange::Missing, *ticks),
            Act::Unplug { ticks } => self.without(Exchange::Down, *ticks),
            Act::Late { ticks } => self.late(*ticks),
            Act::FrontDead { ticks } => self.front_dead(*ticks),
            Act::Bits { bits, ticks } => self.bits(*bits, *ticks),
            Act::Jump { joint } => self.jump(*joint),
            Act::Rewind => self.rewind(),
            Act::NotFinite => self.not_finite(),
        }
        self.tick();
    }

    fn tick(&mut self) {
        self.rig.step();
        self.check();
    }

    fn check(&mut self) {
        self.checker.check(&self.rig);
        self.estop |= self.rig.observation.status & status::ESTOP_INPUT != 0;
        let latched = self.rig.record.flags & flag::ESTOP != 0;
        assert_eq!(latched, self.estop, "law 8");
    }

    fn push(&mut self, force_n: V3) {
        let spatial = self.rig.model.dof == 3;
        self.rig.hand(if spatial {
            force_n
        } else {
            V3::new(force_n.x, force_n.y, 0.0)
        });
    }

    fn ask(&mut self, event: Event) {
        let carried_out = self.rig.controller.event(event).is_ok();
        self.estop |= event == Event::EstopEngage;
        self.estop &= !(carried_out && event == Event::EstopAcknowledge);
    }

    /// What an operator does after a stop.
    fn recover(&mut self) {
        self.ask(Event::EstopAcknowledge);
        self.ask(Event::FaultAcknowledge(FaultSet::from_bits(u64::MAX)));
        self.tick();
        self.ask(Event::Enable);
        self.travel(&V3::zeros(), 60);
    }

    /// Moves within the joint limits.
    fn travel(&mut self, velocity: &V3, ticks: usize) {
        for _ in 0..ticks {
            let q = V3::from(self.rig.record.joint_position_rad) + velocity * 1e-3;
            let (kinematics, joints) = (self.rig.model.kinematics, self.rig.model.joints);
            if kinematics.inside(&joints, &q, 0.0) {
                self.rig.place(&q);
            }
            self.tick();
        }
    }

    fn without(&mut self, exchange: Exchange, ticks: usize) {
        for passed in 1..=ticks {
            self.rig.exchange(exchange);
            self.check();
            let connected = self.rig.state() != State::Offline;
            let too_long = passed > self.rig.model.limits.missing_ticks as usize;
            if exchange == Exchange::Missing && connected && too_long {
                assert!(self.rig.has(Fault::ObservationMissing), "law 4");
            }
        }
    }

    fn late(&mut self, ticks: usize) {
        self.rig.late = true;
        let mut in_use = 0;
        for _ in 0..ticks {
            in_use = if self.rig.command.enable {
                in_use + 1
            } else {
                0
            };
            self.tick();
            let too_long = in_use >= self.rig.model.limits.late_ticks;
            assert!(!too_long || self.rig.has(Fault::DeadlineMissed), "law 5");
        }
        self.rig.late = false;
    }

    fn front_dead(&mut self, ticks: usize) {
        self.rig.front_alive = false;
        for _ in 0..ticks {
            let in_use = self.rig.command.enable;
            self.tick();
            assert!(!in_use || self.rig.has(Fault::FrontLost), "law 5");
            assert_ne!(self.rig.state(), State::Enabled, "law 5");
        }
        self.rig.front_alive = true;
    }

    fn bits(&mut self, bits: u64, ticks: usize) {
        self.rig.observation.status |= bits;
        for _ in 0..ticks {
            self.tick();
        }
        self.rig.observation.status &= !bits;
    }

    /// What an impossible observation must lead to, if there is one before it to compare with.
    fn disbelieved(&mut self, fault: Fault) {
        let comparable = self.rig.record.flags & flag::FRESH != 0;
        self.tick();
        if comparable {
            assert!(self.rig.has(fault), "law 4: {fault:?}");
            assert!(is_zero(&self.rig.command), "law 4");
            assert_eq!(self.rig.record.flags & flag::FRESH, 0, "law 4: believed");
        }
    }

    fn jump(&mut self, joint: usize) {
        let before = self.rig.observation.counts;
        self.rig.observation.counts[joint] += 5000;
        self.disbelieved(Fault::EncoderJump);
        self.rig.observation.counts = before;
    }

    fn rewind(&mut self) {
        self.rig.observation.seq = self.rig.observation.seq.saturating_sub(3);
        self.disbelieved(Fault::SequenceBroken);
    }

    fn not_finite(&mut self) {
        if self.rig.observation.status & status::FORCE_PRESENT != 0 {
            let before = self.rig.observation.force_n;
            self.rig.observation.force_n[0] = f64::NAN;
            self.disbelieved(Fault::ObservationNotFinite);
            self.rig.observation.force_n = before;
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(192) })]

    #[test]
    fn laws_hold_whatever_happens(
        model in any_model(),
        acts in prop::collection::vec(act(), 20..80),
    ) {
        let mut run = Run { rig: Rig::running(model), checker: Checker::default(), estop: false };
        for act in &acts {
            run.play(act);
        }
    }
}
