use crate::symmetric::NormalEquations;
use crate::{Error, Observation, Solver, expected_range};
use heapless::Vec;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// Estimates the range biases of A anchors from measurements at known and unknown points.
///
/// At every point the tag stands still for a while, and the median range of each anchor is taken. At an unknown
/// point the position is eliminated from the equations, and what remains constrains the biases; nothing is stored
/// per point. With four anchors in the plane little remains (no better than a common bias): mark at least one
/// point, better three. From six anchors on, ten unknown points do nearly as well as known ones (8 anchors, 90
/// recorded points: 6.5 cm against 5.6 cm; a common bias: 9.2 cm).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct Calibration<T: Scalar, const A: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    anchors: [SVector<T, 3>; A],
    /// Normal equations of the biases, multiplied by the variance of a range.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::rows"))]
    normal: [[T; A]; A],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    right: [T; A],
}

/// Standard deviation with which the error of a link varies from place to place, m.
pub(crate) const LINK_SIGMA: f64 = 0.07;
/// Standard deviation of an anchor's own bias about the common one, m; smaller where five anchors or fewer
/// constrain it little.
const ANCHOR_SIGMA: f64 = 0.1;
const ANCHOR_SIGMA_OF_FEW: f64 = 0.06;
/// Standard deviation of the common bias, m.
const COMMON_SIGMA: f64 = 0.3;
/// Standard deviation of the position of a marked point, m.
const MARK_SIGMA: f64 = 0.02;

impl<T: Scalar, const A: usize> Calibration<T, A> {
    /// Creates a calibration for anchors at these positions (room frame, m).
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub fn new(anchors: [SVector<T, 3>; A]) -> Result<Self, Error> {
        if !anchors.iter().all(|anchor| T::all_finite(anchor.as_array())) {
            return Err(Error::NotFinite);
        }
        let own = if A <= 5 { ANCHOR_SIGMA_OF_FEW } else { ANCHOR_SIGMA };
        let ratio = LINK_SIGMA * LINK_SIGMA / (own * own);
        let common = COMMON_SIGMA * COMMON_SIGMA;
        let shared = T::from_f64(ratio * common / (own * own + A as f64 * common));
        let mut normal = [[-shared; A]; A];
        for (index, row) in normal.iter_mut().enumerate() {
            if let Some(diagonal) = row.get_mut(index) {
                *diagonal += T::from_f64(ratio);
            }
        }
        Ok(Self { anchors, normal, right: [T::ZERO; A] })
    }

    /// Adds the median ranges (m) taken at a point whose position (m) is known.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::TooFewRanges`]; nothing is changed.
    pub fn add_known(
        &mut self,
        position: &SVector<T, 3>,
        medians: &[Option<T>; A],
    ) -> Result<(), Error> {
        let stiffness = T::from_f64(LINK_SIGMA * LINK_SIGMA / (MARK_SIGMA * MARK_SIGMA));
        self.add(position, T::ZERO, medians, stiffness)
    }

    /// Adds the median ranges (m) taken at a point of unknown position, in D dimensions; with D = 2 its `height`
    /// (m) must be known.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`] unless there are at least D + 2 ranges, or the reason why no position was found;
    /// nothing is changed.
    pub fn add_unknown<const D: usize>(
        &mut self,
        height: T,
        medians: &[Option<T>; A],
    ) -> Result<(), Error> {
        let biases = self.biases()?;
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA);
        let mut observations = Vec::<Observation<T>, A>::new();
        for ((&anchor, &median), &bias) in self.anchors.iter().zip(medians).zip(&biases) {
            if let Some(median) = median {
                let observation = Observation { anchor, range: median - bias, variance };
                observations.push(observation).map_err(|_| Error::TooFewRanges)?;
            }
        }
        if observations.len() < D + 2 {
            return Err(Error::TooFewRanges);
        }
        let fix = Solver::new(height).solve::<D>(&observations, None)?;
        self.add(&fix.position, height, medians, T::ZERO)
    }

    /// The current estimates of the biases, m.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the sums have left the range of fixed point.
    pub fn biases(&self) -> Result<[T; A], Error> {
        solved(&self.normal, &self.right).ok_or(Error::NotFinite)
    }

    /// Adds a point to the normal equations: N += W, g += W (z − r), with W = 1 − J (Λ + JᵀJ)⁻¹ Jᵀ over the anchors
    /// that were heard.
    fn add<const D: usize>(
        &mut self,
        position: &SVector<T, D>,
        height: T,
        medians: &[Option<T>; A],
        stiffness: T,
    ) -> Result<(), Error> {
        let mut equations = NormalEquations::new();
        for axis in 0..D {
            equations.a[axis][axis] = stiffness;
        }
        let mut rows: [Option<([T; D], T)>; A] = [None; A];
        for ((slot, anchor), median) in rows.iter_mut().zip(&self.anchors).zip(medians) {
            let Some(median) = *median else { continue };
            let expected = expected_range(position, height, anchor);
            equations.add(&expected.direction, median - expected.distance, T::ONE);
            *slot = Some((expected.direction, median - expected.distance));
        }
        if rows.iter().flatten().count() <= 1 {
            return Err(Error::TooFewRanges);
        }
        let factors = equations.factorised().ok_or(Error::DegenerateGeometry)?;
        let moved = factors.solve(&equations.b);
        let mut next = *self;
        for (i, seen) in rows.iter().enumerate() {
            let Some((row, residual)) = seen else { continue };
            let through = factors.solve(row);
            for (j, other) in rows.iter().enumerate() {
                let Some((other, _)) = other else { continue };
                let own = if i == j { T::ONE } else { T::ZERO };
                if let Some(entry) = next.normal.get_mut(i).and_then(|line| line.get_mut(j)) {
                    *entry += own - T::dot(&through, other);
                }
            }
            if let Some(entry) = next.right.get_mut(i) {
                *entry += *residual - T::dot(row, &moved);
            }
        }
        let finite = T::all_finite(&next.right) && T::all_finite(next.normal.as_flattened());
        if !finite {
            return Err(Error::NotFinite);
        }
        *self = next;
        Ok(())
    }
}

/// Solves N x = g for a positive definite N by elimination; `None` if a pivot is not positive.
pub(crate) fn solved<T: Scalar, const A: usize>(
    normal: &[[T; A]; A],
    right: &[T; A],
) -> Option<[T; A]> {
    let (mut rest, mut x) = (*normal, *right);
    for pivot in 0..A {
        let line = *rest.get(pivot)?;
        let diagonal = *line.get(pivot)?;
        if !(diagonal > T::ZERO && diagonal.is_finite()) {
            return None;
        }
        let value = *x.get(pivot)?;
        for row in pivot + 1..A {
            let below = rest.get_mut(row)?;
            let factor = *below.get(pivot)? / diagonal;
            for (entry, &above) in below.iter_mut().zip(&line) {
                *entry -= factor * above;
            }
            *x.get_mut(row)? -= factor * value;
        }
    }
    for pivot in (0..A).rev() {
        let line = rest.get(pivot)?;
        let mut sum = *x.get(pivot)?;
        for (&entry, &known) in line.iter().zip(&x).skip(pivot + 1) {
            sum -= entry * known;
        }
        *x.get_mut(pivot)? = sum / *line.get(pivot)?;
    }
    T::all_finite(&x).then_some(x)
}
