use nalgebra::SMatrix;

/// A discrete-time plant: x⁺ = A x + B u, y = C x, with N states, M inputs and P outputs.
///
/// For a plant with direct feedthrough, y = C x + D u, pass y − D u to the observer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant<const N: usize, const M: usize, const P: usize> {
    /// A, N × N, the transition of one step.
    pub a: SMatrix<f64, N, N>,
    /// B, N × M, the input matrix of one step.
    pub b: SMatrix<f64, N, M>,
    /// C, P × N, the output matrix.
    pub c: SMatrix<f64, P, N>,
}
