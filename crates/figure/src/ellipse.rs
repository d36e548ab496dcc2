//! The ellipse of a covariance.

/// The 95 % quantile of the χ² distribution with two degrees of freedom.
const CHI_SQUARE_2: f64 = 5.991;

/// The ellipse that holds 95 % of a normal distribution, from its covariance: the variance along x, the covariance and
/// the variance along y. Of the result `[a, b, c]`, the point (u, v) of the unit circle gives the point (a u, b u + c
/// v) of the ellipse, relative to its centre.
///
/// It is the Cholesky factor of the covariance times √χ²: it has the axes' units, and a value interpolated between two
/// factors is a factor again.
pub fn ellipse([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let a = xx.max(0.0).sqrt();
    let b = if a > 0.0 { xy / a } else { 0.0 };
    // Rounding may make the difference negative.
    let c = (yy - b * b).max(0.0).sqrt();
    // `max` turns `NaN` into a number, so finiteness is checked on the input.
    let is_known = (xx + xy + yy).is_finite();
    [a, b, c].map(|part| if is_known { CHI_SQUARE_2.sqrt() * part } else { f64::NAN })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_times_itself_is_the_covariance() {
        let [a, b, c] = ellipse([2.5, 1.5, 2.5]).map(|part| part / CHI_SQUARE_2.sqrt());
        for (found, expected) in [(a * a, 2.5), (a * b, 1.5), (b * b + c * c, 2.5)] {
            assert!((found - expected).abs() < 1e-12, "{found} / {expected}");
        }
    }

    #[test]
    fn what_is_certain_is_a_point_and_what_is_unknown_nothing() {
        assert_eq!(ellipse([0.0; 3]), [0.0; 3]);
        assert_eq!(ellipse([1.0, 1.0 + 1e-9, 1.0])[2], 0.0, "a line");
        assert!(ellipse([1.0, f64::NAN, 1.0]).iter().all(|part| part.is_nan()));
    }
}
