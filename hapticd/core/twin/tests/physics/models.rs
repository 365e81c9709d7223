//! The shipped device files.

use hapticd_control::model::DeviceModel;
use hapticd_twin::TwinModel;

fn parse(text: &str) -> (DeviceModel, TwinModel) {
    let mut table: toml::Table = text.parse().expect("device file is TOML");
    let twin = table.remove("twin").expect("device file has a twin");
    (
        table
            .try_into()
            .expect("device file matches the device model"),
        twin.try_into()
            .expect("twin section matches the twin model"),
    )
}

pub fn phantom() -> (DeviceModel, TwinModel) {
    parse(include_str!("../../../../devices/phantom-1.0.toml"))
}

pub fn hhd() -> (DeviceModel, TwinModel) {
    parse(include_str!("../../../../devices/hhd.toml"))
}
