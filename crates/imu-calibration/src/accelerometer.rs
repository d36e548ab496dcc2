use crate::matrix::{identity, times};
use crate::normal::{Inverse, Normal, amplification, noise};
use crate::{Error, Poses, Triad};
use kestirim_scalar::{Components, Scalar};
use nalgebra::{SMatrix, SVector};

/// The parameters of an accelerometer that were determined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum AccelerometerModel {
    /// Three offsets and three scales: from six poses, each axis up and down once. The axes are assumed orthogonal.
    OffsetAndScale,
    /// Offsets, scales and three misalignments: from nine or more poses, of which some stand on edges.
    Full,
}

impl AccelerometerModel {
    /// The number of parameters, which is also the number of poses required.
    pub const fn unknowns(self) -> u16 {
        match self {
            Self::OffsetAndScale => 6,
            Self::Full => 9,
        }
    }
}

/// The errors of an accelerometer, determined from poses.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct AccelerometerFit<T: Scalar> {
    /// The offset (m/s²) and the matrix, upper triangular.
    pub triad: Triad<T>,
    /// The parameters that were determined; the others are as in a perfect sensor.
    pub model: AccelerometerModel,
    /// The standard deviations of the offset (m/s²).
    pub offset_sigma: [T; 3],
    /// The standard deviations of the matrix, row by row; `None` for entries that were not determined.
    pub matrix_sigma: [[Option<T>; 3]; 3],
    /// The root mean square deviation of the corrected poses from gravity (m/s²).
    pub residual: T,
}

/// The number of unknowns: offsets, scales, misalignments xy, xz and yz.
const UNKNOWNS: usize = 9;
const OFFSET_AND_SCALE: [bool; UNKNOWNS] =
    [true, true, true, true, true, true, false, false, false];
/// The largest uncertainty of a parameter, as a multiple of a pose's noise, in units of gravity: beyond it the poses
/// are too similar.
const MOST_AMPLIFICATION: f64 = 10.0;
/// The limits of the scale factors: beyond them a sensor is broken, or no accelerometer.
const SCALES: [f64; 2] = [0.5, 2.0];
/// The largest offset (g) and misalignment (rad) of a working sensor.
const FARTHEST: f64 = 0.5;
/// The largest residual (g) of a working sensor.
const MOST_LEFT: f64 = 0.05;
/// The standard deviation of a misalignment that is not determined (rad): data sheets allow ± 2 % across the axes.
const MISALIGNMENT: f64 = 0.01;
const STEPS: u16 = 30;

impl<T: Scalar, const N: usize> Poses<T, N> {
    /// Determines the errors of the accelerometer such that every corrected pose shows `gravity` (m/s²), whatever its
    /// direction.
    ///
    /// The method is that of Tedaldi, Pretto & Menegatti (2014), with the norm itself instead of its square, so that
    /// all residuals have the noise of a pose.
    ///
    /// `noise` is the standard deviation of a pose's mean (m/s²), including everything that a calibration cannot
    /// explain: 0.01 suits consumer sensors, whose offset changes by a mg when they are turned. Standard deviations
    /// follow from it, or from the residuals if they are larger, and contain what a usual misalignment does where it is not
    /// estimated. From nine poses on, misalignments are estimated, too;
    /// if the poses do not determine them, or are fewer, only offset and scale. The fit is by Levenberg–Marquardt.
    ///
    /// # Errors
    /// [`Error::TooFew`] below six poses, [`Error::NotObservable`] if they are too similar, [`Error::Inconsistent`] if
    /// no working accelerometer explains them, [`Error::NotPositive`] for gravity or noise.
    pub fn accelerometer(&self, gravity: T, noise: T) -> Result<AccelerometerFit<T>, Error> {
        let is_positive = |x: T| x.is_finite() && x > T::ZERO;
        if !(is_positive(gravity) && is_positive(noise)) {
            return Err(Error::NotPositive);
        }
        // At most 65 535 poses are counted: they would be a megabyte.
        let found = self.poses.len().min(usize::from(u16::MAX)) as u16;
        let needed = AccelerometerModel::OffsetAndScale.unknowns();
        if found < needed {
            return Err(Error::TooFew { found, needed });
        }
        if found >= AccelerometerModel::Full.unknowns()
            && let Ok(fit) = self.fit(AccelerometerModel::Full, gravity, noise)
        {
            return Ok(fit);
        }
        self.fit(AccelerometerModel::OffsetAndScale, gravity, noise)
    }

    fn fit(
        &self,
        model: AccelerometerModel,
        gravity: T,
        given: T,
    ) -> Result<AccelerometerFit<T>, Error> {
        let active = match model {
            AccelerometerModel::OffsetAndScale => OFFSET_AND_SCALE,
            AccelerometerModel::Full => [true; UNKNOWNS],
        };
        // Parameters that the poses do not determine diverge, so observability is checked first.
        let (start, _) = self.equations(&Parameters::perfect(), gravity);
        observed(&start, &active)?;
        let parameters = self.descend(&active, gravity)?;
        parameters.check()?;
        let (normal, count) = self.equations(&parameters, gravity);
        let (inverse, gains) = observed(&normal, &active)?;
        let left = normal.squares;
        let residual = (left / count).sqrt();
        // The squares are finite, as `observed` has checked.
        if residual > T::from_f64(MOST_LEFT) {
            return Err(Error::Inconsistent);
        }
        let unknowns = T::from_binary(i32::from(model.unknowns()), 0);
        let sigma = noise(given / gravity, left, count, unknowns);
        let mut sigmas = gains.map(|gain| gain * sigma);
        for (index, &is_estimated) in active.iter().enumerate() {
            let moved = normal.shift(&inverse, index);
            for (sigma, moved) in sigmas.iter_mut().zip(moved).filter(|_| !is_estimated) {
                *sigma = sigma.hypot(moved * T::from_f64(MISALIGNMENT));
            }
        }
        let [ox, oy, oz, x, y, z, xy, xz, yz] = sigmas;
        let beside = |sigma: T| (model == AccelerometerModel::Full).then_some(sigma);
        let fit = AccelerometerFit {
            triad: parameters.triad(gravity),
            model,
            offset_sigma: [ox * gravity, oy * gravity, oz * gravity],
            matrix_sigma: [
                [Some(x), beside(xy), beside(xz)],
                [None, Some(y), beside(yz)],
                [None, None, Some(z)],
            ],
            residual: residual * gravity,
        };
        fit.triad.check()?;
        let finite = T::all_finite(&fit.offset_sigma) && fit.residual.is_finite();
        if finite { Ok(fit) } else { Err(Error::NotFinite) }
    }

    /// Finds the least-squares parameters.
    fn descend(&self, active: &[bool; UNKNOWNS], gravity: T) -> Result<Parameters<T>, Error> {
        let mut at = Parameters::perfect();
        let (mut normal, _) = self.equations(&at, gravity);
        let mut damping = T::from_f64(1e-3);
        let tenth = T::from_f64(0.1);
        for _ in 0..STEPS {
            let Some(inverse) = normal.inverse(active, damping) else {
                return Err(if normal.is_finite() {
                    Error::NotObservable
                } else {
                    Error::NotFinite
                });
            };
            let step = normal.solution(&inverse);
            let next = at.moved(&step);
            let (equations, _) = self.equations(&next, gravity);
            let is_better = equations.squares < normal.squares && equations.is_finite();
            let is_small = T::norm(&step) < T::from_f64(16.0) * T::EPSILON;
            if is_better {
                (at, normal) = (next, equations);
                damping *= tenth;
            } else {
                damping = (damping / tenth).min(T::from_f64(1e3));
            }
            if is_small {
                break;
            }
        }
        Ok(at)
    }

    /// The equations of a step from these parameters, and their number; the squares are those of the residuals at these
    /// parameters.
    fn equations(&self, at: &Parameters<T>, gravity: T) -> (Normal<T, UNKNOWNS>, T) {
        let (mut normal, mut count) = (Normal::new(), T::ZERO);
        let by = gravity.divisor();
        for pose in &self.poses {
            let measured = pose.specific_force.as_array().map(|force| force.divided_by(by));
            let ([x, y, z], [ox, oy, oz]) = (measured, at.offset);
            let [x, y, z] = [x - ox, y - oy, z - oz];
            let corrected = times(&at.columns(), &[x, y, z]);
            let norm = T::norm(&corrected);
            let [ux, uy, uz] = corrected.map(|force| force / norm);
            let [c0, c1, c2] = at.columns().map(|column| -T::dot(&column, &[ux, uy, uz]));
            normal
                .add(&[c0, c1, c2, ux * x, uy * y, uz * z, ux * y, ux * z, uy * z], T::ONE - norm);
            count += T::ONE;
        }
        (normal, count)
    }
}

/// The inverse of the equations, and the amplification of a pose's noise in each parameter; an error if it is too large in one
/// of them.
fn observed<T: Scalar>(
    normal: &Normal<T, UNKNOWNS>,
    active: &[bool; UNKNOWNS],
) -> Result<(Inverse<T, UNKNOWNS>, [T; UNKNOWNS]), Error> {
    if !normal.is_finite() {
        return Err(Error::NotFinite);
    }
    let inverse = normal.inverse(active, T::ZERO).ok_or(Error::NotObservable)?;
    let gains = amplification(&inverse);
    let is_told = gains.iter().all(|&gain| gain <= T::from_f64(MOST_AMPLIFICATION));
    if is_told { Ok((inverse, gains)) } else { Err(Error::NotObservable) }
}

/// The parameters, with the offset in units of gravity.
#[derive(Clone, Copy)]
struct Parameters<T> {
    offset: [T; 3],
    scale: [T; 3],
    /// The misalignments xy, xz, yz.
    beside: [T; 3],
}

impl<T: Scalar> Parameters<T> {
    fn perfect() -> Self {
        Self { offset: [T::ZERO; 3], scale: [T::ONE; 3], beside: [T::ZERO; 3] }
    }

    fn moved(&self, [ox, oy, oz, x, y, z, xy, xz, yz]: &[T; UNKNOWNS]) -> Self {
        let sum = |a: [T; 3], b: [T; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        Self {
            offset: sum(self.offset, [*ox, *oy, *oz]),
            scale: sum(self.scale, [*x, *y, *z]),
            beside: sum(self.beside, [*xy, *xz, *yz]),
        }
    }

    /// The columns of the matrix.
    fn columns(&self) -> [[T; 3]; 3] {
        let [mut first, mut second, mut third] = identity();
        let ([x, y, z], [xy, xz, yz]) = (self.scale, self.beside);
        first[0] = x;
        [second[0], second[1]] = [xy, y];
        [third[0], third[1], third[2]] = [xz, yz, z];
        [first, second, third]
    }

    fn check(&self) -> Result<(), Error> {
        let (least, most) = (T::from_f64(SCALES[0]), T::from_f64(SCALES[1]));
        let farthest = T::from_f64(FARTHEST);
        let is_near = |x: &T| x.abs() <= farthest;
        let usual = self.scale.iter().all(|scale| *scale >= least && *scale <= most)
            && self.offset.iter().chain(&self.beside).all(is_near);
        if usual { Ok(()) } else { Err(Error::Inconsistent) }
    }

    fn triad(&self, gravity: T) -> Triad<T> {
        Triad {
            offset: SVector::from(self.offset.map(|offset| offset * gravity)),
            matrix: SMatrix::from(self.columns()),
        }
    }
}
