//! The tables of the paper.

use super::super::experiment::{Row, WALKS, error_percent};
use super::Typical;
use crate::metrics::percentile;
use crate::report::{Comparison, Headline, Value};
use crate::systems::pedestrian::paper::published::{LOG_LINES, ROUTE_M};
use crate::systems::pedestrian::simulate::scenario::Scenario;
use crate::systems::pedestrian::simulate::sensor::razor_text;

/// The columns of Table 1, with their units.
const LOG_COLUMNS: [(&str, &str); 7] = [
    ("time", "ms"),
    ("specific force x", "g"),
    ("specific force y", "g"),
    ("specific force z", "g"),
    ("angular rate x", "°/s"),
    ("angular rate y", "°/s"),
    ("angular rate z", "°/s"),
];

/// Table 1: lines of the log.
pub(super) fn log_lines(walk: &Typical) -> Comparison {
    let samples = &walk.recording.log.samples;
    let text = razor_text(&samples[..samples.len().min(LOG_LINES.len())]);
    let lines = LOG_LINES.into_iter().zip(text.lines()).enumerate();
    let values = lines.clone().flat_map(|(i, (published, ours))| {
        let both = published.split_whitespace().zip(ours.split_whitespace());
        LOG_COLUMNS.into_iter().zip(both).map(move |((name, unit), (published, ours))| {
            let value = Value::new(name, unit).under(format!("line {}", i + 1));
            value.by("simulated sensor").is(ours.parse().ok()).published(published.parse().ok())
        })
    });
    let values: Vec<_> = values.collect();
    lines.fold(
        Comparison::new(
            "pedestrian-table-1",
            "Table 1: the log, ms, 3 × specific force in g, 3 × angular rate in °/s",
        ),
        |table, (i, (published, ours))| table.row(format!("line {}", i + 1), published, ours, ""),
    )
    .values(values)
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
    let each = Scenario::leg_lengths().enumerate();
    let leg = |name: String, length_m: f64| {
        Value::new("length", "m").under(name).by("route of the scenario").is(length_m)
    };
    table
        .values(each.map(|(i, length_m)| leg(format!("leg {}", i + 1), length_m)))
        .values([leg("sum".to_owned(), sum).published(ROUTE_M)])
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
        .repeated("mean relative error and σ of the length", "", of_the_papers_method(row), "")
        .values(values(row))
        .note(format!(
            "Ours are the first {WALKS} of {} synthetic walks; a row does not compare the same walk. No bound is \
             known for this sensor and route.",
            row.ours.lengths_m.len()
        ))
}

/// The numbers of [`walks`], for other programs.
fn values(row: &Row) -> Vec<Value> {
    let rate = format!("{} Hz", row.rate_hz);
    let all = row.ours.lengths_m.len();
    let pairs = row.published.walks_m.iter().zip(&row.ours.lengths_m).enumerate();
    let mut values: Vec<_> = pairs
        .map(|(i, (published, ours))| {
            let length = Value::new("length of the path", "m").is(*ours).published(*published);
            length.under(format!("{rate}, walk {}", i + 1))
        })
        .collect();
    let error = |of: f64| Value::new("mean relative error of the length", "%").under(&rate).is(of);
    let sigma = |of: f64| Value::new("standard deviation of the length", "m").under(&rate).is(of);
    let both = [("default", &row.ours), ("published method", &row.paper_method)];
    values.extend(both.into_iter().flat_map(|(method, of)| {
        [
            error(of.mean_relative_error_percent)
                .published(row.published.mean_relative_error_percent),
            sigma(of.sigma_m).published(row.published.sigma_m),
        ]
        .map(|value| value.by(method).of(all, None))
    }));
    values.extend([5.0, 50.0, 95.0].map(|percent| {
        let at = |lengths_m: &[f64]| percentile(lengths_m, percent);
        Value::new("length of the path", "m")
            .under(format!("{rate}, {percent} % of all walks below"))
            .is(at(&row.ours.lengths_m))
            .of(all, None)
            .published(at(&row.published.walks_m))
    }));
    values
}

/// The most important result.
pub(super) fn headline(row: &Row) -> Headline {
    Headline {
        quantity: format!("mean error of a walk's length at {} Hz", row.rate_hz),
        unit: "%",
        published: Some(row.published.mean_relative_error_percent),
        theirs: Some(row.paper_method.mean_relative_error_percent),
        ours: Some(row.ours.mean_relative_error_percent),
        limit: None,
    }
}

/// The mean relative error and σ: published and ours.
pub(super) fn errors(row: &Row) -> [(String, String); 2] {
    let cells = |error: f64, sigma_m: f64| {
        // σ has as many digits as in the paper.
        (format!("{error:.2} %"), format!("{} cm", (1e4 * sigma_m).round() / 100.0))
    };
    [
        cells(row.published.mean_relative_error_percent, row.published.sigma_m),
        cells(row.ours.mean_relative_error_percent, row.ours.sigma_m),
    ]
}

/// The mean relative error and σ of the paper's method, implemented literally.
pub(super) fn of_the_papers_method(row: &Row) -> String {
    let method = &row.paper_method;
    format!("{:.1} %, σ {:.0} cm", method.mean_relative_error_percent, 100.0 * method.sigma_m)
}
