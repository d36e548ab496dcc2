//! Tables of published results beside ours.

use kestirim_replay::gnss::FilterKind;

use crate::report::{Comparison, Headline, Value};
use crate::systems::gnss::paper::experiment::{CLEAN, KINEMATIC, Report, Row, STATIC, four};
use crate::systems::gnss::paper::published::PppErrors;

/// The paper's Table 2, and each filter as published.
pub(super) fn standing(report: &Report) -> Comparison {
    let table = Comparison::new("gnss-table-2", "Table 2: static receivers (mean of station-days)");
    let table = with_rows(table, report, STATIC, plain(report, 0));
    let published = |row: &Row| row.published.map(|errors| errors.rms_mm[3]);
    let ours = |row: &Row| row.published.map(|_| row.ours.rms_mm[3]);
    table.note(format!(
        "As published: σ̂0 of (17), which the outliers inflate, and the bracket of (15) without its square. The \
         limit is what the plain filter makes of the same days without faults: no bound in the strict sense. The \
         faults of our days are worse than those of the paper's stations: compare the order by RMS 3-D, worst \
         first. Published: {}; ours: {}.",
        in_order(report, published),
        in_order(report, ours),
    ))
}

/// The paper's static filters ordered by a measure, the largest first.
fn in_order(report: &Report, measure: impl Fn(&Row) -> Option<f64>) -> String {
    let rows = report.rows.iter().filter(|row| row.table == STATIC);
    let mut rows: Vec<_> = rows.filter_map(|row| Some((row.filter, measure(row)?))).collect();
    // The sort is stable: equal ones stay in the order of the table.
    rows.sort_by(|(_, a), (_, b)| b.total_cmp(a));
    rows.into_iter().map(|(filter, _)| filter).collect::<Vec<_>>().join(", ")
}

/// The paper's Table 3: kinematic filters.
pub(super) fn moving(report: &Report) -> Comparison {
    let title = format!(
        "Table 3: receivers that may move, {:e} m²/s (mean of station-days)",
        report.process_noise
    );
    let table = Comparison::new("gnss-table-3", title);
    let table = with_rows(table, report, KINEMATIC, plain(report, 2));
    table.note(
        "The paper has IKF and UKF alone, and no convergence. No filter that knows nothing of slips survives those \
         that nothing else shows: only the default finds them. UKF as published is IKF as published, as the factor \
         of (22) never falls.",
    )
}

/// The cost of the default filter on days without faults.
pub(super) fn without_faults(report: &Report) -> Comparison {
    let table = Comparison::new(
        "gnss-without-faults",
        "The same station-days without faults: no harm done",
    );
    let rows = report.rows.iter().filter(|row| row.table == CLEAN);
    rows.fold(table, |table, row| {
        let (rms, worst) = (four(row.ours.rms_mm), format!("{:.1}", row.worst_rms_mm));
        let worst_day = Value::new("RMS 3-D of the worst day", "mm").is(row.worst_rms_mm);
        let table = add(table, row, format!("{}: RMS N E U 3-D, mm", row.filter), ["", &rms, ""])
            .values(numbers(row, "RMS", row.ours.rms_mm, [None; 2]));
        let name = format!("{}: RMS 3-D of the worst day, mm", row.filter);
        add(table, row, name, ["", &worst, ""]).values([by(row, worst_day)])
    })
}

/// The most important numbers: the 3-D errors.
pub(super) fn summary(report: &Report) -> Comparison {
    let mut table = Comparison::new(
        "gnss-summary",
        format!("GNSS: RMS 3-D after the first hour, {} station-days with faults", report.trials),
    );
    let wanted =
        [FilterKind::Ikf, FilterKind::Adaptive, FilterKind::Default].map(FilterKind::title);
    for row in &report.rows {
        let (limit, mode) = match row.table {
            STATIC if !row.is_published() => (plain(report, 0), "static"),
            KINEMATIC if wanted.contains(&row.filter) => (plain(report, 2), "kinematic"),
            _ => continue,
        };
        let rms = |errors: &PppErrors| format!("{:.1} mm", errors.rms_mm[3]);
        let published = row.published.as_ref().map_or(String::new(), rms);
        let limit = limit.map_or(String::new(), rms);
        let name = format!("{}, {mode}", row.filter);
        table = add(table, row, name, [&published, &rms(&row.ours), &limit]);
    }
    table.note("limit: the plain filter on the same days without faults")
}

/// The plain filter on days without faults: static (0) or kinematic (2).
fn plain(report: &Report, place: usize) -> Option<&PppErrors> {
    let clean = report.rows.iter().filter(|row| row.table == CLEAN);
    clean.map(|row| &row.ours).nth(place)
}

fn with_rows(
    table: Comparison,
    report: &Report,
    which: &str,
    limit: Option<&PppErrors>,
) -> Comparison {
    let rows = report.rows.iter().filter(|row| row.table == which);
    rows.fold(table, |table, row| {
        let Row { filter, published, ours, .. } = row;
        let cell = |of: fn(&PppErrors) -> String| {
            let text = |errors: Option<&PppErrors>| errors.map_or(String::new(), of);
            (text(published.as_ref()), of(ours), text(limit))
        };
        let last = cell(|errors| four(errors.final_mm));
        let rms = cell(|errors| four(errors.rms_mm));
        let shown = cell(minutes_in_words);
        let others = |of: fn(&PppErrors) -> [f64; 4]| [published.as_ref().map(of), limit.map(of)];
        let minutes = Value::new("convergence", "min").is(ours.convergence_min);
        let minutes = by(row, minutes)
            .of(row.days.len().saturating_sub(row.unconverged), None)
            .published(published.as_ref().and_then(|errors| errors.convergence_min))
            .limited(limit.and_then(|errors| errors.convergence_min));
        let table =
            add(table, row, format!("{filter}: error N E U 3-D, mm"), [&last.0, &last.1, &last.2]);
        let table =
            add(table, row, format!("{filter}: RMS N E U 3-D, mm"), [&rms.0, &rms.1, &rms.2]);
        let here = row.converged();
        let converged = [&shown.0, &here, &shown.2].map(String::as_str);
        add(table, row, format!("{filter}: converged after, min"), converged)
            .values(numbers(row, "final error", ours.final_mm, others(|errors| errors.final_mm)))
            .values(numbers(row, "RMS", ours.rms_mm, others(|errors| errors.rms_mm)))
            .values([minutes])
    })
}

/// Adds a row of the paper's filters, or of ours: published value, result here, limit.
fn add(
    table: Comparison,
    row: &Row,
    quantity: String,
    [published, here, limit]: [&str; 3],
) -> Comparison {
    if is_ours(row) {
        table.row(quantity, published, here, limit)
    } else {
        table.repeated(quantity, published, here, limit)
    }
}

/// Whether a row is of the default filter, with any motion model.
fn is_ours(row: &Row) -> bool {
    row.filter.starts_with(FilterKind::Default.title())
}

/// Sets the method and condition of a value to the filter and days of a row.
fn by(row: &Row, value: Value) -> Value {
    // The motion model is not part of the filter's name.
    let (filter, moves) = row.filter.split_once(", ").unwrap_or((row.filter, ""));
    let method = match filter {
        _ if is_ours(row) => "default".to_owned(),
        filter if row.is_published() => {
            format!("published {}", filter.replace(" as published", ""))
        }
        filter if ["RKF", "IKF", "UKF"].iter().any(|name| filter.contains(name)) => {
            format!("{filter}, scale repaired")
        }
        filter => format!("published {filter}"),
    };
    let condition = [row.table, moves].join(", ");
    value.under(condition.trim_end_matches(", ")).by(method).of(row.days.len(), None)
}

/// The values for north, east, up and 3-D, with published ones and limits.
fn numbers(
    row: &Row,
    quantity: &str,
    values: [f64; 4],
    [published, limit]: [Option<[f64; 4]>; 2],
) -> [Value; 4] {
    let each = Value::each(quantity, ["north", "east", "up", "3-D"], ["mm"; 4], values);
    std::array::from_fn(|axis| {
        let of = |all: Option<[f64; 4]>| all.map(|all| all[axis]);
        by(row, each[axis].clone()).published(of(published)).limited(of(limit))
    })
}

/// The most important results: a static and a kinematic solution.
pub(super) fn headlines(report: &Report) -> Vec<Headline> {
    let line = |table: &str, paper: FilterKind, filter: &str, place: usize, quantity: &str| {
        let find = |filter: &str| {
            report.rows.iter().find(|row| row.table == table && row.filter == filter)
        };
        let rms = |errors: &PppErrors| errors.rms_mm[3];
        let (theirs, ours) = (find(filter), find(FilterKind::Default.title()));
        let paper = find(paper.title());
        Headline {
            quantity: quantity.to_owned(),
            unit: "mm",
            published: paper.and_then(|row| row.published.as_ref()).map(rms),
            theirs: theirs.map(|row| rms(&row.ours)),
            ours: ours.map(|row| rms(&row.ours)),
            limit: plain(report, place).map(rms),
        }
    };
    vec![
        line(
            STATIC,
            FilterKind::Ikf,
            "IKF as published",
            0,
            "RMS 3-D after the first hour, the receiver stands",
        ),
        line(
            KINEMATIC,
            FilterKind::Adaptive,
            "UKF as published",
            2,
            "RMS 3-D after the first hour, the receiver may move",
        ),
    ]
}

fn minutes_in_words(errors: &PppErrors) -> String {
    errors.convergence_min.map_or(String::new(), |minutes| format!("{minutes:.1}"))
}
