use heapless::Vec;
use kestirim_air_to_ground::{Likelihood, Measurement};
use kestirim_particle_filter::Region;
use kestirim_scalar::Scalar;

use crate::Error;

/// A polygon of up to N corners (m, in the plane of the measurements): where a user can be.
///
/// The prior it stands for is uniform inside and zero outside: [`Area::region`] is the box that a lattice or a cloud
/// fills, [`Area::contains`] says which of its points count. 8·N bytes in single precision. Edges must be shorter
/// than the largest number of the format (32 km in Q16.16).
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
    /// The polygon of these corners, in either sense of rotation.
    ///
    /// # Errors
    /// [`Error::NotFinite`]; [`Error::TooManyCorners`] beyond N; [`Error::NoArea`] if the corners enclose nothing.
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

    /// All of a region: a rectangle, for which N must be at least four.
    ///
    /// # Errors
    /// [`Error::NoArea`] if a side is zero.
    pub fn rectangle(region: &Region<T, 2>) -> Result<Self, Error> {
        const { assert!(N >= 4, "a rectangle has four corners") };
        let ([left, bottom], [right, top]) = (*region.low(), *region.high());
        Self::new(&[[left, bottom], [right, bottom], [right, top], [left, top]])
    }

    /// The corners in their order, m.
    #[inline]
    pub fn corners(&self) -> &[[T; 2]] {
        &self.corners
    }

    /// The smallest box around it.
    #[inline]
    pub fn region(&self) -> &Region<T, 2> {
        &self.region
    }

    /// The same area with coordinates that are counted from `origin`.
    ///
    /// # Errors
    /// Those of [`Area::new`], where the numbers cannot tell the corners apart any more.
    pub fn relative_to(&self, origin: [T; 2]) -> Result<Self, Error> {
        let mut corners = self.corners.clone();
        for [x, y] in &mut corners {
            *x -= origin[0];
            *y -= origin[1];
        }
        Self::new(&corners)
    }

    /// m²; on the upper rail of fixed point where that does not hold it.
    pub fn size(&self) -> T {
        let [width, height] = self.region.width();
        self.share() * width * height
    }

    /// The part of its box that it covers, by the shoelace formula in units of the box's sides, of which all products
    /// are numbers.
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

    /// From each corner to the next, the last one to the first.
    fn edges(&self) -> impl Iterator<Item = ([T; 2], [T; 2])> {
        let next = self.corners.iter().skip(1).chain(self.corners.first());
        self.corners.iter().copied().zip(next.copied())
    }

    /// Whether a place (m) is inside: a line from it to the east crosses the border an odd number of times.
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

/// A channel to users within an area only: the likelihood of any place outside is zero.
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
    /// A channel and where its users can be.
    #[inline]
    pub fn new(channel: C, area: &'a Area<T, N>) -> Self {
        Self { channel, area }
    }
}

impl<T: Scalar, C: Likelihood<T>, const N: usize> Likelihood<T> for Within<'_, T, C, N> {
    #[inline]
    fn log_likelihood(&self, measurement: &Measurement<T>, user: [T; 2]) -> T {
        if self.area.contains(user) {
            self.channel.log_likelihood(measurement, user)
        } else {
            T::ZERO.ln()
        }
    }
}
