//! Logs of a robot's IMU and wheels.

use std::path::Path;

use kestirim_import::Options;
use kestirim_replay::robot::{Inertial, Wheels};

use crate::Error;
use crate::table::{self, Column, Found, Log, Row};

/// Standard gravity, m/s².
const GRAVITY: f64 = 9.806_65;

/// The usual range of the time between samples of a robot's wheels (s).
const USUAL_STEP_S: [f64; 2] = [5e-4, 2.0];
/// That of its IMU (s): steps of a whole second are milliseconds.
const USUAL_STEP_OF_IMU_S: [f64; 2] = [5e-4, 0.5];

/// The columns of an IMU log that are present.
struct Columns {
    time: Column,
    attitude: Option<[Column; 4]>,
    linear: Option<[Column; 3]>,
    force: Option<[Column; 3]>,
}

fn numbers<const K: usize>(row: &Row<'_>, columns: [Column; K]) -> Result<[f64; K], Error> {
    let mut values = [0.0; K];
    for (value, column) in values.iter_mut().zip(columns) {
        *value = row.number("of the IMU", column)?;
    }
    Ok(values)
}

/// Reads an IMU: CSV with a column `t` (s) and any of `qw,qx,qy,qz` (body to room), `gx,gy,gz` (rad/s),
/// `ax,ay,az` (specific force, m/s²) and `lax,lay,laz` (acceleration without gravity, body, m/s²).
///
/// Without any acceleration there are no samples. A position tracker does not need the angular rate.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_inertial(path: &Path, options: &Options) -> Result<(Vec<Inertial>, Found), Error> {
    let mut samples: Vec<Inertial> = Vec::new();
    let found = table::read_log(
        path,
        &Log { what: "samples of an IMU", usual_step_s: Some(USUAL_STEP_OF_IMU_S), options },
        |header| {
            let [time] = header.require(["t"])?;
            Ok(Columns {
                time,
                attitude: header.all(["qw", "qx", "qy", "qz"])?,
                linear: header.all(["lax", "lay", "laz"])?,
                force: header.all(["ax", "ay", "az"])?,
            })
        },
        |columns, row| {
            let time_us = row.time_us(columns.time)?;
            let attitude = columns.attitude.map(|columns| numbers(row, columns)).transpose()?;
            let linear = columns.linear.map(|columns| numbers(row, columns)).transpose()?;
            let force = columns.force.map(|columns| numbers(row, columns)).transpose()?;
            let Some(acceleration) = linear.or(force) else { return Ok(()) };
            let push = attitude.and_then(|attitude| {
                let [x, y, z] = turned(attitude, acceleration)?;
                Some([x, y, if linear.is_some() { z } else { z - GRAVITY }])
            });
            samples.push(Inertial { time_us, acceleration, push });
            Ok(())
        },
    )?;
    Ok((samples, found))
}

/// The largest plausible track width of a vehicle (m).
const WIDEST_TRACK_M: f64 = 10.0;

/// Reads wheels: CSV with columns `t,v_left,v_right,track` (s, m/s, m; the track at most 10 m).
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read_wheels(path: &Path, options: &Options) -> Result<(Vec<Wheels>, Found), Error> {
    let mut samples: Vec<Wheels> = Vec::new();
    let found = table::read_log(
        path,
        &Log { what: "samples of the wheels", usual_step_s: Some(USUAL_STEP_S), options },
        |header| header.require(["t", "v_left", "v_right", "track"]),
        |&[t, left, right, track], row| {
            let time_us = row.time_us(t)?;
            let (left, right) = (row.number("v_left", left)?, row.number("v_right", right)?);
            let track = row.number("track", track)?;
            if track <= 0.0 || track > WIDEST_TRACK_M {
                let problem = format!(
                    "expected a wheel track above 0 and at most {WIDEST_TRACK_M} m, found {track}"
                );
                return Err(row.line.error(problem));
            }
            let turn_rate = (right - left) / track;
            samples.push(Wheels { time_us, speed: 0.5 * (left + right), turn_rate });
            Ok(())
        },
    )?;
    Ok((samples, found))
}

/// Rotates a vector from the body to the room; `None` for a quaternion of length zero.
fn turned([w, x, y, z]: [f64; 4], [a, b, c]: [f64; 3]) -> Option<[f64; 3]> {
    let size = w * w + x * x + y * y + z * z;
    if size < 1e-6 {
        return None;
    }
    let turned = [
        (w * w + x * x - y * y - z * z) * a + 2.0 * ((x * y - w * z) * b + (x * z + w * y) * c),
        (w * w - x * x + y * y - z * z) * b + 2.0 * ((x * y + w * z) * a + (y * z - w * x) * c),
        (w * w - x * x - y * y + z * z) * c + 2.0 * ((x * z - w * y) * a + (y * z + w * x) * b),
    ];
    Some(turned.map(|component| component / size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quaternion_turns_from_body_to_room() {
        let half = std::f64::consts::FRAC_1_SQRT_2;
        // After a quarter turn to the left, ahead in the body frame is y in the room.
        let [x, y, z] = turned([half, 0.0, 0.0, half], [1.0, 0.0, 2.0]).unwrap();
        assert!(x.abs() < 1e-12 && (y - 1.0).abs() < 1e-12 && (z - 2.0).abs() < 1e-12);
        assert_eq!(turned([0.0; 4], [1.0; 3]), None);
    }

    #[test]
    fn a_track_that_no_vehicle_has_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("odom.csv");
        for (track, is_refused) in [(0.0, true), (0.08, false), (10.0, false), (10.1, true)] {
            let rows = format!("0.1,1.0,1.1,{track}\n0.2,1.0,1.1,{track}\n");
            std::fs::write(&path, format!("t,v_left,v_right,track\n{rows}")).unwrap();
            let read = read_wheels(&path, &Options::default());
            assert_eq!(read.is_err(), is_refused, "{track} m: {read:?}");
        }
    }
}
