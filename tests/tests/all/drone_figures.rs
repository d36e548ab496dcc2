//! The book's figures of the drone, a selection from the report.
//!
//! `cargo test --release -p kestirim-tests --test all drone_figures:: -- --ignored`

use std::error::Error;

use host_sim::system::{RunOptions, Settings, experiment};
use host_sim::systems::drone::Drone;
use host_sim::systems::drone::paper::chapter;
use host_sim::systems::drone::settings::cell;
use kestirim_tests::book;

#[test]
#[ignore = "makes the book's figures"]
fn figures() -> Result<(), Box<dyn Error>> {
    let report = experiment::<Drone>(&RunOptions::default(), &Settings::new(cell::table()))?;
    book::draw(
        &chapter::chapter(&report)?,
        &[
            ("drone-table-3-2-height", "drone-height.svg"),
            ("drone-fig-3-2-systematic", "drone-measurements.svg"),
            ("drone-table-3-2-particles", "drone-particles.svg"),
            ("drone-table-3-2-radius", "drone-radius.svg"),
            ("drone-fig-3-8-error", "drone-user-radius.svg"),
            ("drone-fig-3-11-error", "drone-end-time.svg"),
        ],
    )?;
    Ok(())
}
