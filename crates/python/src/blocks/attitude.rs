//! Attitude and heading from gyroscope and accelerometer.

use kestirim_attitude::{Ahrs, Gains, Orientation};
use nalgebra::SVector;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{Line, Results, Table, doubles, rows, values};
use crate::error::{KestirimError, refused, refused_at};

/// Computes quaternions and gyroscope biases after each sample.
#[pyfunction]
#[pyo3(signature = (interval, gyro, accel, start, bias, tilt, bias_gain, gate))]
pub(crate) fn attitude<'py>(
    py: Python<'py>,
    interval: Line<'py>,
    gyro: Table<'py>,
    accel: Option<Table<'py>>,
    start: Option<[f64; 4]>,
    bias: [f64; 3],
    tilt: f64,
    bias_gain: f64,
    gate: f64,
) -> PyResult<Bound<'py, PyDict>> {
    let (interval, gyro) = (values(&interval)?, rows::<3>(&gyro)?);
    let accel = accel.as_ref().map(rows::<3>).transpose()?;
    let (quaternion, bias) = py.detach(|| {
        let start = match (start, accel.and_then(<[_]>::first)) {
            (Some(quaternion), _) => Orientation::from_quaternion(quaternion).ok_or_else(|| {
                KestirimError::new_err("start: expected a quaternion other than zero")
            })?,
            (None, Some(force)) => Orientation::from_specific_force(&SVector::from(*force))
                .ok_or_else(|| refused_at(0, "the specific force tells no direction"))?,
            (None, None) => Orientation::identity(),
        };
        let gains = Gains { tilt, bias: bias_gain, gate };
        let mut ahrs = Ahrs::new(start, SVector::from(bias), gains);
        let (mut quaternions, mut biases) = (Vec::new(), Vec::new());
        for (index, (interval, rate)) in interval.iter().zip(gyro).enumerate() {
            let force = accel.and_then(|accel| accel.get(index)).copied().map(SVector::from);
            let taken = ahrs.update(&SVector::from(*rate), force.as_ref(), *interval);
            taken.map_err(|error| refused_at(index, error))?;
            quaternions.push(ahrs.orientation().renormalised().quaternion());
            biases.push(doubles(ahrs.gyro_bias()));
        }
        Ok::<_, PyErr>((quaternions, biases))
    })?;
    if quaternion.is_empty() {
        return Err(refused("expected at least one sample, found none"));
    }
    Ok(Results::new(py).table("quaternion", quaternion)?.table("gyro_bias", bias)?.done())
}
