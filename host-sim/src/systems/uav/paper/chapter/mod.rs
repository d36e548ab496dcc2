//! The UAV's part of the report: the thesis' chapters 3, 5 and 6 in their order, followed by what goes beyond them.

mod conclusions;
mod flights;
mod plants;
mod streams;
mod summary;

use crate::Error;
use crate::figure::Figure;
use crate::report::{Chapter, Made};
use crate::system::System;
use crate::systems::uav::Uav;
use crate::systems::uav::paper::report::Report;
use crate::systems::uav::simulate::plant::{STATE_NAMES, STATE_SLUGS, STATE_UNITS, STATES};

/// The complete chapter.
///
/// # Errors
/// If an estimator of a figure does not exist in the report's number type.
pub fn chapter(report: &Report) -> Result<Chapter, Error> {
    let mut items = plants::items(report);
    items.extend(flights::items(report)?);
    items.extend(conclusions::items(report)?);
    Ok(Chapter {
        system: Uav::NAME,
        title: "UAV: longitudinal motion by Luenberger observer and Kalman filter",
        paper: Uav::PAPER,
        about: "The thesis prints figures and words, but neither its aircraft nor its gains nor a number \
                of its errors. So there are three aircraft, of which P2 is fitted to its prose; and every \
                conclusion is measured, on the truth of simulated flights."
            .to_owned(),
        summary: summary::summary(report),
        headlines: summary::headlines(report),
        picture: "uav-fig-6-1-alpha",
        items,
        streams: streams::streams(report)?,
        recorded: None,
    })
}

/// How the tables of the command were made, with the number of trials.
fn made(report: &Report, trials: impl Into<String>) -> Made {
    let Report { seed, trials: flights, .. } = report;
    let scalar = format!("{:?}", report.scalar).to_lowercase();
    Made {
        command: format!(
            "cargo run --release -p host-sim -- run uav --seed {seed} --trials {flights} --scalar {scalar}"
        ),
        seed: *seed,
        trials: trials.into(),
    }
}

/// A numbered figure over time for each state, with contents from `draw`.
fn by_state(
    id: &str,
    title: &str,
    caption: &str,
    draw: impl Fn(usize, Figure) -> Figure,
) -> [Figure; 4] {
    std::array::from_fn(|state| {
        let name = format!("{id}-{}", STATE_SLUGS[state]);
        let title = format!("{title}: {}", STATE_NAMES[state]);
        let label = format!("{}, {}", STATES[state], STATE_UNITS[state]);
        let empty = Figure::new(name, title).over_seconds(label).caption(caption);
        draw(state, empty)
    })
}

#[cfg(test)]
mod tests;
