//! The system's part of the report: the paper's tables and figures, and the results of the default filter.

mod drawn;
mod tables;

use super::experiment::Report;
use crate::Error;
use crate::report::{Chapter, Made};
use crate::system::System;
use crate::systems::gnss::Gnss;

/// The chapter of an experiment.
///
/// # Errors
/// [`Error::File`] if a filter finds no position on a station-day that is drawn.
pub fn chapter(report: &Report) -> Result<Chapter, Error> {
    let Report { seed, trials, .. } = *report;
    let command =
        format!("cargo run --release -p host-sim -- run gnss --seed {seed} --trials {trials}");
    let all = Made { command: command.clone(), seed, trials: format!("{trials} station-days") };
    let days = drawn::Days::follow(report)?;
    let one = Made { command, seed, trials: "the first station-day".to_owned() };
    let mut items = Vec::new();
    items.extend(days.residuals().map(|figure| one.item(figure)));
    items.extend(days.standing().map(|(day, figure)| {
        Made { trials: format!("station-day {day}"), ..one.clone() }.item(figure)
    }));
    items.push(all.item(tables::standing(report)));
    items.push(one.item(days.moving()));
    items.push(all.item(tables::moving(report)));
    items.push(all.item(tables::without_faults(report)));
    items.push(one.item(days.trusted()));
    Ok(Chapter {
        system: Gnss::NAME,
        title: "GNSS: a receiver, positioned precisely",
        paper: "Bahadur and Nohutcu 2020: robust Kalman filters for precise point positioning (in Turkish)",
        about: "The paper's hundred station-days are real; it names four of the ten stations, and of none what was \
                wrong with its observations. These are synthetic ones with faults that are known, so that the order \
                of the filters can be compared with the paper's, but not each number. As published three of its \
                robust filters reject nothing, as their scale (17) is inflated by what it is to find. Figures 1 (a \
                flow chart) and 2 (a map of the stations) have nothing to compare."
            .to_owned(),
        summary: tables::summary(report),
        headlines: tables::headlines(report),
        picture: "gnss-figure-4-1",
        items,
        streams: days.streams(),
        recorded: None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{RunOptions, Settings, experiment};
    use crate::systems::gnss::Gnss;

    #[test]
    fn the_chapter_has_every_table_and_figure_of_the_paper() {
        let options = RunOptions { trials: Some(1), seed: 2, scalar: None };
        let chapter = chapter(&experiment::<Gnss>(&options, &Settings::new([])).unwrap()).unwrap();
        let tables: Vec<_> = chapter.comparisons().map(|table| table.id.as_str()).collect();
        assert_eq!(tables, ["gnss-table-2", "gnss-table-3", "gnss-without-faults"]);
        let figures: Vec<_> = chapter.figures().map(|figure| figure.id.as_str()).collect();
        let filters = ["gkf", "rkf", "skf", "ikf", "adaptive", "default"];
        let expected = filters.map(|filter| format!("gnss-figure-3-{filter}"));
        let others = ["gnss-figure-4-1", "gnss-figure-5", "gnss-deviation"];
        assert_eq!(figures, expected.iter().map(String::as_str).chain(others).collect::<Vec<_>>());
        for figure in chapter.figures() {
            assert!(figure.series.iter().any(|series| !series.x.is_empty()), "{}", figure.id);
        }
        assert!(chapter.summary.rows.len() <= 10);
        chapter.assert_complete();
        assert!(chapter.comparisons().all(|table| {
            table.rows.iter().all(|row| !(row.ours.is_empty() && row.theirs.is_empty()))
        }));
    }

    /// Checks what the paper's figure 3 shows: outliers remain in the plain filter's code residuals, but not in the
    /// default's.
    #[test]
    fn outliers_are_left_to_the_plain_filter_alone() {
        let options = RunOptions { trials: Some(1), seed: 2, scalar: None };
        let chapter = chapter(&experiment::<Gnss>(&options, &Settings::new([])).unwrap()).unwrap();
        let far = |filter: &str| {
            let id = format!("gnss-figure-3-{filter}");
            let figure = chapter.figures().find(|figure| figure.id == id).unwrap();
            figure.series[1].x.len()
        };
        assert!(
            far("gkf") > 50 && far("default") * 10 < far("gkf"),
            "{} {}",
            far("gkf"),
            far("default")
        );
    }
}
