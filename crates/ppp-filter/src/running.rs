//! A filter that has a position.

use crate::channel::Channel;
use crate::clock_jump::ClockJump;
use crate::collected::collected;
use crate::consistency::Consistency;
use crate::line::{Line, Row};
use crate::phase_monitor::{PhaseMonitor, is_judged};
use crate::rest::Rest;
use crate::start::CodePosition;
use crate::states::{CLOCK, COMMON, WET};
use crate::{Config, Error, Motion, SatelliteObservation, Slipped, Solution};
use heapless::Vec;
use kestirim_gnss_ppp::{Arc, Constellation, Expected, GpsTime, Receiver, Site, Slip};
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Decision, Measurement};
use kestirim_scalar::Components;
use nalgebra::{SVector, Vector3};

/// Variance of a coordinate from codes, m².
const START_VARIANCE: f64 = 1e4;
/// Variance of the receiver's clock, of which each epoch knows nothing but its codes, m².
const CLOCK_VARIANCE: f64 = 1e6;
/// Variance per second by which the clock of Galileo walks beside that of GPS, m²/s: the receiver's delays are steady,
/// the times of the products are not always.
const OFFSET_WALK: f64 = 1e-8;
/// Variance of an ambiguity from one epoch's code, m².
const AMBIGUITY_VARIANCE: f64 = 1e4;
/// Wet zenith delay of a temperate climate, m.
const WET_DELAY: f64 = 0.1;
/// A receiver that was found farther than this from where the model was linearised is looked at
/// again from there, m: at 20 000 km, 100 m are worth 0.2 mm.
const LINEAR: f64 = 100.0;
/// Largest number of relinearisations of an epoch.
const RELINEARISATIONS: usize = 5;
/// The model is one of the ground: what is found elsewhere is none, distances from the Earth's centre, m.
pub(crate) const GROUND: core::ops::Range<f64> = 6.3e6..6.5e6;

/// Median of the squares of standard normal numbers.
const MEDIAN_OF_SQUARES: f64 = 0.455;

/// Observations of an epoch that are used.
pub(crate) type Lines<'a, 'b, const N: usize> = Vec<(&'a SatelliteObservation<'b>, Line), N>;
/// Decisions about each line's code and phase.
pub(crate) type Decisions<const N: usize> = Vec<[Decision<f64>; 2], N>;

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Running<const N: usize> {
    pub(crate) estimate: Gaussian<f64, N>,
    pub(crate) time: GpsTime,
    /// The shortest time between two epochs so far, s.
    pub(crate) interval: Option<f64>,
    /// By the state that is their ambiguity.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    channels: [Option<Channel>; N],
    /// The state that is the clock of Galileo beside that of GPS, both as the receiver has them, from the first
    /// satellite of Galileo on.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "state::<_, N>"))]
    offset: Option<usize>,
    pub(crate) consistency: Consistency,
    pub(crate) rest: Rest,
    /// By how many milliseconds the phases are ahead of the codes since the beginning.
    ahead: i32,
    /// The jump of the present epoch.
    pub(crate) jump: Option<ClockJump>,
}

/// A state that there is, or none.
#[cfg(feature = "serde")]
fn state<'de, D: serde::Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<Option<usize>, D::Error> {
    let state = <Option<usize> as serde::Deserialize>::deserialize(deserializer)?;
    if state.is_none_or(|index| index < N) {
        Ok(state)
    } else {
        Err(serde::de::Error::custom("a state that there is not"))
    }
}

impl<const N: usize> Running<N> {
    /// Starts at the position of an epoch's codes.
    pub(crate) fn start(time: GpsTime, start: &CodePosition, config: &Config) -> Self {
        let mut mean = SVector::<f64, N>::zeros();
        let mut variances = [0.0; N];
        let [x, y, z] = *start.position.as_array();
        let known = [
            (x, START_VARIANCE),
            (y, START_VARIANCE),
            (z, START_VARIANCE),
            (start.clock, CLOCK_VARIANCE),
            (WET_DELAY, config.wet_delay * config.wet_delay),
        ];
        let places = mean.as_array_mut().iter_mut().zip(&mut variances);
        for ((mean, variance), known) in places.zip(known) {
            (*mean, *variance) = known;
        }
        let estimate = Gaussian::new(mean, Covariance::from_variances(&variances));
        Self {
            estimate,
            time,
            interval: None,
            channels: [None; N],
            offset: None,
            consistency: Consistency::default(),
            rest: Rest::default(),
            ahead: 0,
            jump: None,
        }
    }

    /// Predicts to the time of an epoch, which comes later (`direction` 1) or earlier (−1).
    pub(crate) fn advance(
        &mut self,
        time: GpsTime,
        direction: f64,
        config: &Config,
    ) -> Result<(), Error> {
        let elapsed = direction * time.since(self.time);
        if elapsed <= 0.0 || elapsed.is_nan() {
            return Err(Error::TimeNotAdvancing);
        }
        self.time = time;
        self.interval = Some(self.interval.map_or(elapsed, |interval| interval.min(elapsed)));
        if let Motion::Kinematic { process_noise } = config.motion {
            for coordinate in 0..3 {
                self.estimate.add_variance_at(coordinate, process_noise * elapsed)?;
            }
        }
        self.estimate.add_variance_at(WET, config.wet_delay_walk * elapsed)?;
        if let Some(offset) = self.offset {
            self.estimate.add_variance_at(offset, OFFSET_WALK * elapsed)?;
        }
        Ok(())
    }

    /// Takes in the observations of the present time.
    pub(crate) fn observe(
        &mut self,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
        config: &Config,
    ) -> Result<Solution<N>, Error> {
        let mut site = Site::new(receiver, &self.position(), self.time);
        self.jump = self.clock_jump(observations, config);
        if let Some(ClockJump::Milliseconds(milliseconds)) = self.jump {
            self.ahead = self.ahead.saturating_add(milliseconds);
        }
        let known = self.offset;
        let mut lines = self.lines(&site, observations, config);
        if lines.len() < 4 {
            return Err(Error::TooFewSatellites);
        }
        self.set_clocks(&lines, known)?;
        for (_, line) in lines.iter().filter(|(_, line)| line.slipped.is_some()) {
            let ambiguity = line.phase - line.code;
            self.estimate.reset_at(line.state, ambiguity, AMBIGUITY_VARIANCE)?;
        }
        let contradicted = |line: &&Line| line.slipped == Some(Slipped::Contradicted);
        let anew = lines.iter().map(|(_, line)| line).filter(contradicted).count();
        self.rest.restart(anew, lines.len());
        let mut decisions = collected(lines.iter().map(|_| [Decision::NONE; 2]));
        self.settle(receiver, &mut site, &mut lines, &mut decisions, config)?;
        self.monitor(&lines, &decisions, config);
        self.consistency.update(decisions.as_flattened().iter());
        Ok(self.solution(&site, &lines, &decisions, config))
    }

    /// Begins the receiver's clock anew at the median code, and its offset to Galileo's time if that was not `known`.
    fn set_clocks(&mut self, lines: &Lines<'_, '_, N>, known: Option<usize>) -> Result<(), Error> {
        let codes = |of_galileo: bool| -> Vec<f64, N> {
            let of = lines.iter().map(|(_, line)| line);
            collected(of.filter(|it| it.offset.is_some() == of_galileo).map(|line| line.code))
        };
        let (gps, galileo) = (codes(false), codes(true));
        let [of_gps, of_galileo] = [&gps, &galileo].map(|codes| median(codes, |code| *code));
        let offset = known.map_or(0.0, |state| self.state(state));
        let clock = if gps.is_empty() { of_galileo - offset } else { of_gps };
        if let (Some(state), None) = (self.offset, known) {
            self.estimate.reset_at(state, of_galileo - clock, CLOCK_VARIANCE)?;
        }
        Ok(self.estimate.reset_at(CLOCK, clock, CLOCK_VARIANCE)?)
    }

    /// Updates with the lines, and again from nearer the solution if that was far from where they
    /// were linearised.
    fn settle<'r>(
        &mut self,
        receiver: &Receiver<'r>,
        site: &mut Site<'r>,
        lines: &mut Lines<'_, '_, N>,
        decisions: &mut Decisions<N>,
        config: &Config,
    ) -> Result<(), Error> {
        let predicted = self.estimate;
        let expected = self.position();
        let deviation = self.deviation();
        let mut linearised = expected;
        for _ in 0..RELINEARISATIONS {
            self.estimate = predicted;
            self.update(lines, &(expected - linearised), decisions, config)?;
            let found = self.position();
            if (found - linearised).norm() < LINEAR {
                if !GROUND.contains(&found.norm()) {
                    return Err(Error::Contradictory);
                }
                self.rest.follow(&expected, deviation, &found);
                return Ok(());
            }
            *site = Site::new(receiver, &found, self.time);
            for (observation, line) in &mut *lines {
                line.relinearise(observation, site);
            }
            linearised = found;
        }
        Err(Error::Contradictory)
    }

    /// One update with all lines; `offset` is from where they are linearised to the prediction.
    fn update(
        &mut self,
        lines: &Lines<'_, '_, N>,
        offset: &Vector3<f64>,
        decisions: &mut Decisions<N>,
        config: &Config,
    ) -> Result<(), Error> {
        let rows: Vec<Row, N> = collected(lines.iter().map(|(_, line)| line.row()));
        let measurements = lines.iter().zip(&rows).map(|((_, line), row)| {
            let common = row.split_last().map_or(&row[..0], |(_, common)| common);
            let [code, phase] = line.innovations(&self.estimate.mean, offset);
            [
                Measurement { row: common, innovation: code, variance: line.code_variance },
                Measurement {
                    row,
                    innovation: phase,
                    variance: line.phase_variance * line.phase_noise + line.clock_variance,
                },
            ]
        });
        let measurements: Vec<_, N> = collected(measurements);
        config.estimator.robust.update(
            &mut self.estimate,
            measurements.as_flattened(),
            decisions.as_flattened_mut(),
        )?;
        Ok(())
    }

    /// Updates the phases' monitors. An error common to all phases is no noise of any one.
    fn monitor(&mut self, lines: &Lines<'_, '_, N>, decisions: &Decisions<N>, config: &Config) {
        let judged = decisions.iter().map(|[_, phase]| phase).filter(|phase| is_judged(phase));
        let squares: Vec<f64, N> = collected(judged.map(|it| it.standardised * it.standardised));
        let common = (median(&squares, |square| *square) / MEDIAN_OF_SQUARES).max(1.0);
        for ((_, line), [_, phase]) in lines.iter().zip(decisions) {
            if let Some(Some(channel)) = self.channels.get_mut(line.state) {
                channel.monitor.update(phase, line, common, config.motion);
            }
        }
    }

    /// The satellites above the mask, each with a state for its ambiguity.
    fn lines<'a, 'b>(
        &mut self,
        site: &Site<'_>,
        observations: &'a [SatelliteObservation<'b>],
        config: &Config,
    ) -> Lines<'a, 'b, N> {
        let mut lines = Vec::new();
        for observation in observations {
            if lines.iter().any(|(_, line): &(_, Line)| line.satellite == observation.satellite) {
                continue;
            }
            let known = self.find(observation.satellite);
            let wind_up = known.and_then(|state| Some(self.channel(state)?.wind_up));
            let expected = {
                let SatelliteObservation { state, carriers, antenna, .. } = observation;
                site.expect(state, *carriers, antenna.as_ref(), wind_up)
            };
            let Some(expected) = expected else { continue };
            let above = expected.direction.elevation >= config.elevation_mask;
            if !above && let Some(place) = known.and_then(|state| self.channels.get_mut(state)) {
                *place = None;
            }
            if !above || !observation.is_finite() {
                continue;
            }
            let offset = match observation.carriers.constellation() {
                Constellation::Gps => None,
                Constellation::Galileo => {
                    let Some(offset) = self.offset_state(observations) else { continue };
                    Some(offset)
                }
            };
            let Some(state) = known.or_else(|| self.free(observations)) else { continue };
            let slipped = self.track(state, observation, &expected, config);
            let phase = self.repaired(observation);
            let mut line = Line::new(observation, phase, expected, state, slipped, config);
            line.offset = offset;
            if config.estimator.patience.is_some()
                && let Some(channel) = self.channel(state)
            {
                line.learn(channel.monitor.noise(), config.motion);
            }
            if lines.push((observation, line)).is_err() {
                break;
            }
        }
        lines
    }

    /// Follows a satellite whose ambiguity is `state`. Whether and why that begins anew.
    fn track(
        &mut self,
        state: usize,
        observation: &SatelliteObservation<'_>,
        expected: &Expected,
        config: &Config,
    ) -> Option<Slipped> {
        let SatelliteObservation { satellite, code, lock_lost, .. } = *observation;
        let phase = self.repaired(observation);
        let clock = matches!(self.jump, Some(ClockJump::Other)).then_some(Slip::Clock);
        let time = self.time;
        let place = self.channels.get_mut(state)?;
        let Some(channel) = place.as_mut().filter(|channel| channel.satellite == satellite) else {
            *place = Some(Channel {
                satellite,
                arc: Arc::begin(time, observation.carriers, phase, code),
                wind_up: expected.wind_up_cycles,
                monitor: PhaseMonitor::NEW,
            });
            return Some(Slipped::New);
        };
        channel.wind_up = expected.wind_up_cycles;
        let slip = channel.arc.observe(time, phase, code, lock_lost, &config.slips);
        let slip = slip.or(clock);
        let slip = slip.or_else(|| channel.agrees(config.estimator.patience));
        let slipped = slip.map(Slipped::Seen).or_else(|| {
            let patience = config.estimator.patience?;
            channel.monitor.contradicts(patience).then_some(Slipped::Contradicted)
        });
        if slipped.is_some() {
            channel.arc.restart(time, phase, code);
            channel.monitor.begin();
        }
        slipped
    }

    /// The jump of the phases that most satellites have in common since they were seen before.
    fn clock_jump(
        &self,
        observations: &[SatelliteObservation<'_>],
        config: &Config,
    ) -> Option<ClockJump> {
        let jumps: Vec<f64, N> = collected(observations.iter().filter_map(|observation| {
            let arc = self.channel(self.find(observation.satellite)?)?.arc;
            let jump = arc.jump(self.repaired(observation), observation.code);
            (self.time.since(arc.last()).abs() <= config.slips.gap).then_some(jump)
        }));
        ClockJump::of(&jumps, median(&jumps, |jump| *jump))
    }

    /// Phases without the milliseconds by which they are ahead of the codes, cycles.
    pub(crate) fn repaired(&self, observation: &SatelliteObservation<'_>) -> [f64; 2] {
        let [first, second] = observation.phase;
        let seconds = 1e-3 * f64::from(self.ahead);
        let [of_first, of_second] = observation.carriers.frequency();
        [first - seconds * of_first, second - seconds * of_second]
    }

    pub(crate) fn find(&self, satellite: u8) -> Option<usize> {
        let is = |channel: &Option<Channel>| channel.is_some_and(|c| c.satellite == satellite);
        self.channels.iter().position(is)
    }

    fn channel(&self, state: usize) -> Option<&Channel> {
        self.channels.get(state)?.as_ref()
    }

    /// The state that is the clock of Galileo, begun if there is none.
    fn offset_state(&mut self, observations: &[SatelliteObservation<'_>]) -> Option<usize> {
        if self.offset.is_none() {
            let state = self.free(observations)?;
            *self.channels.get_mut(state)? = None;
            self.offset = Some(state);
        }
        self.offset
    }

    /// A state that is no satellite's, or that of the satellite unseen for longest.
    fn free(&self, observations: &[SatelliteObservation<'_>]) -> Option<usize> {
        let unseen = |state: usize| match self.channel(state) {
            None => Some(f64::INFINITY),
            Some(Channel { satellite, .. })
                if observations.iter().any(|observation| observation.satellite == *satellite) =>
            {
                None
            }
            Some(channel) => Some(self.time.since(channel.arc.last()).abs()),
        };
        let states = (COMMON..N).filter(|state| self.offset != Some(*state));
        let free = states.filter_map(|state| Some((state, unseen(state)?)));
        free.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(state, _)| state)
    }

    /// Standard deviation of the position as the filter takes it, m.
    fn deviation(&self) -> f64 {
        let variance = |axis| self.estimate.covariance.get(axis, axis).unwrap_or(0.0);
        libm::sqrt((0..3).map(variance).sum())
    }

    pub(crate) fn state(&self, index: usize) -> f64 {
        self.estimate.mean.as_array().get(index).copied().unwrap_or(0.0)
    }

    pub(crate) fn position(&self) -> Vector3<f64> {
        Vector3::new(self.state(0), self.state(1), self.state(2))
    }
}

/// By counting: sorting would bring panics along.
fn median<T, const N: usize>(items: &Vec<T, N>, value: impl Fn(&T) -> f64) -> f64 {
    let values = || items.iter().map(&value);
    let middle = items.len() / 2;
    let is_median = |candidate: &f64| {
        let below = values().filter(|other| other.total_cmp(candidate).is_lt()).count();
        let up_to = values().filter(|other| other.total_cmp(candidate).is_le()).count();
        below <= middle && middle < up_to
    };
    values().find(is_median).unwrap_or(0.0)
}
