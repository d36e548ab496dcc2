//! Noise of sensors and inputs.

use kestirim_observer_design::Discrete;
use nalgebra::{SMatrix, SVector};

/// Standard deviations of white noise.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Noise {
    /// The name in tables.
    pub name: &'static str,
    /// Noise of the inputs that reaches the plant in addition to δe and δt.
    pub inputs: [f64; 2],
    /// Noise of the measured α, q, V and θ.
    pub outputs: [f64; 4],
}

impl Noise {
    /// No noise.
    pub const NONE: Self = Self { name: "none", inputs: [0.0; 2], outputs: [0.0; 4] };
    /// The noise of the thesis, of equal size on all inputs and outputs. It does not print the size.
    pub const EQUAL: Self = Self { name: "equal", inputs: [0.01; 2], outputs: [0.01; 4] };
    /// The noise of usual sensors: half a degree and half a metre per second.
    pub const SENSORS: Self = Self {
        name: "sensors",
        inputs: [HALF_A_DEGREE, 0.02],
        outputs: [HALF_A_DEGREE, HALF_A_DEGREE, 0.5, HALF_A_DEGREE],
    };

    /// Covariance of the state after an interval due to the noise of the inputs.
    pub fn process(&self, plant: &Discrete<4, 2>) -> SMatrix<f64, 4, 4> {
        let inputs = SVector::from(self.inputs.map(|sigma| sigma * sigma));
        plant.b * SMatrix::from_diagonal(&inputs) * plant.b.transpose()
    }

    /// Covariance of the measurements' noise.
    pub fn measurement<const P: usize>(&self, c: &SMatrix<f64, P, 4>) -> SMatrix<f64, P, P> {
        let outputs = SVector::from(self.outputs.map(|sigma| sigma * sigma));
        c * SMatrix::from_diagonal(&outputs) * c.transpose()
    }

    /// Standard deviation of an output that is a mixture of the states with this row of C.
    pub fn of_output(&self, row: &[f64; 4]) -> f64 {
        let parts = row.iter().zip(&self.outputs);
        parts.fold(0.0, |sum: f64, (part, sigma)| sum.hypot(part * sigma))
    }
}

const HALF_A_DEGREE: f64 = 0.5 * std::f64::consts::PI / 180.0;
