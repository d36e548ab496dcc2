//! All devices of a line together.

use super::device::Row;
use super::report::Counts;
use super::state::State;
use crate::numbers::TOLD;
use crate::system::Sheet;

/// The maximum number of devices named in warnings.
const TOLD_DEVICES: usize = 5;

impl State {
    /// Warnings about device numbers that two senders appear to share.
    pub(super) fn shared_numbers(&self) -> impl Iterator<Item = String> {
        let is_shared = |row: &Row| row.another >= TOLD;
        let shared = self.devices.iter().filter(move |(_, row)| is_shared(row));
        let told = shared.take(TOLD_DEVICES).map(|(number, row)| {
            format!("device {number}: {} frames do not follow its numbers and were left out: two senders use this number, or \
                     one does not count its boots", row.another)
        });
        let beyond = self.beyond;
        let beyond = format!("{beyond} frames were left out: they are of too many devices");
        told.chain((self.beyond > 0).then_some(beyond))
    }

    /// Warnings about senders that are not shown in detail and do not rely on their own estimates.
    pub(super) fn doubted(&self) -> impl Iterator<Item = String> {
        let others = self.devices.iter().filter(|(number, _)| Some(**number) != self.shown);
        let named = others.map(|(number, row)| (format!("device {number} does"), row.own_health));
        let unnamed = self.unnamed.iter();
        let unnamed =
            unnamed.map(|row| ("a sender without a number does".to_owned(), row.own_health));
        let mut doubted: Vec<_> = named
            .chain(unnamed)
            .filter_map(|(who, health)| Some((who, health.filter(|it| it.is_bad())?)))
            .map(|(who, health)| format!("{who} not rely on its own estimate: {health}"))
            .collect();
        if let Some(more) = doubted.len().checked_sub(TOLD_DEVICES).filter(|more| *more > 0) {
            doubted.truncate(TOLD_DEVICES);
            doubted.push(format!("{more} more senders do not rely on their own estimates"));
        }
        doubted.into_iter()
    }

    /// The sum of all devices' counters.
    pub(super) fn totals(&self) -> Counts {
        let mut totals = self.counts;
        let others = self.devices.iter().filter(|(number, _)| Some(**number) != self.shown);
        for row in others.map(|(_, row)| row).chain(&self.unnamed) {
            totals.taken += row.taken;
            totals.refused += row.refused;
            totals.restarts += row.restarts;
        }
        totals
    }

    /// The table of all devices that identify themselves, if there are any.
    pub(super) fn fleet(&self) -> Option<Sheet> {
        let number =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |it| format!("{it:.2}"));
        let row = |(device, row): (&u32, &Row)| {
            let [x, y, z] = [0, 1, 2].map(|axis| number(row.position.map(|it| it[axis])));
            let time_s = row.time_us.map(|time_us| time_us as f64 * 1e-6);
            let counts = [row.received, row.lost, row.another].map(|count| count.to_string());
            let outcomes = [row.taken, row.refused].map(|count| count.to_string());
            let place = [number(time_s), x, y, z, number(row.path_length_m)];
            let first = [device.to_string(), row.boot.to_string()];
            first
                .into_iter()
                .chain(counts)
                .chain(outcomes)
                .chain(place)
                .chain(row.healths())
                .collect()
        };
        let header = [
            "device",
            "boot",
            "frames",
            "lost",
            "of another",
            "taken in",
            "refused",
            "time, s",
            "x, m",
            "y, m",
            "z, m",
            "path, m",
            "health here",
            "device's own",
        ];
        let caption = "Each device has an estimator of its own; the setting device says which is shown in detail.";
        let sheet = Sheet::new("live-devices", "Devices", &header).caption(caption);
        (!self.devices.is_empty()).then(|| sheet.with(self.devices.iter().map(row)))
    }
}
