//! The pedestrian's part of the report: the paper's tables and figures beside ours.

mod drawings;
mod own;
mod tables;

use kestirim_replay::pedestrian::{Options, Trace, trace, without_updates};

use super::experiment::{Report, WALKS, refused};
use crate::Error;
use crate::random::stream;
use crate::report::{Chapter, Comparison, Made};
use crate::system::System;
use crate::systems::pedestrian::Pedestrian;
use crate::systems::pedestrian::figures::streams;
use crate::systems::pedestrian::recording::{Recording, Walked};

/// The chapter of an experiment's report.
///
/// # Errors
/// No others than those of the experiment.
pub fn chapter(report: &Report) -> Result<Chapter, Error> {
    let Report { seed, trials, .. } = *report;
    let scalar = format!("{:?}", report.scalar).to_lowercase();
    let command = format!(
        "cargo run --release -p host-sim -- run pedestrian --seed {seed} --trials {trials} --scalar {scalar}"
    );
    let made = |trials: String| Made { command: command.clone(), seed, trials };
    let (slow, fast) = (Typical::draw(report, 50.0)?, Typical::draw(report, 100.0)?);
    let [one, all] =
        [made("walk 0 alone".to_owned()), made(format!("{trials} × {WALKS} walks a rate"))];
    let mut items = vec![one.item(tables::log_lines(&fast))];
    items.extend(drawings::of_the_sensor(&fast).map(|figure| one.item(figure)));
    let scenario = Walked::Route.draw(&mut stream(seed, 0));
    items.extend(drawings::of_the_velocity(&slow, &fast, &scenario).map(|figure| one.item(figure)));
    items.extend(drawings::of_the_position(&slow).map(|figure| one.item(figure)));
    items.push(one.item(tables::legs()));
    items.extend(report.rows.iter().map(|row| all.item(tables::walks(row))));
    items.push(all.item(own::distribution(report)));
    let compared = made(format!("the first {} walks a rate", own::COMPARED));
    items.push(compared.item(own::methods(report)?));
    Ok(Chapter {
        system: Pedestrian::NAME,
        title: "Pedestrian: a foot-mounted IMU with zero-velocity updates",
        paper: Pedestrian::PAPER,
        about: "The paper's walks are not published: ours are synthetic walks of a route as long, logged by a \
                simulated Razor in the paper's text format. As published, the paper's stance detector fires \
                within every swing and loses most of the path; the filtered magnitude that its own results need is \
                not described there. Its Figs 1 to 7 are diagrams of the method, and Fig. 19, its interface, is the \
                explorer (host-sim serve)."
            .to_owned(),
        summary: summary(report),
        headlines: report.rows.iter().map(tables::headline).collect(),
        picture: "pedestrian-figure-17",
        items,
        streams: streams::streams(&fast.recording.log.samples, &fast.ours, &fast.recording.truth()),
        recorded: None,
    })
}

fn summary(report: &Report) -> Comparison {
    let mut summary = Comparison::new(
        "pedestrian",
        format!(
            "Pedestrian: length of the path, {} × {WALKS} synthetic walks of 12.60 m",
            report.trials
        ),
    );
    for row in &report.rows {
        let rate = row.rate_hz;
        let [published, ours] = tables::errors(row);
        summary = summary
            .row(format!("mean relative error, {rate} Hz"), published.0, ours.0, "")
            .row(format!("σ of the length, {rate} Hz"), published.1, ours.1, "")
            .row(
                format!("RMSE of the footprints, median, {rate} Hz"),
                "",
                format!("{:.2} m", row.ours.median_rmse_m),
                "",
            )
            .repeated(
                format!("mean relative error and σ of the length, {rate} Hz"),
                "",
                tables::of_the_papers_method(row),
                "",
            );
    }
    summary
}

/// One walk of the experiment, tracked by our method, by the paper's, and without zero-velocity updates.
struct Typical {
    recording: Recording,
    ours: Trace,
    paper: Trace,
    drifting: Trace,
}

impl Typical {
    fn draw(report: &Report, rate_hz: f64) -> Result<Self, Error> {
        let index = 0;
        let recording = Recording::synthetic(Walked::Route, rate_hz, report.seed, index)?;
        let options = Options { scalar: report.scalar, ..Options::default() };
        let published = Options { scalar: report.scalar, ..Options::published() };
        let samples = &recording.log.samples;
        let traces = [
            trace(samples, &options),
            trace(samples, &published),
            without_updates(samples, &options),
        ];
        let [ours, paper, drifting] =
            traces.map(|trace| trace.map_err(|error| refused(index, &error)));
        Ok(Self { ours: ours?, paper: paper?, drifting: drifting?, recording })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{RunOptions, Settings, experiment};
    use crate::systems::pedestrian::Pedestrian;

    #[test]
    fn every_table_and_figure_is_there_once_and_says_something() {
        let options = RunOptions { trials: Some(1), seed: 2, scalar: None };
        let chapter =
            chapter(&experiment::<Pedestrian>(&options, &Settings::new([])).unwrap()).unwrap();
        let mut ids: Vec<_> =
            chapter.comparisons().map(|comparison| comparison.id.clone()).collect();
        ids.extend(chapter.figures().map(|figure| figure.id.clone()));
        for table in 1..=4 {
            assert!(ids.contains(&format!("pedestrian-table-{table}")), "table {table}");
        }
        for figure in 8..=17 {
            assert!(ids.contains(&format!("pedestrian-figure-{figure}")), "figure {figure}");
        }
        let count = ids.len();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), count);
        for figure in chapter.figures() {
            let Some(first) = figure.series.first() else { panic!("{} is empty", figure.id) };
            assert!(!first.x.is_empty() && !figure.caption.is_empty(), "{}", figure.id);
        }
        assert!(chapter.summary.rows.len() <= 10);
        chapter.assert_complete();
    }

    #[test]
    fn the_tables_print_what_the_paper_prints() {
        let options = RunOptions { trials: Some(1), seed: 2, scalar: None };
        let chapter =
            chapter(&experiment::<Pedestrian>(&options, &Settings::new([])).unwrap()).unwrap();
        let table = chapter.comparisons().find(|table| table.id == "pedestrian-table-4").unwrap();
        let published: Vec<_> = table.rows.iter().map(|row| row.published.as_str()).collect();
        assert_eq!(published[..2], ["1274 cm, 1.11 %", "1435 cm, 13.89 %"]);
        assert_eq!(published[7..9], ["11.72 %", "88.52 cm"]);
        assert!(table.rows.iter().all(|row| !row.ours.is_empty() || !row.theirs.is_empty()));
    }
}
