mod candidate;
mod moments;

use self::candidate::{Candidate, Prior};
use self::moments::Moments;
use crate::calibration::LINK_SIGMA;
use crate::{Error, Observation};
use heapless::Vec;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The estimated height of a tag, and the range biases of the anchors that belong to it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Height<T, const A: usize> {
    /// The height in the anchors' frame (z up), m.
    pub metres: T,
    /// Standard deviation of the height, m.
    pub sigma: T,
    /// Position uncertainty in the plane due to that of the height, m: the root mean square distance over the
    /// places so far, with the biases varying along with the height.
    pub position_sigma: T,
    /// Bias of each anchor at this height, m. Height and biases were estimated together and are used together: a
    /// height too high by a metre and ranges too long by half a metre look much the same, and lead to the same
    /// position. Calibrated anchors may keep their measured biases.
    pub biases: [T; A],
}

/// Search for the constant height of a tag, from places at which at least three anchors heard it; the places need
/// not be known.
///
/// The slant of a range depends on the height, and differently from place to place, unlike an anchor's bias.
/// Seventeen candidate heights are carried along. At each place every candidate finds its own position in the
/// plane, the position is eliminated from the equations, and the remainder constrains the biases
/// ([`Calibration`](crate::Calibration) does the same at one height) and the height, through the sum of squares
/// with the best biases. The probability over the candidates gives mean and standard deviation.
///
/// Candidates range from the floor (z = 0, or the lowest anchor) to the highest anchor, or 2 m above the floor if
/// that is higher: **heights outside are not considered**. Anchors at one height cannot distinguish above from
/// below: where both explain the ranges, and the anchors' own height does not, **below** is taken.
///
/// In fixed point, distances may be up to 40 m.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeightSearch<T: Scalar, const A: usize> {
    anchors: Vec<SVector<T, 3>, A>,
    prior: Prior<T>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    candidates: [Candidate<T, A>; CANDIDATES],
    /// The number of places (faded ones count less), and the number of ranges beyond two per place.
    places: T,
    spare: T,
}

/// Number of candidate heights.
const CANDIDATES: usize = 17;
/// The candidates reach at least this far above the floor, m.
const LEAST_REACH: f64 = 2.0;
/// Number of places at which all accumulated sums are halved, so that they stay small and the anchors may change.
const MOST_PLACES: f64 = 128.0;
/// The difference of costs that corresponds to three standard deviations.
const CERTAIN: f64 = 9.0;

impl<T: Scalar, const A: usize> HeightSearch<T, A> {
    /// Begins a search for anchors at these positions (z up, m). `common` and `own` are the standard deviations (m)
    /// of the common part of their biases and of each anchor's own part: 0.3 and 0.1 for uncalibrated anchors, 0.05
    /// each for calibrated ones.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`] for fewer than three anchors or more than A, [`Error::NotFinite`], or
    /// [`Error::NotPositive`] for a standard deviation below a millimetre.
    pub fn new(anchors: &[SVector<T, 3>], common: T, own: T) -> Result<Self, Error> {
        let anchors = Vec::<_, A>::from_slice(anchors).map_err(|_| Error::TooFewRanges)?;
        if anchors.len() < 3 {
            return Err(Error::TooFewRanges);
        }
        let finite = anchors.iter().all(|anchor| T::all_finite(anchor.as_array()));
        if !(finite && common.is_finite() && own.is_finite()) {
            return Err(Error::NotFinite);
        }
        let least = T::from_f64(1e-3);
        if common < least || own < least {
            return Err(Error::NotPositive);
        }
        let (mut floor, mut top) = (T::ZERO, T::MIN);
        for anchor in &anchors {
            let [_, _, z] = *anchor.as_array();
            (floor, top) = (floor.min(z), top.max(z));
        }
        top = top.max(floor + T::from_f64(LEAST_REACH));
        let share = (top - floor) * T::from_f64(1.0 / (CANDIDATES - 1) as f64);
        let ratio = T::from_f64(LINK_SIGMA) / own;
        let among = common / own;
        let among = among * among;
        let count = T::from_micro(anchors.len().min(2000) as i32 * 1_000_000);
        let mut candidates = [Candidate::at(floor); CANDIDATES];
        for (index, candidate) in candidates.iter_mut().enumerate() {
            candidate.height += share * T::from_micro(index as i32 * 1_000_000);
        }
        let own = ratio * ratio;
        let shared = own * (among / (T::ONE + count * among));
        let prior = Prior { own, shared, anchors: anchors.len() };
        Ok(Self { anchors, prior, candidates, places: T::ZERO, spare: T::ZERO })
    }

    /// Adds the ranges (m) at a place: medians while the tag stands, or simultaneous ranges. Neighbouring places
    /// share their errors: let the tag move by half a metre from one to the next.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`] unless three anchors were heard, [`Error::NotFinite`], or
    /// [`Error::DegenerateGeometry`] if no candidate height has a position; nothing is changed.
    pub fn add(&mut self, ranges: &[Option<T>; A]) -> Result<(), Error> {
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA);
        let mut heard = Vec::<(usize, Observation<T>), A>::new();
        for (index, (&anchor, &range)) in self.anchors.iter().zip(ranges).enumerate() {
            let Some(range) = range else { continue };
            if !range.is_finite() {
                return Err(Error::NotFinite);
            }
            // There are no more anchors than the capacity.
            let _ = heard.push((index, Observation { anchor, range, variance }));
        }
        let spare = heard.len().checked_sub(3).ok_or(Error::TooFewRanges)? + 1;
        let mut next = self.clone();
        let mut found = 0;
        for candidate in &mut next.candidates {
            found += u16::from(candidate.add(&heard, &self.prior));
        }
        if found == 0 {
            return Err(Error::DegenerateGeometry);
        }
        let mut below: Option<[T; 2]> = None;
        for candidate in &mut next.candidates {
            if let (Some([x, y]), Some([x_below, y_below])) = (candidate.position, below) {
                let (dx, dy) = (x - x_below, y - y_below);
                candidate.apart += dx * dx + dy * dy;
            }
            below = candidate.position;
        }
        next.places += T::ONE;
        next.spare += T::from_micro(spare.min(2000) as i32 * 1_000_000);
        if next.places >= T::from_f64(MOST_PLACES) {
            next.fade();
        }
        if !next.candidates.iter().all(Candidate::is_finite) {
            return Err(Error::NotFinite);
        }
        *self = next;
        Ok(())
    }

    /// Number of places so far; it is halved whenever the accumulated evidence fades.
    pub fn places(&self) -> T {
        self.places
    }

    /// The height and its uncertainty; `None` before the first place.
    ///
    /// [`Height::position_sigma`] tells whether the uncertainty matters: among anchors at the tag's own height, the
    /// height is uncertain but does not affect the position.
    pub fn height(&self) -> Option<Height<T, A>> {
        if self.places <= T::ZERO {
            return None;
        }
        let (mut costs, mut biases) = ([T::ZERO; CANDIDATES], [[T::ZERO; A]; CANDIDATES]);
        for ((cost, biases), candidate) in costs.iter_mut().zip(&mut biases).zip(&self.candidates) {
            (*cost, *biases) = candidate.explained(&self.prior)?;
        }
        let least = costs.iter().fold(T::MAX, |least, &cost| least.min(cost));
        // Ranges that agree worse than the links' noise weigh less; those that agree better do not weigh more.
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA).max(least / self.spare.max(T::ONE));
        let inverse = variance.divisor();
        for cost in &mut costs {
            *cost = (*cost - least).divided_by(inverse);
        }
        let sides = self.sides(&costs);
        let moments = Moments::of(&self.candidates, self.places, &costs, sides)?;
        let biases = moments.at(&biases)?;
        let Moments { metres, sigma, position_sigma, .. } = moments;
        let all = [metres, sigma, position_sigma];
        let finite = T::all_finite(&all) && T::all_finite(&biases);
        finite.then_some(Height { metres, sigma, position_sigma, biases })
    }

    /// The range of candidates (first, last) that is considered: one side of the anchors' mean height if both sides
    /// explain the ranges and the mean height itself does not.
    fn sides(&self, costs: &[T; CANDIDATES]) -> (usize, usize) {
        let all = (0, CANDIDATES - 1);
        let share = T::from_micro(self.anchors.len().min(2000) as i32 * 1_000_000).recip();
        let mean = self.anchors.iter().fold(T::ZERO, |sum, anchor| sum + anchor.as_array()[2]);
        let middle = self.candidates.iter().filter(|it| it.height < mean * share).count();
        let (Some(&barrier), Some((below, above))) =
            (costs.get(middle), costs.split_at_checked(middle))
        else {
            return all;
        };
        let best = |side: &[T]| side.iter().fold(T::MAX, |least, &cost| least.min(cost));
        let (below, above) = (best(below), best(above));
        // One standard deviation.
        if barrier - below.max(above) <= T::ONE {
            return all;
        }
        if below - above < T::from_f64(CERTAIN) { (0, middle) } else { (middle, CANDIDATES - 1) }
    }

    /// Halves the accumulated evidence of all places.
    fn fade(&mut self) {
        self.candidates.iter_mut().for_each(Candidate::fade);
        self.places *= T::HALF;
        self.spare *= T::HALF;
    }
}
