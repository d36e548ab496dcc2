//! Recorded flights, and the stretches of them that are used.

use crate::Error;
use crate::parameter::STATES;

/// Longer gaps between samples end a stretch, s.
const LONGEST_GAP_S: f64 = 1.0;
/// Shorter stretches are not used, since they show no mode, s.
const SHORTEST_S: f64 = 5.0;
/// Lowest mean airspeed of a flight, m/s.
const SLOWEST: f64 = 2.0;
/// Smallest standard deviation of an elevator that counts as moving, rad.
const LEAST_ELEVATOR: f64 = 1e-3;
/// Smallest standard deviation of a throttle (0 to 1) that counts as moving.
const LEAST_THROTTLE: f64 = 0.01;
/// Times are rounded to the usual interval divided by this, so that few different steps occur.
const TICKS: f64 = 64.0;

/// The outputs that enter the likelihood: columns of the log, in this order.
pub(crate) const FITTED: [&str; 6] = ["alpha", "q", "V", "theta", "az", "ax"];
pub(crate) const OUTPUTS: usize = FITTED.len();

/// A recorded flight.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Flight {
    /// Times, s.
    pub times: Vec<f64>,
    /// Elevator (rad) and throttle (0 to 1) at these times.
    pub inputs: Vec<[f64; 2]>,
    /// Measurements: for each column a name, and a value or `None` at each time.
    ///
    /// `alpha`, `q`, `V`, `theta` are the states (rad, rad/s, m/s, rad); `az` and `ax` specific forces along the
    /// body's axes down and forwards, m/s² (−9.8 and 0 at rest); `qbar` the dynamic pressure, Pa; `climb` and
    /// `V_ground` the velocity relative to the ground, m/s. Other columns are ignored.
    pub columns: Vec<(String, Vec<Option<f64>>)>,
}

impl Flight {
    /// The column with this name, if it contains any measurement.
    pub(crate) fn column(&self, name: &str) -> Option<&[Option<f64>]> {
        let (_, values) = self.columns.iter().find(|(column, _)| column == name)?;
        values.iter().any(Option::is_some).then_some(values)
    }

    /// The median interval between samples, s.
    pub(crate) fn interval(&self) -> f64 {
        let mut steps: Vec<f64> = self.times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(1.0)
    }

    pub(crate) fn check(&self) -> Result<(), Error> {
        let length = self.times.len();
        if self.inputs.len() != length || self.columns.iter().any(|(_, it)| it.len() != length) {
            return Err(Error::Lengths);
        }
        let measured = self.columns.iter().flat_map(|(_, values)| values.iter().flatten());
        let mut numbers = self.times.iter().chain(self.inputs.iter().flatten()).chain(measured);
        if numbers.any(|number| !number.is_finite()) {
            return Err(Error::NotFinite);
        }
        if self.times.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err(Error::NotLater);
        }
        let required = STATES[1..].iter().find(|name| self.column(name).is_none());
        if let Some(name) = required {
            return Err(Error::Missing(name));
        }
        if self.column("alpha").is_none() && self.column("az").is_none() {
            return Err(Error::NoLift);
        }
        Ok(())
    }

    /// The stretches without gaps that are long enough, as ranges of samples.
    fn stretches(&self) -> Vec<(usize, usize)> {
        let breaks = (1..self.times.len())
            .filter(|&at| self.times[at] - self.times[at - 1] > LONGEST_GAP_S)
            .chain([self.times.len()]);
        let mut from = 0;
        let all: Vec<_> = breaks.map(|to| (std::mem::replace(&mut from, to), to)).collect();
        all.into_iter().filter(|&range| self.length(range) >= SHORTEST_S).collect()
    }

    fn length(&self, (from, to): (usize, usize)) -> f64 {
        if to > from { self.times[to - 1] - self.times[from] } else { 0.0 }
    }

    /// The samples between two shares of the flight.
    pub(crate) fn part(&self, from: f64, to: f64) -> Self {
        let at = |share: f64| (share * self.times.len() as f64).round() as usize;
        let range = at(from)..at(to);
        let column = |(name, values): &(String, Vec<Option<f64>>)| {
            (name.clone(), values[range.clone()].to_vec())
        };
        Self {
            times: self.times[range.clone()].to_vec(),
            inputs: self.inputs[range.clone()].to_vec(),
            columns: self.columns.iter().map(column).collect(),
        }
    }
}

/// The operating point from which deviations are counted: the mean of all flights.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Reference {
    pub(crate) state: [f64; 4],
    pub(crate) input: [f64; 2],
    /// Mean specific forces az and ax, m/s².
    pub(crate) force: [f64; 2],
    /// Which of the columns [`FITTED`] are available.
    pub(crate) has: [bool; OUTPUTS],
    pub(crate) throttle_moves: bool,
    /// The smallest of the flights' median intervals, s.
    pub(crate) interval: f64,
}

/// The mean and the standard deviation.
pub(crate) fn spread(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count().max(1) as f64;
    let mean = values.clone().sum::<f64>() / count;
    (mean, (values.map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt())
}

impl Reference {
    pub(crate) fn of(flights: &[Flight]) -> Result<Self, Error> {
        if flights.is_empty() {
            return Err(Error::Missing(STATES[1]));
        }
        flights.iter().try_for_each(Flight::check)?;
        let has = FITTED.map(|name| flights.iter().all(|flight| flight.column(name).is_some()));
        if !has[0] && !has[4] {
            return Err(Error::NoLift);
        }
        let mean = |name: &str| {
            let values =
                flights.iter().filter_map(|flight| flight.column(name)).flatten().flatten();
            spread(values.copied()).0
        };
        let input = |which: usize| {
            spread(flights.iter().flat_map(|flight| &flight.inputs).map(move |input| input[which]))
        };
        let (elevator, moved) = input(0);
        let (throttle, throttled) = input(1);
        if moved < LEAST_ELEVATOR {
            return Err(Error::NotExcited(moved));
        }
        let [airspeed, theta] = [mean("V"), mean("theta")];
        if airspeed < SLOWEST {
            return Err(Error::NotFlying(airspeed));
        }
        // Without a vane, α is the pitch angle minus the climb angle.
        let climb = (mean("climb") / airspeed).clamp(-0.5, 0.5).asin();
        let alpha = if has[0] { mean("alpha") } else { theta - climb };
        let [az, ax] = [mean("az"), mean("ax")];
        let force = [if has[4] { az } else { -crate::structure::GRAVITY }, ax];
        let interval = flights.iter().map(Flight::interval).fold(f64::MAX, f64::min);
        Ok(Self {
            state: [alpha, mean("q"), airspeed, theta],
            input: [elevator, throttle],
            force,
            has,
            throttle_moves: throttled >= LEAST_THROTTLE,
            interval,
        })
    }
}

/// A stretch of a flight, as deviations from the [`Reference`].
#[derive(Debug, Clone)]
pub(crate) struct Segment {
    /// Times since the beginning of the stretch, s.
    pub(crate) times: Vec<f64>,
    /// Times since the beginning of the stretch, in ticks.
    pub(crate) ticks: Vec<i64>,
    /// Duration of a tick, s.
    pub(crate) tick: f64,
    pub(crate) inputs: Vec<[f64; 2]>,
    pub(crate) measured: Vec<[Option<f64>; OUTPUTS]>,
}

impl Segment {
    /// All stretches of these flights that are long enough.
    pub(crate) fn all(flights: &[Flight], reference: &Reference) -> Result<Vec<Self>, Error> {
        let segments: Vec<_> = flights
            .iter()
            .flat_map(|flight| {
                let stretches = flight.stretches();
                stretches.into_iter().map(move |range| Self::of(flight, range, reference))
            })
            .collect();
        if segments.is_empty() {
            let longest = flights.iter().map(|flight| flight.length((0, flight.times.len())));
            let found_s = longest.fold(0.0, f64::max).min(SHORTEST_S);
            return Err(Error::TooShort { found_s, needed_s: SHORTEST_S });
        }
        Ok(segments)
    }

    fn of(flight: &Flight, (from, to): (usize, usize), reference: &Reference) -> Self {
        let tick = flight.interval() / TICKS;
        let times: Vec<_> = flight.times[from..to].iter().map(|t| t - flight.times[from]).collect();
        let columns = FITTED.map(|name| flight.column(name));
        let [alpha, q, airspeed, theta] = reference.state;
        let [az, ax] = reference.force;
        let origin = [alpha, q, airspeed, theta, az, ax];
        let sample = |at: usize| {
            std::array::from_fn(|output| {
                let value = columns[output].filter(|_| reference.has[output])?[at]?;
                Some(value - origin[output])
            })
        };
        Self {
            ticks: times.iter().map(|time| (time / tick).round() as i64).collect(),
            times,
            tick,
            inputs: flight.inputs[from..to]
                .iter()
                .map(|input| std::array::from_fn(|which| input[which] - reference.input[which]))
                .collect(),
            measured: (from..to).map(sample).collect(),
        }
    }

    /// The median interval between samples, s.
    pub(crate) fn interval(&self) -> f64 {
        TICKS * self.tick
    }

    /// The inputs at a time, interpolated linearly between samples.
    pub(crate) fn input_at(&self, time: f64) -> [f64; 2] {
        let after = self.times.partition_point(|at| *at <= time).clamp(1, self.times.len() - 1);
        let (before, span) = (after - 1, self.times[after] - self.times[after - 1]);
        let share = ((time - self.times[before]) / span).clamp(0.0, 1.0);
        std::array::from_fn(|which| {
            let [a, b] = [self.inputs[before][which], self.inputs[after][which]];
            a + share * (b - a)
        })
    }
}
