//! Decides the units of a log: what is claimed, if the data agree; what the data show, if nothing is claimed.

use super::columns::Claim;
use super::conclusion::Source;
use super::evidence::Evidence;
use super::raw::Raw;
use super::rest::{Rest, length_of, median};
use crate::clock::refuse_times_of_day;
use crate::error::Error;
use crate::unit::{Quantity, STANDARD_GRAVITY, Unit, counts};

/// The smallest number of samples that count as evidence against a usual unit.
const FEWEST: usize = 20;
/// Plausible rates of inertial sensors, Hz; without a stated unit only units of the clock that yield such a rate are
/// considered.
const RATES: (f64, f64) = (9.9, 10_100.0);
/// The rates that even a stated or usual unit must yield, Hz.
const ABSURD_RATES: (f64, f64) = (1.1, 20_000.0);
/// The largest relative deviation of the norm at rest from a unit's gravity: sensors are off by some percent, units by
/// a factor of two.
const NORM: f64 = 0.15;
/// The factor by which the norm at rest must differ from gravity to contradict a stated or usual unit.
const WRONG_NORM: f64 = 1.5;
/// The largest norm, as a share of gravity, of a log from which gravity was removed.
const NO_GRAVITY: f64 = 0.3;
/// The name of a thousandth of gravity as a unit.
const MILLIGRAVITY: &str = "mg";
/// The option that decides each unit: of acceleration, rate and time.
pub(super) const OPTIONS: [&str; 3] = [
    "--units acc=m/s2 (g, mg, 16384lsb, …)",
    "--units gyro=rad/s (deg/s, 131lsb, …)",
    "--units t=s (ms, us, ns)",
];

/// The units of acceleration, rate and time, and the evidence for each.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Units {
    pub(crate) units: [Unit; 3],
    pub(crate) sources: [Source; 3],
}

/// Decides the units of samples that are in order.
///
/// # Errors
/// [`Error::Undecided`] where the data do not settle an unstated unit, or contradict a stated one.
pub(crate) fn decide(
    raw: &[Raw],
    claims: &[Claim; 3],
    axes_are_said: bool,
) -> Result<Units, Error> {
    let [acceleration, rate, time] = claims;
    let usual = median(
        raw.windows(2).map(|pair| pair[1].time - pair[0].time).filter(|&step| step > 0.0).collect(),
    );
    if !matches!(time, Claim::Said(_, Source::Option)) {
        let all: Vec<_> = raw.iter().map(|sample| sample.time).collect();
        refuse_times_of_day(&all, OPTIONS[2])?;
    }
    let times = times(time, usual, raw.len())?;
    let evidence = Evidence::find(raw, usual, &times);
    let (force, force_source) = force(acceleration, evidence.rest.as_ref(), raw)?;
    let rates = rates(rate, force.name == MILLIGRAVITY);
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

/// The units that a quantity may have, the likeliest first, and the evidence for that one.
pub(super) struct Candidates {
    pub(super) units: Vec<Unit>,
    pub(super) source: Source,
    /// Whether the first one is stated or usual, and not contradicted yet.
    pub(super) is_claimed: bool,
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
            // No other unit fits better, so the usual one stays.
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

/// The units that a gyroscope may have, beside an accelerometer `in_milligravity` or in another unit.
pub(super) fn rates(claim: &Claim, in_milligravity: bool) -> Vec<Unit> {
    // Autopilots (MAVLink's RAW_IMU) have both in thousandths.
    let thousandths = in_milligravity.then_some("mrad/s");
    let names = ["rad/s", "deg/s", "mdps"].into_iter().chain(thousandths);
    let names = names.filter_map(|name| Unit::read(Quantity::Rate, name));
    // Ranges of ±250, 500, 1000 and 2000 °/s in 16 bits.
    let ranges =
        [131.0, 65.5, 32.8, 16.4].into_iter().filter_map(|each| counts(Quantity::Rate, each));
    // The same ranges of ST's sensors, whose steps are round instead.
    let steps = [0.00875, 0.0175, 0.035, 0.07]
        .map(|step: f64| Unit::new(step.to_radians(), format!("counts of {step} °/s")));
    let others = names.chain(ranges).chain(steps);
    match claim {
        Claim::Said(unit, _) => vec![unit.clone()],
        Claim::Usual(unit, _) => {
            let others = others.filter(|other| other != unit);
            std::iter::once(unit.clone()).chain(others).collect()
        }
        Claim::None => others.collect(),
    }
}

/// The unit of the accelerometer, from its norm at rest.
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
