use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// A unit quaternion that rotates vectors from **body** axes to **earth** axes.
///
/// Earth is right-handed with z up; its x axis points wherever heading zero was declared. The
/// quaternion follows Hamilton's convention, w first; q and −q are the same orientation.
///
/// Turns let rounding accumulate in the norm; [`Orientation::renormalised`] restores it to 1 and is due
/// every few hundred turns. Corrections in earth axes renormalise themselves.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Orientation<T> {
    w: T,
    x: T,
    y: T,
    z: T,
}

impl<T: Scalar> Orientation<T> {
    /// The orientation in which body and earth axes coincide.
    #[inline]
    pub fn identity() -> Self {
        Self { w: T::ONE, x: T::ZERO, y: T::ZERO, z: T::ZERO }
    }

    /// The orientation with quaternion `[w, x, y, z]`, normalised; `None` if its norm is zero or not finite.
    pub fn from_quaternion([w, x, y, z]: [T; 4]) -> Option<Self> {
        let norm = w.hypot(x).hypot(y.hypot(z));
        if !norm.is_finite() || norm <= T::ZERO {
            return None;
        }
        Some(Self { w: w / norm, x: x / norm, y: y / norm, z: z / norm })
    }

    /// The quaternion `[w, x, y, z]`.
    #[inline]
    pub fn quaternion(&self) -> [T; 4] {
        [self.w, self.x, self.y, self.z]
    }

    /// The orientation that brings a specific force measured at rest (body, any unit) upright, by the shortest turn.
    ///
    /// Its heading is arbitrary: it is whatever the shortest turn leaves. `None` if the
    /// force is zero or not finite, and so has no direction.
    pub fn from_specific_force(force: &SVector<T, 3>) -> Option<Self> {
        let [x, y, z] = *force.as_array();
        let norm = x.hypot(y).hypot(z);
        if !norm.is_finite() || norm <= T::ZERO {
            return None;
        }
        let (x, y, z) = (x / norm, y / norm, z / norm);
        // Upside down, the shortest turn is ill-defined, so half a turn about x is made first.
        if z < T::ZERO {
            let upright = Self::shortest_to_up(x, -y, -z)?;
            return Some(upright.then_body(&Self {
                w: T::ZERO,
                x: T::ONE,
                y: T::ZERO,
                z: T::ZERO,
            }));
        }
        Self::shortest_to_up(x, y, z)
    }

    /// This orientation with its tilt corrected by a specific force measured at rest (body, any unit), by the
    /// shortest turn, which preserves a correct heading.
    ///
    /// `None` if the force is zero or not finite, and so has no direction.
    pub fn levelled(&self, force: &SVector<T, 3>) -> Option<Self> {
        let upright = Self::from_specific_force(&self.to_earth(force))?;
        Some(upright.then_body(self).renormalised())
    }

    /// The shortest turn of the unit vector (x, y, z), z ≥ 0, to (0, 0, 1).
    fn shortest_to_up(x: T, y: T, z: T) -> Option<Self> {
        Self::from_quaternion([T::ONE + z, y, -x, T::ZERO])
    }

    /// The orientation after a turn given as a rotation vector in **body** axes (rad), such as a gyroscope's
    /// angular rate × time.
    #[inline]
    pub fn turned_in_body(&self, rotation: &SVector<T, 3>) -> Self {
        self.then_body(&Self::from_rotation_vector(rotation))
    }

    /// The orientation after a turn given as a rotation vector in **earth** axes (rad), as estimators
    /// correct tilt and heading.
    #[inline]
    pub fn turned_in_earth(&self, rotation: &SVector<T, 3>) -> Self {
        Self::from_rotation_vector(rotation).then_body(self).renormalised()
    }

    /// A vector in body axes, transformed to earth axes.
    #[inline]
    pub fn to_earth(&self, body: &SVector<T, 3>) -> SVector<T, 3> {
        self.rotate(body, self.w)
    }

    /// A vector in earth axes, transformed to body axes.
    #[inline]
    pub fn to_body(&self, earth: &SVector<T, 3>) -> SVector<T, 3> {
        self.rotate(earth, -self.w)
    }

    /// The earth's z axis, up, in body axes.
    #[inline]
    pub fn up_in_body(&self) -> SVector<T, 3> {
        let Self { w, x, y, z } = *self;
        SVector::from([
            T::TWO * (x * z - w * y),
            T::TWO * (y * z + w * x),
            T::ONE - T::TWO * (x * x + y * y),
        ])
    }

    /// Heading of the body's x axis, seen from above, anticlockwise from earth's x (rad, −π..=π).
    pub fn heading(&self) -> T {
        let sine = T::TWO * (self.w * self.z + self.x * self.y);
        let cosine = T::ONE - T::TWO * (self.y * self.y + self.z * self.z);
        sine.atan2(cosine)
    }

    /// v + 2·w·(q × v) + 2·q × (q × v), in 15 multiplications; −w rotates the other way.
    #[cfg_attr(for_size, inline(never))]
    #[cfg_attr(not(for_size), inline)]
    fn rotate(&self, v: &SVector<T, 3>, w: T) -> SVector<T, 3> {
        let q = [self.x, self.y, self.z];
        let v = *v.as_array();
        let t = cross(&q, &v).map(|component| component + component);
        let u = cross(&q, &t);
        SVector::from([v[0] + w * t[0] + u[0], v[1] + w * t[1] + u[1], v[2] + w * t[2] + u[2]])
    }

    /// exp(φ/2): by its power series up to half a radian, which a sample period rarely exceeds, and by
    /// sine and cosine beyond.
    #[inline(always)]
    fn from_rotation_vector(rotation: &SVector<T, 3>) -> Self {
        let [x, y, z] = *rotation.as_array();
        let square = T::dot(&[x, y, z], &[x, y, z]);
        let (w, scale) = if square < T::from_f64(0.25) {
            (
                T::ONE - square * (T::from_f64(1.0 / 8.0) - square * T::from_f64(1.0 / 384.0)),
                T::HALF - square * (T::from_f64(1.0 / 48.0) - square * T::from_f64(1.0 / 3840.0)),
            )
        } else {
            half_angle(x.hypot(y).hypot(z))
        };
        Self { w, x: x * scale, y: y * scale, z: z * scale }
    }

    /// The Hamilton product self ⊗ other: first `other` within the body, then self.
    #[inline]
    fn then_body(&self, other: &Self) -> Self {
        let (a, b) = (self, other);
        Self {
            w: T::dot(&[a.w, -a.x, -a.y, -a.z], &[b.w, b.x, b.y, b.z]),
            x: T::dot(&[a.w, a.x, a.y, -a.z], &[b.x, b.w, b.z, b.y]),
            y: T::dot(&[a.w, -a.x, a.y, a.z], &[b.y, b.z, b.w, b.x]),
            z: T::dot(&[a.w, a.x, -a.y, a.z], &[b.z, b.y, b.x, b.w]),
        }
    }

    /// The same orientation with the norm restored to 1 by one Newton step of 1/√(norm²). The error left is quadratic
    /// in the deviation, which is due to rounding only.
    #[inline]
    pub fn renormalised(&self) -> Self {
        let q = [self.w, self.x, self.y, self.z];
        let scale = T::from_f64(1.5) - T::HALF * T::dot(&q, &q);
        let [w, x, y, z] = q.map(|component| component * scale);
        Self { w, x, y, z }
    }
}

/// (cos a/2, sin(a/2)/a), kept out of line because it is rarely needed and long.
#[cold]
#[inline(never)]
fn half_angle<T: Scalar>(angle: T) -> (T, T) {
    let (sine, cosine) = (angle * T::HALF).sin_cos();
    (cosine, sine / angle)
}

#[inline]
fn cross<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
