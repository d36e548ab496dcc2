//! The whole recording at once: where a tag was, given what was measured before and after.
//!
//! A fixed-interval smoother in the form of nonlinear least squares (Bell, *The iterated Kalman smoother as a Gauss–Newton
//! method*, 1994). Ranges and motion have the tracker's models, but for a velocity that decays more slowly; each anchor's constant error is a parameter of the whole
//! run, and so are the turns' gain and drift of a robot on wheels. Ranges are weighed as Student's distribution has it,
//! with a heavier tail where they are too long; how large their noise is, and how long it lasts, is estimated.

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

/// A part of a recording, and what a tracker made of it, from which the smoother begins.
#[derive(Debug, Clone, Copy)]
pub struct Tracked<'a> {
    /// What the sensors said.
    pub events: &'a [Event],
    /// Where the tracker found the tag, and what became of every range.
    pub trace: &'a Trace,
}

/// What a smoother made of a recording.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Smoothed {
    /// Of each part: of a tag that moves, its trace's epochs; of one that was put down, a single one; none of a part in which
    /// the tracker never found it.
    pub parts: Vec<Vec<Epoch>>,
    /// What each anchor measures too long, m, beyond what was known beforehand and what all of them do, with its standard
    /// deviation, m.
    pub biases: Vec<[f64; 2]>,
    /// What all of them measure too long, m, and what more in 10 m of distance, m, each with its standard deviation.
    pub common: [[f64; 2]; 2],
}

/// Why a recording is not smoothed.
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
    /// What came out is less certain than the tracker's positions, or the tracker tells no standard deviation.
    #[error("it would be less certain than the tracker is")]
    LessCertain,
    /// The anchors are as few as can tell a position, and the way does not tell what all of them measure too long.
    #[error("so few anchors do not tell what all of them measure too long")]
    CommonBias,
    /// What came out contradicts the tracker.
    #[error("it would contradict the tracker by more than twice its standard deviation")]
    Contradicts,
}

/// So many epochs are smoothed together, in about 250 MB with the most anchors.
const MOST_KNOTS: usize = 50_000;
/// By how many of the tracker's standard deviations the smoothed positions may differ from the tracker's, root mean
/// square.
const MOST_SIGMAS: f64 = 2.0;

/// Smooths the parts of a recording together. A static recording is one place a part; else the tag moves.
///
/// # Errors
/// [`Unsmoothed`]: it does not pay, or cannot be relied upon.
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
            // To which side turns are counted: what is more probable.
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

/// Of as few anchors as can tell a position, the way that the tag goes has told what all measure too long if it is known to this
/// share of what was known before: of two recordings of three anchors one has a quarter of it and is better for it, one a half and
/// is worse.
const TOLD: f64 = 0.4;

/// The result, if it is worth more than the tracker's and agrees with it, at most epochs.
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
