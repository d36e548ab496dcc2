//! Where a tag is, from ranges to anchors.

mod events;
mod height;
mod tag;
mod trace;

use pyo3::prelude::*;
use pyo3::types::PyDict;

use self::events::{Motion, Rows};
use self::height::Found;
use self::tag::Setup;
use self::trace::{Trace, follow};
use crate::arrays::{Counts, Line, Results, ScalarKind, Table, reasons, rows, values};
use crate::error::KestirimError;

/// Most anchors of a tracker.
pub(crate) const MOST: usize = 32;

/// A tag's track.
#[pyfunction]
#[pyo3(signature = (anchors, t, anchor, range, height, heights, biases, imu, wheels, room, dim, scalar))]
pub(crate) fn robot<'py>(
    py: Python<'py>,
    anchors: Table<'py>,
    t: Line<'py>,
    anchor: Counts<'py>,
    range: Line<'py>,
    height: Option<f64>,
    heights: Option<(Line<'py>, Line<'py>)>,
    biases: Option<Line<'py>>,
    imu: Option<(Line<'py>, Table<'py>)>,
    wheels: Option<(Line<'py>, Line<'py>, Line<'py>)>,
    room: Option<[f64; 4]>,
    dim: usize,
    scalar: &str,
) -> PyResult<Bound<'py, PyDict>> {
    let scalar = ScalarKind::named(scalar)?;
    let anchors = rows::<3>(&anchors)?;
    let biases = biases.as_ref().map(values).transpose()?;
    let mut motion = Motion::default();
    if let Some((t, accel)) = &imu {
        motion.add_imu(values(t)?, rows(accel)?);
    }
    if let Some((t, speed, turn_rate)) = &wheels {
        motion.add_wheels(values(t)?, values(speed)?, values(turn_rate)?);
    }
    let heights = heights.as_ref();
    let heights = heights.map(|(t, z)| PyResult::Ok((values(t)?, values(z)?))).transpose()?;
    let ranges = Rows { t: values(&t)?, anchor: values(&anchor)?, range: values(&range)?, heights };
    let (trace, found) = py.detach(|| -> PyResult<(Trace, Option<Found>)> {
        if anchors.len() > MOST {
            let sentence = format!("expected at most {MOST} anchors, found {}", anchors.len());
            return Err(KestirimError::new_err(sentence));
        }
        ranges.check(anchors.len())?;
        let mut setup = Setup {
            anchors: anchors.to_vec(),
            biases: biases.map(<[f64]>::to_vec),
            height: height.unwrap_or_default(),
            room,
            has_wheels: motion.has_wheels(),
            dim,
            found: None,
        };
        // In space the height is estimated, and begun at the anchors' mean.
        if height.is_none() && (dim == 3 || heights.is_some()) {
            let sum: f64 = anchors.iter().map(|[_, _, z]| z).sum();
            setup.height = sum / anchors.len().max(1) as f64;
        }
        if height.is_none() && dim == 2 && heights.is_none() {
            let found = height::find(&setup, &ranges)?;
            setup.height = found.metres;
            setup.found = Some(found);
        }
        let mut tag = tag::build(&setup, scalar)?;
        let mut trace = follow(tag.as_mut(), &ranges, &motion);
        if let Some(found) = &setup.found {
            trace.widen(found);
        }
        Ok((trace, setup.found))
    })?;
    let results = Results::new(py)
        .line("t", trace.seconds())?
        .table("position", trace.positions())?
        .table("sigma", trace.sigmas())?
        .line("health", trace.healths())?
        .with("lost", trace.lost_s())?
        .with("reasons", reasons(trace.doubts()))?
        .with("height", found.as_ref().map(|found| found.metres))?
        .with("height_sigma", found.as_ref().map(|found| found.sigma))?;
    Ok(results.line("taken", trace.taken)?.line("nis", trace.nis)?.done())
}
