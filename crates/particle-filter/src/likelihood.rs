/// Likelihood of a measurement, for [`Particles::weigh`](crate::Particles::weigh) and
/// [`PointMass::weigh`](crate::PointMass::weigh).
///
/// A type instead of a closure: of a closure nobody can demand that it be inlined, and what is not inlined into the
/// loop over the particles does not become vector instructions. Mark `logarithm` `#[inline(always)]`, and what it calls.
pub trait Likelihood<T, const D: usize> {
    /// Logarithm of the likelihood of a state; one that is not a number counts as that of zero.
    fn logarithm(&self, state: [T; D]) -> T;
}

/// A closure, inlined where the compiler sees fit.
pub(crate) struct Closure<F>(pub(crate) F);

impl<T, F: Fn([T; D]) -> T, const D: usize> Likelihood<T, D> for Closure<F> {
    #[inline(always)]
    fn logarithm(&self, state: [T; D]) -> T {
        (self.0)(state)
    }
}
