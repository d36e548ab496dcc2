//! The streams of a typical run: P2 under the noise of real sensors.

use kestirim_replay::uav::{MIDDLE, Noise, Plant};

use crate::Error;
use crate::stream::Stream;
use crate::systems::uav::paper::report::Report;
use crate::systems::uav::simulate::design::Kind;
use crate::systems::uav::simulate::flight::{Flight, Moment};
use crate::systems::uav::simulate::plant::{Outputs, STREAM_COLUMNS};
use crate::systems::uav::simulate::scenario::{INTERVAL_S, Inputs, NEAR, SAMPLES, START};

/// The inputs, the measurements, the truth, and the estimates of both estimators.
pub(super) fn streams(report: &Report) -> Result<Vec<Stream>, Error> {
    let flight = Flight {
        plant: Plant::P2,
        outputs: Outputs::RateAirspeedPitch,
        inputs: Inputs::Sine,
        noise: Noise::SENSORS,
        truth: START,
        start: NEAR,
        samples: SAMPLES,
    };
    let follow = |kind: Kind| {
        flight
            .follow(&kind, report.scalar, report.seed)
            .map_err(|problem| Error::Usage(format!("uav: there is no {}: {problem}", kind.name())))
    };
    let filter = follow(Kind::TimeVarying(flight.noise))?;
    let observer = follow(Kind::Luenberger(MIDDLE))?;
    let columns = &STREAM_COLUMNS;
    Ok(vec![
        stream("/uav/inputs", &["delta_e_rad", "delta_t"], &filter, |m| {
            m.sample.u.as_slice().into()
        }),
        // There is no sensor for α here.
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
