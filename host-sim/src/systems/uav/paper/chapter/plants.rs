//! Chapters 3 and 5 of the thesis: the trim, and the response of the plant without an estimator.

use kestirim_replay::uav::{Model, Plant};

use super::{by_state, made};
use crate::figure::{Colour, Figure, Series};
use crate::report::{Comparison, Item, Value, printed};
use crate::systems::uav::paper::published::{RANK, SETTLING_S, TRIM};
use crate::systems::uav::paper::report::{Report, said_of_constant_inputs};
use crate::systems::uav::paper::responses::{Bode, Responses};
use crate::systems::uav::simulate::plant::STATES;

/// The inputs, with the unit of each in the figures: a degree of elevator, a tenth of the throttle.
const DRIVES: [(&str, f64, Colour); 2] = [
    ("1° of elevator", std::f64::consts::PI / 180.0, Colour::Other(0)),
    ("10 % of throttle", 0.1, Colour::Other(1)),
];

/// The items in the thesis' order.
pub(super) fn items(report: &Report) -> Vec<Item> {
    let once = made(report, "none: nothing is random");
    let mut items = vec![once.item(trim()), once.item(visibility(report))];
    let Some(plant) = report.plants.iter().find(|row| row.plant == Plant::P2) else { return items };
    let impulse = ("uav-fig-5-1", "Fig. 5.1, impulse response of P2");
    let step = ("uav-fig-5-2", "Fig. 5.2, step response of P2");
    let settles =
        "The thesis says that it settles after about 600 s: so does this, by the phugoid alone.";
    for (response, name, caption) in [
        (
            &plant.impulse,
            impulse,
            "The short period is over in a second, the phugoid swings for minutes.",
        ),
        (&plant.step, step, settles),
    ] {
        items.extend(driven(plant, response, name, caption).map(|figure| once.item(figure)));
    }
    items.push(once.item(settling(report)));
    items.extend(bode(plant).map(|figure| once.item(figure)));
    items.push(once.item(singular_values(&report.plants)));
    items.extend(constant_inputs(plant).map(|figure| once.item(figure)));
    items.push(once.item(said(report)));
    items
}

fn trim() -> Comparison {
    let (state, _) = Model::of(Plant::P1).trim.unwrap_or_default();
    let degrees = |angle: f64| format!("{:.2}°", angle.to_degrees());
    let ours = [
        degrees(state[0]),
        format!("{:.0} rad/s", state[1]),
        format!("{:.0} m/s", state[2]),
        degrees(state[3]),
    ];
    let empty =
        Comparison::new("uav-table-3-1", "Table 3.1: steady flight (ours: P1, the Aerosonde)");
    let shown = [state[0].to_degrees(), state[1], state[2], state[3].to_degrees()];
    let values = Value::each("trim", STATES, ["°", "rad/s", "m/s", "°"], shown);
    let values = values.into_iter().zip(TRIM);
    let values = values.map(|(value, text)| value.under("P1").by("model").published(printed(text)));
    let rows = STATES.into_iter().zip(TRIM).zip(ours);
    rows.fold(empty, |table, ((name, published), ours)| table.row(name, published, ours, ""))
        .values(values)
        .note(
            "No documented aircraft has this trim and settles in 600 s. The thesis' own simulations start \
             at θ = 0.53 rad, not at 12°.",
        )
}

fn visibility(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-observability",
        "Sections 4.2.1, 4.2.2: whether every mode is moved and seen (ours: least singular value, above 0)",
    );
    report
        .plants
        .iter()
        .fold(empty, |table, row| {
            let name = row.plant.name();
            let table = table.row(
                format!("{name}: moved by δe and δt"),
                RANK,
                format!("{:.1e}", row.controllability),
                "",
            );
            let least = |of: String, value: f64| {
                Value::new("least singular value", "").under(of).by("model").is(value)
            };
            let table = table.values([least(format!("{name}: moved"), row.controllability)]);
            row.observability.iter().fold(table, |table, seen| {
                let name = format!("{name}: seen in {}", seen.outputs.name());
                let value = least(name.clone(), seen.least);
                table.row(name, RANK, format!("{:.1e}", seen.least), "").values([value])
            })
        })
        .note(
            "A determinant of [C; CA; …] tells nothing at 100 Hz: hence the Popov–Belevitch–Hautus test on a \
             balanced pair. Neither a rank nor a number is printed, but that the ranks must be full.",
        )
}

/// A figure per state with the responses to both inputs.
fn driven(
    plant: &Responses,
    response: &[Vec<[f64; 4]>; 2],
    (id, title): (&str, &str),
    caption: &str,
) -> [Figure; 4] {
    by_state(id, title, caption, |state, figure| {
        let series = response.iter().zip(DRIVES).map(|(samples, (name, size, colour))| {
            let values = samples.iter().map(|sample| size * sample[state]).collect();
            Series::line(name, plant.step_times_s.clone(), values).coloured(colour)
        });
        figure.with_all(series).showing(Some([0.0, 900.0]), None)
    })
}

fn settling(report: &Report) -> Comparison {
    let empty = Comparison::new(
        "uav-settling",
        "Fig. 5.2: time in which steps settle to 2 %, of α, q, V, θ, s",
    );
    report.plants.iter().fold(empty, |table, row| {
        let inputs = ["δe", "δt"].into_iter().zip(row.settling_s);
        inputs.fold(table, |table, (input, seconds)| {
            let published = match row.plant {
                Plant::P2 => format!("≈ {SETTLING_S}"),
                _ => String::new(),
            };
            let here = seconds.map(|s| format!("{s:.0}")).join(" ");
            let condition = format!("{}, {input}", row.plant.name());
            let said = (row.plant == Plant::P2).then_some(SETTLING_S);
            let values = Value::each("time in which a step settles", STATES, ["s"; 4], seconds);
            let values = values.map(|value| value.under(&condition).by("model").published(said));
            table.repeated(condition, published, here, "").values(values)
        })
    })
}

/// Fig. 5.3: a gain and a phase diagram for each input.
fn bode(plant: &Responses) -> [Figure; 4] {
    let omegas: Vec<f64> = plant.bode.iter().map(|point| point.omega).collect();
    let of = |of: &dyn Fn(&Bode, usize) -> f64, state: usize| -> Vec<f64> {
        plant.bode.iter().map(|point| of(point, state)).collect()
    };
    let inputs = [("δe", "elevator"), ("δt", "throttle")];
    std::array::from_fn(|number| {
        let (input, phase) = (number % 2, number / 2 == 1);
        let (symbol, name) = inputs[input];
        let (what, label) =
            if phase { ("phase", "phase, °") } else { ("gain", "gain, states' units") };
        let series = STATES.into_iter().enumerate().map(|(state, name)| {
            let values = if phase {
                unwrapped(&of(&|point, state| point.phase[state][input], state))
            } else {
                of(&|point, state| point.magnitude[state][input], state)
            };
            Series::line(name, omegas.clone(), values).coloured(Colour::Other(state))
        });
        let mut figure = Figure::new(
            format!("uav-fig-5-3-{what}-{name}"),
            format!("Fig. 5.3, Bode diagram of P2: {what} from {symbol}"),
        )
        .axes("ω, rad/s", label)
        .caption(
            "The phugoid's resonance at 0.16 rad/s is narrow: it is what takes 600 s to settle.",
        )
        .with_all(series);
        (figure.x.logarithmic, figure.y.logarithmic) = (true, !phase);
        figure
    })
}

/// Phases in degrees, without jumps of 360°.
fn unwrapped(phases: &[f64]) -> Vec<f64> {
    let mut before = phases.first().map_or(0.0, |phase| phase.to_degrees());
    phases
        .iter()
        .map(|phase| {
            let phase = phase.to_degrees();
            before = phase - 360.0 * ((phase - before) / 360.0).round();
            before
        })
        .collect()
}

/// Fig. 5.4: the singular values of all aircraft.
fn singular_values(plants: &[Responses]) -> Figure {
    let mut figure = Figure::new("uav-fig-5-4", "Fig. 5.4, largest and smallest singular value")
        .axes("ω, rad/s", "gain over all directions of the input")
        .caption("Each aircraft's phugoid stands out; the smallest values are broken lines.")
        .logarithmic();
    figure.x.logarithmic = true;
    for (number, plant) in plants.iter().enumerate() {
        let of = |place: usize| {
            plant.bode.iter().map(move |point| [point.omega, point.singular_values[place]])
        };
        let mut largest: Vec<_> = of(0).collect();
        // The resonance is narrower than the spacing of the frequencies.
        largest.push([plant.peak.omega, plant.peak.gain]);
        largest.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let (name, colour) = (plant.plant.name(), Colour::Other(number));
        let smallest = Series::path(format!("{name}, smallest"), of(1));
        figure = figure
            .with(Series::path(name, largest).coloured(colour))
            .with(smallest.marked(crate::figure::Mark::Dashes).coloured(colour));
    }
    figure
}

/// Figs 5.5 to 5.8: the responses to constant inputs.
fn constant_inputs(plant: &Responses) -> [Figure; 4] {
    let column = |place: usize| plant.constant_inputs.iter().map(|row| row[place]).collect();
    by_state(
        "uav-fig-5-5",
        "Figs 5.5–5.8, P2 with δe 0.025 and δt 0.155",
        "From the thesis' start, V = 40 m/s and θ = 0.53 rad; what it says of the curve is in the table below.",
        |state, figure| figure.with(Series::line("plant", column(0), column(state + 1))),
    )
}

fn said(report: &Report) -> Comparison {
    let empty =
        Comparison::new("uav-constant-inputs", "Figs 5.5–5.8: what the thesis says of them");
    said_of_constant_inputs(&report.plants).into_iter().fold(
        empty,
        |table, [quantity, published, here]| {
            // The name contains the unit after the comma, if there is one.
            let unit =
                ["rad", "m/s"].into_iter().find(|unit| quantity.contains(&format!(", {unit}")));
            let value = Value::new(quantity.clone(), unit.unwrap_or("s")).by("model");
            let value = value.is(printed(&here)).published(printed(&published));
            table.repeated(quantity, published, here, "").values([value])
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phases_do_not_jump() {
        let turns = [3.0, -3.2, -3.0, 3.1, 3.3 - std::f64::consts::TAU];
        let steps = unwrapped(&turns);
        assert!(steps.windows(2).all(|pair| (pair[1] - pair[0]).abs() < 30.0), "{steps:?}");
    }
}
