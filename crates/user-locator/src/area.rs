use heapless::Vec;
use kestirim_air_to_ground::{Likelihood, Measurement};
use kestirim_particle_filter::Region;
use kestirim_scalar::Scalar;

use crate::Error;

/// A polygon of up to N corners (m, in the plane of the measurements): the area in which a user can be.
///
/// It represents a prior that is uniform inside and zero outside: [`Area::region`] is the bounding box for a lattice
/// or a cloud, and [`Area::contains`] tells which of its points count. 8·N bytes in single precision. Edges must be
/// shorter than the largest number of the format (32 km in Q16.16).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Area<T, const N: usize> {
    corners: Vec<[T; 2], N>,
    region: Region<T, 2>,
}

impl<T: Scalar, const N: usize> Area<T, N> {
    /// Creates the polygon with these corners, in either sense of rotation.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::TooManyCorners`] for more than N corners; [`Error::NoArea`] if they enclose
    /// nothing.
    pub fn new(corners: &[[T; 2]]) -> Result<Self, Error> {
        if !corners.iter().all(|corner| T::all_finite(corner)) {
            return Err(Error::NotFinite);
        }
        let (mut low, mut high) = ([T::MAX; 2], [T::MIN; 2]);
        for corner in corners {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        let region = Region::new(low, high).map_err(|_| Error::NoArea)?;
        let corners = Vec::from_slice(corners).map_err(|_| Error::TooManyCorners)?;
        let area = Self { corners, region };
        if area.share() > T::EPSILON { Ok(area) } else { Err(Error::NoArea) }
    }

    /// A rectangle that covers a whole region; N must be at least four.
    ///
    /// # Errors
    /// [`Error::NoArea`] if a side is zero.
    pub fn rectangle(region: &Region<T, 2>) -> Result<Self, Error> {
        const { assert!(N >= 4, "a rectangle has four corners") };
        let ([left, bottom], [right, top]) = (*region.low(), *region.high());
        Self::new(&[[left, bottom], [right, bottom], [right, top], [left, top]])
    }

    /// The corners in order, m.
    #[inline]
    pub fn corners(&self) -> &[[T; 2]] {
        &self.corners
    }

    /// The bounding box.
    #[inline]
    pub fn region(&self) -> &Region<T, 2> {
        &self.region
    }

    /// The same area in coordinates relative to `origin`.
    ///
    /// # Errors
    /// Those of [`Area::new`], if the number format can no longer distinguish the corners.
    pub fn relative_to(&self, origin: [T; 2]) -> Result<Self, Error> {
        let mut corners = self.corners.clone();
        for [x, y] in &mut corners {
            *x -= origin[0];
            *y -= origin[1];
        }
        Self::new(&corners)
    }

    /// The area, m²; saturates in fixed point.
    pub fn size(&self) -> T {
        let [width, height] = self.region.width();
        self.share() * width * height
    }

    /// The fraction of its bounding box that it covers, by the shoelace formula in units of the box's sides, in which
    /// no product overflows.
    fn share(&self) -> T {
        let ([left, bottom], [width, height]) = (*self.region.low(), self.region.width());
        let [across, up] = [width, height].map(|side| side.max(T::EPSILON).divisor());
        let unit = |[x, y]: [T; 2]| [(x - left).divided_by(across), (y - bottom).divided_by(up)];
        let mut sum = T::ZERO;
        for (from, to) in self.edges() {
            let ([ax, ay], [bx, by]) = (unit(from), unit(to));
            sum += ax * by - ay * bx;
        }
        sum.abs() * T::HALF
    }

    /// The edges: from each corner to the next, and from the last to the first.
    fn edges(&self) -> impl Iterator<Item = ([T; 2], [T; 2])> {
        let next = self.corners.iter().skip(1).chain(self.corners.first());
        self.corners.iter().copied().zip(next.copied())
    }

    /// Whether a point (m) is inside: a ray from it to the east crosses the border an odd number of times.
    #[inline]
    pub fn contains(&self, [x, y]: [T; 2]) -> bool {
        let mut inside = false;
        for ([ax, ay], [bx, by]) in self.edges() {
            if (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax) {
                inside = !inside;
            }
        }
        inside
    }
}

/// A channel restricted to users within an area: the likelihood of any point outside is zero.
///
/// ```
/// use kestirim_air_to_ground::{Channel, Environment};
/// use kestirim_user_locator::{Area, Locator, Within};
///
/// // The western half of a square and a corner of the eastern one.
/// let area = Area::<f32, 8>::new(&[[0.0, 0.0], [2000.0, 0.0], [1000.0, 1000.0], [1000.0, 2000.0], [0.0, 2000.0]])?;
/// let channel = Within::new(Channel::new(&Environment::urban(), 0.15)?, &area);
/// let locator = Locator::<f32, 500, 40, 2, _>::new(channel, area.region());
/// # Ok::<(), kestirim_user_locator::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within<'a, T, C, const N: usize> {
    channel: C,
    area: &'a Area<T, N>,
}

impl<'a, T, C, const N: usize> Within<'a, T, C, N> {
    /// Restricts a channel to users inside `area`.
    #[inline]
    pub fn new(channel: C, area: &'a Area<T, N>) -> Self {
        Self { channel, area }
    }
}

impl<T: Scalar, C: Likelihood<T>, const N: usize> Likelihood<T> for Within<'_, T, C, N> {
    const IS_LESS_AGAIN: bool = true;

    #[inline]
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        if self.area.contains(user) {
            self.channel.log_likelihood(measurement, user)
        } else {
            T::ZERO.ln()
        }
    }

    #[inline(always)]
    fn log_likelihood_again(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        self.channel.log_likelihood_again(measurement, user)
    }
}
