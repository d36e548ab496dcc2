//! Text export of Xsens MT Manager: comments of `//`, then tabulators between `PacketCounter`, `SampleTimeFine`, `Acc_X`, …,
//! `Gyr_X`, … (MT Manager User Manual, "Exporter"): m/s², rad/s, and `SampleTimeFine` in ticks of 0.1 ms. It holds nothing in
//! exports of `MTw`, whose packets are only counted: their rate is asked for.

use super::{Description, Format, has};
use crate::table::Table;

const SENSORS: [&str; 6] = ["Acc_X", "Acc_Y", "Acc_Z", "Gyr_X", "Gyr_Y", "Gyr_Z"];

pub(super) const XSENS: Description = Description {
    format: Format::Xsens,
    name: "xsens",
    title: "Xsens MT export",
    is_it: Some(is_it),
    time: &[("SampleTimeFine", "0.1ms"), ("PacketCounter", "")],
    sensors: SENSORS,
    acceleration: "m/s2",
    rate: "rad/s",
    is_a_guess: false,
};

fn is_it(table: &Table) -> bool {
    has(table, &["PacketCounter"]) && has(table, &SENSORS)
}
