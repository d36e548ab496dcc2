//! What the rotations between moments of rest tell about units and axes.

use super::columns::Claim;
use super::conclusion::Source;
use super::motion::{Axes, Motion};
use super::raw::Raw;
use super::rest::Rest;
use super::units::{Candidates, OPTIONS, rates};
use crate::error::Error;
use crate::unit::Unit;

/// The largest disagreement at which a scale may win.
const AGREEMENT: f64 = 0.15;
/// The ratio by which the disagreement of every other scale must exceed the winner's.
const CLEAR: f64 = 2.0;
/// The same ratio for a scale that is so near the winner's that its disagreement cannot be much larger.
const CLEAR_OF_NEAR: f64 = 1.3;
/// The ratio of two scales below which they are near: two makers' steps for the same range are 15 % apart.
const NEAR: f64 = 1.25;
/// The ratio by which the disagreement of the stated or usual scale must exceed the winner's for that scale to be
/// overruled.
const AGAINST: f64 = 3.0;
/// The smallest number of stretches of motion from which anything is concluded.
const FEWEST_STRETCHES: usize = 2;
/// The ratio by which the disagreement at half and at twice the winning scale must exceed the winner's, so that the
/// truth does not lie between two units.
const VALLEY: f64 = 1.5;
/// The factor by which other axes must explain the motion better before those of the log are refused.
const OTHER_AXES: f64 = 1.8;
/// The number of stretches from which `OTHER_AXES` applies; with fewer, the second, larger factor does.
const ENOUGH_FOR_AXES: usize = 5;
const OTHER_AXES_OF_FEW: f64 = 3.0;
/// The disagreement from which a log cannot be a recording of one sensor in these units; the second value applies to
/// few stretches.
const HOPELESS: f64 = 0.4;
const HOPELESS_OF_FEW: f64 = 0.7;
/// The disagreement up to which the axes are accepted without trying others.
const SURE: f64 = 0.02;

/// The evidence that rest and motion give.
pub(super) struct Evidence {
    pub(super) rest: Option<Rest>,
    motion: Option<Motion>,
}

type Told = (Unit, Source);

impl Evidence {
    pub(super) fn find(raw: &[Raw], usual: f64, times: &Candidates) -> Self {
        // The first unit in which rest is found is used: it only determines the length of the windows.
        let mut steps =
            times.units.iter().map(|unit| usual * unit.scale).filter(|step| step.is_finite());
        let found = steps.find_map(|step| Some((Rest::find(raw, step)?, step)));
        let motion = found.as_ref().map(|(rest, step)| Motion::find(raw, rest, usual, *step));
        let motion = motion.filter(|motion| motion.count() > 0);
        Self { rest: found.map(|(rest, _)| rest), motion }
    }

    /// The units of rate and time that carry gravity along best.
    pub(super) fn turns(
        &self,
        rates: &[Unit],
        times: &Candidates,
        claim: &Claim,
        contradicted: bool,
    ) -> Result<(Told, Told), Error> {
        let rate_source = match claim {
            Claim::Said(_, source) | Claim::Usual(_, source) => *source,
            Claim::None => Source::Data,
        };
        let own = (claim != &Claim::None && (times.is_claimed || times.units.len() == 1))
            .then_some((0, 0));
        let winner = self.winner(rates, &times.units);
        let told = |(rate, time): (usize, usize)| {
            let rate_source = if rate == 0 { rate_source } else { Source::Data };
            let time_source = if time == 0 { times.source } else { Source::Data };
            ((rates[rate].clone(), rate_source), (times.units[time].clone(), time_source))
        };
        let is_said = rates.len() == 1 && times.units.len() == 1;
        match (own, winner) {
            (Some(_), _) if is_said => {
                self.contradiction(&rates[0], rate_source, times).map(|()| told((0, 0)))
            }
            (Some(own), Some(winner))
                if winner == own || self.is_better(winner, own, rates, &times.units) =>
            {
                Ok(told(winner))
            }
            (Some(own), _) if !contradicted => Ok(told(own)),
            (None, Some(winner)) => Ok(told(winner)),
            (_, _) if rates.len() > 1 => {
                let problem = match self.near(rates, &times.units) {
                    Some((one, other)) => format!(
                        "expected turns that tell a gyroscope in {} from one in {}, found too few",
                        rates[one], rates[other]
                    ),
                    None => {
                        "expected turns from which the gyroscope's unit can be told, found too few"
                            .to_owned()
                    }
                };
                Err(Error::undecided(problem, OPTIONS[1]))
            }
            _ => {
                let problem =
                    "expected turns from which the unit of time can be told, found too few";
                Err(Error::undecided(problem, OPTIONS[2]))
            }
        }
    }

    /// The pair of units that explains the motion far better than every other.
    fn winner(&self, rates: &[Unit], times: &[Unit]) -> Option<(usize, usize)> {
        let motion = self.motion.as_ref().filter(|motion| motion.count() >= FEWEST_STRETCHES)?;
        let error = |scale: f64| motion.error(scale, Axes::SAME);
        let pairs =
            (0..rates.len()).flat_map(|rate| (0..times.len()).map(move |time| (rate, time)));
        let scale = |(rate, time): (usize, usize)| rates[rate].scale * times[time].scale;
        let errors: Vec<_> = pairs.map(|pair| (pair, error(scale(pair)))).collect();
        let &(best, least) = errors.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let clear = |pair| if is_near(scale(pair), scale(best)) { CLEAR_OF_NEAR } else { CLEAR };
        let is_clear =
            errors.iter().all(|&(pair, error)| pair == best || error >= clear(pair) * least);
        // No unit lies at half or twice the scale, but the truth may.
        let is_valley =
            [0.5, 2.0].iter().all(|factor| error(factor * scale(best)) >= VALLEY * least);
        (least <= AGREEMENT && is_clear && is_valley).then_some(best)
    }

    /// The unit of rate that explains the motion best, and one that is too near to it to be excluded.
    fn near(&self, rates: &[Unit], times: &[Unit]) -> Option<(usize, usize)> {
        let motion = self.motion.as_ref().filter(|motion| motion.count() >= FEWEST_STRETCHES)?;
        let [time] = times else { return None };
        let scale = |rate: usize| rates[rate].scale * time.scale;
        let error = |rate: usize| motion.error(scale(rate), Axes::SAME);
        let best = (0..rates.len()).min_by(|a, b| error(*a).total_cmp(&error(*b)))?;
        let is_rival = |&rate: &usize| {
            let is_other = rate != best && is_near(scale(rate), scale(best));
            is_other && error(rate) < CLEAR_OF_NEAR * error(best)
        };
        let rival = (0..rates.len()).find(is_rival)?;
        (error(best) <= AGREEMENT).then_some((best, rival))
    }

    fn is_better(
        &self,
        winner: (usize, usize),
        own: (usize, usize),
        rates: &[Unit],
        times: &[Unit],
    ) -> bool {
        let scale = |(rate, time): (usize, usize)| rates[rate].scale * times[time].scale;
        self.motion.as_ref().is_some_and(|motion| {
            let [winner, own] = [winner, own].map(|pair| motion.error(scale(pair), Axes::SAME));
            own >= AGAINST * winner
        })
    }

    /// Refuses a stated unit if another unit of the gyroscope explains the motion far better.
    fn contradiction(&self, said: &Unit, source: Source, times: &Candidates) -> Result<(), Error> {
        if source == Source::Option || times.source == Source::Option {
            return Ok(());
        }
        let usual = Claim::Usual(Unit::new(said.scale, said.name.clone()), source);
        let all = rates(&usual, false);
        match self.winner(&all, &times.units) {
            Some(winner)
                if winner != (0, 0) && self.is_better(winner, (0, 0), &all, &times.units) =>
            {
                let problem = format!(
                    "expected an angular rate in {said} ({source}), found one that turns as gravity does in the accelerometer in {}",
                    all[winner.0]
                );
                Err(Error::undecided(problem, OPTIONS[1]))
            }
            _ => Ok(()),
        }
    }

    /// Refuses axes of the gyroscope that are swapped or reversed against the accelerometer's.
    pub(super) fn axes(&self, scale: f64) -> Result<(), Error> {
        let Some(motion) = &self.motion else { return Ok(()) };
        let count = motion.count();
        let is_enough = count >= ENOUGH_FOR_AXES;
        let (clearly, hopelessly) =
            if is_enough { (OTHER_AXES, HOPELESS) } else { (OTHER_AXES_OF_FEW, HOPELESS_OF_FEW) };
        let own = motion.error(scale, Axes::SAME);
        if own <= SURE {
            return Ok(());
        }
        let others = Axes::all().map(|axes| (axes, motion.error(scale, axes)));
        let Some((axes, error)) = others.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(()) };
        if error > AGREEMENT || own < clearly * error || count < FEWEST_STRETCHES {
            return if own < hopelessly { Ok(()) } else { Err(hopeless(own)) };
        }
        let name = |axis: usize| {
            let sign = if axes.signs[axis] < 0.0 { "-" } else { "" };
            format!("{sign}{}", ["gx", "gy", "gz"][axes.from[axis]])
        };
        let [x, y, z] = [0, 1, 2].map(name);
        Err(Error::undecided(
            format!(
                "expected a gyroscope with the accelerometer's axes, found one that fits as {x}, {y}, {z}"
            ),
            format!("--columns gx={x},gy={y},gz={z} (with the log's own names)"),
        ))
    }
}

fn is_near(scale: f64, other: f64) -> bool {
    (1.0 / NEAR..NEAR).contains(&(scale / other))
}

fn hopeless(error: f64) -> Error {
    let problem = format!(
        "expected an angular rate that turns as gravity does in the accelerometer, found them {:.0} % of gravity apart in these units",
        100.0 * error
    );
    Error::undecided(problem, "--units acc=…,gyro=…,t=…")
}
