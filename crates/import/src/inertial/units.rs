//! Which units a log is in: what is claimed, if the data agree; what the data say, if nothing is claimed.

use super::columns::Claim;
use super::conclusion::Source;
use super::motion::{Axes, Motion};
use super::raw::Raw;
use super::rest::{Rest, length_of, median};
use crate::error::Error;
use crate::unit::{Quantity, STANDARD_GRAVITY, Unit, counts};

/// Fewer samples are no evidence against what is usual.
const FEWEST: usize = 20;
/// Rates of inertial sensors, Hz; a clock's unit that gives another one is not taken for what is not said.
const RATES: (f64, f64) = (9.9, 10_100.0);
/// Rates that no unit which is said or usual may give, Hz.
const ABSURD_RATES: (f64, f64) = (1.1, 20_000.0);
/// How far the norm at rest may be from a unit's: sensors are off by some percent, the units by a factor of two.
const NORM: f64 = 0.15;
/// So far it contradicts what is said.
const WRONG_NORM: f64 = 1.5;
/// A log without gravity has so much of it at most.
const NO_GRAVITY: f64 = 0.3;
/// The scale that wins leaves no more than this in disagreement, …
const AGREEMENT: f64 = 0.15;
/// … and every other one leaves so many times as much, …
const CLEAR: f64 = 2.0;
/// … three times as much if it is the one that was said or is usual.
const AGAINST: f64 = 3.0;
/// Fewer stretches of motion tell nothing.
const FEWEST_STRETCHES: usize = 2;
/// Other axes must explain the motion so many times as well, in so many stretches, to accuse those of the log.
const OTHER_AXES: f64 = 1.6;
const FEWEST_FOR_AXES: usize = 4;
/// So much disagreement is no recording of one sensor in these units.
const HOPELESS: f64 = 0.4;
/// So little disagreement accuses no axes.
const SURE: f64 = 0.02;

/// Which option decides.
const OPTIONS: [&str; 3] = [
    "--units acc=m/s2 (g, mg, 16384lsb, …)",
    "--units gyro=rad/s (deg/s, 131lsb, …)",
    "--units t=s (ms, us, ns)",
];

/// The units of acceleration, rate and time, and what told them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Units {
    pub(crate) units: [Unit; 3],
    pub(crate) sources: [Source; 3],
}

/// Decides the units of samples in order.
///
/// # Errors
/// [`Error::Undecided`] where the data do not tell what nobody says, or contradict what is said.
pub(crate) fn decide(
    raw: &[Raw],
    claims: &[Claim; 3],
    axes_are_said: bool,
) -> Result<Units, Error> {
    let [acceleration, rate, time] = claims;
    let usual = median(
        raw.windows(2).map(|pair| pair[1].time - pair[0].time).filter(|&step| step > 0.0).collect(),
    );
    let times = times(time, usual, raw.len())?;
    let evidence = Evidence::find(raw, usual, &times);
    let (force, force_source) = force(acceleration, evidence.rest.as_ref(), raw)?;
    let rates = rates(rate);
    let contradicted = [(acceleration, force_source), (time, times.source)]
        .into_iter()
        .any(|(claim, source)| matches!(claim, Claim::Usual(..)) && source == Source::Data);
    let ((rate_unit, rate_source), (time_unit, time_source)) =
        evidence.turns(&rates, &times, rate, contradicted)?;
    let scale = rate_unit.scale * time_unit.scale;
    if !axes_are_said && rate_source != Source::Option {
        evidence.axes(scale)?;
    }
    Ok(Units {
        units: [force, rate_unit, time_unit],
        sources: [force_source, rate_source, time_source],
    })
}

/// Units that a quantity may have, the likeliest first, and what tells that one.
struct Candidates {
    units: Vec<Unit>,
    source: Source,
    /// Whether the first one is said or usual, and not contradicted yet.
    is_claimed: bool,
}

/// The units that the clock may have.
fn times(claim: &Claim, usual: f64, samples: usize) -> Result<Candidates, Error> {
    let rate = |unit: &Unit| 1.0 / (usual * unit.scale);
    let is_absurd =
        |unit: &Unit| samples >= FEWEST && !(ABSURD_RATES.0..=ABSURD_RATES.1).contains(&rate(unit));
    let plausible = || {
        let all =
            ["s", "ms", "us", "ns"].into_iter().filter_map(|name| Unit::read(Quantity::Time, name));
        all.filter(|unit| (RATES.0..=RATES.1).contains(&rate(unit))).collect::<Vec<_>>()
    };
    let said =
        |unit: &Unit, source| Candidates { units: vec![unit.clone()], source, is_claimed: true };
    match claim {
        Claim::Said(unit, source) if *source == Source::Option || !is_absurd(unit) => {
            Ok(said(unit, *source))
        }
        Claim::Said(unit, source) => {
            let problem = format!(
                "expected samples at 1 to 20000 Hz, found {:.3e} Hz with time in {unit} ({source})",
                rate(unit)
            );
            Err(Error::undecided(problem, OPTIONS[2]))
        }
        Claim::Usual(unit, source) if samples < FEWEST => Ok(said(unit, *source)),
        Claim::Usual(unit, source) => {
            let others = plausible().into_iter().filter(|other| other != unit);
            let is_claimed = !is_absurd(unit);
            let units: Vec<_> =
                is_claimed.then(|| unit.clone()).into_iter().chain(others).collect();
            let source = if is_claimed { *source } else { Source::Data };
            // Nothing fits better: it stays.
            if units.is_empty() {
                return Ok(said(unit, source));
            }
            Ok(Candidates { units, source, is_claimed })
        }
        Claim::None => {
            let units = plausible();
            if units.is_empty() {
                let problem = format!(
                    "expected samples at 10 to 10000 Hz in s, ms, µs or ns, found a spacing of {usual:.3e}"
                );
                return Err(Error::undecided(problem, OPTIONS[2]));
            }
            Ok(Candidates { units, source: Source::Data, is_claimed: false })
        }
    }
}

/// The units that a gyroscope may have.
fn rates(claim: &Claim) -> Vec<Unit> {
    let names =
        ["rad/s", "deg/s", "mdps"].into_iter().filter_map(|name| Unit::read(Quantity::Rate, name));
    // Of ranges of ±250, 500, 1000 and 2000 °/s in 16 bits.
    let ranges =
        [131.0, 65.5, 32.8, 16.4].into_iter().filter_map(|each| counts(Quantity::Rate, each));
    let others = names.chain(ranges);
    match claim {
        Claim::Said(unit, _) => vec![unit.clone()],
        Claim::Usual(unit, _) => {
            let others = others.filter(|other| other != unit);
            std::iter::once(unit.clone()).chain(others).collect()
        }
        Claim::None => others.collect(),
    }
}

/// The unit of the accelerometer, by what it shows at rest.
fn force(claim: &Claim, rest: Option<&Rest>, raw: &[Raw]) -> Result<(Unit, Source), Error> {
    let fits = |norm: f64| {
        let names = ["m/s2", "g", "mg"]
            .into_iter()
            .filter_map(|name| Unit::read(Quantity::Acceleration, name));
        let ranges = [16384.0, 8192.0, 4096.0, 2048.0];
        let ranges = ranges.into_iter().filter_map(|each| counts(Quantity::Acceleration, each));
        names.chain(ranges).find(|unit| (norm * unit.scale / STANDARD_GRAVITY - 1.0).abs() <= NORM)
    };
    let (unit, source) = match claim {
        Claim::Said(unit, source) | Claim::Usual(unit, source) => (unit, *source),
        Claim::None => {
            let Some(rest) = rest else {
                let problem =
                    "expected moments of rest, which tell the accelerometer's unit, found none";
                return Err(Error::undecided(problem, OPTIONS[0]));
            };
            let problem = || {
                format!(
                    "expected an accelerometer that shows 1 g at rest in m/s², g, mg or counts, found {:.4}",
                    rest.norm
                )
            };
            return match fits(rest.norm) {
                Some(unit) => Ok((unit, Source::Data)),
                None => Err(Error::undecided(problem(), OPTIONS[0])),
            };
        }
    };
    if source == Source::Option {
        return Ok((unit.clone(), source));
    }
    let Some(rest) = rest else {
        let norm = median(raw.iter().map(|raw| length_of(raw.force)).collect()) * unit.scale.abs();
        if raw.len() >= FEWEST && norm > 0.0 && norm < NO_GRAVITY * STANDARD_GRAVITY {
            let problem = format!(
                "expected about 9.81 m/s² most of the time, found {norm:.3} (gravity taken out?)"
            );
            return Err(Error::undecided(problem, OPTIONS[0]));
        }
        return Ok((unit.clone(), source));
    };
    let share = rest.norm * unit.scale.abs() / STANDARD_GRAVITY;
    if (1.0 / WRONG_NORM..=WRONG_NORM).contains(&share) {
        return Ok((unit.clone(), source));
    }
    match fits(rest.norm) {
        Some(other) if matches!(claim, Claim::Usual(..)) => Ok((other, Source::Data)),
        _ => {
            let problem = format!(
                "expected 9.81 m/s² at rest, found {:.4} with acceleration in {unit} ({source})",
                share * STANDARD_GRAVITY
            );
            Err(Error::undecided(problem, OPTIONS[0]))
        }
    }
}

/// What the motion says.
struct Evidence {
    rest: Option<Rest>,
    motion: Option<Motion>,
}

type Told = (Unit, Source);

impl Evidence {
    fn find(raw: &[Raw], usual: f64, times: &Candidates) -> Self {
        // With the first unit that shows rest: it only says how long windows are.
        let mut steps =
            times.units.iter().map(|unit| usual * unit.scale).filter(|step| step.is_finite());
        let found = steps.find_map(|step| Some((Rest::find(raw, step)?, step)));
        let motion = found.as_ref().map(|(rest, step)| Motion::find(raw, rest, usual, *step));
        let motion = motion.filter(|motion| motion.count() >= FEWEST_STRETCHES);
        Self { rest: found.map(|(rest, _)| rest), motion }
    }

    /// The units of rate and time, by how the turns carry gravity along.
    fn turns(
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
                let problem =
                    "expected turns from which the gyroscope's unit can be told, found too few";
                Err(Error::undecided(problem, OPTIONS[1]))
            }
            _ => {
                let problem =
                    "expected turns from which the unit of time can be told, found too few";
                Err(Error::undecided(problem, OPTIONS[2]))
            }
        }
    }

    /// The pair of units that explains the motion, and far better than every other.
    fn winner(&self, rates: &[Unit], times: &[Unit]) -> Option<(usize, usize)> {
        let motion = self.motion.as_ref()?;
        let error = |scale: f64| motion.error(scale, Axes::SAME);
        let pairs =
            (0..rates.len()).flat_map(|rate| (0..times.len()).map(move |time| (rate, time)));
        let scale = |(rate, time): (usize, usize)| rates[rate].scale * times[time].scale;
        let errors: Vec<_> = pairs.map(|pair| (pair, error(scale(pair)))).collect();
        let &(best, least) = errors.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_clear = errors.iter().all(|&(pair, error)| pair == best || error >= CLEAR * least);
        // Half and double are no unit's, but the truth may lie there.
        let is_valley =
            [0.5, 2.0].iter().all(|factor| error(factor * scale(best)) >= CLEAR * least);
        (least <= AGREEMENT && is_clear && is_valley).then_some(best)
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

    /// Refuses units that are said if another one of the gyroscope explains the motion far better.
    fn contradiction(&self, said: &Unit, source: Source, times: &Candidates) -> Result<(), Error> {
        if source == Source::Option || times.source == Source::Option {
            return Ok(());
        }
        let usual = Claim::Usual(Unit::new(said.scale, said.name.clone()), source);
        let all = rates(&usual);
        match self.winner(&all, &times.units) {
            Some(winner)
                if winner != (0, 0) && self.is_better(winner, (0, 0), &all, &times.units) =>
            {
                let problem = format!(
                    "expected turns that carry gravity along with the angular rate in {said} ({source}), found them in {}",
                    all[winner.0]
                );
                Err(Error::undecided(problem, OPTIONS[1]))
            }
            _ => Ok(()),
        }
    }

    /// Refuses axes of the gyroscope that are swapped or turned round against the accelerometer's.
    fn axes(&self, scale: f64) -> Result<(), Error> {
        let Some(motion) = self.motion.as_ref().filter(|motion| motion.count() >= FEWEST_FOR_AXES)
        else {
            return Ok(());
        };
        let own = motion.error(scale, Axes::SAME);
        if own <= SURE {
            return Ok(());
        }
        let others = Axes::all().map(|axes| (axes, motion.error(scale, axes)));
        let Some((axes, error)) = others.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Ok(()) };
        if error > AGREEMENT || own < OTHER_AXES * error {
            return if own < HOPELESS { Ok(()) } else { Err(hopeless(own)) };
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

fn hopeless(error: f64) -> Error {
    let problem = format!(
        "expected turns that carry gravity along, found them {:.0} % of gravity apart in these units",
        100.0 * error
    );
    Error::undecided(problem, "--units acc=…,gyro=…,t=…")
}
