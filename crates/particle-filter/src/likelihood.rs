/// Likelihood of a measurement, for [`Particles::weigh`](crate::Particles::weigh) and
/// [`PointMass::weigh`](crate::PointMass::weigh).
///
/// A trait instead of a closure, because inlining of a closure cannot be forced, and what is not inlined into the
/// loop over the particles is not vectorised. Mark `logarithm` and the functions that it calls `#[inline(always)]`.
pub trait Likelihood<T, const D: usize> {
    /// Logarithm of the likelihood of a state; NaN counts as a likelihood of zero.
    fn logarithm(&self, state: [T; D]) -> T;
}

/// A closure as a likelihood, inlined at the compiler's discretion.
pub(crate) struct Closure<F>(pub(crate) F);

impl<T, F: Fn([T; D]) -> T, const D: usize> Likelihood<T, D> for Closure<F> {
    #[inline(always)]
    fn logarithm(&self, state: [T; D]) -> T {
        (self.0)(state)
    }
}
