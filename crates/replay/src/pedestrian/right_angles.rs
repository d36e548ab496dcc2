//! Correction of the heading of a walk among walls at right angles.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use kestirim_pedestrian::PathUncertainty;
use nalgebra::{Matrix2, Vector2};

use super::Walk;
use super::path::{Path, PathErrors};

/// Standard deviation of a leg's direction from that of the walls, rad: 1.5°.
const ALONG: f64 = 0.026;
/// The largest angle between a stride and the leg so far for the stride to belong to that leg, rad.
const BEND: f64 = 0.26;
/// The fewest strides of a leg.
const STRIDES: usize = 3;
/// The share of legs that are assumed to go in any direction.
const ASTRAY: f64 = 0.2;
/// The fewest legs along the walls.
const LEGS: usize = 4;
/// The smallest share of the path along the walls.
const SHARE: f64 = 0.6;
/// The smallest likelihood ratio of the directions with walls to those without, over all rates and walls.
const LIKELIER: f64 = 100.0;
/// The largest heading rate that is tried to either side, in standard deviations; `RATES` is the largest number of
/// rates on a side.
const FURTHEST: f64 = 4.0;
const RATES: f64 = 1000.0;
/// The number of directions of walls that are tried.
const DIRECTIONS: i32 = 45;

/// How well a walk follows walls at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RightAngles {
    /// The share of the path along the walls, 0 to 1.
    pub share: f64,
    /// The remaining standard deviation of the heading's rate, rad/s.
    pub rate_sigma: f64,
}

impl Walk {
    /// Removes a drift of the heading at a constant rate, which shows in a building: people go straight along its
    /// walls, which stand at right angles, so that the directions of straight legs differ by multiples of 90°
    /// (Borenstein and Ojeda, Heuristic drift elimination for personnel tracking systems, J. Navigation 63, 2010, here
    /// over the whole walk and with its likelihood).
    ///
    /// The rate is the most likely one, given how gyroscopes of the class drift: legs with little evidence change
    /// little. Standard deviations of the path remain unchanged until it is [closed](Self::close), which takes the
    /// remaining rate error into account.
    ///
    /// # Errors
    /// A sentence if the walk does not follow right angles, or does not tell: it then remains unchanged.
    pub fn align_to_right_angles(&mut self) -> Result<RightAngles, String> {
        let path = Path::of(self);
        if path.steps.is_empty() {
            return Err("no right angles: there is no stride".to_owned());
        }
        let path_m: f64 = path.steps.iter().map(|(_, step)| step.norm()).sum();
        let legs = legs(&path);
        let (walls, evidence) = Walls::likeliest(&legs, PathErrors::of(self).rate);
        let along: Vec<_> = legs.iter().filter(|leg| walls.has(leg)).collect();
        // Not `sum`, which is -0 for no terms, and is shown.
        let along_m = along.iter().fold(0.0, |sum, leg| sum + leg.length_m);
        if along.len() < LEGS || along_m < SHARE * path_m {
            let (count, percent) = (along.len(), 100.0 * SHARE);
            return Err(format!(
                "no right angles: of {path_m:.0} m walked {along_m:.0} m are straight along two directions at right angles, in \
                 {count} legs; {percent:.0} % and {LEGS} legs are needed"
            ));
        }
        if evidence < LIKELIER.ln() {
            let count = legs.len();
            return Err(format!(
                "no right angles: the directions of {count} straight legs may be so by chance"
            ));
        }
        self.turn_back(walls.rate);
        let found = RightAngles { share: along_m / path_m, rate_sigma: walls.rate_sigma };
        self.right_angles = Some(found);
        Ok(found)
    }
}

/// A leg: consecutive strides in one direction.
struct Leg {
    /// The direction, rad.
    direction: f64,
    /// The mean time over its path, s since the start.
    time_s: f64,
    length_m: f64,
    /// Standard deviation of the direction from the walls', rad.
    sigma: f64,
}

fn legs(path: &Path) -> Vec<Leg> {
    let (mut legs, mut rest) = (Vec::new(), &path.steps[..]);
    while let [(_, first), others @ ..] = rest {
        let mut chord = *first;
        let goes_on = |(_, step): &&(f64, Vector2<f64>)| {
            let is_straight = chord.angle(step) < BEND;
            if is_straight {
                chord += step;
            }
            is_straight
        };
        let count = 1 + others.iter().take_while(goes_on).count();
        let (leg, others) = rest.split_at(count);
        rest = others;
        let length_m: f64 = leg.iter().map(|(_, step)| step.norm()).sum();
        let moment: f64 = leg.iter().map(|(time_s, step)| step.norm() * time_s).sum();
        if count >= STRIDES && length_m > 0.0 {
            let of_its_ends = PathUncertainty::<f64>::FOOTPRINT * 2.0_f64.sqrt() / length_m;
            legs.push(Leg {
                direction: chord.y.atan2(chord.x),
                time_s: moment / length_m,
                length_m,
                sigma: ALONG.hypot(of_its_ends),
            });
        }
    }
    legs
}

/// An estimate of walls and heading drift from the legs of a walk.
#[derive(Clone, Copy)]
struct Walls {
    /// The direction of one of the walls at the start, rad.
    direction: f64,
    /// The rate of the heading's drift and its standard deviation, rad/s.
    rate: f64,
    rate_sigma: f64,
}

impl Walls {
    /// The most likely walls and rate, for rates with this prior standard deviation, and the logarithm of how much
    /// likelier the legs are with walls, averaged over all directions and rates by their prior, than without walls.
    fn likeliest(legs: &[Leg], prior: f64) -> (Self, f64) {
        let furthest = FURTHEST * prior;
        let longest_s = legs.iter().map(|leg| leg.time_s).fold(0.0, f64::max);
        // Between neighbouring rates, the last leg turns by two standard deviations.
        let rates = (furthest * longest_s / (2.0 * ALONG)).ceil().clamp(10.0, RATES);
        // The logarithm of the prior of a rate.
        let known = |rate: f64| -0.5 * (rate / prior).powi(2);
        let (mut walls, mut best) =
            (Self { direction: 0.0, rate: 0.0, rate_sigma: prior }, f64::NEG_INFINITY);
        // Sums of probabilities, relative to the largest so far.
        let (mut of_all, mut of_rates) = (0.0, 0.0);
        for index in -(rates as i32)..=rates as i32 {
            let rate = f64::from(index) / rates * furthest;
            let known = known(rate);
            of_rates += f64::from(DIRECTIONS) * known.exp();
            for direction in 0..DIRECTIONS {
                let direction = f64::from(direction) / f64::from(DIRECTIONS) * FRAC_PI_2;
                let tried = Self { direction, rate, rate_sigma: prior };
                let likely = tried.evidence(legs) + known;
                if likely > best {
                    of_all *= (best - likely).exp();
                    (walls, best) = (tried, likely);
                }
                of_all += (likely - best).exp();
            }
        }
        let tried = walls;
        for _ in 0..10 {
            walls.improve(legs, prior);
        }
        if walls.evidence(legs) + known(walls.rate) < best {
            walls = Self { rate_sigma: walls.rate_sigma, ..tried };
        }
        (walls, best + (of_all / of_rates).ln())
    }

    /// A Gauss–Newton step towards the most likely walls, each leg weighted by the probability that it goes along them.
    fn improve(&mut self, legs: &[Leg], prior: f64) {
        let mut information = Matrix2::new(prior.powi(-2), 0.0, 0.0, 0.0);
        let mut gradient = Vector2::new(-self.rate / prior.powi(2), 0.0);
        for leg in legs {
            let [along, astray] = self.densities(leg);
            let weight = along / (along + astray) / leg.sigma.powi(2);
            let row = Vector2::new(leg.time_s, 1.0);
            information += row * row.transpose() * weight;
            gradient += row * (weight * self.off(leg));
        }
        let Some(inverse) = information.try_inverse() else { return };
        let step = inverse * gradient;
        self.rate += step.x;
        self.direction += step.y;
        self.rate_sigma = inverse[(0, 0)].max(0.0).sqrt();
    }

    /// The angle between a leg and the nearest wall, rad.
    fn off(&self, leg: &Leg) -> f64 {
        let angle = leg.direction - self.rate * leg.time_s - self.direction;
        (angle + FRAC_PI_2 / 2.0).rem_euclid(FRAC_PI_2) - FRAC_PI_2 / 2.0
    }

    fn has(&self, leg: &Leg) -> bool {
        self.off(leg).abs() < 3.0 * leg.sigma
    }

    /// The probability densities of a leg's direction if it goes along the walls, and if it goes anywhere, 1/rad, each
    /// times its share.
    fn densities(&self, leg: &Leg) -> [f64; 2] {
        let off = self.off(leg) / leg.sigma;
        let along = (-0.5 * off * off).exp() / (leg.sigma * TAU.sqrt());
        [(1.0 - ASTRAY) * along, ASTRAY * 2.0 / PI]
    }

    /// The logarithm of the likelihood ratio of the legs with these walls to those without walls.
    fn evidence(&self, legs: &[Leg]) -> f64 {
        let anywhere = 2.0 / PI;
        legs.iter().map(|leg| (self.densities(leg).iter().sum::<f64>() / anywhere).ln()).sum()
    }
}
