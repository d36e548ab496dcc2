use nalgebra::SMatrix;

/// A discrete-time plant: x⁺ = A x + B u, y = C x, with N states, M inputs and P outputs.
///
/// Where the plant has a direct feedthrough, y = C x + D u, hand the observer y − D u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant<const N: usize, const M: usize, const P: usize> {
    /// A, N × N, of one step.
    pub a: SMatrix<f64, N, N>,
    /// B, N × M.
    pub b: SMatrix<f64, N, M>,
    /// C, P × N.
    pub c: SMatrix<f64, P, N>,
}
