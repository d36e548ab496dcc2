//! The book's figures of the UAV, a selection from the report.
//!
//! `cargo test --release -p kestirim-tests --test all uav_figures:: -- --ignored`

use std::error::Error;

use host_sim::system::{RunOptions, Settings, experiment};
use host_sim::systems::uav::Uav;
use host_sim::systems::uav::paper::chapter;
use kestirim_tests::book;

#[test]
#[ignore = "makes the book's figures"]
fn figures() -> Result<(), Box<dyn Error>> {
    let report = experiment::<Uav>(&RunOptions::default(), &Settings::new([]))?;
    book::draw(
        &chapter::chapter(&report)?,
        &[
            ("uav-fig-5-2-airspeed", "uav-steps.svg"),
            ("uav-fig-5-4", "uav-singular-values.svg"),
            ("uav-catching-errors", "uav-catching.svg"),
            ("uav-noise-against-time", "uav-noise.svg"),
        ],
    )?;
    Ok(())
}
