//! Example plants to estimate, and their output matrices. States α, q, V, θ; inputs δe, δt.

use nalgebra::SMatrix;

use crate::{Airframe, Error, StateSpace, SteadyFlight};

/// P1: the Aerosonde of 13.5 kg, climbing at 40 m/s and 4°, from its published coefficients.
///
/// # Errors
/// Those of [`Airframe::trim`]; as the tests show, none occurs.
pub fn aerosonde() -> Result<StateSpace, Error> {
    let airframe = Airframe::aerosonde();
    let flight = SteadyFlight { airspeed: 40.0, climb_angle: 4.0_f64.to_radians() };
    airframe.linearise(&airframe.trim(&flight)?)
}

/// P2: not a real aircraft, but fitted to the properties that the thesis reports of its own, whose numbers it does
/// not print.
pub fn thesis_like() -> StateSpace {
    model(
        [
            [-1.79, 1.0, -0.0076, -0.017_107_775_185_746_733],
            [-25.0, -20.0, -0.02, 0.0],
            [2.0, 0.0, -0.0267, -9.786_103_333_048_876],
            [0.0, 1.0, 0.0, 0.0],
        ],
        [[0.3, -0.158], [-100.0, -3.0], [0.3, 45.0], [0.0, 0.0]],
    )
}

/// P3: the Navion of Nelson, *Flight Stability and Automatic Control*, in SI units; the throttle column is assumed.
pub fn navion() -> StateSpace {
    model(
        [
            [-2.02, 1.0, -0.006_878_579_098_067_286, 0.0],
            [-6.969_600_000_000_001, -2.948, 0.006_233_595_800_524_933, 0.0],
            [1.931_212_8, 0.0, -0.045, -9.814_560_000_000_002],
            [0.0, 1.0, 0.0, 0.0],
        ],
        [[-0.159_943_181_818_181_82, 0.0], [-11.1874, 0.0], [0.0, 3.0], [0.0, 0.0]],
    )
}

/// Creates a model from rows, as they are published.
fn model(a: [[f64; 4]; 4], b: [[f64; 2]; 4]) -> StateSpace {
    StateSpace {
        a: SMatrix::<f64, 4, 4>::from(a).transpose(),
        b: SMatrix::<f64, 2, 4>::from(b).transpose(),
    }
}

/// Output matrix C for measurements of all states, as in the thesis.
pub fn full_state() -> SMatrix<f64, 4, 4> {
    SMatrix::identity()
}

/// Output matrix C for gyroscope, pitot tube and attitude reference: q, V, θ.
pub fn rate_airspeed_and_pitch() -> SMatrix<f64, 3, 4> {
    full_state().fixed_rows::<3>(1).into_owned()
}

/// Output matrix C for pitot tube and attitude reference alone: V, θ.
pub fn airspeed_and_pitch() -> SMatrix<f64, 2, 4> {
    full_state().fixed_rows::<2>(2).into_owned()
}
