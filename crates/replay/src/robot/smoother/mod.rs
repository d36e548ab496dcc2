//! Smoothing of a whole recording: the positions of a tag given the measurements before and after.
//!
//! A fixed-interval smoother in the form of nonlinear least squares (Bell, *The iterated Kalman smoother as a
//! Gauss–Newton method*, 1994). Ranges and motion have the tracker's models, except for a velocity that decays more
//! slowly; each anchor's constant error is a parameter of the whole run, and so are the gain and drift of the turns of
//! a robot on wheels. Ranges are weighted by Student's distribution, with a heavier tail for those that are too long;
//! the size of their noise, and how long it lasts, are estimated.

mod free;
mod knots;
mod noise;
mod problem;
mod wheels;

use kestirim_health::{Health, Reason};
use kestirim_uwb_tracker::Config;

use self::free::Free;
use self::knots::Knots;
use self::problem::{Problem, Solved};
use self::wheels::Driven;
use super::{Dimensions, Epoch, Event, Setup, Trace};
use crate::metrics::rms;

/// A part of a recording with its track, from which the smoother begins.
#[derive(Debug, Clone, Copy)]
pub struct Tracked<'a> {
    /// The events of the sensors.
    pub events: &'a [Event],
    /// The tracker's positions, and the outcome of every range.
    pub trace: &'a Trace,
}

/// The result of smoothing a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Smoothed {
    /// The epochs of each part: for a tag that moves, those of its trace; for one that was put down, a single one; none
    /// for a part in which the tracker never found it.
    pub parts: Vec<Vec<Epoch>>,
    /// The bias of each anchor, m, beyond what was known beforehand and the common bias, with its standard deviation,
    /// m.
    pub biases: Vec<[f64; 2]>,
    /// The bias common to all anchors, m, and its increase over 10 m of distance, m, each with its standard deviation.
    pub common: [[f64; 2]; 2],
}

/// Why a recording cannot be smoothed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Unsmoothed {
    /// There is no position to begin with.
    #[error("the tracker found no position to begin with")]
    NoPosition,
    /// The ranges do not tell where the tag was.
    #[error("the ranges do not tell where the tag was")]
    NotObservable,
    /// The positions do not settle.
    #[error("the positions do not settle")]
    NotConverged,
    /// There are more epochs than are smoothed together.
    #[error("it has more than {MOST_KNOTS} epochs")]
    TooLong,
    /// The result is less certain than the tracker's positions, or the tracker has no standard deviations.
    #[error("it would be less certain than the tracker is")]
    LessCertain,
    /// There are only just enough anchors for a position, and the track does not tell their common bias.
    #[error("so few anchors do not tell what all of them measure too long")]
    CommonBias,
    /// The result contradicts the tracker.
    #[error("it would contradict the tracker by more than twice its standard deviation")]
    Contradicts,
}

/// The largest number of epochs that are smoothed together, in about 250 MB with the most anchors.
const MOST_KNOTS: usize = 50_000;
/// The largest root mean square difference between smoothed and tracked positions, in the tracker's standard
/// deviations.
const MOST_SIGMAS: f64 = 2.0;

/// Smooths the parts of a recording together. In a static recording each part has one place; otherwise the tag moves.
///
/// # Errors
/// [`Unsmoothed`] if smoothing brings no gain, or its result cannot be relied upon.
pub fn smooth(
    setup: &Setup,
    parts: &[Tracked<'_>],
    is_static: bool,
) -> Result<Smoothed, Unsmoothed> {
    let is_calibrated = setup.biases.is_some();
    let config = if is_calibrated { Config::calibrated } else { Config::uncalibrated };
    let config = setup.tuning.of_the_robust(config(setup.height_m));
    let knots = Knots::new(setup, parts, is_static).ok_or(Unsmoothed::NoPosition)?;
    if knots.points.len() > MOST_KNOTS {
        return Err(Unsmoothed::TooLong);
    }
    let solved = match setup.dimensions {
        Dimensions::Three => {
            Problem::<6, 3, _>::new(setup, &config, &knots, Free::<3, 6>::new(setup, &config))
                .solve()
        }
        Dimensions::Two if setup.is_wheeled() && !is_static => {
            // The sign of turns is the more probable one.
            let to_a_side = [1.0, -1.0].map(|side| {
                let motion = Driven::new(parts, &knots, side);
                Problem::<4, 2, _>::new(setup, &config, &knots, motion).solve()
            });
            match to_a_side {
                [Ok(left), Ok(right)] if left.cost <= right.cost => Ok(left),
                [Ok(left), Err(_)] => Ok(left),
                [_, right] => right,
            }
        }
        Dimensions::Two => {
            Problem::<4, 2, _>::new(setup, &config, &knots, Free::<2, 4>::new(setup, &config))
                .solve()
        }
    };
    let solved = solved?;
    let fewest = match setup.dimensions {
        Dimensions::Two => 3,
        Dimensions::Three => 4,
    };
    let known = config.common_sigmas(&setup.anchors::<f64>())[0];
    let is_told = solved.common[0][1] <= TOLD * known;
    if !is_calibrated && setup.anchors.len() <= fewest && !is_told {
        return Err(Unsmoothed::CommonBias);
    }
    accepted(solved, &knots)
}

/// The share of its prior standard deviation to which the common bias must be known, from the track, with only just
/// enough anchors for a position: of two recordings of three anchors, one has a quarter of it and is better for it, one
/// a half and is worse.
const TOLD: f64 = 0.4;

/// The result, if at most epochs it is more certain than the tracker's and agrees with it.
fn accepted(solved: Solved, knots: &Knots) -> Result<Smoothed, Unsmoothed> {
    let (mut certain, mut moved) = (Vec::new(), Vec::new());
    for (knot, epoch) in knots.points.iter().zip(&solved.epochs) {
        let (Some(before), Some(now)) = (knot.epoch.position, epoch.position) else { continue };
        let (Some(was), Some(is)) = (knot.epoch.sigma_m(), epoch.sigma_m()) else { continue };
        certain.push(is / was);
        moved.push((now[0] - before[0]).hypot(now[1] - before[1]) / was);
    }
    let median = |mut shares: Vec<f64>| {
        shares.sort_by(f64::total_cmp);
        shares.get(shares.len() / 2).copied()
    };
    if !median(certain).is_some_and(|share| share <= 1.0) {
        return Err(Unsmoothed::LessCertain);
    }
    if !rms(&moved).is_finite() || rms(&moved) > MOST_SIGMAS {
        return Err(Unsmoothed::Contradicts);
    }
    let mut parts: Vec<Vec<Epoch>> = vec![Vec::new(); knots.parts];
    for (knot, mut epoch) in knots.points.iter().zip(solved.epochs) {
        if epoch.is_vague() || epoch.mirror.is_some() {
            epoch.health = epoch.health.with(Reason::NotObservable, true);
        } else if knot.epoch.is_vague() || knot.epoch.position.is_none() {
            epoch.health = Health::GOOD;
        }
        parts[knot.part].push(epoch);
    }
    Ok(Smoothed { parts, biases: solved.biases, common: solved.common })
}
