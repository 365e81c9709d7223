use super::*;
use crate::document::parse;
use hapticd_control::io::Axes;
use hapticd_control::scene::{CubicForm, Law, Probe, Shape, Wall};
use proptest::prelude::*;

/// One of the shapes; its numbers differ, so that none can take the place of another.
fn shape(kind: u64, normal: Axes, size: f64) -> Shape {
    let (hollow, radius_m) = (kind & 4 != 0, size.abs());
    let [a, b] = [[size, 0.1, 0.2], [0.3, size, 0.4]];
    match kind % 4 {
        0 => Shape::Plane {
            normal,
            offset_m: size,
        },
        1 => Shape::Sphere {
            center_m: a,
            radius_m,
            hollow,
        },
        2 => Shape::Box {
            center_m: a,
            axes: [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]],
            half_m: [radius_m, 0.5, 0.6],
            hollow,
        },
        _ => Shape::Capsule {
            from_m: a,
            to_m: b,
            radius_m,
            hollow,
        },
    }
}

fn law(kind: u64, size: f64) -> Law {
    match kind / 8 % 5 {
        0 => Law::Motion { eta: size },
        1 => Law::Spring {
            stiffness_n_per_m: size,
            damping_n_s_per_m: 2.0 * size,
        },
        2 => Law::Damper {
            damping_n_s_per_m: size,
        },
        3 => Law::CubicDamper {
            coefficient_n_s3_per_m3: size,
            form: CubicForm::Implicit,
        },
        _ => Law::CubicDamper {
            coefficient_n_s3_per_m3: size,
            form: CubicForm::Explicit,
        },
    }
}

fn wall() -> impl Strategy<Value = Wall> {
    (
        0.0..std::f64::consts::TAU,
        -1.0..1.0f64,
        -1.0..1.0f64,
        0.0..=1.0f64,
        any::<u64>(),
    )
        .prop_map(|(azimuth, height, offset_m, eta, kind)| {
            let radius = (1.0 - height * height).sqrt();
            let normal = [radius * azimuth.cos(), radius * azimuth.sin(), height];
            Wall {
                shape: shape(kind, normal, offset_m),
                law: law(kind, eta),
                passivity: eta < 0.5,
                ..Wall::plane(kind, normal, offset_m, eta)
            }
        })
}

fn probe() -> impl Strategy<Value = Option<Probe>> {
    let probe = (0.0..1.0f64, 0.0..500.0f64).prop_map(|(amplitude_m, frequency_hz)| Probe {
        direction: [0.6, 0.0, 0.8],
        amplitude_m,
        frequency_hz,
    });
    prop::option::of(probe)
}

fn scene() -> impl Strategy<Value = Scene> {
    let choices = (0u64..2, 0u64..2, 0u64..3);
    let walls = prop::collection::vec(wall(), 0..=MAX_WALLS);
    let head = (any::<u64>(), 0.0..5.0f64, probe());
    (head, choices, walls).prop_map(|((revision, fade_s, probe), choice, list)| {
        let mut scene = Scene {
            revision,
            fade_s,
            mapping: mapping_of(choice.0).unwrap(),
            stiffness: stiffness_of(choice.1).unwrap(),
            allocation: allocation_of(choice.2).unwrap(),
            probe,
            count: list.len(),
            ..Scene::default()
        };
        scene.walls[..list.len()].copy_from_slice(&list);
        scene
    })
}

fn round_trip(envelope: &Envelope) -> Result<Envelope, u64> {
    let mut words = [0; REQUEST_WORDS];
    let length = envelope.encode(&mut words);
    Envelope::decode(&words[..length])
}

proptest! {
    #[test]
    fn scenes_survive_their_words(scene in scene(), id in any::<u64>(), epoch in prop::option::of(0u64..1 << 60)) {
        let envelope = Envelope { id, epoch, request: Request::Scene(scene) };
        prop_assert_eq!(round_trip(&envelope), Ok(envelope));
    }

    #[test]
    fn cut_scenes_are_refused_by_number(scene in scene(), id in any::<u64>(), cut in 1usize..5) {
        let mut words = [0; REQUEST_WORDS];
        let envelope = Envelope { id, epoch: None, request: Request::Scene(scene) };
        let length = envelope.encode(&mut words);
        prop_assert_eq!(Envelope::decode(&words[..length - cut]), Err(id));
    }

    #[test]
    fn arbitrary_words_never_become_an_invalid_request(
        words in prop::collection::vec(prop_oneof![any::<u64>(), 0u64..12], 0..30)
    ) {
        if let Ok(envelope) = Envelope::decode(&words) {
            prop_assert!(envelope.request.is_valid());
        }
    }
}

#[test]
fn every_kind_of_request_survives_its_words() {
    let documents = [
        r#"{"type":"desired","desired":"enabled"}"#,
        r#"{"type":"desired","desired":"disabled"}"#,
        r#"{"type":"desired","desired":"paused"}"#,
        r#"{"type":"estop"}"#,
        r#"{"type":"estop_ack"}"#,
        r#"{"type":"fault_ack","faults":5}"#,
        r#"{"type":"hand","script":{"type":"follow","target_m":[0.1,0.2,0.0]}}"#,
        r#"{"type":"inject","injection":{"type":"silence","duration_s":0.5}}"#,
        r#"{"type":"stop"}"#,
        r#"{"type":"scene","epoch":3,"scene":{"revision":7,"fade_s":0.2,"mapping":"inverse","stiffness":"pose",
            "allocation":"brake_only","walls":[{"key":1,"shape":{"type":"plane","normal":[0,0,1],"offset_m":-0.02},"law":{"type":"motion","eta":0.5}}]}}"#,
    ];
    for (id, document) in (1..).zip(documents) {
        let (request, epoch) = parse(document).unwrap();
        let envelope = Envelope { id, epoch, request };
        assert_eq!(round_trip(&envelope), Ok(envelope), "{document}");
    }
}

#[test]
fn documents_that_make_no_sense_are_refused() {
    let scene = |wall: &str| {
        format!(
            r#"{{"type":"scene","scene":{{"revision":1,"fade_s":0.1,"mapping":"transpose","stiffness":"pose",
                "allocation":"motor_only","walls":[{wall}]}}}}"#
        )
    };
    let documents = [
        "[]".to_owned(),
        r#"{"type":"dance"}"#.into(),
        r#"{"type":"estop","volume":11}"#.into(),
        r#"{"type":"desired","desired":"broken"}"#.into(),
        r#"{"type":"stop","epoch":-1}"#.into(),
        r#"{"type":"hand","script":{"type":"push","direction":[0,0,0],"force_n":1}}"#.into(),
        scene(r#"{"key":1,"shape":{"type":"plane","normal":[0,0,0],"offset_m":0},"law":{"type":"motion","eta":0}}"#),
        scene(r#"{"key":1,"shape":{"type":"plane","normal":[0,0,2],"offset_m":0},"law":{"type":"motion","eta":0}}"#),
        scene(r#"{"key":1,"shape":{"type":"plane","normal":[0,0,1],"offset_m":0},"law":{"type":"motion","eta":1.2}}"#),
        scene(r#"{"key":1,"shape":{"type":"plane","normal":[0,0,1],"offset_m":0},"law":{"type":"motion","eta":0},"colour":"red"}"#),
        scene(&[r#"{"key":1,"shape":{"type":"plane","normal":[0,0,1],"offset_m":0},"law":{"type":"motion","eta":0}}"#; MAX_WALLS + 1].join(",")),
    ];
    for document in documents {
        assert!(parse(&document).is_err(), "{document}");
    }
}

const UP: Axes = [0.0, 0.0, 1.0];

/// Each spoils one number of a wall.
const SPOILERS: [fn(&mut Wall); 8] = [
    |wall| *wall = Wall::plane(1, [f64::NAN, 0.0, 1.0], 0.0, 0.0),
    |wall| *wall = Wall::plane(1, UP, f64::INFINITY, 0.0),
    |wall| *wall = Wall::plane(1, UP, 0.0, f64::NAN),
    |wall| *wall = Wall::plane(1, UP, 0.0, -0.1),
    |wall| wall.friction.static_ = f64::NAN,
    |wall| wall.friction.kinetic = 0.1,
    |wall| {
        wall.law = Law::Spring {
            stiffness_n_per_m: f64::INFINITY,
            damping_n_s_per_m: 0.0,
        };
    },
    |wall| {
        wall.shape = Shape::Box {
            center_m: UP,
            axes: [UP, UP, UP],
            half_m: UP,
            hollow: false,
        };
    },
];

#[test]
fn a_scene_with_a_nan_is_malformed_even_when_the_words_are_whole() {
    let mut scene = Scene {
        count: 1,
        ..Scene::default()
    };
    scene.walls[0] = Wall::plane(1, [0.0, 0.0, 1.0], 0.0, 0.0);
    for spoil in SPOILERS {
        let mut spoiled = scene;
        spoil(&mut spoiled.walls[0]);
        let request = Request::Scene(spoiled);
        let envelope = Envelope {
            id: 4,
            epoch: None,
            request,
        };
        assert_eq!(round_trip(&envelope), Err(4));
    }
}

#[test]
fn walls_that_share_a_key_are_refused() {
    let mut scene = Scene {
        count: 2,
        ..Scene::default()
    };
    scene.walls[0] = Wall::plane(1, [0.0, 0.0, 1.0], 0.0, 0.0);
    scene.walls[1] = scene.walls[0];
    assert!(!Request::Scene(scene).is_valid());
    scene.walls[1].key = 2;
    assert!(Request::Scene(scene).is_valid());
}

#[test]
fn probe_with_a_nan_is_refused() {
    for (direction, amplitude_m, frequency_hz) in [
        ([f64::NAN, 0.0, 0.0], 0.1, 1.0),
        ([0.0, 0.0, 1.0], -0.1, 1.0),
        ([0.0, 0.0, 1.0], 0.1, f64::NAN),
    ] {
        let probe = Some(Probe {
            direction,
            amplitude_m,
            frequency_hz,
        });
        let scene = Scene {
            probe,
            ..Scene::default()
        };
        assert!(!Request::Scene(scene).is_valid());
    }
}

#[test]
fn only_withdrawals_ignore_the_lease() {
    let lease_free = |json: &str| parse(json).unwrap().0.is_withdrawal();
    assert!(lease_free(r#"{"type":"estop"}"#));
    assert!(lease_free(r#"{"type":"stop"}"#));
    assert!(lease_free(r#"{"type":"desired","desired":"disabled"}"#));
    assert!(!lease_free(r#"{"type":"desired","desired":"enabled"}"#));
    assert!(!lease_free(r#"{"type":"estop_ack"}"#));
}
