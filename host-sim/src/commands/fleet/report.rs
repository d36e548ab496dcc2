//! The report at the end of a run.

use std::fmt;

use serde::Serialize;

use super::counts::Counts;
use super::keyed::Fleet;
use crate::numbers::TOLD;
use crate::output;

/// The maximum number of devices named in a warning.
const NAMED: usize = 5;

/// The report that `host-sim fleet` prints at its end.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    system: &'static str,
    source: String,
    /// The number of devices heard. Like the counts below, it covers all runs since the states were begun.
    devices: usize,
    counts: Counts,
    /// Messages that were not complete frames of devices.
    unreadable: u64,
    /// The mean memory of a device in bytes.
    bytes_a_device: f64,
    /// The number of messages that this run processed, and its duration in seconds.
    messages: u64,
    seconds: f64,
    warnings: Vec<String>,
}

impl Report {
    pub(super) fn of(
        (system, source): (&'static str, String),
        fleet: &Fleet,
        messages: u64,
        seconds: f64,
    ) -> Self {
        let devices = fleet.keyed.devices.len();
        Self {
            system,
            source,
            devices,
            counts: fleet.counts(),
            unreadable: fleet.keyed.unreadable,
            bytes_a_device: fleet.bytes() as f64 / devices.max(1) as f64,
            messages,
            seconds,
            warnings: warnings(fleet),
        }
    }

    /// Warnings for the user.
    pub(super) fn warnings(&self) -> &[String] {
        &self.warnings
    }
}

fn warnings(fleet: &Fleet) -> Vec<String> {
    let devices = fleet.keyed.devices.iter();
    let shared = devices.filter(|(_, device)| device.counts.another >= u64::from(TOLD));
    let shared: Vec<_> = shared.map(|(number, _)| number.to_string()).collect();
    let named = shared.get(..shared.len().min(NAMED)).unwrap_or_default().join(", ");
    let more = if shared.len() > NAMED { ", …" } else { "" };
    let told = format!(
        "{} device numbers are used by two senders, or by one that does not count its boots: {named}{more}; the first is \
         followed",
        shared.len()
    );
    let unreadable = fleet.keyed.unreadable;
    let other = format!("{unreadable} messages were not whole frames of devices (version 2)");
    let told = (!shared.is_empty()).then_some(told);
    told.into_iter().chain((unreadable > 0).then_some(other)).collect()
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        row("source", self.source.clone());
        row("devices", self.devices.to_string());
        for (name, _, count) in self.counts.named() {
            row(name, count.to_string());
        }
        row("bytes a device", format!("{:.0}", self.bytes_a_device));
        let rate = self.messages as f64 / self.seconds.max(1e-3);
        row("messages", format!("{} in {:.1} s, {rate:.0} a second", self.messages, self.seconds));
        table.fmt(f)
    }
}
