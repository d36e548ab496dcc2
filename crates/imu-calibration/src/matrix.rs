//! Matrices of three columns as arrays, whose indexing leaves no bounds checks.

use kestirim_scalar::Scalar;

/// The columns of a 3 × 3 matrix.
pub(crate) type Square<T> = [[T; 3]; 3];

pub(crate) fn identity<T: Scalar>() -> Square<T> {
    [[T::ONE, T::ZERO, T::ZERO], [T::ZERO, T::ONE, T::ZERO], [T::ZERO, T::ZERO, T::ONE]]
}

/// The product of a matrix and a vector.
#[inline]
pub(crate) fn times<T: Scalar>([a, b, c]: &Square<T>, v: &[T; 3]) -> [T; 3] {
    [T::dot(&[a[0], b[0], c[0]], v), T::dot(&[a[1], b[1], c[1]], v), T::dot(&[a[2], b[2], c[2]], v)]
}

/// The product of two matrices.
#[inline]
pub(crate) fn product<T: Scalar>(a: &Square<T>, b: &Square<T>) -> Square<T> {
    b.map(|column| times(a, &column))
}

#[inline]
pub(crate) fn cross<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The unit vector of a vector; `None` if it has no direction.
pub(crate) fn unit<T: Scalar>(v: &[T; 3]) -> Option<[T; 3]> {
    let norm = v[0].hypot(v[1]).hypot(v[2]);
    let is_usable = norm.is_finite() && norm > T::ZERO;
    is_usable.then(|| v.map(|x| x / norm))
}

/// The determinant.
pub(crate) fn determinant<T: Scalar>([a, b, c]: &Square<T>) -> T {
    T::dot(a, &cross(b, c))
}

/// The inverse of a symmetric matrix; not finite if it is singular.
pub(crate) fn inverse_of_symmetric<T: Scalar>(m: &Square<T>) -> Square<T> {
    let [a, b, c] = m;
    // The rows of the inverse are the cross products of the columns; for a symmetric matrix they are its columns, too.
    let by = determinant(m).recip();
    [cross(b, c), cross(c, a), cross(a, b)].map(|column| column.map(|x| x * by))
}

/// The rotation by a rotation vector (rad): Rodrigues' formula.
pub(crate) fn rotation<T: Scalar>([x, y, z]: [T; 3]) -> Square<T> {
    let square = T::dot(&[x, y, z], &[x, y, z]);
    // sin a/a and (1 − cos a)/a² by their series below a tenth of a radian, where these are exact to the last bit of an
    // `f32` and to 10⁻¹³ of an `f64`.
    let (s, c) = if square < T::from_f64(0.01) {
        let term = |by: T| square * by;
        let s = T::ONE
            - term(T::from_f64(1.0 / 6.0))
                * (T::ONE
                    - term(T::from_f64(1.0 / 20.0)) * (T::ONE - term(T::from_f64(1.0 / 42.0))));
        let c = T::ONE
            - term(T::from_f64(1.0 / 12.0))
                * (T::ONE
                    - term(T::from_f64(1.0 / 30.0)) * (T::ONE - term(T::from_f64(1.0 / 56.0))));
        (s, c * T::HALF)
    } else {
        let angle = x.hypot(y).hypot(z);
        let (sine, cosine) = angle.sin_cos();
        (sine / angle, (T::ONE - cosine) / (angle * angle))
    };
    [
        [T::ONE - c * (y * y + z * z), s * z + c * x * y, c * x * z - s * y],
        [c * x * y - s * z, T::ONE - c * (x * x + z * z), s * x + c * y * z],
        [s * y + c * x * z, c * y * z - s * x, T::ONE - c * (x * x + y * y)],
    ]
}
