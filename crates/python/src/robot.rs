//! The position of a tag, from ranges to anchors.

use kestirim_replay::Finding;
use kestirim_replay::robot::{
    Anchors, Course, Dimensions, Epoch, Error, FoundHeight, Inertial, KnownHeight, MOST, RangeRow,
    Sensors, Setup, Smoothed, Trace, Tracked, Unsmoothed, Wheels, check, doubts, smooth, track,
};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::arrays::{
    Counts, Line, Results, Table, code, microseconds, reasons, rows, scalar, sentences, values,
};
use crate::error::{KestirimError, refused_at};

/// The hint for ranges that do not determine the height.
const MISSING: &str = "expected height, metres above the floor (or dim=3)";

/// Tracks a tag.
#[pyfunction]
#[pyo3(signature = (anchors, t, anchor, range, height, heights, biases, imu, wheels, room, dim, scalar, smooth))]
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
    smooth: bool,
) -> PyResult<Bound<'py, PyDict>> {
    let places = rows::<3>(&anchors)?;
    if places.len() > MOST {
        let sentence = format!("expected at most {MOST} anchors, found {}", places.len());
        return Err(KestirimError::new_err(sentence));
    }
    let log = ranges(values(&t)?, values(&anchor)?, values(&range)?, places.len())?;
    let mut sensors = Sensors::ranges(log.clone());
    if let Some((t, accel)) = &imu {
        let rows = values(t)?.iter().zip(rows::<3>(accel)?);
        let sample = |(t, &acceleration): (&f64, &[f64; 3])| Inertial {
            time_us: microseconds(*t),
            acceleration,
            push: None,
        };
        sensors.inertial = rows.map(sample).collect();
    }
    if let Some((t, speed, turn_rate)) = &wheels {
        let rows = values(t)?.iter().zip(values(speed)?).zip(values(turn_rate)?);
        let sample = |((t, &speed), &turn_rate): ((&f64, &f64), &f64)| Wheels {
            time_us: microseconds(*t),
            speed,
            turn_rate,
        };
        sensors.wheels = rows.map(sample).collect();
    }
    if let Some((t, z)) = &heights {
        let rows = values(t)?.iter().zip(values(z)?);
        sensors.height = Some(Course::new(rows.map(|(t, z)| (microseconds(*t), [*z])).collect()));
    }
    let dimensions = match dim {
        2 => Dimensions::Two,
        3 => Dimensions::Three,
        other => {
            return Err(KestirimError::new_err(format!("dim: expected 2 or 3, found {other}")));
        }
    };
    let known = match (height, dimensions) {
        _ if heights.is_some() => KnownHeight::Varying,
        (_, Dimensions::Three) => KnownHeight::Unknown,
        (Some(metres), Dimensions::Two) => KnownHeight::Said(metres),
        (None, Dimensions::Two) => KnownHeight::NotFound,
    };
    let names = (0..places.len()).map(|anchor| anchor.to_string()).collect();
    let anchors = Anchors { names, positions: places.to_vec() };
    // In space the height is estimated, starting at the anchors' mean.
    let mean = places.iter().map(|[_, _, z]| z).sum::<f64>() / places.len().max(1) as f64;
    let setup = Setup {
        dimensions,
        scalar: self::scalar(scalar)?,
        room,
        biases: biases.as_ref().map(values).transpose()?.map(<[f64]>::to_vec),
        has_wheels: !sensors.wheels.is_empty(),
        ..Setup::new(places, height.unwrap_or(mean))
    };
    let followed = py.detach(|| follow(&anchors, setup, sensors, known, smooth));
    results(py, followed.map_err(refused)?, &log)
}

/// The results of tracking a log.
struct Followed {
    trace: Trace,
    found: Option<FoundHeight>,
    smoothed: Option<Result<Smoothed, Unsmoothed>>,
    /// The findings about the log before it is tracked.
    findings: Vec<Finding>,
    /// The changes that were made to the log.
    changed: Vec<String>,
    /// Whether the ranges were sorted by time.
    is_sorted: bool,
}

fn follow(
    anchors: &Anchors,
    setup: Setup,
    mut sensors: Sensors,
    known: KnownHeight,
    is_smoothed: bool,
) -> Result<Followed, Error> {
    let order = sensors.put_in_order();
    let is_sorted = order.is_some();
    let dropped = sensors.drop_wrong_times()?;
    let changed = order.map(str::to_owned).into_iter().chain(dropped).collect();
    let events = sensors.events();
    let (setup, known) = if known == KnownHeight::NotFound {
        let found = FoundHeight::of_parts(&setup, [events.as_slice()])?;
        let setup = setup.at(found);
        let known = KnownHeight::Found(setup.height_m);
        (setup, known)
    } else {
        (setup, known)
    };
    let (room_is_known, biases) = (setup.room.is_some(), setup.biases.as_deref());
    let findings = check(anchors, [events.as_slice()], known, room_is_known, biases);
    let trace = track(&setup, &events)?;
    let parts = [Tracked { events: &events, trace: &trace }];
    let smoothed = is_smoothed.then(|| smooth(&setup, &parts, false));
    Ok(Followed { trace, found: setup.found, smoothed, findings, changed, is_sorted })
}

/// The ranges in the order of the log, with NaN for those that are missing; refuses values that no log can contain.
fn ranges(t: &[f64], anchor: &[i64], range: &[f64], anchors: usize) -> PyResult<Vec<RangeRow>> {
    let lines = t.iter().zip(anchor).zip(range).enumerate();
    let row = |(index, ((t, anchor), range)): (usize, ((&f64, &i64), &f64))| {
        if t.is_nan() || t.abs() > 1e12 {
            return Err(refused_at(index, format!("expected a time in s, found {t}")));
        }
        let known = usize::try_from(*anchor).ok().filter(|anchor| *anchor < anchors);
        let Some(anchor) = known else {
            let sentence = format!("expected an anchor from 0 to {}, found {anchor}", anchors - 1);
            return Err(refused_at(index, sentence));
        };
        let range = Some(*range).filter(|range| !range.is_nan());
        Ok(RangeRow { time_us: microseconds(*t), anchor, range })
    };
    lines.map(row).collect()
}

fn refused(error: Error) -> PyErr {
    KestirimError::new_err(match error {
        Error::HeightUnknown | Error::HeightVague { .. } => format!("{error}: {MISSING}"),
        other => other.to_string(),
    })
}

fn results<'py>(
    py: Python<'py>,
    followed: Followed,
    log: &[RangeRow],
) -> PyResult<Bound<'py, PyDict>> {
    let Followed { trace, found, smoothed, findings, changed, is_sorted } = followed;
    let (taken, nis) = by_row(&trace, log, is_sorted);
    let lost = trace.lost_s();
    let of_all = Finding::doubts(&findings);
    let why = doubts(std::slice::from_ref(&trace), false).and(of_all);
    let health = |epoch: &Epoch| code(epoch.health.state().max(of_all.state()));
    let epochs = &trace.epochs;
    let of = |epoch: &Epoch| epoch.sigmas_m().map(|sigma| sigma.unwrap_or(f64::NAN));
    let found = found.as_ref();
    let left = smoothed.as_ref().and_then(|it| it.as_ref().err()).map(ToString::to_string);
    let smoothed = smoothed.and_then(Result::ok).map(|smoothed| {
        let epochs = smoothed.parts.first().map(Vec::as_slice).unwrap_or_default();
        Results::new(py)
            .table("position", epochs.iter().filter_map(|it| it.position).collect())?
            .table("sigma", epochs.iter().map(of).collect())?
            .line("health", epochs.iter().map(health).collect())?
            .table("biases", smoothed.biases)?
            .with("common_bias", smoothed.common[0])?
            .with("excess_in_10_m", smoothed.common[1])
            .map(Results::done)
    });
    Ok(Results::new(py)
        .line("t", epochs.iter().map(|epoch| epoch.time_us as f64 / 1e6).collect())?
        .table("position", epochs.iter().map(|it| it.position.unwrap_or([f64::NAN; 3])).collect())?
        .table("sigma", epochs.iter().map(of).collect())?
        .line("health", epochs.iter().map(health).collect())?
        .with("lost", lost)?
        .words("warnings", changed.into_iter().chain(sentences(&findings)))?
        .words("reasons", reasons(why))?
        .with("height", found.map(|found| found.metres))?
        .with("height_sigma", found.map(|found| found.sigma_m))?
        .line("taken", taken)?
        .line("nis", nis)?
        .with("smoothed", smoothed.transpose()?)?
        .with("not_smoothed", left)?
        .done())
}

/// For each row of the log, whose ranges may have been sorted by time: whether its range was accepted, and its
/// normalised innovation squared.
fn by_row(trace: &Trace, log: &[RangeRow], is_sorted: bool) -> (Vec<bool>, Vec<f64>) {
    let mut order: Vec<usize> = (0..log.len()).collect();
    if is_sorted {
        order.sort_by_key(|&row| log[row].time_us);
    }
    let (mut taken, mut nis) = (vec![false; log.len()], vec![f64::NAN; log.len()]);
    let mut followed = trace.ranges.iter().peekable();
    for row in order {
        // In the sorted order; rows without a range, or with a time far ahead, are not among them.
        let next = followed.next_if(|(range, _)| {
            let RangeRow { time_us, anchor, range: metres } = log[row];
            (range.time_us, range.anchor, Some(range.metres)) == (time_us, anchor, metres)
        });
        let Some((_, reception)) = next else { continue };
        taken[row] = reception.taken;
        nis[row] = reception.nis().unwrap_or(f64::NAN);
    }
    (taken, nis)
}
