//! Requests of the front: words in the mailbox. Checked again here, for the loop trusts nobody.

use crate::codec::{Decoder, Encoder};
use crate::probe::{self, PROBE_WORDS};
use crate::wall::{self, WALL_WORDS};
use hapticd_control::fault::FaultSet;
use hapticd_control::scene::{Allocation, Mapping, Scene, StiffnessScope, MAX_WALLS};
use hapticd_control::state::Event;
use hapticd_twin::script::SCRIPT_WORDS;
use hapticd_twin::{Injection, Script};

const ENVELOPE_WORDS: usize = 3;
const SCENE_HEAD_WORDS: usize = 6 + PROBE_WORDS;

/// Words of the longest request.
pub const REQUEST_WORDS: usize = ENVELOPE_WORDS + SCENE_HEAD_WORDS + MAX_WALLS * WALL_WORDS;

/// What the front asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // a box would allocate in the loop
pub enum Request {
    /// An event of the device's state machine.
    Event(Event),
    /// Another scene.
    Scene(Scene),
    /// Twin only: another script for the hand.
    Hand(Script),
    /// Twin only: a fault of the simulated hardware.
    Inject(Injection),
    /// Fade to zero and end the loop.
    Stop,
}

/// A request with its number and the epoch of the lease it was made under.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Envelope {
    /// Number the front gave it.
    pub id: u64,
    /// Epoch of the lease; `None` when nobody holds one.
    pub epoch: Option<u64>,
    /// What is asked.
    pub request: Request,
}

impl Request {
    /// Whether an outdated lease is no reason to refuse it: it only takes force away.
    #[must_use]
    pub fn is_withdrawal(&self) -> bool {
        matches!(
            self,
            Self::Event(Event::Disable | Event::Pause | Event::EstopEngage) | Self::Stop
        )
    }

    /// Whether every number makes sense.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        match self {
            Self::Scene(scene) => scene_is_valid(scene),
            Self::Hand(script) => script.is_valid(),
            Self::Inject(injection) => injection.is_valid(),
            Self::Event(_) | Self::Stop => true,
        }
    }
}

fn scene_is_valid(scene: &Scene) -> bool {
    let fade_valid = scene.fade_s.is_finite() && scene.fade_s >= 0.0;
    let walls_valid = scene.count <= MAX_WALLS && scene.walls().iter().all(wall::is_valid);
    fade_valid && walls_valid && keys_differ(scene) && scene.probe.iter().all(probe::is_valid)
}

/// Whether every wall has a key of its own: history follows it through edits.
fn keys_differ(scene: &Scene) -> bool {
    let walls = scene.walls();
    (1..walls.len()).all(|i| walls[..i].iter().all(|other| other.key != walls[i].key))
}

impl Envelope {
    /// The request as words; returns how many of `words` it takes.
    #[must_use]
    pub fn encode(&self, words: &mut [u64; REQUEST_WORDS]) -> usize {
        let epoch = self.epoch.map_or(0, |epoch| epoch.saturating_add(1));
        let mut encoder = Encoder::new(words);
        encoder.words(&[self.id, kind(&self.request), epoch]);
        match &self.request {
            Request::Event(Event::FaultAcknowledge(faults)) => {
                encoder.word(faults.bits());
            }
            Request::Event(_) | Request::Stop => {}
            Request::Scene(scene) => encode_scene(scene, &mut encoder),
            Request::Hand(script) => {
                encoder.numbers(&script.to_words());
            }
            Request::Inject(injection) => {
                encoder.numbers(&injection.to_words());
            }
        }
        encoder.len()
    }

    /// The request in words; the number alone when they hold no valid request.
    ///
    /// # Errors
    /// The request's number, 0 when there is not even that.
    pub fn decode(words: &[u64]) -> Result<Self, u64> {
        let mut decoder = Decoder::new(words);
        let id = decoder.word().ok_or(0_u64)?;
        let rest = || -> Option<Self> {
            let (kind, epoch) = (decoder.word()?, decoder.word()?);
            Some(Self {
                id,
                epoch: epoch.checked_sub(1),
                request: decode_request(kind, &mut decoder)?,
            })
        };
        let envelope = { rest }();
        envelope
            .filter(|envelope| envelope.request.is_valid())
            .ok_or(id)
    }
}

fn kind(request: &Request) -> u64 {
    match request {
        Request::Event(Event::Enable) => 0,
        Request::Event(Event::Disable) => 1,
        Request::Event(Event::Pause) => 2,
        Request::Event(Event::EstopEngage) => 3,
        Request::Event(Event::EstopAcknowledge) => 4,
        Request::Event(Event::FaultAcknowledge(_)) => 5,
        Request::Scene(_) => 6,
        Request::Hand(_) => 7,
        Request::Inject(_) => 8,
        Request::Stop => 9,
    }
}

fn decode_request(kind: u64, decoder: &mut Decoder<'_>) -> Option<Request> {
    Some(match kind {
        0 => Request::Event(Event::Enable),
        1 => Request::Event(Event::Disable),
        2 => Request::Event(Event::Pause),
        3 => Request::Event(Event::EstopEngage),
        4 => Request::Event(Event::EstopAcknowledge),
        5 => Request::Event(Event::FaultAcknowledge(FaultSet::from_bits(
            decoder.word()?,
        ))),
        6 => Request::Scene(decode_scene(decoder)?),
        7 => Request::Hand(Script::from_words(&script_words(decoder)?)?),
        8 => Request::Inject(Injection::from_words(&script_words(decoder)?)?),
        9 => Request::Stop,
        _ => return None,
    })
}

fn script_words(decoder: &mut Decoder<'_>) -> Option<[f64; SCRIPT_WORDS]> {
    Some(decoder.array::<SCRIPT_WORDS>()?.map(f64::from_bits))
}

fn encode_scene(scene: &Scene, encoder: &mut Encoder<'_>) {
    encoder
        .word(scene.revision)
        .number(scene.fade_s)
        .word(scene.mapping as u64)
        .word(scene.stiffness as u64)
        .word(scene.allocation as u64)
        .word(scene.walls().len() as u64);
    probe::encode(scene.probe.as_ref(), encoder);
    for wall in scene.walls() {
        wall::encode(wall, encoder);
    }
}

fn decode_scene(decoder: &mut Decoder<'_>) -> Option<Scene> {
    let mut scene = Scene {
        revision: decoder.word()?,
        fade_s: decoder.number()?,
        mapping: mapping_of(decoder.word()?)?,
        stiffness: stiffness_of(decoder.word()?)?,
        allocation: allocation_of(decoder.word()?)?,
        ..Scene::default()
    };
    scene.count = usize::try_from(decoder.word()?).ok()?;
    scene.probe = probe::decode(decoder)?;
    for wall in scene.walls.get_mut(..scene.count)? {
        *wall = wall::decode(decoder)?;
    }
    Some(scene)
}

fn mapping_of(word: u64) -> Option<Mapping> {
    [Mapping::Transpose, Mapping::Inverse]
        .into_iter()
        .find(|mapping| *mapping as u64 == word)
}

fn stiffness_of(word: u64) -> Option<StiffnessScope> {
    [StiffnessScope::Pose, StiffnessScope::Workspace]
        .into_iter()
        .find(|scope| *scope as u64 == word)
}

fn allocation_of(word: u64) -> Option<Allocation> {
    [
        Allocation::MotorOnly,
        Allocation::MotorAndBrake,
        Allocation::BrakeOnly,
    ]
    .into_iter()
    .find(|allocation| *allocation as u64 == word)
}

#[cfg(test)]
#[path = "request_test.rs"]
mod tests;
