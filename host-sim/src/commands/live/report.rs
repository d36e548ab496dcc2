//! The report at the end of a stream.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::Serialize;

use super::device::Row;
use crate::output;
use crate::text::printable_path;

/// Counters of everything that arrived.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Decoded bytes; all of them are in the recording.
    pub bytes: u64,
    /// The number of good frames.
    pub received: u32,
    /// Fragments between two delimiters that cannot have been a complete frame: cut, too long, or noise.
    pub torn: u32,
    /// Frames with a wrong checksum.
    pub corrupt: u32,
    /// Frames of another version, or with an unknown message.
    pub unknown: u32,
    /// Missing sequence numbers between those of the good frames.
    pub lost: u32,
    /// Good frames that were duplicates, too late, or from a second sender.
    pub left_out: u64,
    /// Measurements that the estimator used.
    pub taken: u64,
    /// Intact measurements that are implausible or older than earlier ones.
    pub refused: u64,
    /// The number of times that the sender's clock restarted, and the estimator with it.
    pub restarts: u32,
}

/// A device that identifies itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeviceRow {
    /// The number of the device.
    pub device: u32,
    /// The counters and position of the device.
    #[serde(flatten)]
    pub row: Row,
}

impl DeviceRow {
    /// All devices, ordered by number.
    pub(super) fn all(devices: &BTreeMap<u32, Row>) -> Vec<Self> {
        devices.iter().map(|(&device, &row)| Self { device, row }).collect()
    }
}

/// The maximum number of devices that the terminal shows.
const SHOWN: usize = 20;

/// The report that `host-sim live` prints at its end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// The system whose estimator ran; `none` if none did.
    pub system: &'static str,
    /// The source of the stream.
    pub source: String,
    /// The path of the recording.
    pub recording: PathBuf,
    /// The counters of the stream.
    pub counts: Counts,
    /// The devices that identify themselves; the fields below are those of the device shown in detail.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub devices: Vec<DeviceRow>,
    /// The final position estimate (m).
    pub position: Option<[f64; 3]>,
    /// For an aeroplane, the final angle of attack (rad), pitch rate (rad/s), airspeed (m/s) and pitch angle (rad).
    pub state: Option<[f64; 4]>,
    /// For a walk, its horizontal length from stance to stance (m).
    pub path_length_m: Option<f64>,
    /// For a satellite receiver, the estimator's further results by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub facts: BTreeMap<String, String>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        let mut row = |name: &str, value: String| {
            table.add_row([name, value.as_str()]);
        };
        let counts = &self.counts;
        row("source", self.source.clone());
        row("recording", format!("{}, {} bytes", printable_path(&self.recording), counts.bytes));
        row("frames received", counts.received.to_string());
        row("  lost on the way", counts.lost.to_string());
        row("  left out", counts.left_out.to_string());
        let Counts { torn, corrupt, unknown, .. } = counts;
        row("torn, corrupt, unknown", format!("{torn}, {corrupt}, {unknown}"));
        row("measurements taken in", counts.taken.to_string());
        row("  refused", counts.refused.to_string());
        if let Some([x, y, z]) = self.position {
            row("position", format!("{x:.2} m, {y:.2} m, {z:.2} m"));
        }
        if let Some([alpha, rate, airspeed, pitch]) = self.state {
            row("angle of attack", format!("{alpha:.4} rad"));
            row("pitch rate", format!("{rate:.4} rad/s"));
            row("airspeed", format!("{airspeed:.2} m/s"));
            row("pitch", format!("{pitch:.4} rad"));
        }
        if let Some(length) = self.path_length_m {
            row("path length", format!("{length:.2} m"));
        }
        for (name, value) in &self.facts {
            row(name, value.clone());
        }
        table.fmt(f)?;
        if self.devices.is_empty() { Ok(()) } else { self.devices(f) }
    }
}

impl Report {
    fn devices(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut table = output::table();
        table.set_header([
            "device",
            "boot",
            "frames",
            "lost",
            "of another",
            "taken in",
            "refused",
            "position",
            "health here",
            "device's own",
        ]);
        for DeviceRow { device, row } in self.devices.iter().take(SHOWN) {
            let position = row.position;
            let position = position.map(|[x, y, z]| format!("{x:.2} m, {y:.2} m, {z:.2} m"));
            let counts = [*device, row.boot, row.received, row.lost, row.another].map(u64::from);
            let counts = counts.into_iter().chain([row.taken, row.refused]);
            let position = [position.unwrap_or_default()];
            let counts = counts.map(|it| it.to_string());
            table.add_row(counts.chain(position).chain(row.healths()));
        }
        write!(f, "\n{table}")?;
        let more = self.devices.len().saturating_sub(SHOWN);
        if more > 0 { write!(f, "\n… and {more} more devices (--json)") } else { Ok(()) }
    }
}
