//! Least squares over all meetings of two sensors.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix2, Rotation2, SVector, Vector2};

use super::super::path::{Path, PathErrors};
use super::super::{TrackPoint, Walk};
use super::meeting::Meeting;
use crate::chain::{Chain, Solution, Tie, Want};
use crate::metrics::rms;

/// Standard deviation of where a foot passes the other, each axis, m.
const BESIDE: f64 = 0.1;
/// Standard deviation of how far to the side it passes, m.
const WIDTH: f64 = 0.15;
/// Beyond so many deviations a meeting counts less: a turn, a step to the side.
const HUBER: f64 = 2.0;
/// Differences of both rates that are tried first, to either side, and how many standard deviations the last of them is away.
const TRIED: (i32, f64) = (200, 4.0);
const ITERATIONS: usize = 50;
/// A step of no unknown is larger in the end.
const SOLVED: f64 = 1e-7;

/// Unknowns of the whole walk, in their order: how far the other sensor's frame is turned to the left, rad, …
const TURN: usize = 0;
/// … rate of the heading, rad/s, and scale of this one, …
pub(super) const OWN: usize = 1;
/// … of the other, …
const OTHER: usize = 3;
/// … and how far to its left this one passes the other, m.
const SIDE: usize = 5;
const UNKNOWNS: usize = 6;

/// A foot's path and how large its errors are.
pub(super) struct Foot {
    pub(super) path: Path,
    errors: PathErrors,
}

impl Foot {
    fn of(walk: &Walk) -> Self {
        Self { path: Path::of(walk), errors: PathErrors::of(walk) }
    }

    /// Footprints from the start on, m.
    fn footprints(&self, rate: f64, scale: f64) -> Vec<Vector2<f64>> {
        let walked = self.path.walked(rate, scale).map(|(place, _)| place);
        std::iter::once(Vector2::zeros()).chain(walked).collect()
    }
}

/// What is known of two walks.
pub(super) struct Problem {
    pub(super) own: Foot,
    other: Foot,
    pub(super) meetings: Vec<Meeting>,
}

/// What is sought.
pub(super) struct Guess {
    pub(super) unknowns: SVector<f64, UNKNOWNS>,
    /// What is added at each meeting to where this foot is, seen from the other, m: by how much their frames begin apart, and
    /// the strides' own errors, taken back.
    corrections: Vec<Vector2<f64>>,
}

/// What was found.
pub(super) struct Solved {
    pub(super) guess: Guess,
    pub(super) solution: Solution<2>,
}

impl Problem {
    pub(super) fn of(own: &Walk, other: &Walk) -> Self {
        let meetings = Meeting::all(own, other);
        Self { own: Foot::of(own), other: Foot::of(other), meetings }
    }

    /// Whether both sensors are on one foot.
    pub(super) fn is_of_one_foot(&self) -> bool {
        self.meetings.iter().all(Meeting::is_at_rest)
    }

    /// Whether a time is between the first meeting and the last.
    pub(super) fn is_seen(&self, time_us: u64) -> bool {
        let ends = self.meetings.first().zip(self.meetings.last());
        ends.is_some_and(|(first, last)| (first.time_us..=last.time_us).contains(&time_us))
    }

    /// The likeliest unknowns; none if they are not determined.
    pub(super) fn solve(&self) -> Option<Solved> {
        let mut guess = self.begin()?;
        for _ in 0..ITERATIONS {
            let solution = self.equations(&guess).solve(Want::Step)?;
            for (correction, step) in guess.corrections.iter_mut().zip(&solution.states) {
                *correction += step;
            }
            for (unknown, step) in guess.unknowns.iter_mut().zip(solution.parameters.iter()) {
                *unknown += step;
            }
            if solution.parameters.amax() < SOLVED {
                let solution = self.equations(&guess).solve(Want::Covariances)?;
                return Some(Solved { guess, solution });
            }
        }
        None
    }

    /// The turn of the other's frame and the difference of both rates with which the paths lie nearest to each other.
    fn begin(&self) -> Option<Guess> {
        let [own, other] = [self.own.errors, self.other.errors].map(|errors| errors.rate.powi(2));
        let (count, furthest) = TRIED;
        let tried = (-count..=count).map(|k| {
            let difference = f64::from(k) / f64::from(count) * furthest * (own + other).sqrt();
            self.laid_together([own, -other].map(|share| difference * share / (own + other)))
        });
        let (_, unknowns, correction) = tried.min_by(|(a, ..), (b, ..)| a.total_cmp(b))?;
        Some(Guess { unknowns, corrections: vec![correction; self.meetings.len()] })
    }

    /// The other path turned and moved onto this one (Procrustes), at these rates: the sum of the squared distances that are
    /// left, m², the unknowns, and the correction that they share.
    fn laid_together(&self, rates: [f64; 2]) -> (f64, SVector<f64, UNKNOWNS>, Vector2<f64>) {
        let own = self.own.footprints(rates[0], 0.0);
        let other = self.other.footprints(rates[1], 0.0);
        let places = || self.meetings.iter().map(|it| places(it, &own, &other));
        let share = 1.0 / self.meetings.len().max(1) as f64;
        let [own_middle, other_middle] =
            places().fold([Vector2::zeros(); 2], |[a, b], [c, d]| [a + c * share, b + d * share]);
        let (mut cosine, mut sine, mut squares) = (0.0, 0.0, 0.0);
        for [own, other] in places() {
            let (own, other) = (own - own_middle, other - other_middle);
            cosine += other.dot(&own);
            sine += other.perp(&own);
            squares += own.norm_squared() + other.norm_squared();
        }
        let mut unknowns = SVector::zeros();
        unknowns[TURN] = sine.atan2(cosine);
        [unknowns[OWN], unknowns[OTHER]] = rates;
        let correction = Rotation2::new(unknowns[TURN]) * other_middle - own_middle;
        (squares - 2.0 * cosine.hypot(sine), unknowns, correction)
    }

    /// Where this foot is, seen from the other, at each meeting, with the derivatives by all unknowns.
    ///
    /// Those by rates and scales are those of the path in the middle, alike for both feet: of what turns both alike nothing is
    /// known. By their own steps, whose errors turn with them, it would seem to be.
    fn rows(&self, guess: &Guess) -> Vec<Row> {
        let unknown = |index: usize| guess.unknowns[index];
        let own = self.own.footprints(unknown(OWN), unknown(OWN + 1));
        let other = self.other.footprints(unknown(OTHER), unknown(OTHER + 1));
        let turn = Rotation2::new(unknown(TURN));
        let places = |meeting: &Meeting| {
            let [place, beside] = places(meeting, &own, &other);
            [place, turn * beside]
        };
        let places: Vec<_> = self.meetings.iter().map(places).collect();
        let middle = |index: usize| {
            let [place, beside] = places[index.min(places.len() - 1)];
            0.5 * (place + beside)
        };
        let quarter = Rotation2::new(FRAC_PI_2);
        let mut turned = [Vector2::zeros(); 2];
        let row = |(index, [place, beside]): (usize, &[Vector2<f64>; 2])| {
            let (before, now) = (middle(index.saturating_sub(1)), middle(index));
            let ahead = middle(index + 1) - before;
            let left = quarter * ahead.try_normalize(1e-9).unwrap_or_else(Vector2::zeros);
            let time_us = self.meetings[index].time_us;
            for (turned, foot) in turned.iter_mut().zip([&self.own, &self.other]) {
                let seconds = foot.path.seconds(time_us);
                *turned -= quarter * (now - before) * seconds;
            }
            let between = place - beside + guess.corrections[index];
            Row {
                between,
                residual: between - unknown(SIDE) * left,
                slopes: [-(quarter * beside), turned[0], -now, -turned[1], now, -left],
            }
        };
        places.iter().enumerate().map(row).collect()
    }

    fn equations(&self, guess: &Guess) -> Chain<2> {
        let mut chain = Chain::new(self.meetings.len(), UNKNOWNS);
        let (own, other) = (self.own.errors, self.other.errors);
        let sigmas = [own.rate, own.scale, other.rate, other.scale, WIDTH];
        for (unknown, sigma) in (OWN..UNKNOWNS).zip(sigmas) {
            chain.add_prior(unknown, guess.unknowns[unknown], sigma.powi(-2));
        }
        for (state, row) in self.rows(guess).iter().enumerate() {
            let far = row.residual.norm() / BESIDE;
            let information = (HUBER / far).min(1.0) * BESIDE.powi(-2);
            for axis in 0..2 {
                let mut by = Vector2::zeros();
                by[axis] = 1.0;
                let shared: Vec<_> = (0..UNKNOWNS).map(|it| (it, row.slopes[it][axis])).collect();
                chain.observe(state, &by, &shared, row.residual[axis], information);
            }
        }
        // Half a footprint further is half of a stride's error.
        let pairs = self.meetings.windows(2).zip(guess.corrections.windows(2));
        for (state, (meetings, corrections)) in pairs.enumerate() {
            let halves =
                |of: fn(&Meeting) -> usize| of(&meetings[1]).abs_diff(of(&meetings[0])) as f64;
            let variance = 0.5 * halves(|it| it.own) * own.stride.powi(2)
                + 0.5 * halves(|it| it.other) * other.stride.powi(2);
            let root = 1.0 / variance.max(1e-6).sqrt();
            let after = Matrix2::identity() * root;
            let residual = (corrections[1] - corrections[0]) * root;
            chain.tie(state, &Tie::<2, 2> { residual, before: -after, after, shared: Vec::new() });
        }
        chain
    }

    /// Root mean square of what no error of a path explains, m.
    pub(super) fn left_over(&self, guess: &Guess) -> f64 {
        rms(&self.rows(guess).iter().map(|row| row.residual.norm()).collect::<Vec<_>>())
    }

    /// How far apart both are where they meet, root mean square, m.
    pub(super) fn distance(&self, guess: &Guess) -> f64 {
        rms(&self.rows(guess).iter().map(|row| row.between.norm()).collect::<Vec<_>>())
    }

    /// How the correction has changed since the first meeting, m.
    pub(super) fn corrections(&self, guess: &Guess) -> Vec<TrackPoint> {
        let first = guess.corrections.first().copied().unwrap_or_default();
        let point = |(meeting, correction): (&Meeting, &Vector2<f64>)| {
            let [x, y] = (correction - first).into();
            TrackPoint { time_us: meeting.time_us, position: [x, y, 0.0] }
        };
        self.meetings.iter().zip(&guess.corrections).map(point).collect()
    }

    /// Variance of that at a time, each axis, m², as if first and last were not correlated.
    pub(super) fn correction_variance(&self, solution: &Solution<2>, time_us: u64) -> f64 {
        let next = self.meetings.partition_point(|meeting| meeting.time_us < time_us);
        let of = |index: usize| solution.covariances.get(index).map_or(0.0, |it| 0.5 * it.trace());
        of(0) + of(next.min(self.meetings.len().saturating_sub(1)))
    }
}

/// Where both are at a meeting, each in its own frame, m.
fn places(meeting: &Meeting, own: &[Vector2<f64>], other: &[Vector2<f64>]) -> [Vector2<f64>; 2] {
    let half_way = |footprints: &[Vector2<f64>], twice: usize| {
        0.5 * (footprints[twice / 2] + footprints[twice.div_ceil(2)])
    };
    [half_way(own, meeting.own), half_way(other, meeting.other)]
}

/// A meeting as it is computed.
struct Row {
    /// From the other foot to this one, m, corrected.
    between: Vector2<f64>,
    /// The same but for how far to the side they pass each other.
    residual: Vector2<f64>,
    slopes: [Vector2<f64>; UNKNOWNS],
}
