//! Levels of a radio on board a drone and the places where they were heard, in bags of ROS 1 and MCAP of ROS 1 and ROS 2. A
//! table of text is a [`crate::NamedTable`].
//!
//! There is no common message for a level, so the definition in the file decides:
//!
//! | | topics that are recognised |
//! |---|---|
//! | place | `sensor_msgs/NavSatFix` with a fix |
//! | level | a number called `rssi`, `rss`, `signal`, `signal_strength`, `rx_power`, `received_power`, `rsrp`, with or without `_dbm`; `level_dbm`, `power_dbm`; `path_loss`: the field of a message, or the topic of one with nothing but `data` |
//! | height | a message with nothing but `data` on a topic `rel_alt`, `relative_altitude`, `height_above_takeoff`, `height_above_ground`, `height`, `agl` |
//!
//! Fractions and whole numbers with a sign are in dB; those without a sign are a radio's own units, and refused without
//! `--units rssi_db=dB`. The altitude of a fix counts from the ellipsoid and says nothing of a height above anybody, so it is
//! taken with `--columns h=altitude` alone.
//!
//! Each level is a row. Its place and height are interpolated between the messages before and after it, if they are within
//! two seconds; else it is left out and counted.

use crate::containers::{self, ALTITUDE, LevelEntry, LevelRole};
use crate::damage::Damage;
use crate::error::{Error, listed};
use crate::options::Options;
use crate::part::Part;

/// The longest gap between messages that is interpolated over, µs.
const LONGEST_GAP_US: f64 = 2e6;
/// The columns that options may refer to.
const NAMES: [&str; 4] = ["lat", "h", "rssi_db", "path_loss_db"];

/// A received level, and where it was received.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Heard {
    /// Time on the log's clock, µs.
    pub time_us: i64,
    /// Latitude, degrees.
    pub latitude: f64,
    /// Longitude, degrees.
    pub longitude: f64,
    /// Height above the take-off point, m.
    pub height: f64,
    /// Level or path loss, dB.
    pub level: f64,
}

/// A log of levels.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// The levels, in order of time.
    pub heard: Vec<Heard>,
    /// Whether the levels are path losses.
    pub are_losses: bool,
    /// What was recognised.
    pub conclusions: Vec<String>,
    /// What was skipped.
    pub damage: Damage,
}

/// Reads the levels of a bag or MCAP file; `None` if it is another file.
///
/// # Errors
/// What was expected and what was found, and which option decides where the log does not tell.
pub fn read(bytes: &[u8], options: &Options) -> Result<Option<Levels>, Error> {
    let Some((format, topics)) = containers::levels(bytes, options)? else { return Ok(None) };
    options.refuse_beside(&NAMES)?;
    let (fixes, heights, levels) = (topics.fixes()?, topics.heights()?, topics.levels()?);
    let scale = topics.scale(levels)?;
    let is_altitude = options.columns.of("h").is_some_and(|pick| pick.name == ALTITUDE);
    let heights = match heights {
        _ if is_altitude => None,
        Some(heights) => Some(heights),
        None => {
            return Err(Error::undecided(
                "expected a topic of heights above the ground, such as rel_alt, found altitudes above the ellipsoid alone",
                "--columns h=TOPIC, or h=altitude if those count from the user's ground,",
            ));
        }
    };
    let used = || [Some(fixes), heights, Some(levels)].into_iter().flatten();
    let has_stamps = used().all(|it| it.entries.iter().all(|entry| is_stamped(entry.stamp)));
    let times = Times { has_stamps };
    let (height_scale, place) = match heights {
        Some(heights) => (topics.scale(heights)?, 0),
        None => (1.0, 2),
    };
    let places = Track::of(&fixes.entries, &times, is_fix);
    let heights_by_time = Track::of(&heights.unwrap_or(fixes).entries, &times, |entry| {
        entry.values[place].is_finite() && (place == 0 || is_fix(entry))
    });
    let mut heard: Vec<_> = levels
        .entries
        .iter()
        .filter(|entry| entry.values[0].is_finite())
        .filter_map(|entry| {
            let time = times.of(entry);
            let [latitude, longitude, ..] = places.at(time)?;
            let height = heights_by_time.at(time)?[place] * height_scale;
            let (time_us, level) = (time.round() as i64, entry.values[0] * scale);
            Some(Heard { time_us, latitude, longitude, height, level })
        })
        .collect();
    heard.sort_by_key(|it| it.time_us);
    let stamps = if has_stamps { "" } else { ", times of receipt, as there are no stamps of all" };
    let height = heights.map_or_else(|| "altitude".to_owned(), |it| named(&it.name));
    let mut conclusions = vec![format!(
        "{} in dB: topic {}, places of {}, heights of {height}{stamps}: {format}",
        levels.field,
        named(&levels.name),
        named(&fixes.name)
    )];
    let left_out = levels.entries.len() - heard.len();
    if left_out > 0 {
        conclusions.push(format!(
            "levels left out, as no place or height is within two seconds: {left_out}"
        ));
    }
    let unfixed = fixes.entries.iter().filter(|entry| !is_fix(entry)).count();
    if unfixed > 0 {
        conclusions.push(format!("places left out, as they have no fix: {unfixed}"));
    }
    let damage = topics.losses.damage(Part::Record, levels.entries.len());
    damage.accept(levels.entries.len() + damage.count(), options.strict)?;
    let are_losses = levels.role == LevelRole::Loss;
    Ok(Some(Levels { heard, are_losses, conclusions, damage }))
}

fn named(topic: &str) -> String {
    listed([topic])
}

fn is_stamped(stamp: Option<f64>) -> bool {
    stamp.is_some_and(|stamp| stamp != 0.0)
}

/// Whether a message holds a valid fix: `STATUS_NO_FIX` is −1.
fn is_fix(entry: &LevelEntry) -> bool {
    let [latitude, longitude, _, status] = entry.values;
    status >= 0.0 && latitude.abs() <= 90.0 && longitude.abs() <= 360.0
}

/// Which time of a message is used: its stamp or its receipt.
struct Times {
    has_stamps: bool,
}

impl Times {
    /// The time of a message, µs.
    fn of(&self, entry: &LevelEntry) -> f64 {
        if self.has_stamps { entry.stamp.unwrap_or(entry.receipt) } else { entry.receipt }
    }
}

/// Numbers over time.
struct Track(Vec<(f64, [f64; 4])>);

impl Track {
    fn of(entries: &[LevelEntry], times: &Times, is_one: impl Fn(&LevelEntry) -> bool) -> Self {
        let wanted = entries.iter().filter(|entry| is_one(entry));
        let mut track: Vec<_> = wanted.map(|entry| (times.of(entry), entry.values)).collect();
        track.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self(track)
    }

    /// The numbers at a time, interpolated between two entries that are near each other.
    fn at(&self, time: f64) -> Option<[f64; 4]> {
        let next = self.0.partition_point(|(own, _)| *own < time);
        let &(end, to) = self.0.get(next)?;
        if end == time {
            return Some(to);
        }
        let &(begin, from) = self.0.get(next.checked_sub(1)?)?;
        if end - begin > LONGEST_GAP_US {
            return None;
        }
        let part = (time - begin) / (end - begin);
        let mut between = from;
        for (axis, (value, end)) in between.iter_mut().zip(to).enumerate() {
            let mut way = end - *value;
            if axis == 1 {
                // Across the date line the other way round is shorter.
                way -= 360.0 * (way / 360.0).round();
            }
            *value += part * way;
        }
        Some(between)
    }
}
