//! Least squares over all meetings of two sensors.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{Matrix2, Rotation2, SVector, Vector2};

use super::super::path::{Path, PathErrors};
use super::super::{TrackPoint, Walk};
use super::meeting::Meeting;
use crate::chain::{Chain, Solution, Tie, Want};
use crate::metrics::rms;

/// Standard deviation of the place at which a foot passes the other, for each axis, m.
const BESIDE: f64 = 0.1;
/// Standard deviation of the sideways distance at which it passes, m.
const WIDTH: f64 = 0.15;
/// The residual, in standard deviations, beyond which a meeting has less weight: a turn, a step to the side.
const HUBER: f64 = 2.0;
/// The number of differences between both rates that are tried first, to either side, and the largest of them in
/// standard deviations.
const TRIED: (i32, f64) = (200, 4.0);
const ITERATIONS: usize = 50;
/// The largest step of any unknown at which the iteration has converged.
const SOLVED: f64 = 1e-7;

/// Index of the unknown angle by which the other sensor's frame is turned to the left, rad; first of the unknowns of
/// the whole walk.
const TURN: usize = 0;
/// Index of this path's heading rate, rad/s, followed by its scale.
pub(super) const OWN: usize = 1;
/// Index of the other path's heading rate, rad/s, followed by its scale.
const OTHER: usize = 3;
/// Index of the distance at which this foot passes to the left of the other, m.
const SIDE: usize = 5;
const UNKNOWNS: usize = 6;

/// The path of a foot, and the size of its errors.
pub(super) struct Foot {
    pub(super) path: Path,
    errors: PathErrors,
}

impl Foot {
    fn of(walk: &Walk) -> Self {
        Self { path: Path::of(walk), errors: PathErrors::of(walk) }
    }

    /// The footprints from the start on, m.
    fn footprints(&self, rate: f64, scale: f64) -> Vec<Vector2<f64>> {
        let walked = self.path.walked(rate, scale).map(|(place, _)| place);
        std::iter::once(Vector2::zeros()).chain(walked).collect()
    }
}

/// The data of two walks.
pub(super) struct Problem {
    pub(super) own: Foot,
    other: Foot,
    pub(super) meetings: Vec<Meeting>,
}

/// A guess of the unknowns.
pub(super) struct Guess {
    pub(super) unknowns: SVector<f64, UNKNOWNS>,
    /// The correction added at each meeting to the position of this foot relative to the other, m: the initial offset
    /// between their frames, and the negative of the strides' own errors.
    corrections: Vec<Vector2<f64>>,
}

/// The solution of a problem.
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

    /// Solves for the most likely unknowns; `None` if they are not determined.
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

    /// The rotation of the other's frame and the difference of both rates with which the paths are closest to each
    /// other.
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

    /// Turns and moves the other path onto this one (Procrustes), at these rates: returns the sum of the remaining
    /// squared distances, m², the unknowns, and the correction common to all meetings.
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

    /// The position of this foot relative to the other at each meeting, with the derivatives with respect to all
    /// unknowns.
    ///
    /// The derivatives with respect to rates and scales are those of the middle path, alike for both feet: nothing is
    /// known of what turns both alike. With the derivatives of each foot's own steps, whose errors turn with them, it
    /// would seem to be known.
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
        // Half a footprint further adds half of a stride's error.
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

    /// The root mean square of the residuals that no error of a path explains, m.
    pub(super) fn left_over(&self, guess: &Guess) -> f64 {
        rms(&self.rows(guess).iter().map(|row| row.residual.norm()).collect::<Vec<_>>())
    }

    /// The root mean square distance between both where they meet, m.
    pub(super) fn distance(&self, guess: &Guess) -> f64 {
        rms(&self.rows(guess).iter().map(|row| row.between.norm()).collect::<Vec<_>>())
    }

    /// The change of the correction since the first meeting, m.
    pub(super) fn corrections(&self, guess: &Guess) -> Vec<TrackPoint> {
        let first = guess.corrections.first().copied().unwrap_or_default();
        let point = |(meeting, correction): (&Meeting, &Vector2<f64>)| {
            let [x, y] = (correction - first).into();
            TrackPoint { time_us: meeting.time_us, position: [x, y, 0.0] }
        };
        self.meetings.iter().zip(&guess.corrections).map(point).collect()
    }

    /// The variance of that change at a time, for each axis, m², as if first and last corrections were uncorrelated.
    pub(super) fn correction_variance(&self, solution: &Solution<2>, time_us: u64) -> f64 {
        let next = self.meetings.partition_point(|meeting| meeting.time_us < time_us);
        let of = |index: usize| solution.covariances.get(index).map_or(0.0, |it| 0.5 * it.trace());
        of(0) + of(next.min(self.meetings.len().saturating_sub(1)))
    }
}

/// The positions of both at a meeting, each in its own frame, m.
fn places(meeting: &Meeting, own: &[Vector2<f64>], other: &[Vector2<f64>]) -> [Vector2<f64>; 2] {
    let half_way = |footprints: &[Vector2<f64>], twice: usize| {
        0.5 * (footprints[twice / 2] + footprints[twice.div_ceil(2)])
    };
    [half_way(own, meeting.own), half_way(other, meeting.other)]
}

/// The computed terms of a meeting.
struct Row {
    /// The vector from the other foot to this one, m, corrected.
    between: Vector2<f64>,
    /// That vector minus the sideways distance at which they pass each other.
    residual: Vector2<f64>,
    slopes: [Vector2<f64>; UNKNOWNS],
}
