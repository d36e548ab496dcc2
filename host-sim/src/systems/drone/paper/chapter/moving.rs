//! Figures and tables of a walking user: Table 3.5, Figs 3.6 to 3.12.

use kestirim_particle_filter::Resampler;
use kestirim_replay::drone::{EnvironmentKind, Estimate, Track};

use super::cells::Cells;
use super::{made, tables};
use crate::figure::{Colour, Figure, Mark, Series};
use crate::report::Item;
use crate::stream::Stream;
use crate::systems::drone::paper::report::{Report, Row};
use crate::systems::drone::settings::expected_loss_db;
use crate::systems::drone::simulate::moving_user::{LOST_M, Policy, SIDE_M, Walk, track};

/// The flights that are drawn.
pub(super) struct Walks {
    hovering: Track,
    orbiting: Track,
}

impl Walks {
    /// Simulates the flights with the report's seed.
    pub(super) fn new(report: &Report) -> Self {
        let of = |policy| track(&Walk::thesis(policy), report.seed, 0);
        Self { hovering: of(Policy::Hover(Resampler::Systematic)), orbiting: of(Policy::Orbit) }
    }

    /// The streams of the flight that circles the estimate.
    pub(super) fn streams(&self) -> Vec<Stream> {
        let (track, channel) = (&self.orbiting, EnvironmentKind::Urban.channel());
        let stream = |topic: &str, columns: &[&str], values: &dyn Fn(&Estimate) -> Vec<f64>| {
            let rows = track.estimates.iter();
            let rows = rows.map(|estimate| (track.stop(estimate).t, values(estimate)));
            Stream::new(topic, columns, rows.collect())
        };
        vec![
            stream("/drone/position", &["x_m", "y_m", "z_m"], &|estimate| {
                let stop = track.stop(estimate);
                vec![stop.place[0], stop.place[1], stop.height]
            }),
            stream("/drone/path_loss", &["measured_db", "expected_db"], &|estimate| {
                let stop = track.stop(estimate);
                let expected = expected_loss_db(&channel, &stop, estimate.place);
                vec![stop.loss, expected.unwrap_or(f64::NAN)]
            }),
            stream("/drone/truth", &["x_m", "y_m"], &|estimate| {
                track.user(estimate).map_or_else(Vec::new, Vec::from)
            }),
            stream("/drone/estimate", &["x_m", "y_m", "spread_m", "effective"], &|estimate| {
                let [x, y] = estimate.place;
                vec![x, y, estimate.sd_m, estimate.effective().unwrap_or(f64::NAN)]
            }),
        ]
    }
}

/// The items in the thesis' order.
pub(super) fn items(report: &Report, walks: &Walks) -> Vec<Item> {
    let once = made(report, "1 flight each");
    let mut items = vec![
        once.item(drawn(
            &walks.hovering,
            ("drone-fig-3-6-hovering", "Fig. 3.6, a user followed as in the thesis"),
            "Right above the user the loss does not tell where they go: the drone is blind to it.",
        )),
        once.item(drawn(
            &walks.orbiting,
            ("drone-fig-3-6-circling", "The same user followed by circling the estimate"),
            "From beside the user it does.",
        )),
        once.item(errors(walks)),
    ];
    let sweeps = [
        ("Fig. 3.7", "drone-fig-3-7", "Fig. 3.7", "L=", "particles L"),
        (
            "Fig. 3.8 (h=500)",
            "drone-fig-3-8",
            "Fig. 3.8, h = 500 m",
            "r=",
            "radius of the user's circle, m",
        ),
        (
            "Fig. 3.9 (h=1000)",
            "drone-fig-3-9",
            "Fig. 3.9, h = 1000 m",
            "r=",
            "radius of the user's circle, m",
        ),
        ("Fig. 3.11", "drone-fig-3-11", "Figs 3.10 and 3.11", "T_end=", "steps of the walk"),
        ("Fig. 3.12", "drone-fig-3-12", "Fig. 3.12", "v=", "speed of the drone, km/h"),
    ];
    for (table, id, title, key, label) in sweeps {
        items.extend(sweep(report, table, (id, title), (key, label)));
    }
    items
}

/// The error, energy and share of lost users of both policies, and the table.
fn sweep(
    report: &Report,
    table: &str,
    (id, title): (&str, &str),
    (key, label): (&str, &str),
) -> Vec<Item> {
    let note = "The thesis' plots did not survive: it prints no numbers to compare with. Its jitter, the \
                length of a step and the middle of the user's circle are not printed either.";
    let table_id = format!("{id}-table");
    let table_title = format!("{title}: mean error, energy, lost at {LOST_M} m and more");
    let Some(item) = tables::of(report, table, (&table_id, &table_title, note)) else {
        return Vec::new();
    };
    let made = item.made.clone();
    let hovering = Cells { table, filter: "published", named: &[], key };
    let circling = Cells { filter: "best", ..hovering };
    let both = [
        (hovering, "hovering over the estimate (thesis)", Colour::Published),
        (circling, "circling, velocity marginalised", Colour::Ours),
    ];
    let quantity = |what: &str, axis: &str, value: fn(&Row) -> Option<f64>| {
        let name = format!("{id}-{what}");
        let lines = both.map(|(cells, name, colour)| {
            let line = Series::path(name, cells.points(report, value));
            line.marked(Mark::LineAndPoints).coloured(colour)
        });
        Figure::new(name, format!("{title}: {what}")).axes(label, axis).with_all(lines)
    };
    let error = Figure::new(format!("{id}-error"), format!("{title}: error"))
        .axes(label, "mean error, m")
        .caption("Bars are standard errors of the mean.")
        .with_all(both.map(|(cells, name, colour)| cells.line(report, name, colour)));
    let energy = quantity("energy", "energy of the flight, kJ", |row| {
        row.energy_j.map(|joules| joules / 1e3)
    });
    let lost = quantity("lost", "lost flights, %", |row| row.lost_percent);
    let mut items = vec![made.item(error), made.item(energy)];
    items.push(made.item(lost));
    items.push(item);
    items
}

/// The paths of drone and user, and the estimates of the user's position.
fn drawn(track: &Track, (id, title): (&str, &str), caption: &str) -> Figure {
    let path = |name: &str, place: &dyn Fn(&Estimate) -> Option<[f64; 2]>, colour| {
        Series::path(name, track.estimates.iter().filter_map(place)).coloured(colour)
    };
    Figure::new(id, title)
        .axes("x, m", "y, m")
        .map()
        .caption(caption)
        .showing(Some([0.0, SIDE_M]), Some([0.0, SIDE_M]))
        .with(path("drone", &|it| Some(track.stop(it).place), Colour::Other(1)))
        .with(path("estimate", &|it| Some(it.place), Colour::Ours))
        .with(path("user", &|it| track.user(it), Colour::Truth))
}

fn errors(walks: &Walks) -> Figure {
    let line = |name: &str, track: &Track, colour| {
        let points = track
            .estimates
            .iter()
            .filter_map(|estimate| Some([estimate.stop as f64 + 1.0, track.error_m(estimate)?]));
        Series::path(name, points).coloured(colour)
    };
    let steps = walks.hovering.estimates.len() as f64;
    let lost = Series::path("lost", [[1.0, LOST_M], [steps, LOST_M]]);
    Figure::new("drone-fig-3-6-errors", "Errors of both flights")
        .axes("step", "distance of the estimate from the user, m")
        .caption("A flight counts as lost whose mean is above the broken line.")
        .with(lost.marked(Mark::Dashes).coloured(Colour::Alarm))
        .with(line("hovering (thesis)", &walks.hovering, Colour::Published))
        .with(line("circling", &walks.orbiting, Colour::Ours))
}
