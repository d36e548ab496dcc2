//! What is said at the end.

use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

use serde::Serialize;

use super::device::Row;
use crate::output;
use crate::text::printable_path;

/// What became of everything that arrived.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Bytes that were decoded; all are in the recording.
    pub bytes: u64,
    /// Good frames.
    pub received: u32,
    /// Pieces between two delimiters that cannot have been a whole frame: cut, too long, or noise.
    pub torn: u32,
    /// Frames whose checksum is wrong.
    pub corrupt: u32,
    /// Frames of another version, or with a message that this program does not know.
    pub unknown: u32,
    /// Numbers that are missing between those of the good frames.
    pub lost: u32,
    /// Good frames that came twice, too late, or from a second sender.
    pub left_out: u64,
    /// Measurements that the estimator took in.
    pub taken: u64,
    /// What arrived whole and cannot be true, or is older than what came before.
    pub refused: u64,
    /// How often the sender's clock began anew, and the estimator with it.
    pub restarts: u32,
}

/// A device that says who it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DeviceRow {
    /// Its number.
    pub device: u32,
    /// What became of it.
    #[serde(flatten)]
    pub row: Row,
}

impl DeviceRow {
    /// All, by their numbers.
    pub(super) fn all(devices: &BTreeMap<u32, Row>) -> Vec<Self> {
        devices.iter().map(|(&device, &row)| Self { device, row }).collect()
    }
}

/// Devices that the terminal shows.
const SHOWN: usize = 20;

/// What `host-sim live` prints at its end.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Whose estimator ran; `none` if none did.
    pub system: &'static str,
    /// What was listened to.
    pub source: String,
    /// Where everything is written down.
    pub recording: PathBuf,
    /// What became of it.
    pub counts: Counts,
    /// Those that say who they are; the rest is of the one that is shown in detail.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub devices: Vec<DeviceRow>,
    /// Where the estimator ended, m.
    pub position: Option<[f64; 3]>,
    /// Of an aeroplane: angle of attack (rad), pitch rate (rad/s), airspeed (m/s) and pitch (rad) at its end.
    pub state: Option<[f64; 4]>,
    /// Of a walk: its horizontal length from stance to stance, m.
    pub path_length_m: Option<f64>,
    /// Of a receiver of satellites: what else the estimator says, by name.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub facts: BTreeMap<String, String>,
    /// What a user should know.
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
        ]);
        for DeviceRow { device, row } in self.devices.iter().take(SHOWN) {
            let position = row.position;
            let position = position.map(|[x, y, z]| format!("{x:.2} m, {y:.2} m, {z:.2} m"));
            let counts = [*device, row.boot, row.received, row.lost, row.another].map(u64::from);
            let counts = counts.into_iter().chain([row.taken, row.refused]);
            table.add_row(counts.map(|it| it.to_string()).chain([position.unwrap_or_default()]));
        }
        write!(f, "\n{table}")?;
        let more = self.devices.len().saturating_sub(SHOWN);
        if more > 0 { write!(f, "\n… and {more} more devices (--json)") } else { Ok(()) }
    }
}
