//! Numbers that carry their exact derivatives: forward-mode differentiation.

use core::array::from_fn;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// Number of variables: α, q, V, θ, δe, δt.
pub(crate) const VARIABLES: usize = 6;

/// A value and its partial derivatives with respect to states and inputs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dual {
    pub(crate) value: f64,
    pub(crate) gradient: [f64; VARIABLES],
}

impl Dual {
    /// The independent variable with this index.
    pub(crate) fn variable(value: f64, index: usize) -> Self {
        Self { value, gradient: from_fn(|place| if place == index { 1.0 } else { 0.0 }) }
    }

    /// The function value f(x) with its gradient, from the derivative of f at x.
    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, gradient: self.gradient.map(|partial| derivative * partial) }
    }

    pub(crate) fn sin(self) -> Self {
        self.chain(libm::sin(self.value), libm::cos(self.value))
    }

    pub(crate) fn cos(self) -> Self {
        self.chain(libm::cos(self.value), -libm::sin(self.value))
    }

    /// The logistic function 1/(1 + e⁻ˣ), exact in both tails, as are its derivatives.
    pub(crate) fn logistic(self) -> Self {
        let small = libm::exp(-libm::fabs(self.value));
        let tail = small / (1.0 + small);
        let value = if self.value < 0.0 { tail } else { 1.0 - tail };
        self.chain(value, tail * (1.0 - tail))
    }

    pub(crate) fn square(self) -> Self {
        self * self
    }
}

impl Add for Dual {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            value: self.value + other.value,
            gradient: from_fn(|i| self.gradient[i] + other.gradient[i]),
        }
    }
}

impl Sub for Dual {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Dual {
    type Output = Self;
    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the product rule")]
impl Mul for Dual {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            value: self.value * other.value,
            gradient: from_fn(|i| self.gradient[i] * other.value + self.value * other.gradient[i]),
        }
    }
}

#[expect(clippy::suspicious_arithmetic_impl, reason = "the quotient rule")]
impl Div for Dual {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        let partial = |i| (self.gradient[i] - value * other.gradient[i]) / other.value;
        Self { value, gradient: from_fn(partial) }
    }
}

impl Add<f64> for Dual {
    type Output = Self;
    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Mul<f64> for Dual {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        self.chain(self.value * factor, factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every operation, against central differences.
    #[test]
    fn derivatives_are_those_of_the_function() {
        let function = |x: Dual, y: Dual| {
            let wave = (x * y).sin() / (y.square() + 2.0) - x.cos() * 0.3;
            wave + (x * 3.0 + y).logistic() * -y
        };
        let at = |x: f64, y: f64| function(Dual::variable(x, 0), Dual::variable(y, 4) + 0.0).value;
        for (x, y) in [(0.3, -1.2), (-2.0, 0.7), (0.0, 0.0)] {
            let exact = function(Dual::variable(x, 0), Dual::variable(y, 4)).gradient;
            let step = 1e-5;
            let slopes = [
                (at(x + step, y) - at(x - step, y)) / (2.0 * step),
                (at(x, y + step) - at(x, y - step)) / (2.0 * step),
            ];
            assert!((exact[0] - slopes[0]).abs() < 1e-9 && (exact[4] - slopes[1]).abs() < 1e-9);
            assert_eq!([exact[1], exact[2], exact[3], exact[5]], [0.0; 4]);
        }
    }

    #[test]
    fn a_logistic_keeps_its_tails() {
        let tail = Dual::variable(-700.0, 0).logistic();
        assert!(tail.value > 0.0 && tail.value == tail.gradient[0]);
        for x in [f64::NEG_INFINITY, -1e300, 1e300, f64::INFINITY] {
            let end = Dual::variable(x, 0).logistic();
            assert_eq!((end.value, end.gradient[0]), (f64::from(u8::from(x > 0.0)), 0.0));
        }
    }
}
