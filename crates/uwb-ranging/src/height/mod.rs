mod candidate;
mod moments;

use self::candidate::{Candidate, Prior};
use self::moments::Moments;
use crate::calibration::LINK_SIGMA;
use crate::{Error, Observation};
use heapless::Vec;
use kestirim_scalar::{Components, Scalar};
use nalgebra::SVector;

/// The height at which a tag moves, as its ranges tell it, and what the anchors measure too long with it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Height<T, const A: usize> {
    /// The height in the anchors' frame (z up), m.
    pub metres: T,
    /// Its standard deviation, m.
    pub sigma: T,
    /// By how much a position in the plane is uncertain because the height is, m: the root mean square
    /// distance over the places so far, when the biases go with the height.
    pub position_sigma: T,
    /// What each anchor measures too long at this height, m. Height and biases were found together and are used
    /// together: a height too high by a metre and ranges too long by half of one look much the same, and lead to
    /// the same position. Anchors that were calibrated may keep what was measured.
    pub biases: [T; A],
}

/// Search for the height of a tag that stays at one, from places at which it was heard by at least three
/// anchors and which need not be known.
///
/// The slant of a range makes the height felt: from place to place differently, unlike what an anchor
/// measures too long. Seventeen candidate heights are carried along. At each place every candidate finds its
/// own position in the plane, what the ranges say about that is eliminated, and the rest says something about
/// the biases ([`Calibration`](crate::Calibration) does the same at one height) and about the height: the
/// squares that the best biases leave. The probability over the candidates gives mean and deviation.
///
/// Candidates reach from the floor (z = 0, or the lowest anchor) to the highest anchor, or 2 m above the floor
/// if that is higher: **a tag is not looked for outside**. Anchors at one height cannot tell above from below:
/// where both explain the ranges, and the anchors' own height does not, **below** is taken.
///
/// In fixed point, distances of up to 40 m.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct HeightSearch<T: Scalar, const A: usize> {
    anchors: Vec<SVector<T, 3>, A>,
    prior: Prior<T>,
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    candidates: [Candidate<T, A>; CANDIDATES],
    /// Weight of the places, and of the ranges beyond two a place.
    places: T,
    spare: T,
}

/// Candidate heights.
const CANDIDATES: usize = 17;
/// The candidates reach at least so far above the floor, m.
const LEAST_REACH: f64 = 2.0;
/// Places beyond which the oldest fade, so that the sums stay small and the anchors may change.
const MOST_PLACES: f64 = 128.0;
/// The difference of costs that a height of three standard deviations makes.
const CERTAIN: f64 = 9.0;

impl<T: Scalar, const A: usize> HeightSearch<T, A> {
    /// Begins for anchors at these places (z up, m), whose biases have a common part and one of each anchor's own
    /// with these standard deviations, m: 0.3 and 0.1 for anchors as they come, 0.05 each for calibrated ones.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`] for fewer than three anchors or more than A, [`Error::NotFinite`], or
    /// [`Error::NotPositive`] for a deviation below a millimetre.
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

    /// Takes in the ranges (m) of a place: medians while the tag stands, or ranges of one moment. Neighbouring
    /// places share their errors: let the tag move by half a metre from one to the next.
    ///
    /// # Errors
    /// [`Error::TooFewRanges`] unless three anchors were heard, [`Error::NotFinite`], or why no candidate height
    /// has a position; nothing is changed.
    pub fn add(&mut self, ranges: &[Option<T>; A]) -> Result<(), Error> {
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA);
        let mut heard = Vec::<(usize, Observation<T>), A>::new();
        for (index, (&anchor, &range)) in self.anchors.iter().zip(ranges).enumerate() {
            let Some(range) = range else { continue };
            if !range.is_finite() {
                return Err(Error::NotFinite);
            }
            // There are no more anchors than places.
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

    /// Number of places so far; those that have faded count half.
    pub fn places(&self) -> T {
        self.places
    }

    /// The height, and how certain it is; none before the first place.
    ///
    /// If it matters is said by [`Height::position_sigma`]: among anchors at the tag's own height the height is
    /// uncertain, and moves no position.
    pub fn height(&self) -> Option<Height<T, A>> {
        if self.places <= T::ZERO {
            return None;
        }
        let (mut costs, mut biases) = ([T::ZERO; CANDIDATES], [[T::ZERO; A]; CANDIDATES]);
        for ((cost, biases), candidate) in costs.iter_mut().zip(&mut biases).zip(&self.candidates) {
            (*cost, *biases) = candidate.explained(&self.prior)?;
        }
        let least = costs.iter().fold(T::MAX, |least, &cost| least.min(cost));
        // Ranges that agree worse with each other than links do say less; those that agree better, no more.
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

    /// From which candidate to which the height is looked for: on one side of the anchors' mean height if both
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
        // A standard deviation.
        if barrier - below.max(above) <= T::ONE {
            return all;
        }
        if below - above < T::from_f64(CERTAIN) { (0, middle) } else { (middle, CANDIDATES - 1) }
    }

    /// Halves what all places have said.
    fn fade(&mut self) {
        self.candidates.iter_mut().for_each(Candidate::fade);
        self.places *= T::HALF;
        self.spare *= T::HALF;
    }
}
