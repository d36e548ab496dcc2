//! The book's figures of satellite positioning, from recordings: the paper's figures 3 to 5 on data with known faults,
//! drawn as in the report.
//!
//! `cargo test --release -p kestirim-tests --test all gnss_figures:: -- --ignored`

use std::io;
use std::path::Path;

use host_sim::figure::Figure;
use host_sim::systems::gnss::figures::errors;
use host_sim::systems::gnss::figures::residuals::left;
use host_sim::systems::gnss::settings::PROCESS_NOISE;
use kestirim_gnss_ppp::Corrections;
use kestirim_ppp_filter::Motion;
use kestirim_replay::gnss::{FilterKind, Followed, Pass, follow};
use kestirim_tests::book::draw_figure;
use kestirim_tests::gnss::{ACOR, ESBC, ESBC_INJECTED, Station};
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;
use rayon::prelude::*;

type Days = Vec<(FilterKind, Followed)>;

/// The results of the filters on a station's day, including the treatment of each observation.
fn follow_all(station: &Station, folder: &Path, filters: &[FilterKind], motion: Motion) -> Days {
    let recording = station.read(folder);
    let receiver = recording.receiver(Corrections::ALL);
    let epochs = recording.epochs(Some(station.until));
    let day = |&filter: &FilterKind| {
        let config = filter.config(motion, false);
        let pass = Pass { with_residuals: true, ..Pass::default() };
        (filter, follow(&recording, epochs, &receiver, config, pass, &mut || ()))
    };
    filters.par_iter().map(day).collect()
}

/// Draws errors over the hours, decimated: each epoch of the first hour, then one in twenty.
fn draw_errors(name: &str, title: &str, station: &Station, mut days: Days) -> io::Result<()> {
    for (_, followed) in &mut days {
        let fixes = std::mem::take(&mut followed.fixes).into_iter().enumerate();
        let wanted = fixes.filter(|(epoch, _)| *epoch < 120 || epoch % 20 == 0);
        followed.fixes = wanted.map(|(_, fix)| fix).collect();
    }
    let filters = days.iter().map(|(filter, followed)| (*filter, followed));
    draw_figure(&errors(Figure::new(name, title), filters, &Vector3::from(station.truth)))
}

/// Figure 3: the code residuals.
#[test]
#[ignore = "makes the book's figures"]
fn residuals() -> io::Result<()> {
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    for (filter, followed) in follow_all(&ESBC_INJECTED, &folder, &FilterKind::ALL, Motion::Static)
    {
        let title = format!("{}: {} codes rejected", filter.title(), followed.rejected.code);
        let figure = Figure::new(format!("gnss-residuals-{}", filter.name()), title);
        draw_figure(
            &left(figure, &followed, |report| &report.code).showing(None, Some([-34.0, 34.0])),
        )?;
    }
    Ok(())
}

/// Figure 4: a receiver that is known to be static.
#[test]
#[ignore = "makes the book's figures"]
fn standing() -> io::Result<()> {
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    for (name, title, station) in [
        ("gnss-static-esbc", "ESBC, clocks every 30 s", &ESBC),
        ("gnss-static-faults", "ESBC with faults", &ESBC_INJECTED),
        ("gnss-static-acor", "ACOR, clocks every 15 min", &ACOR),
    ] {
        let days = follow_all(station, &folder, &FilterKind::ALL, Motion::Static);
        draw_errors(name, title, station, days)?;
    }
    Ok(())
}

/// Figure 5: a receiver that may move.
#[test]
#[ignore = "makes the book's figures"]
fn moving() -> io::Result<()> {
    const FILTERS: [FilterKind; 3] = [FilterKind::Ikf, FilterKind::Adaptive, FilterKind::Default];
    let Some(folder) = folder_of("gnss") else { return Ok(()) };
    for (name, title, process_noise) in [
        ("gnss-kinematic-free", "With faults, 100 m²/s: each epoch stands alone", PROCESS_NOISE),
        ("gnss-kinematic-held", "With faults, 1e-4 m²/s: the epochs hold together", 1e-4),
    ] {
        let motion = Motion::Kinematic { process_noise };
        let days = follow_all(&ESBC_INJECTED, &folder, &FILTERS, motion);
        draw_errors(name, title, &ESBC_INJECTED, days)?;
    }
    Ok(())
}
