//! The model as a filter takes it.

use nalgebra::{Matrix4, RowVector4, SMatrix, SVector, Vector2, Vector4};

use crate::flight::{FITTED, Flight, Reference, spread};
use crate::innovations::{Filter, UNKNOWNS};
use crate::structure::{Structure, inverse};

/// Of what else the log may have, kinematics says what it is.
const DERIVED: [&str; 3] = ["qbar", "climb", "V_ground"];
/// What a steady flight may differ in from the one that was recorded, of ẋ: its deviation, and how it wanders per √s.
const AFFINE: ([f64; 4], [f64; 4]) = ([0.002, 0.02, 0.3, 0.0], [5e-4, 5e-3, 0.02, 0.0]);
/// Of a gyro and of a pitch angle from flight to flight, rad/s and rad, with their wandering.
const BIASES: [(&str, f64, f64); 2] = [("q", 0.02, 1e-5), ("theta", 0.03, 1e-5)];
/// Share of an airspeed that its density may be wrong by.
const AIRSPEED: f64 = 0.01;

/// A linear model of deviations from a steady flight, ẋ = A·x + B·u, y = C·x + D·u, of states α (rad, as the vane shows it),
/// q (rad/s), V (m/s), θ (rad) and inputs elevator (rad) and throttle (0 to 1). Serialised it is a `model.json`.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Model {
    /// A, row by row.
    #[cfg_attr(feature = "serde", serde(rename = "A"))]
    pub a: [[f64; 4]; 4],
    /// B, row by row.
    #[cfg_attr(feature = "serde", serde(rename = "B"))]
    pub b: [[f64; 2]; 4],
    /// C: a row for each output.
    #[cfg_attr(feature = "serde", serde(rename = "C"))]
    pub c: Vec<[f64; 4]>,
    /// D: a row for each output.
    #[cfg_attr(feature = "serde", serde(rename = "D"))]
    pub d: Vec<[f64; 2]>,
    /// Columns of the log.
    pub outputs: Vec<&'static str>,
    /// The steady flight that deviations are counted from.
    pub trim: Trim,
    /// How much is not told by the model.
    pub noise: Noise,
    /// Outputs that grow with the dynamic pressure.
    pub scaled: Vec<&'static str>,
    /// By how much inputs act later than the log says, s; half an interval is an input that is held.
    pub delay: f64,
    /// What sensors may be off from flight to flight.
    pub bias: Vec<Bias>,
    /// A constant part of ẋ.
    pub affine: Affine,
    /// Turbulence.
    pub gust: Gust,
}

/// A steady flight.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Trim {
    /// α, q, V, θ.
    pub x: [f64; 4],
    /// Elevator, throttle.
    pub u: [f64; 2],
    /// What each output shows in it.
    pub y: Vec<f64>,
}

/// White noise.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Noise {
    /// Spectral density on ẋ, squared units per second.
    pub process: [f64; 4],
    /// Standard deviation of each output.
    pub outputs: Vec<f64>,
}

/// What an output is off.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Bias {
    /// Which output.
    pub of: &'static str,
    /// Deviation at the start.
    pub sigma: f64,
    /// How it wanders, per √s.
    pub rate: f64,
}

/// A constant part of ẋ.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Affine {
    /// Deviation at the start.
    pub sigma: [f64; 4],
    /// How it wanders, per √s.
    pub rate: [f64; 4],
}

/// Turbulence: deviations (m/s) and lengths (m) along and across the path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Gust {
    /// Along.
    pub sigma_u: f64,
    /// Across.
    pub sigma_w: f64,
    /// Along.
    pub length_u: f64,
    /// Across.
    pub length_w: f64,
}

impl Default for Gust {
    fn default() -> Self {
        Self { sigma_u: 2.0, sigma_w: 2.0, length_u: 300.0, length_w: 300.0 }
    }
}

/// Where the model flies steadily, next to what was flown: A·x + B·u = −constant with the least of each beside how much it
/// moved.
fn steady(
    structure: &Structure,
    constant: Vector4<f64>,
    moved: &[f64; 6],
) -> (Vector4<f64>, Vector2<f64>) {
    let mut both = SMatrix::<f64, 4, 6>::zeros();
    both.fixed_view_mut::<4, 4>(0, 0).copy_from(&structure.a);
    both.fixed_view_mut::<4, 2>(0, 4).copy_from(&structure.b);
    let weighted = both * SMatrix::<f64, 6, 6>::from_diagonal(&SVector::from(*moved));
    let square = weighted * weighted.transpose();
    let Some(inverse) = square.try_inverse() else { return Default::default() };
    let step = SVector::from(*moved).component_mul(&(weighted.transpose() * (inverse * -constant)));
    (step.fixed_rows::<4>(0).into_owned(), step.fixed_rows::<2>(4).into_owned())
}

/// A row of what kinematics says of a state.
fn derived(name: &str, reference: &Reference, pressure: f64) -> RowVector4<f64> {
    let [alpha, _, airspeed, theta] = reference.state;
    let (sin, cos) = (theta - alpha).sin_cos();
    match name {
        "climb" => RowVector4::new(-airspeed * cos, 0.0, sin, airspeed * cos),
        "V_ground" => RowVector4::new(airspeed * sin, 0.0, cos, -airspeed * sin),
        _ => RowVector4::new(0.0, 0.0, 2.0 * pressure / airspeed, 0.0),
    }
}

impl Model {
    /// What was found, `linear` being what each stretch began with.
    pub(crate) fn of(
        flights: &[Flight],
        reference: &Reference,
        filter: &Filter<'_>,
        linear: &[[f64; UNKNOWNS]],
    ) -> Self {
        let structure = filter.structure;
        let count = linear.len().max(1) as f64;
        let mean = |place: usize| linear.iter().map(|it| it[place]).sum::<f64>() / count;
        let scatter = |place: usize| spread(linear.iter().map(move |it| it[place])).1;
        let constant = Vector4::from_fn(|state, _| mean(4 + state));
        let moved = moved(flights);
        let (x, u) = steady(structure, constant, &moved);
        let at = [reference.state, [reference.force[0], reference.force[1], 0.0, 0.0]].concat();
        let mut model = Self {
            a: rows4(&structure.a),
            b: std::array::from_fn(|row| [structure.b[(row, 0)], structure.b[(row, 1)]]),
            c: Vec::new(),
            d: Vec::new(),
            outputs: Vec::new(),
            trim: Trim {
                x: std::array::from_fn(|state| reference.state[state] + x[state]),
                u: std::array::from_fn(|input| reference.input[input] + u[input]),
                y: Vec::new(),
            },
            noise: Noise { process: filter.process, outputs: Vec::new() },
            scaled: Vec::new(),
            delay: filter.delay,
            bias: Vec::new(),
            affine: Affine {
                sigma: std::array::from_fn(|state| AFFINE.0[state].max(scatter(4 + state))),
                rate: AFFINE.1,
            },
            gust: Gust::default(),
        };
        for output in (0..FITTED.len()).filter(|&output| reference.has[output]) {
            let (row, through) = (structure.c.row(output), structure.d.row(output));
            let off = if output >= 4 { mean(4 + output) } else { 0.0 };
            let shown = at[output] + off + (row * x)[0] + (through * u)[0];
            let (c, d) = ([row[0], row[1], row[2], row[3]], [through[0], through[1]]);
            model.push((FITTED[output], c, d, shown), filter.measured[output].sqrt());
            if output >= 4 {
                model.scaled.push(FITTED[output]);
            }
        }
        for name in
            DERIVED.into_iter().filter(|name| flights.iter().all(|it| it.column(name).is_some()))
        {
            model.derive(name, flights, reference, (&structure.seen, &x));
        }
        let biases = BIASES.into_iter().filter(|(of, ..)| model.outputs.contains(of));
        model.bias = biases.map(|(of, sigma, rate)| Bias { of, sigma, rate }).collect();
        if model.outputs.contains(&"qbar") {
            model.bias.push(Bias { of: "V", sigma: AIRSPEED * reference.state[2], rate: 0.0 });
        }
        model
    }

    fn push(&mut self, (name, c, d, y): (&'static str, [f64; 4], [f64; 2], f64), sigma: f64) {
        self.outputs.push(name);
        self.c.push(c);
        self.d.push(d);
        self.trim.y.push(y);
        self.noise.outputs.push(sigma);
    }

    /// Adds an output that is known from states, with what it is off on average, and how much.
    fn derive(
        &mut self,
        name: &'static str,
        flights: &[Flight],
        reference: &Reference,
        (seen, x): (&Matrix4<f64>, &Vector4<f64>),
    ) {
        let values = flights.iter().filter_map(|flight| flight.column(name)).flatten().flatten();
        let mean = spread(values.copied()).0;
        let row = derived(name, reference, mean) * inverse(seen);
        let off = flights.iter().flat_map(|flight| {
            let column = |name: &str| flight.column(name);
            let (of, states) = (column(name), crate::STATES.map(column));
            (0..flight.times.len()).filter_map(move |at| {
                let mut value = of?[at]? - mean;
                for (state, measured) in states.iter().enumerate() {
                    let Some(measured) = measured else { continue };
                    value -= row[state] * (measured[at]? - reference.state[state]);
                }
                Some(value)
            })
        });
        let (offset, sigma) = spread(off.collect::<Vec<_>>().into_iter());
        let shown = mean + offset + (row * x)[0];
        self.push((name, [row[0], row[1], row[2], row[3]], [0.0; 2], shown), sigma);
    }
}

fn rows4(matrix: &Matrix4<f64>) -> [[f64; 4]; 4] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]))
}

/// How much states and inputs moved.
fn moved(flights: &[Flight]) -> [f64; 6] {
    let least = [1e-3, 1e-3, 0.1, 1e-3, 1e-4, 1e-4];
    std::array::from_fn(|which| {
        let values: Vec<f64> = if which < 4 {
            let columns = flights.iter().filter_map(|flight| flight.column(crate::STATES[which]));
            columns.flatten().flatten().copied().collect()
        } else {
            flights.iter().flat_map(|flight| &flight.inputs).map(|input| input[which - 4]).collect()
        };
        spread(values.into_iter()).1.max(least[which])
    })
}
