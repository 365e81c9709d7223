use hapticd_servo::front::{Front, SendError};
use hapticd_servo::layout::{schema_hash, VERSION};
use hapticd_servo::region::{Identity, Region, RegionError};
use hapticd_servo::request::Request;
use std::fs;
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

fn place() -> (TempDir, PathBuf) {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("device.shm");
    (directory, path)
}

fn create(path: &Path, device_id: &str) -> Result<Region, RegionError> {
    let identity = Identity {
        device_id,
        rate_hz: 1000.0,
        twin: true,
    };
    Region::create(path, &identity)
}

/// Overwrites one word of the file.
fn spoil(path: &Path, word: u64, value: u64) {
    let mut file = fs::OpenOptions::new().write(true).open(path).unwrap();
    file.seek(SeekFrom::Start(word * 8)).unwrap();
    file.write_all(&value.to_ne_bytes()).unwrap();
}

#[test]
fn the_front_reads_the_header_that_the_servo_wrote() {
    let (_directory, path) = place();
    let region = create(&path, "left hand · 手").unwrap();
    let front = Front::attach(&path, false).unwrap();
    let info = front.region().info();
    assert_eq!(info.device_id, "left hand · 手");
    assert_eq!(info.rate_hz, 1000.0);
    assert_eq!(info.pid, std::process::id());
    assert!(info.twin);
    assert_eq!(front.region().layout(), region.layout());
    assert!(front.servo_alive(), "it has just started");
    assert_eq!(front.region().identity(), "");
    region.set_identity("board 4711");
    assert_eq!(front.region().identity(), "board 4711");
}

#[test]
fn a_second_servo_on_the_same_file_is_refused() {
    let (_directory, path) = place();
    let _first = create(&path, "a").unwrap();
    let second = create(&path, "a");
    assert!(matches!(second, Err(RegionError::ServoRunning(_))));
}

#[test]
fn a_second_front_is_refused_until_the_first_lets_go_but_observers_are_welcome() {
    let (_directory, path) = place();
    let _region = create(&path, "a").unwrap();
    let first = Front::attach(&path, false).unwrap();
    let second = Front::attach(&path, false);
    assert!(matches!(second, Err(RegionError::FrontAttached(_))));
    let observer = Front::attach(&path, true).unwrap();
    assert_eq!(observer.heartbeat(), Err(SendError::Observer));
    assert_eq!(observer.send(Request::Stop, None), Err(SendError::Observer));
    drop(first);
    assert!(Front::attach(&path, false).is_ok());
}

#[test]
fn request_numbers_go_on_where_the_last_front_left_them() {
    let (_directory, path) = place();
    let _region = create(&path, "a").unwrap();
    for expected in 1..4 {
        let front = Front::attach(&path, false).unwrap();
        assert_eq!(front.send(Request::Stop, None), Ok(expected));
    }
}

#[test]
fn a_restarted_servo_leaves_the_old_region_to_its_readers() {
    let (_directory, path) = place();
    let old = create(&path, "old").unwrap();
    let reader = Front::attach(&path, true).unwrap();
    drop(old);
    let _new = create(&path, "new").unwrap();
    assert_eq!(reader.region().info().device_id, "old");
    let front = Front::attach(&path, false).unwrap();
    assert_eq!(front.region().info().device_id, "new");
    assert_eq!(front.region().ticks().head(), 0);
}

#[test]
fn another_layout_or_schema_is_refused_by_name() {
    let (_directory, path) = place();
    drop(create(&path, "a").unwrap());
    spoil(&path, 2, schema_hash() ^ 1);
    let error = Region::attach(&path, false).err().unwrap();
    assert!(matches!(error, RegionError::Schema { found } if found == schema_hash() ^ 1));
    spoil(&path, 1, VERSION + 1);
    let error = Region::attach(&path, false).err().unwrap();
    assert!(matches!(error, RegionError::Version { found } if found == VERSION + 1));
    assert!(error.to_string().contains("restart the servo"));
    spoil(&path, 0, 0);
    let error = Region::attach(&path, false).err().unwrap();
    assert!(matches!(error, RegionError::NotARegion(_)));
}

#[test]
fn a_file_that_is_cut_short_or_lies_about_its_size_is_no_region() {
    let (_directory, path) = place();
    let refused = |path: &Path| {
        let error = Region::attach(path, false).err().unwrap();
        matches!(error, RegionError::NotARegion(_))
    };
    drop(create(&path, "a").unwrap());
    let length = fs::metadata(&path).unwrap().len();
    for cut in [length - 8, 64, 0] {
        let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
        file.set_len(cut).unwrap();
        assert!(refused(&path), "{cut} bytes of {length}");
    }
    for capacity in [0, 1 << 40, u64::MAX] {
        drop(create(&path, "a").unwrap());
        spoil(&path, 3, capacity);
        assert!(refused(&path), "capacity {capacity}");
    }
    let missing = Region::attach(&path.with_extension("none"), false);
    assert!(matches!(missing, Err(RegionError::Io(_))));
}
