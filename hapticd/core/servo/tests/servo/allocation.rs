use crate::rig::Rig;
use assert_no_alloc::{assert_no_alloc, permit_alloc, AllocDisabler};
use std::sync::atomic::Ordering;

#[global_allocator]
static ALLOCATOR: AllocDisabler = AllocDisabler;

fn wall(key: usize) -> String {
    format!(
        r#"{{"key":{key},"shape":{{"type":"plane","normal":[0,0,1],"offset_m":-0.01}},"law":{{"type":"motion","eta":0.2}}}}"#
    )
}

#[test]
fn nothing_on_the_way_of_a_tick_or_a_request_allocates() {
    let walls: Vec<String> = (0..16).map(wall).collect();
    let scene = format!(
        r#"{{"type":"scene","scene":{{"revision":1,"fade_s":0.05,"mapping":"transpose","stiffness":"pose",
            "allocation":"motor_only","walls":[{}]}}}}"#,
        walls.join(",")
    );
    let rig = Rig::new();
    let report = rig.run_guarded(
        |run| assert_no_alloc(run),
        |moment| {
            permit_alloc(|| match moment.n {
                20 => {
                    moment.send(&scene);
                    moment.send(r#"{"type":"desired","desired":"enabled"}"#);
                    moment.send(r#"{"type":"hand","script":{"type":"hold"}}"#);
                }
                // The status is written within this time, and misses are told.
                300 => moment.clock.spend(5_000_000),
                400 => {
                    moment
                        .send(r#"{"type":"inject","injection":{"type":"silence","duration_s":1}}"#);
                }
                500 => moment.stop.store(true, Ordering::Relaxed),
                _ => {}
            });
        },
    );
    assert_eq!(report.acks.len(), 4);
}
