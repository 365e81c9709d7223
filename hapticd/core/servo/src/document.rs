//! Requests as the front writes them: JSON. Parsed in the front's process, never in the loop's.

use crate::request::Request;
use hapticd_control::fault::FaultSet;
use hapticd_control::scene::{Allocation, Mapping, Probe, Scene, StiffnessScope, Wall, MAX_WALLS};
use hapticd_control::state::Event;
use hapticd_twin::{Injection, Script};
use serde::Deserialize;
use serde_json::Value;

#[derive(Deserialize)]
#[serde(tag = "type", rename_all = "snake_case", deny_unknown_fields)]
enum Document {
    Desired { desired: Desired },
    Estop {},
    EstopAck {},
    FaultAck { faults: u64 },
    Scene { scene: FlatScene },
    Hand { script: Script },
    Inject { injection: Injection },
    Stop {},
}

#[derive(Deserialize)]
#[serde(rename_all = "snake_case")]
enum Desired {
    Enabled,
    Disabled,
    Paused,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FlatScene {
    revision: u64,
    fade_s: f64,
    mapping: Mapping,
    stiffness: StiffnessScope,
    allocation: Allocation,
    #[serde(default)]
    probe: Option<Probe>,
    walls: Vec<Wall>,
}

impl FlatScene {
    fn scene(&self) -> Result<Scene, String> {
        let mut scene = Scene {
            revision: self.revision,
            fade_s: self.fade_s,
            mapping: self.mapping,
            stiffness: self.stiffness,
            allocation: self.allocation,
            probe: self.probe,
            count: self.walls.len(),
            ..Scene::default()
        };
        let room = scene.walls.get_mut(..self.walls.len());
        let room = room.ok_or_else(|| format!("a scene holds at most {MAX_WALLS} walls"))?;
        room.copy_from_slice(&self.walls);
        Ok(scene)
    }
}

impl Document {
    fn request(self) -> Result<Request, String> {
        Ok(match self {
            Self::Desired { desired } => Request::Event(match desired {
                Desired::Enabled => Event::Enable,
                Desired::Disabled => Event::Disable,
                Desired::Paused => Event::Pause,
            }),
            Self::Estop {} => Request::Event(Event::EstopEngage),
            Self::EstopAck {} => Request::Event(Event::EstopAcknowledge),
            Self::FaultAck { faults } => {
                Request::Event(Event::FaultAcknowledge(FaultSet::from_bits(faults)))
            }
            Self::Scene { scene } => Request::Scene(scene.scene()?),
            Self::Hand { script } => Request::Hand(script),
            Self::Inject { injection } => Request::Inject(injection),
            Self::Stop {} => Request::Stop,
        })
    }
}

/// The request in `json`, and the epoch of the lease it was made under.
///
/// # Errors
/// What is wrong with it, in one sentence.
pub fn parse(json: &str) -> Result<(Request, Option<u64>), String> {
    let mut value: Value = serde_json::from_str(json).map_err(|error| error.to_string())?;
    let epoch = value.as_object_mut().and_then(|map| map.remove("epoch"));
    let epoch = match epoch {
        None | Some(Value::Null) => None,
        Some(epoch) => Some(epoch.as_u64().ok_or("epoch is no unsigned integer")?),
    };
    let document: Document = serde_path_to_error::deserialize(value)
        .map_err(|error| format!("{}: {}", error.path(), error.inner()))?;
    let request = document.request()?;
    if !request.is_valid() {
        return Err(
            "a number is out of range: normals have unit length, eta is 0 to 1, sizes and times are not negative, static friction is at least the kinetic, and every wall has a key of its own".into(),
        );
    }
    Ok((request, epoch))
}
