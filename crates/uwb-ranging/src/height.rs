use crate::calibration::{LINK_SIGMA, solved};
use crate::symmetric::NormalEquations;
use crate::{Error, Huber, Observation, Solver, expected_range};
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

/// What is known of biases beforehand: times the variance of a range, the inverse of their covariance is
/// `own` on the diagonal less `shared` everywhere among the anchors.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
struct Prior<T> {
    own: T,
    shared: T,
    anchors: usize,
}

/// One height, and how well it explains the ranges.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
struct Candidate<T, const A: usize> {
    height: T,
    /// Normal equations of the biases, without what they may be, times the variance of a range.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays::rows"))]
    normal: [[T; A]; A],
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    right: [T; A],
    /// Squares that are left without biases, m².
    squares: T,
    /// The last position, m.
    position: Option<[T; 2]>,
    /// Sum of the squared distances to the position of the candidate below, m².
    apart: T,
}

/// Candidate heights.
const CANDIDATES: usize = 17;
/// Heights between two candidates at which the probability is taken.
const BETWEEN: i32 = 8;
/// The candidates reach at least so far above the floor, m.
const LEAST_REACH: f64 = 2.0;
/// Huber's threshold, and the cost beyond which a residual costs no more: a range off by more than half a metre
/// says nothing.
const DOUBT: f64 = 2.0;
const LARGEST_COST: f64 = 20.0;
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
        let blank = Candidate {
            height: floor,
            normal: [[T::ZERO; A]; A],
            right: [T::ZERO; A],
            squares: T::ZERO,
            position: None,
            apart: T::ZERO,
        };
        let mut candidates = [blank; CANDIDATES];
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
        let moments = self.moments(&costs, sides)?;
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

    /// Mean and deviation over the candidates of one side.
    fn moments(
        &self,
        costs: &[T; CANDIDATES],
        (first, last): (usize, usize),
    ) -> Option<Moments<T>> {
        let places = self.places.divisor();
        let step = T::from_f64(1.0 / f64::from(BETWEEN));
        // Weights, and places counted in candidates and in metres of the position's way.
        let (mut sum, mut mean, mut variance) = (T::ZERO, T::ZERO, T::ZERO);
        let (mut way_mean, mut way_variance) = (T::ZERO, T::ZERO);
        let mut way = T::ZERO;
        for index in first..last {
            let (here, next) = (*costs.get(index)?, *costs.get(index + 1)?);
            let before = index.checked_sub(1).and_then(|index| costs.get(index));
            let after = costs.get(index + 2);
            let length = self.candidates.get(index + 1)?.apart.divided_by(places).sqrt();
            for part in 0..BETWEEN {
                // The middle of each part.
                let share = step * (T::from_micro(part * 1_000_000) + T::HALF);
                let cost = between(before.copied(), here, next, after.copied(), share);
                let weight = (-T::HALF * cost.max(T::ZERO).min(T::from_f64(40.0))).exp();
                let at = T::from_micro(index as i32 * 1_000_000) + share;
                let along = way + length * share;
                sum += weight;
                let more = weight / sum;
                let (off, way_off) = (at - mean, along - way_mean);
                mean += more * off;
                way_mean += more * way_off;
                variance += more * (off * (at - mean) - variance);
                way_variance += more * (way_off * (along - way_mean) - way_variance);
            }
            way += length;
        }
        let (low, high) = (self.candidates.first()?.height, self.candidates.get(1)?.height);
        let spacing = high - low;
        Some(Moments {
            metres: low + mean * spacing,
            sigma: variance.max(T::ZERO).sqrt() * spacing,
            position_sigma: way_variance.max(T::ZERO).sqrt(),
            place: mean,
        })
    }

    /// Halves what all places have said.
    fn fade(&mut self) {
        for candidate in &mut self.candidates {
            let entries = candidate.normal.as_flattened_mut().iter_mut();
            for entry in entries.chain(&mut candidate.right) {
                *entry *= T::HALF;
            }
            candidate.squares *= T::HALF;
            candidate.apart *= T::HALF;
        }
        self.places *= T::HALF;
        self.spare *= T::HALF;
    }
}

/// Mean and deviation of a height, and where that is among the candidates.
struct Moments<T> {
    metres: T,
    sigma: T,
    position_sigma: T,
    place: T,
}

impl<T: Scalar> Moments<T> {
    /// What the candidates on either side say, in proportion.
    fn at<const A: usize>(&self, of: &[[T; A]; CANDIDATES]) -> Option<[T; A]> {
        let whole = |index: usize| T::from_micro(index as i32 * 1_000_000);
        let index = (0..CANDIDATES - 1).rfind(|&index| whole(index) <= self.place)?;
        let share = self.place - whole(index);
        let (low, high) = (of.get(index)?, of.get(index + 1)?);
        let mut between = *low;
        for (value, &high) in between.iter_mut().zip(high) {
            *value += share * (high - *value);
        }
        Some(between)
    }
}

/// A cubic through two costs, with the slopes of the parabolas through their neighbours (Catmull and Rom 1974).
fn between<T: Scalar>(before: Option<T>, here: T, next: T, after: Option<T>, share: T) -> T {
    let rise = next - here;
    let leaving = before.map_or(rise, |before| (next - before) * T::HALF);
    let arriving = after.map_or(rise, |after| (after - here) * T::HALF);
    let rest = T::ONE - share;
    let (bend, counter) = (leaving - rise, rise - arriving);
    here + rise * share + share * rest * (bend * rest + counter * share)
}

impl<T: Scalar, const A: usize> Candidate<T, A> {
    /// Takes in the ranges of a place; whether there is a position at this height.
    fn add(&mut self, heard: &[(usize, Observation<T>)], prior: &Prior<T>) -> bool {
        let before = *self;
        // Once with the biases as they were known, and once with those as they are known then.
        for _ in 0..2 {
            let biases = self.explained(prior).map_or([T::ZERO; A], |(_, biases)| biases);
            let near = self.position;
            *self = before;
            self.position = self.placed(heard, &biases, near);
            let place = self.position.map(SVector::from);
            if !place.is_some_and(|place| self.project(heard, &biases, &place)) {
                // A height at which there is no position is not made more likely by that.
                *self = before;
                let count = T::from_micro(heard.len().min(2000) as i32 * 1_000_000);
                self.squares += T::from_f64(LINK_SIGMA * LINK_SIGMA * LARGEST_COST) * count;
                return false;
            }
        }
        true
    }

    /// The position that fits best, near the last one if the ranges agree there.
    fn placed(
        &self,
        heard: &[(usize, Observation<T>)],
        biases: &[T; A],
        start: Option<[T; 2]>,
    ) -> Option<[T; 2]> {
        let mut freed = Vec::<Observation<T>, A>::new();
        for &(index, observation) in heard {
            let range = observation.range - biases.get(index).copied()?;
            freed.push(Observation { range, ..observation }).ok()?;
        }
        let threshold = T::from_f64(DOUBT);
        let huber = Some(Huber { long: threshold, short: threshold });
        let solver = Solver { huber, ..Solver::new(self.height) };
        let near = start.and_then(|start| {
            let variance = freed.first()?.variance;
            solver.descend::<2>(&freed, &SVector::from(start), variance).ok()
        });
        // Two standard deviations a range.
        let most = T::from_f64(4.0) * T::from_micro(freed.len().min(2000) as i32 * 1_000_000);
        if let Some(near) = near.filter(|near| near.cost <= most) {
            return Some(*near.position.as_array());
        }
        let anywhere = solver.solve::<2>(&freed, None).ok();
        let better = match (near, anywhere) {
            (Some(near), Some(anywhere)) if near.cost <= anywhere.cost => Some(near),
            (near, None) => near,
            (_, anywhere) => anywhere,
        };
        better.map(|fix| *fix.position.as_array())
    }

    /// Adds what the ranges say beyond the position: N += W, g += W e, c += eᵀ W e with
    /// W = w − w J (Jᵀ w J)⁻¹ Jᵀ w, Huber's weights w and ranges that are too long by e.
    fn project(
        &mut self,
        heard: &[(usize, Observation<T>)],
        biases: &[T; A],
        position: &SVector<T, 2>,
    ) -> bool {
        let (threshold, largest) = (T::from_f64(DOUBT), T::from_f64(LARGEST_COST));
        let variance = T::from_f64(LINK_SIGMA * LINK_SIGMA);
        let per_sigma = T::from_f64(1.0 / LINK_SIGMA);
        let mut equations = NormalEquations::new();
        let mut rows = Vec::<(usize, [T; 2], T, T), A>::new();
        for &(index, Observation { anchor, range, .. }) in heard {
            let expected = expected_range(position, self.height, &anchor);
            let excess = range - expected.distance;
            let known = biases.get(index).copied().unwrap_or(T::ZERO);
            let deviations = (excess - known).abs() * per_sigma;
            let mut weight = T::ONE;
            if deviations > threshold {
                weight = threshold / deviations;
                // Huber's cost, or the largest, instead of the weighed square that is added below.
                let cost = (threshold * (T::TWO * deviations - threshold)).min(largest);
                self.squares += variance * (cost - threshold * deviations);
            }
            let row = expected.direction;
            equations.add(&row, excess, weight);
            let _ = rows.push((index, row, excess, weight));
        }
        let Some(factors) = equations.factorised() else { return false };
        let moved = factors.solve(&equations.b);
        for &(index, row, excess, weight) in &rows {
            let left = weight * (excess - T::dot(&row, &moved));
            self.squares += left * excess;
            if let Some(entry) = self.right.get_mut(index) {
                *entry += left;
            }
            let through = factors.solve(&row);
            let Some(line) = self.normal.get_mut(index) else { continue };
            for &(column, other, _, other_weight) in &rows {
                let own = if column == index { weight } else { T::ZERO };
                if let Some(entry) = line.get_mut(column) {
                    *entry += own - weight * other_weight * T::dot(&through, &other);
                }
            }
        }
        true
    }

    /// The squares that the best biases leave (m², with those of the biases), and the biases, m.
    fn explained(&self, prior: &Prior<T>) -> Option<(T, [T; A])> {
        let mut normal = self.normal;
        for (index, line) in normal.iter_mut().enumerate() {
            for (column, entry) in line.iter_mut().enumerate() {
                if column == index {
                    *entry += prior.own;
                }
                if index.max(column) < prior.anchors {
                    *entry -= prior.shared;
                }
            }
        }
        let biases = solved(&normal, &self.right)?;
        Some((self.squares - T::dot(&biases, &self.right), biases))
    }

    fn is_finite(&self) -> bool {
        let sums = [self.squares, self.apart];
        let matrices = T::all_finite(self.normal.as_flattened()) && T::all_finite(&self.right);
        matrices && T::all_finite(&sums) && self.position.is_none_or(|it| T::all_finite(&it))
    }
}
