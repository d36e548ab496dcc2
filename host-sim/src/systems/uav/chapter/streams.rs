//! A typical run for other programs: P2 under the noise of real sensors.

use super::super::design::{Kind, MIDDLE};
use super::super::plant::{Outputs, Plant, STREAM_COLUMNS};
use super::super::report::Report;
use super::super::scenario::{INTERVAL_S, Inputs, NEAR, Noise, SAMPLES, START};
use super::super::trip::{Moment, Trip};
use crate::Error;
use crate::stream::Stream;

/// Inputs, measurements, truth, and what both estimators make of them.
pub(super) fn streams(report: &Report) -> Result<Vec<Stream>, Error> {
    let trip = Trip {
        plant: Plant::P2,
        outputs: Outputs::RateAirspeedPitch,
        inputs: Inputs::Sine,
        noise: Noise::SENSORS,
        truth: START,
        start: NEAR,
        samples: SAMPLES,
    };
    let follow = |kind: Kind| {
        trip.follow(&kind, report.scalar, report.seed)
            .map_err(|problem| Error::Usage(format!("uav: there is no {}: {problem}", kind.name())))
    };
    let filter = follow(Kind::TimeVarying(trip.noise))?;
    let observer = follow(Kind::Luenberger(MIDDLE))?;
    let columns = &STREAM_COLUMNS;
    Ok(vec![
        stream("/uav/inputs", &["delta_e_rad", "delta_t"], &filter, |m| {
            m.sample.u.as_slice().into()
        }),
        // α has no sensor here.
        stream("/uav/sensors", &columns[1..], &filter, |m| m.sample.y.as_slice()[1..].into()),
        stream("/uav/truth", columns, &filter, |m| m.sample.x.as_slice().into()),
        stream("/uav/estimate", columns, &filter, |m| m.estimate.as_slice().into()),
        stream("/uav/luenberger", columns, &observer, |m| m.estimate.as_slice().into()),
    ])
}

fn stream(
    topic: &str,
    columns: &[&str],
    moments: &[Moment],
    values: impl Fn(&Moment) -> Vec<f64>,
) -> Stream {
    let row = |(sample, moment)| (sample as f64 * INTERVAL_S, values(moment));
    Stream::new(topic, columns, moments.iter().enumerate().map(row).collect())
}
