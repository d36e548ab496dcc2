//! The heading of a walk among walls that stand at right angles.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use kestirim_pedestrian::PathUncertainty;
use nalgebra::{Matrix2, Vector2};

use super::Walk;

/// Standard deviation of a leg's direction from that of the walls, rad: 1.5°. Between 1° and 3° the recordings are corrected alike.
const ALONG: f64 = 0.026;
/// Strides of a leg lead nowhere else by more than this, rad, and are so many at least.
const BEND: f64 = 0.26;
const STRIDES: usize = 3;
/// Legs of a walk, and their share of its path along the walls, at least.
const LEGS: usize = 4;
const SHARE: f64 = 0.6;
/// How much likelier the legs' directions are with right angles than without, at least.
const LIKELIER: f64 = 1e3;
/// The share of legs that are taken to go anywhere.
const ASTRAY: f64 = 0.2;
/// Rates to either side of none, and directions of the walls, that are tried; the last rate is so many standard deviations away.
const TRIED: (i32, i32, f64) = (40, 90, 4.0);

/// How well a walk went along walls at right angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RightAngles {
    /// The share of its path along them, 0 to 1.
    pub share: f64,
    /// Standard deviation of the heading's rate, rad/s, that is left.
    pub rate_sigma: f64,
}

impl Walk {
    /// Takes back a drift of the heading at a constant rate, which shows in a building: people go straight along its walls, which
    /// stand at right angles, so that the directions of straight legs differ by multiples of 90° (Borenstein and Ojeda, Heuristic
    /// drift elimination for personnel tracking systems, J. Navigation 63, 2010, here over the whole walk and with its likelihood).
    ///
    /// The rate is the likeliest, given how gyroscopes of the class drift: legs that say little change little. Standard
    /// deviations of the path stay those of an uncorrected one.
    ///
    /// # Errors
    /// A sentence if the walk does not go along right angles: it stays as it was.
    pub fn align_to_right_angles(&mut self) -> Result<RightAngles, String> {
        let legs = legs(self);
        let path_m: f64 = self.strides.iter().map(|stride| stride.length_m).sum();
        let sensor = kestirim_pedestrian::SensorClass::from(self.sensor);
        let walls = Walls::likeliest(&legs, sensor.heading_rate());
        let along = legs.iter().filter(|leg| walls.has(leg)).map(|leg| leg.length_m);
        let along_m = along.fold(0.0, |sum, length_m| sum + length_m);
        if legs.len() < LEGS || along_m < SHARE * path_m || walls.evidence(&legs) < LIKELIER.ln() {
            let percent = 100.0 * SHARE;
            return Err(format!(
                "no right angles: of {path_m:.0} m walked {along_m:.0} m are straight legs along two directions at right angles; \
                 {percent:.0} % and {LEGS} legs are needed"
            ));
        }
        let before = self.heading_rate.unwrap_or(0.0);
        self.turn_back(walls.rate);
        self.heading_rate = Some(before + walls.rate);
        let found = RightAngles { share: along_m / path_m, rate_sigma: walls.rate_sigma };
        self.right_angles = Some(found);
        Ok(found)
    }
}

/// Strides in one direction.
struct Leg {
    /// Where it leads, rad.
    direction: f64,
    /// When half of its path is behind, s since the start.
    time_s: f64,
    length_m: f64,
    /// Standard deviation of the direction from the walls', rad.
    sigma: f64,
}

fn legs(walk: &Walk) -> Vec<Leg> {
    let Some(start) = walk.track.first() else { return Vec::new() };
    let mut from = Vector2::new(start.position[0], start.position[1]);
    let steps: Vec<_> = (walk.strides.iter())
        .map(|stride| {
            let to = Vector2::new(stride.position[0], stride.position[1]);
            let step = to - std::mem::replace(&mut from, to);
            let since_s = stride.time_us.saturating_sub(start.time_us) as f64 * 1e-6;
            (step, since_s - stride.duration_s / 2.0)
        })
        .collect();
    let (mut legs, mut rest) = (Vec::new(), &steps[..]);
    while let [(first, _), ..] = rest {
        let mut chord = *first;
        let goes_on = |(step, _): &&(Vector2<f64>, f64)| {
            let is_straight = turn(&chord, step).abs() < BEND;
            if is_straight {
                chord += step;
            }
            is_straight
        };
        let count = 1 + rest[1..].iter().take_while(goes_on).count();
        let (leg, others) = rest.split_at(count);
        rest = others;
        let length_m: f64 = leg.iter().map(|(step, _)| step.norm()).sum();
        let moment: f64 = leg.iter().map(|(step, time_s)| step.norm() * time_s).sum();
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

/// The angle from one direction to another, rad.
fn turn(from: &Vector2<f64>, to: &Vector2<f64>) -> f64 {
    from.perp(to).atan2(from.dot(to))
}

/// What the legs of a walk say of walls and heading.
#[derive(Clone, Copy)]
struct Walls {
    /// The direction of one of them at the start, rad.
    direction: f64,
    /// The rate of the heading's drift and its standard deviation, rad/s.
    rate: f64,
    rate_sigma: f64,
}

impl Walls {
    /// The likeliest, where rates have this standard deviation before.
    fn likeliest(legs: &[Leg], prior: f64) -> Self {
        let (rates, directions, furthest) = TRIED;
        let tried = (-rates..=rates).flat_map(|rate| {
            let rate = f64::from(rate) / f64::from(rates) * furthest * prior;
            (0..directions).map(move |direction| {
                let direction = f64::from(direction) / f64::from(directions) * FRAC_PI_2;
                Self { direction, rate, rate_sigma: prior }
            })
        });
        let likely = |it: &Self| it.evidence(legs) - 0.5 * (it.rate / prior).powi(2);
        let mut walls = tried.max_by(|a, b| likely(a).total_cmp(&likely(b))).unwrap_or(Self {
            direction: 0.0,
            rate: 0.0,
            rate_sigma: prior,
        });
        for _ in 0..10 {
            let mut information = Matrix2::new(prior.powi(-2), 0.0, 0.0, 0.0);
            let mut gradient = Vector2::new(-walls.rate / prior.powi(2), 0.0);
            for leg in legs {
                let [along, astray] = walls.densities(leg);
                let weight = along / (along + astray) / leg.sigma.powi(2);
                let row = Vector2::new(leg.time_s, 1.0);
                information += row * row.transpose() * weight;
                gradient += row * (weight * walls.off(leg));
            }
            let Some(inverse) = information.try_inverse() else { break };
            let step = inverse * gradient;
            walls.rate += step.x;
            walls.direction += step.y;
            walls.rate_sigma = inverse[(0, 0)].max(0.0).sqrt();
        }
        walls
    }

    /// How far a leg is from along them, rad.
    fn off(&self, leg: &Leg) -> f64 {
        let angle = leg.direction - self.rate * leg.time_s - self.direction;
        (angle + FRAC_PI_2 / 2.0).rem_euclid(FRAC_PI_2) - FRAC_PI_2 / 2.0
    }

    fn has(&self, leg: &Leg) -> bool {
        self.off(leg).abs() < 3.0 * leg.sigma
    }

    /// Probability densities that a leg goes along them as it does, and that it goes anywhere, 1/rad.
    fn densities(&self, leg: &Leg) -> [f64; 2] {
        let off = self.off(leg) / leg.sigma;
        let along = (-0.5 * off * off).exp() / (leg.sigma * TAU.sqrt());
        [(1.0 - ASTRAY) * along, ASTRAY * 2.0 / PI]
    }

    /// How much likelier the legs are than ones that go anywhere: the logarithm of the ratio.
    fn evidence(&self, legs: &[Leg]) -> f64 {
        let anywhere = 2.0 / PI;
        legs.iter().map(|leg| (self.densities(leg).iter().sum::<f64>() / anywhere).ln()).sum()
    }
}

#[cfg(test)]
mod tests;
