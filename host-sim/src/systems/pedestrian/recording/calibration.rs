//! Calibrations of inertial sensors, as files of parameters.

use std::path::Path;

use kestirim_imu_calibration::{Calibration, Triad};
use nalgebra::SVector;
use serde::Serialize;

use crate::systems::pedestrian::Sample;
use crate::text::printable;
use crate::{Error, output, table};

/// The largest plausible offset (m/s²), bias (rad/s), and deviation of a matrix from the identity.
const FARTHEST: [f64; 3] = [20.0, 2.0, 1.0];
const AXES: [&str; 3] = ["x", "y", "z"];
/// The names of the sensors, the name of their offset, and its unit.
const SENSORS: [(&str, &str, &str); 2] = [("acc", "offset", "m/s²"), ("gyro", "bias", "rad/s")];

/// A number of a calibration.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Parameter {
    /// The name: `acc_offset_x`, `acc_xy` (row x, column y), `gyro_bias_x`, `gyro_xy`.
    pub name: String,
    /// The value of the parameter.
    pub value: f64,
    /// The standard deviation; `None` if the parameter was not determined and has the value of a perfect sensor.
    pub sigma: Option<f64>,
    /// The unit of value and standard deviation; empty for a matrix.
    pub unit: &'static str,
}

/// The standard deviations of a triad's parameters.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sigmas {
    /// The standard deviations of the offset.
    pub offset: [Option<f64>; 3],
    /// The standard deviations of the matrix, row by row.
    pub matrix: [[Option<f64>; 3]; 3],
}

/// All parameters of a calibration.
pub fn parameters(calibration: &Calibration<f64>, sigmas: [Sigmas; 2]) -> Vec<Parameter> {
    let triads = [&calibration.accelerometer, &calibration.gyroscope];
    let mut parameters = Vec::new();
    for (((sensor, offset, unit), triad), sigmas) in SENSORS.into_iter().zip(triads).zip(sigmas) {
        for row in 0..3 {
            let name = format!("{sensor}_{offset}_{}", AXES[row]);
            let (value, sigma) = (triad.offset[row], sigmas.offset[row]);
            parameters.push(Parameter { name, value, sigma, unit });
        }
        for row in 0..3 {
            for column in 0..3 {
                let name = format!("{sensor}_{}{}", AXES[row], AXES[column]);
                let (value, sigma) = (triad.matrix[(row, column)], sigmas.matrix[row][column]);
                parameters.push(Parameter { name, value, sigma, unit: "" });
            }
        }
    }
    parameters
}

/// Writes CSV with columns `parameter,value,sigma,unit`.
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, parameters: &[Parameter]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["parameter", "value", "sigma", "unit"])?;
        for Parameter { name, value, sigma, unit } in parameters {
            let sigma = sigma.map_or_else(String::new, |sigma| format!("{sigma:.7}"));
            table.write_record([name, &format!("{value:.7}"), &sigma, *unit])?;
        }
        table.flush()
    })
}

/// Reads such a file: every parameter once, in any order.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn read(path: &Path) -> Result<Calibration<f64>, Error> {
    let names = parameters(&Calibration::identity(), [Sigmas::default(); 2]);
    let mut found = vec![None; names.len()];
    table::read(
        path,
        "parameters of a calibration",
        |header| header.require(["parameter", "value"]),
        |&[name, value], row| {
            let (name, value) = (row.text(name), row.number("value", value)?);
            let place = names.iter().position(|known| known.name == name);
            let Some(place) = place.filter(|&place| found[place].is_none()) else {
                let problem = format!("expected another parameter, found {}", printable(&name));
                return Err(row.line.error(problem));
            };
            let (perfect, unit) = (names[place].value, names[place].unit);
            let farthest =
                FARTHEST[if unit == "m/s²" { 0 } else { 1 + usize::from(unit.is_empty()) }];
            let off = (value - perfect).abs();
            if off.is_nan() || off > farthest {
                let problem = format!("expected {perfect} ± {farthest} {unit}, found {value}");
                return Err(row.line.error(problem.replace(" ,", ",")));
            }
            found[place] = Some(value);
            Ok(())
        },
    )?;
    if let Some(missing) = found.iter().position(Option::is_none) {
        let problem = format!("expected a parameter {}, found none", names[missing].name);
        return Err(Error::File { path: path.to_path_buf(), problem });
    }
    let mut found = found.into_iter().flatten();
    let mut next = || found.next().unwrap_or_default();
    let mut triad = || {
        let mut triad = Triad::identity();
        for row in 0..3 {
            triad.offset[row] = next();
        }
        for row in 0..3 {
            for column in 0..3 {
                triad.matrix[(row, column)] = next();
            }
        }
        triad
    };
    Ok(Calibration { accelerometer: triad(), gyroscope: triad() })
}

/// A sample corrected by a calibration.
pub fn corrected(calibration: &Calibration<f64>, sample: &Sample) -> Sample {
    let (force, rate) = calibration
        .apply(&SVector::from(sample.specific_force), &SVector::from(sample.angular_rate));
    Sample { specific_force: force.into(), angular_rate: rate.into(), ..*sample }
}

/// The calibration in the form of firmware source.
pub fn firmware(calibration: &Calibration<f64>) -> String {
    let numbers = |values: [f64; 3]| values.map(|value| format!("{:?}", value as f32)).join(", ");
    let triad = |name: &str, triad: &Triad<f64>| {
        let rows: [_; 3] = std::array::from_fn(|row| {
            let of_row = [0, 1, 2].map(|column| triad.matrix[(row, column)]);
            format!("            {},\n", numbers(of_row))
        });
        format!(
            "    {name}: Triad {{\n        offset: Vector3::new({}),\n        matrix: Matrix3::new(\n{}        ),\n    }},\n",
            numbers(triad.offset.into()),
            rows.concat()
        )
    };
    format!(
        "use kestirim_imu_calibration::{{Calibration, Triad}};\nuse nalgebra::{{Matrix3, Vector3}};\n\n\
         let calibration = Calibration::<f32> {{\n{}{}}};",
        triad("accelerometer", &calibration.accelerometer),
        triad("gyroscope", &calibration.gyroscope)
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix3, Vector3};

    fn wrong() -> Calibration<f64> {
        let matrix = Matrix3::new(0.98, 0.012, -0.008, 0.0, 1.025, 0.01, 0.0, 0.0, 1.01);
        let accelerometer = Triad { offset: Vector3::new(0.3, -0.25, 0.15), matrix };
        Calibration { accelerometer, ..Calibration::identity() }
    }

    #[test]
    fn what_is_written_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("calibration.csv");
        write(&path, &parameters(&wrong(), [Sigmas::default(); 2])).unwrap();
        assert_eq!(read(&path).unwrap(), wrong());
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(
            text.starts_with("parameter,value,sigma,unit\nacc_offset_x,0.3000000,,m/s²\n"),
            "{text}"
        );
        for (from, to, expected) in [
            ("acc_xx,0.98", "acc_xx,9.8", "line 5: expected 1 ± 1, found 9.8"),
            ("acc_xx", "acc_qq", "line 5: expected another parameter, found \"acc_qq\""),
            ("acc_xy", "acc_xx", "line 6: expected another parameter, found \"acc_xx\""),
            ("acc_offset_x,0.3", "acc_offset_x,300.3", "line 2: expected 0 ± 20 m/s², found"),
            ("gyro_zz,1.0000000,,\n", "", "expected a parameter gyro_zz, found none"),
            ("acc_zz,1.01", "acc_zz,up1.01", "line 13: expected a finite number"),
        ] {
            std::fs::write(&path, text.replace(from, to)).unwrap();
            let refusal = read(&path).unwrap_err().to_string();
            assert!(refusal.contains(expected), "{refusal}");
        }
    }

    #[test]
    fn firmware_has_the_same_numbers() {
        let text = firmware(&wrong());
        assert!(text.contains("offset: Vector3::new(0.3, -0.25, 0.15),"), "{text}");
        assert!(text.contains("            0.98, 0.012, -0.008,\n            0.0, 1.025, 0.01,\n"));
    }
}
