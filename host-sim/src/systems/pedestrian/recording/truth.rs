//! Measured footprints: the positions of the foot, with times.

use std::path::Path;

use kestirim_replay::pedestrian::Footprint;

use super::log::Log;
use crate::{Error, output, table};

/// The time by which a footprint may lie beyond the ends of a log (µs): a log that was averaged or rewritten in
/// milliseconds ends a few samples early, while the foot is stationary.
const SLACK_US: u64 = 100_000;

/// Reads footprints: CSV with columns `t,x,y` (s, m); others, such as `sample_index`, are ignored. They are matched to
/// the log by `t`. Those outside its time are left out with a warning, as a log may have been cut.
///
/// # Errors
/// An error that names the file, the line, and what was expected there; also if fewer than two footprints, or fewer
/// than half, lie within the `log`, which then belongs to another walk.
pub fn read(path: &Path, log: &Log) -> Result<Vec<Footprint>, Error> {
    let mut footprints: Vec<Footprint> = Vec::new();
    let mut beyond = 0_usize;
    let [start, end] = [log.start_us(), log.end_us()].map(|us| us as f64 * 1e-6);
    table::read(
        path,
        "footprints",
        |header| header.require(["t", "x", "y"]),
        |&[t, x, y], row| {
            let (time_us, position) =
                (row.time_us(t)?, [row.coordinate("x", x)?, row.coordinate("y", y)?]);
            let within = |time_us: &u64| {
                let logged = log.start_us().saturating_sub(SLACK_US)..=log.end_us() + SLACK_US;
                logged.contains(time_us)
            };
            let Some(time_us) = u64::try_from(time_us).ok().filter(within) else {
                beyond += 1;
                return Ok(());
            };
            if footprints.last().is_some_and(|last| time_us < last.time_us) {
                return Err(row.line.error(
                    "expected a time not before that of the line above, found an earlier one",
                ));
            }
            footprints.push(Footprint { time_us, position });
            Ok(())
        },
    )?;
    let all = footprints.len() + beyond;
    if footprints.len() < 2.max(beyond) {
        let problem = format!(
            "expected at least two footprints, and half of them, within the log, {start:.3} to {end:.3} s, found {} of {all}",
            footprints.len()
        );
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    if beyond > 0 {
        let sentence = format!(
            "footprints outside the log, {start:.1} to {end:.1} s, are left out: {beyond} of {all}"
        );
        output::warn_of(path, &[sentence]);
    }
    Ok(footprints)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::systems::pedestrian::Sample;

    fn read_text(text: &str) -> Result<Vec<Footprint>, String> {
        let still =
            |time_us| Sample { time_us, specific_force: [0.0, 0.0, 9.8], angular_rate: [0.0; 3] };
        let log = Log { samples: vec![still(0), still(2_000_000)], ..Log::default() };
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), text).expect("it is written");
        read(file.path(), &log).map_err(|error| error.to_string())
    }

    #[test]
    fn footprints_are_read() {
        let footprints = read_text("sample_index,t,x,y\n0,0.5,1,2\n9,2.05,3,4\n").unwrap();
        assert_eq!(footprints[1], Footprint { time_us: 2_050_000, position: [3.0, 4.0] });
        // The footprints of a log that was cut.
        let cut = read_text("t,x,y\n0.5,1,2\n1,3,4\n3,9,9\n").unwrap();
        assert_eq!(cut.len(), 2);
    }

    #[test]
    fn broken_footprints_are_located() {
        for (text, expected) in [
            ("", "found an empty file"),
            ("t,x\n", "line 1: expected a header with a column y"),
            (
                "t,x,y\n0,0,0\n",
                "at least two footprints, and half of them, within the log, 0.000 to 2.000 s, found 1 of 1",
            ),
            ("t,x,y\n0,0,0\n3,0,0\n", "found 1 of 2"),
            ("t,x,y\n-1,0,0\n-0.5,0,0\n", "found 0 of 2"),
            ("t,x,y\n1,0,0\n0,0,0\n", "line 3: expected a time not before"),
            ("t,x,y\n1,0,zero\n", "line 2: expected a finite number in column y"),
            ("t,x,y\n1,0,1e9\n", "line 2: expected a position in metres"),
        ] {
            let complaint = read_text(text).unwrap_err();
            assert!(complaint.contains(expected), "{complaint} / {expected}");
        }
    }
}
