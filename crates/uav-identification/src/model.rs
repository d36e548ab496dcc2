//! The model in the form that a filter reads.

use kestirim_uav_longitudinal::StateSpace;
use nalgebra::{Matrix4, RowVector4, SMatrix, SVector, Vector2, Vector4};

use crate::accuracy::Whiteness;
use crate::flight::{FITTED, Flight, OUTPUTS, Reference, spread};
use crate::innovations::{Filter, UNKNOWNS};
use crate::structure::{Structure, inverse};

/// Further columns of the log, which kinematics relates to the states.
pub(crate) const DERIVED: [&str; 3] = ["qbar", "climb", "V_ground"];
/// Prior of the constant part of ẋ, by which a steady flight may differ from the recorded one: initial standard
/// deviations, and random-walk rates per √s.
const AFFINE: ([f64; 4], [f64; 4]) = ([0.005, 0.01, 0.3, 0.0], [1e-3, 1e-4, 0.02, 0.0]);
/// Variation of the biases of gyro, pitch angle and accelerometer from flight to flight, rad/s, rad and m/s², with
/// their random walks.
const BIASES: [(&str, Drift); 3] = [
    ("q", Drift { sigma: 0.02, rate: 1e-5 }),
    ("theta", Drift { sigma: 0.03, rate: 1e-5 }),
    ("az", Drift { sigma: 0.05, rate: 0.01 }),
];
/// Relative variation of the air density, where the dynamic pressure is measured.
const DENSITY: Drift = Drift { sigma: 0.03, rate: 5e-4 };
/// Prior of the head wind where the speed over ground is measured besides the airspeed, m/s.
const WIND: Drift = Drift { sigma: 8.0, rate: 0.1 };
/// Outputs that are proportional to the dynamic pressure.
const SCALED: [&str; 2] = ["az", "qbar"];
/// A column that is fitted but not written to the model: ax shows the drag, which is determined less well than the
/// lift.
const UNWRITTEN: &str = "ax";
/// Largest correlation of successive residuals that is allowed for when the noise is widened.
const MOST_COLOURED: f64 = 0.9;
/// Relative error of a linear model on another flight, for deviations as large as in this one.
const WRONG: f64 = 0.07;
/// Duration of such deviations, s.
const LASTING: f64 = 0.5;
/// Lower limits of the spectral densities on ẋ: air is never quite calm.
const LEAST_PROCESS: [f64; 4] = [1e-8, 1e-5, 4e-4, 1e-9];

/// A linear model of deviations from a steady flight, ẋ = A·x + B·u, y = C·x + D·u.
///
/// The states are α (rad, as the vane shows it), q (rad/s), V (m/s) and θ (rad), the inputs elevator (rad) and
/// throttle (0 to 1). Its serialised form is a `model.json`.
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
    /// Names of the outputs: columns of the log.
    pub outputs: Vec<&'static str>,
    /// The steady flight from which deviations are counted.
    pub trim: Trim,
    /// The noise of model and outputs.
    pub noise: Noise,
    /// Outputs that are proportional to the dynamic pressure.
    pub scaled: Vec<&'static str>,
    /// Sensor biases that vary from flight to flight.
    pub bias: Vec<Bias>,
    /// Prior of the head wind, m/s, if the speed over ground is an output.
    pub wind: Option<Drift>,
    /// Prior of the relative error of the air density, if the dynamic pressure is an output.
    pub density: Option<Drift>,
    /// Prior of a constant part of ẋ.
    pub affine: Affine,
    /// Turbulence parameters.
    pub gust: Gust,
}

/// A steady flight.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Trim {
    /// The states α, q, V, θ.
    pub x: [f64; 4],
    /// The inputs elevator and throttle.
    pub u: [f64; 2],
    /// Value of each output in the steady flight.
    pub y: Vec<f64>,
}

/// White noise.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Noise {
    /// Spectral densities on ẋ, squared units per second.
    pub process: [f64; 4],
    /// Standard deviation of each output.
    pub outputs: Vec<f64>,
}

/// Prior of a slowly varying error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Drift {
    /// Initial standard deviation.
    pub sigma: f64,
    /// Random-walk rate, per √s.
    pub rate: f64,
}

/// Prior of an output's bias.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Bias {
    /// The output.
    pub of: &'static str,
    /// Its initial standard deviation and random walk.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub drift: Drift,
}

/// Prior of a constant part of ẋ.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Affine {
    /// Initial standard deviations.
    pub sigma: [f64; 4],
    /// Random-walk rates, per √s.
    pub rate: [f64; 4],
}

/// Turbulence: standard deviations (m/s) and length scales (m) along and across the path.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Gust {
    /// Standard deviation along the path, m/s.
    pub sigma_u: f64,
    /// Standard deviation across the path, m/s.
    pub sigma_w: f64,
    /// Length scale along the path, m.
    pub length_u: f64,
    /// Length scale across the path, m.
    pub length_w: f64,
}

impl Default for Gust {
    fn default() -> Self {
        Self { sigma_u: 2.0, sigma_w: 2.0, length_u: 300.0, length_w: 300.0 }
    }
}

/// The model's steady flight nearest to the recorded mean: the solution of A·x + B·u = −constant of least norm, with
/// each variable relative to how much it moved.
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

/// The row of C, in true states, of an output that kinematics relates to the states.
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
    /// Creates the model from the estimates; `linear` holds the unknowns of each stretch.
    pub(crate) fn of(
        flights: &[Flight],
        reference: &Reference,
        filter: &Filter<'_>,
        linear: &[[f64; UNKNOWNS]],
        whiteness: &[Option<Whiteness>; OUTPUTS],
    ) -> Self {
        let structure = filter.structure;
        let count = linear.len().max(1) as f64;
        let mean = |place: usize| linear.iter().map(|it| it[place]).sum::<f64>() / count;
        let scatter = |place: usize| spread(linear.iter().map(move |it| it[place])).1;
        let constant = Vector4::from_fn(|state, _| mean(4 + state));
        let moved = moved(flights);
        let (x, u) = steady(structure, constant, &moved);
        let linear = StateSpace { a: structure.a, b: structure.b };
        let wrong = linear.process_noise(WRONG, &moved, LASTING);
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
            noise: Noise {
                process: std::array::from_fn(|state| {
                    filter.process[state].max(LEAST_PROCESS[state]).max(wrong[state])
                }),
                outputs: Vec::new(),
            },
            scaled: Vec::new(),
            bias: Vec::new(),
            wind: None,
            density: None,
            affine: Affine {
                sigma: std::array::from_fn(|state| AFFINE.0[state].max(scatter(4 + state))),
                rate: AFFINE.1,
            },
            gust: Gust::default(),
        };
        let is_written = |&output: &usize| reference.has[output] && FITTED[output] != UNWRITTEN;
        for output in (0..FITTED.len()).filter(is_written) {
            let (row, through) = (structure.c.row(output), structure.d.row(output));
            let off = if output >= 4 { mean(4 + output) } else { 0.0 };
            let shown = at[output] + off + (row * x)[0] + (through * u)[0];
            let (c, d) = ([row[0], row[1], row[2], row[3]], [through[0], through[1]]);
            // A filter assumes white noise: the variance of coloured residuals is increased accordingly.
            let next = whiteness[output].map_or(0.0, |it| it.next.clamp(0.0, MOST_COLOURED));
            let coloured = (1.0 + next) / (1.0 - next);
            let sigma = (coloured * filter.measured[output]).sqrt();
            model.push((FITTED[output], c, d, shown), sigma);
        }
        for name in
            DERIVED.into_iter().filter(|name| flights.iter().all(|it| it.column(name).is_some()))
        {
            model.derive(name, flights, reference, (&structure.seen, &x));
        }
        let is_there = |name: &&str| model.outputs.contains(name);
        model.scaled = SCALED.into_iter().filter(is_there).collect();
        let biases = BIASES.into_iter().filter(|(of, _)| is_there(of));
        model.bias = biases.map(|(of, drift)| Bias { of, drift }).collect();
        model.density = is_there(&"qbar").then_some(DENSITY);
        model.wind = is_there(&"V_ground").then_some(WIND);
        model
    }

    fn push(&mut self, (name, c, d, y): (&'static str, [f64; 4], [f64; 2], f64), sigma: f64) {
        self.outputs.push(name);
        self.c.push(c);
        self.d.push(d);
        self.trim.y.push(y);
        self.noise.outputs.push(sigma);
    }

    /// Adds an output that is a function of the states, with its mean error and the standard deviation of that.
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

/// Standard deviations of states and inputs, with lower limits.
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
