//! The measured workloads: every estimator's step, and the peers' on the common scenario.

use anyhow::{Context, Result};
use rayon::prelude::*;

use crate::images::Images;
use crate::row::{Row, is_peer};
use crate::streams::{Common, Encode, circle, ellipse, fly, walk};
use crate::target::CORTEX_M0;
use crate::uav;

/// The images that replay the common scenario.
const COMMON: [&str; 13] = [
    "ekf4-ranges4-f32",
    "ekf4-ranges4-q12-20",
    "ekf4-ranges4-q8-24",
    "ekf4-ranges4-q16-16",
    "peer-adskalman-f32",
    "peer-kfilter-f32",
    "peer-minikalman-f32",
    "peer-minikalman-q16-16",
    "aekf4-ranges4-f32",
    "aekf4-ranges4-q12-20",
    "aekf4-published-f32",
    "robust4-ranges4-f32",
    "robust4-ranges4-q12-20",
];
const FOUR_ANCHORS: [&str; 2] = ["uwb-tracker-4-f32", "uwb-tracker-4-fixed"];
const EIGHT_ANCHORS: [&str; 4] = [
    "uwb-tracker-8-f32",
    "uwb-tracker-8-fixed",
    "uwb-tracker-space-f32",
    "uwb-tracker-space-fixed",
];
const WALK: [&str; 6] = [
    "ahrs-f32",
    "ahrs-fixed",
    "pedestrian-lite-f32",
    "pedestrian-lite-fixed",
    "pedestrian-ekf-f32",
    "pedestrian-ekf-fixed",
];
const CIRCLE: [&str; 2] = ["locator-f32", "locator-fixed"];
const FLIGHT: [&str; 2] = ["observer4-f32", "observer4-fixed"];
const FAST_FLIGHT: [&str; 2] = ["observer4-f32-1khz", "observer4-fixed-1khz"];

/// The meters of the image `ppp` that become rows.
const PPP_METERS: [&str; 2] = ["default clean", "default outliers"];

/// Runs every workload whose image's name begins with `only` on one target at one optimisation.
///
/// `ppp` needs more stack than a Cortex-M0 with 16 KiB has and is left out there, as are the peers where they were not
/// built.
///
/// # Errors
/// A stream cannot be made, or an image failed.
pub fn measure(images: &Images, only: &str) -> Result<Vec<Row>> {
    let [flight, fast_flight] = [0.01, 0.001].map(|interval| fly(&uav::plant(interval)).encode());
    let streams: [(Vec<u8>, &[&str]); 7] = [
        (Common::read()?.encode(), &COMMON),
        (ellipse(4).encode(), &FOUR_ANCHORS),
        (ellipse(8).encode(), &EIGHT_ANCHORS),
        (walk().encode(), &WALK),
        (circle().encode(), &CIRCLE),
        (flight, &FLIGHT),
        (fast_flight, &FAST_FLIGHT),
    ];
    let workloads =
        streams.iter().flat_map(|(stream, names)| names.iter().map(move |&name| (name, stream)));
    let built = |name: &str| images.has_peers() || !is_peer(name);
    let workloads: Vec<_> =
        workloads.filter(|(name, _)| name.starts_with(only) && built(name)).collect();
    let row = |&(image, stream): &(&str, &Vec<u8>)| {
        Row::of(images, image, &images.run(image, stream)?).with_context(|| image.to_owned())
    };
    let mut rows: Vec<Row> = workloads.par_iter().map(row).collect::<Result<_>>()?;
    if images.target.triple != CORTEX_M0.triple && "ppp".starts_with(only) {
        let output = images.run("ppp", &[])?;
        for meter in PPP_METERS {
            let row = Row::of_meter(images, "ppp", &output, meter)?;
            rows.push(Row { name: format!("ppp {meter}"), ..row });
        }
    }
    Ok(rows)
}
