//! The tables of the paper.

use super::super::experiment::{Row, WALKS, error_percent};
use super::Typical;
use crate::metrics::percentile;
use crate::report::Comparison;
use crate::systems::pedestrian::paper::published::{LOG_LINES, ROUTE_M};
use crate::systems::pedestrian::simulate::scenario::Scenario;
use crate::systems::pedestrian::simulate::sensor::razor_text;

/// Table 1: lines of the log.
pub(super) fn log_lines(walk: &Typical) -> Comparison {
    let samples = &walk.recording.log.samples;
    let text = razor_text(&samples[..samples.len().min(LOG_LINES.len())]);
    let lines = LOG_LINES.into_iter().zip(text.lines()).enumerate();
    lines.fold(
        Comparison::new(
            "pedestrian-table-1",
            "Table 1: the log, ms, 3 × specific force in g, 3 × angular rate in °/s",
        ),
        |table, (i, (published, ours))| table.row(format!("line {}", i + 1), published, ours, ""),
    )
    .note("The paper's sensor is mounted upside down; ours, the right way up, has just been switched on.")
}

/// Table 2: the legs of the route.
pub(super) fn legs() -> Comparison {
    let table = Comparison::new("pedestrian-table-2", "Table 2 and Fig. 18: legs of the route, m");
    let legs = Scenario::leg_lengths().enumerate();
    let table = legs.fold(table, |table, (i, leg)| {
        table.row(format!("leg {}", i + 1), "", format!("{leg:.2}"), "")
    });
    let sum: f64 = Scenario::leg_lengths().sum();
    table
        .row("sum", format!("{ROUTE_M:.2}"), format!("{sum:.2}"), "")
        .note("Our copy of the paper has the sum, but neither the single legs nor the plan: ours are chosen to fit.")
}

/// Tables 3 and 4: seven walks at one rate.
pub(super) fn walks(row: &Row) -> Comparison {
    let source = row.published.source;
    let id = format!("pedestrian-{}", source.to_lowercase().replace(' ', "-"));
    let title = format!("{source}: length of the path at {} Hz, true 1260 cm", row.rate_hz);
    let walk =
        |length_m: f64| format!("{:.0} cm, {:.2} %", 100.0 * length_m, error_percent(length_m));
    let walks = row.published.walks_m.iter().zip(&row.ours.lengths_m).enumerate();
    let table = walks.fold(Comparison::new(id, title), |table, (i, (published, ours))| {
        table.row(format!("walk {}", i + 1), walk(*published), walk(*ours), "")
    });
    let [published, ours] = errors(row);
    let spread = |lengths_m: &[f64]| {
        let at = |percent| 100.0 * percentile(lengths_m, percent);
        format!("{:.0}, {:.0}, {:.0} cm", at(5.0), at(50.0), at(95.0))
    };
    table
        .row("mean relative error, all walks", published.0, ours.0, "")
        .row("σ of the length, all walks", published.1, ours.1, "")
        .row(
            "5 %, 50 % and 95 % of all walks",
            spread(&row.published.walks_m),
            spread(&row.ours.lengths_m),
            "",
        )
        .row(
            "the paper's method, literally, on our walks",
            "",
            of_the_papers_method(row),
            "",
        )
        .note(format!(
            "Ours are the first {WALKS} of {} synthetic walks; a row does not compare the same walk. No bound is \
             known for this sensor and route.",
            row.ours.lengths_m.len()
        ))
}

/// Mean relative error and σ: published and ours.
pub(super) fn errors(row: &Row) -> [(String, String); 2] {
    let cells = |error: f64, sigma_m: f64| {
        // As many digits of σ as printed.
        (format!("{error:.2} %"), format!("{} cm", (1e4 * sigma_m).round() / 100.0))
    };
    [
        cells(row.published.mean_relative_error_percent, row.published.sigma_m),
        cells(row.ours.mean_relative_error_percent, row.ours.sigma_m),
    ]
}

/// Mean relative error and σ of the paper's method, taken literally.
pub(super) fn of_the_papers_method(row: &Row) -> String {
    let method = &row.paper_method;
    format!("{:.1} %, σ {:.0} cm", method.mean_relative_error_percent, 100.0 * method.sigma_m)
}
