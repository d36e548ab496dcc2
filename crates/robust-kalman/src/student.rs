use kestirim_scalar::Scalar;

/// Largest number of degrees of freedom; beyond it, Student's t is the normal distribution to three digits.
const MOST_FREEDOM: usize = 1000;
/// Limit on Newton's steps: from the left of a concave function they never pass the root, and a dozen are usual.
const MOST_STEPS: usize = 60;

/// t with P(|T| > t) = `alpha`: the two-sided threshold of Student's distribution with
/// `freedom` ≥ 1 degrees of freedom. 0 if `alpha` ≥ 1, the largest number if `alpha` ≤ 0.
///
/// The finite series of Abramowitz and Stegun (26.7.3, 26.7.4) for θ = atan(t/√ν), solved by Newton's
/// method: to the precision of the number type, without a table.
pub fn student_quantile<T: Scalar>(alpha: T, freedom: usize) -> T {
    if alpha <= T::ZERO {
        return T::MAX;
    }
    if alpha >= T::ONE {
        return T::ZERO;
    }
    let freedom = freedom.clamp(1, MOST_FREEDOM);
    let wanted = T::ONE - alpha;
    let most = T::PI * T::HALF - T::EPSILON;
    let mut theta = T::ZERO;
    for _ in 0..MOST_STEPS {
        let (inside, density) = inside(theta, freedom);
        let step = (wanted - inside) / density;
        let next = (theta + step).min(most);
        if next > theta {
            theta = next;
        } else {
            break;
        }
    }
    let (sine, cosine) = theta.sin_cos();
    whole::<T>(freedom).sqrt() * sine / cosine
}

/// P(|t| ≤ √ν tan θ) and its derivative with respect to θ.
fn inside<T: Scalar>(theta: T, freedom: usize) -> (T, T) {
    let (sine, cosine) = theta.sin_cos();
    let odd = freedom % 2 == 1;
    let two_by_pi = T::TWO / T::PI;
    if freedom == 1 {
        return (two_by_pi * theta, two_by_pi);
    }
    let square = cosine * cosine;
    let (mut term, first) = if odd { (cosine, 3) } else { (T::ONE, 2) };
    let mut sum = term;
    // The last denominator is ν − 2.
    for below in (first..freedom - 1).step_by(2) {
        term *= square * whole::<T>(below - 1) / whole::<T>(below);
        sum += term;
    }
    let slope = term * whole::<T>(freedom - 1) * cosine;
    if odd { (two_by_pi * (theta + sine * sum), two_by_pi * slope) } else { (sine * sum, slope) }
}

/// A whole number as a scalar.
#[inline]
pub(crate) fn whole<T: Scalar>(value: usize) -> T {
    T::from_binary(i32::try_from(value).unwrap_or(i32::MAX), 0)
}
