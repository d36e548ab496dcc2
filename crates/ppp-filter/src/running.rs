//! The running filter, which has a position.

mod satellites;

use crate::channel::Channel;
use crate::clock_jump::ClockJump;
use crate::collected::collected;
use crate::consistency::{Consistency, is_a_guess};
use crate::displacement::{Change, Displacement};
use crate::line::{Line, Row};
use crate::median::median;
use crate::phase_monitor::is_judged;
use crate::rest::Rest;
use crate::start::code_position;
use crate::states::{BEHIND_GRADIENTS, CLOCK, COMMON, GRADIENTS, WET};
use crate::{Config, Error, Motion, SatelliteObservation, Slipped, Solution, Weighting};
use heapless::Vec;
use kestirim_gnss_ppp::{Constellation, GpsTime, Receiver, Site};
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Decision, Measurement};
use kestirim_scalar::Components;
use nalgebra::{SVector, Vector3};

/// The initial variance of a coordinate from codes, m².
const START_VARIANCE: f64 = 1e4;
/// The variance of the receiver's clock, m², about which each epoch knows nothing but its codes.
const CLOCK_VARIANCE: f64 = 1e6;
/// Random walk of the clock offset of another system from GPS: variance per second, m²/s. The receiver's delays are
/// steady, the times of the products not always.
const OFFSET_WALK: f64 = 1e-8;
/// The initial variance of an ambiguity from one epoch's code, m².
const AMBIGUITY_VARIANCE: f64 = 1e4;
/// The time in which gradients change by as much as their standard deviation, s.
const DAY: f64 = 86_400.0;
/// The initial wet zenith delay, m: that of a temperate climate.
const WET_DELAY: f64 = 0.1;
/// The model is linearised again if a receiver is found farther than this from where it was linearised, m: at 20 000
/// km, 100 m are worth 0.2 mm.
const LINEAR: f64 = 100.0;
/// The largest number of relinearisations in an epoch.
const RELINEARISATIONS: usize = 5;
/// The distances from the Earth's centre at which the model is valid, m: it is one for receivers near the ground.
pub(crate) const GROUND: core::ops::Range<f64> = 6.3e6..6.5e6;

/// The fastest rate at which the direction to a satellite turns, rad/s: that of GLONASS, overhead.
const SKY_TURNS: f64 = 2e-4;
/// The standard deviation given to a receiver that was seen to move, in lengths of its step, so that the old place
/// hardly pulls it back.
const ANYWHERE: f64 = 5.0;
/// Phases are not compared between epochs farther apart than this many times the usual interval, as delays change,
/// too.
const FARTHEST_APART: f64 = 1.5;

/// The median of the squares of standard normal numbers.
const MEDIAN_OF_SQUARES: f64 = 0.455;

/// The observations of an epoch that are used.
pub(crate) type Lines<'a, 'b, const N: usize> = Vec<(&'a SatelliteObservation<'b>, Line), N>;
/// The decisions about each line's code and phase.
pub(crate) type Decisions<const N: usize> = Vec<[Decision<f64>; 2], N>;

/// The number of systems besides GPS.
const OTHERS: usize = Constellation::ALL.len() - 1;
/// The states of the clock offsets from GPS, in the order of [`Constellation::ALL`] after GPS.
type Offsets = [Option<usize>; OTHERS];

#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Running<const N: usize> {
    pub(crate) estimate: Gaussian<f64, N>,
    pub(crate) time: GpsTime,
    /// The usual time between two epochs, s.
    pub(crate) interval: Option<f64>,
    /// The first state that may be an ambiguity: those of gradients precede it, if they are estimated.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "first_ambiguity"))]
    first: usize,
    /// The channels, indexed by the state of their ambiguity.
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    channels: [Option<Channel>; N],
    /// The states of the clock offsets of other systems from GPS, as the receiver sees them, each from the first
    /// satellite of that system on.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "offsets::<_, N>"))]
    offsets: Offsets,
    pub(crate) consistency: Consistency,
    pub(crate) rest: Rest,
    displacement: Displacement,
    /// The milliseconds by which the phases are ahead of the codes since the beginning.
    ahead: i32,
    /// The clock jump in the current epoch.
    pub(crate) jump: Option<ClockJump>,
}

/// Deserialises the first ambiguity state: after the common states, or after the gradients.
#[cfg(feature = "serde")]
fn first_ambiguity<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<usize, D::Error> {
    match <usize as serde::Deserialize>::deserialize(deserializer)? {
        first @ (COMMON | BEHIND_GRADIENTS) => Ok(first),
        _ => Err(serde::de::Error::custom("no state that is the first ambiguity")),
    }
}

/// Deserialises the states of clock offsets, all of which must exist.
#[cfg(feature = "serde")]
fn offsets<'de, D: serde::Deserializer<'de>, const N: usize>(
    deserializer: D,
) -> Result<Offsets, D::Error> {
    let offsets = <Offsets as serde::Deserialize>::deserialize(deserializer)?;
    if offsets.iter().flatten().all(|index| *index < N) {
        Ok(offsets)
    } else {
        Err(serde::de::Error::custom("a state that there is not"))
    }
}

impl<const N: usize> Running<N> {
    /// Starts at the position that the codes of an epoch's `observations` give.
    pub(crate) fn start(
        time: GpsTime,
        observations: &[SatelliteObservation<'_>],
        config: &Config<impl Sized>,
    ) -> Result<Self, Error> {
        let start = code_position(observations)?;
        let has_gradients = config.gradient > 0.0
            && N >= BEHIND_GRADIENTS + 4
            && !observations.iter().any(SatelliteObservation::hides_gradients);
        let gradient = if has_gradients { config.gradient * config.gradient } else { 0.0 };
        let mut mean = SVector::<f64, N>::zeros();
        let mut variances = [0.0; N];
        let [x, y, z] = *start.position.as_array();
        let known = [
            (x, START_VARIANCE),
            (y, START_VARIANCE),
            (z, START_VARIANCE),
            (start.clock, CLOCK_VARIANCE),
            (WET_DELAY, config.wet_delay * config.wet_delay),
            (0.0, gradient),
            (0.0, gradient),
        ];
        let places = mean.as_array_mut().iter_mut().zip(&mut variances);
        for ((mean, variance), known) in places.zip(known) {
            (*mean, *variance) = known;
        }
        let estimate = Gaussian::new(mean, Covariance::from_variances(&variances));
        Ok(Self {
            estimate,
            time,
            interval: None,
            first: if has_gradients { BEHIND_GRADIENTS } else { COMMON },
            channels: [None; N],
            offsets: Offsets::default(),
            consistency: Consistency::default(),
            rest: Rest::default(),
            displacement: Displacement::NEW,
            ahead: 0,
            jump: None,
        })
    }

    /// Predicts to the time of an epoch, which is later (`direction` 1) or earlier (−1).
    pub(crate) fn advance(
        &mut self,
        time: GpsTime,
        direction: f64,
        config: &Config<impl Sized>,
    ) -> Result<(), Error> {
        let elapsed = direction * time.since(self.time);
        if elapsed <= 0.0 || elapsed.is_nan() {
            return Err(Error::TimeNotAdvancing);
        }
        self.time = time;
        self.interval = Some(self.interval.map_or(elapsed, |usual| {
            // A gap, or an epoch between others, is no change of rate. (`clamp` can panic.)
            usual + (elapsed - usual).max(-usual / 8.0).min(usual / 8.0)
        }));
        self.rest.advance(elapsed);
        if let Motion::Kinematic { process_noise } = config.motion {
            for coordinate in 0..3 {
                self.estimate.add_variance_at(coordinate, process_noise * elapsed)?;
            }
        }
        self.estimate.add_variance_at(WET, config.wet_delay_walk * elapsed)?;
        if self.has_gradients() {
            let walk = config.gradient * config.gradient * elapsed / DAY;
            for gradient in GRADIENTS {
                self.estimate.add_variance_at(gradient, walk)?;
            }
        }
        for offset in self.offsets.into_iter().flatten() {
            self.estimate.add_variance_at(offset, OFFSET_WALK * elapsed)?;
        }
        Ok(())
    }

    /// Processes the observations of the current time.
    pub(crate) fn observe(
        &mut self,
        receiver: &Receiver<'_>,
        observations: &[SatelliteObservation<'_>],
        config: &Config<impl Weighting>,
    ) -> Result<Solution<N>, Error> {
        let mut site = Site::new(receiver, &self.position(), self.time);
        self.jump = self.clock_jump(observations, config);
        if let Some(ClockJump::Milliseconds(milliseconds)) = self.jump {
            self.ahead = self.ahead.saturating_add(milliseconds);
        }
        let known = self.offsets;
        let mut lines = self.lines(&site, observations, config);
        if lines.len() < 4 {
            return Err(Error::TooFewSatellites);
        }
        self.set_clocks(&lines, known)?;
        self.doubt(&mut lines, config.motion);
        for (_, line) in lines.iter().filter(|(_, line)| line.slipped.is_some()) {
            let ambiguity = line.phase - line.code;
            self.estimate.reset_at(line.state, ambiguity, AMBIGUITY_VARIANCE)?;
        }
        if matches!(config.motion, Motion::Static) {
            self.follow_displacement(&lines)?;
        }
        let mut decisions = collected(lines.iter().map(|_| [Decision::NONE; 2]));
        self.settle(receiver, &mut site, &mut lines, &mut decisions, config)?;
        self.monitor(&lines, &decisions, config);
        let (codes, phases) =
            (decisions.iter().map(|[code, _]| code), decisions.iter().map(|[_, phase]| phase));
        self.consistency.update(codes, phases, config.motion);
        Ok(self.solution(&site, &lines, &decisions, config))
    }

    /// Draws the conclusion from ambiguities that are reset because their phases contradict the place. Of a receiver at rest, the
    /// place is wrong if they are most of all. Of a moving one, the others may be the wrong ones, if it is a guess: all are reset.
    fn doubt(&mut self, lines: &mut Lines<'_, '_, N>, motion: Motion) {
        let [kept, anew] = [None, Some(Slipped::Contradicted)]
            .map(|it| lines.iter().filter(|(_, line)| line.slipped == it).count());
        if matches!(motion, Motion::Static) || !is_a_guess(anew as f64, (kept + anew) as f64) {
            self.rest.restart(anew, lines.len());
            return;
        }
        for (_, line) in lines.iter_mut().filter(|(_, line)| line.slipped.is_none()) {
            line.slipped = Some(Slipped::Contradicted);
            if let Some(Some(channel)) = self.channels.get_mut(line.state) {
                channel.monitor.begin();
            }
        }
    }

    /// Releases the position if the phases show that a receiver that should be at rest has moved. The ambiguities are
    /// kept: they determine where it is now.
    fn follow_displacement(&mut self, lines: &Lines<'_, '_, N>) -> Result<(), Error> {
        if self.interval.is_none_or(|it| self.rest.elapsed() > FARTHEST_APART * it) {
            return Ok(());
        }
        // While the place is uncertain, the turning sky changes phases, too.
        let turned = self.deviation() * SKY_TURNS * self.rest.elapsed();
        let change = |line: &Line| {
            let before = self.channels.get(line.state)?.as_ref()?.monitor.residual()?;
            let [_, now] = line.innovations(&self.estimate.mean, &Vector3::zeros());
            let own = line.phase_variance * line.phase_noise + line.clock_variance;
            let variance = 2.0 * own + turned * turned;
            Some(Change { sight: line.expected.sight, phase: now - before, variance })
        };
        let kept = lines.iter().map(|(_, line)| line).filter(|line| line.slipped.is_none());
        let changes: Vec<_, N> = collected(kept.filter_map(change));
        if let Some(step) = self.displacement.of(&changes) {
            let variance = ANYWHERE * ANYWHERE * step.norm_squared();
            for coordinate in 0..3 {
                self.estimate.add_variance_at(coordinate, variance)?;
            }
            self.rest.displace();
        }
        Ok(())
    }

    /// Resets the receiver's clock to the median code, and the clock offsets of systems that were not `known`.
    #[inline(never)]
    fn set_clocks(&mut self, lines: &Lines<'_, '_, N>, known: Offsets) -> Result<(), Error> {
        let mut clock = median_code(lines, None);
        // Without GPS the clock follows from another system and its offset, preferably a known one.
        for begins in [false, true] {
            for (place, (state, known)) in self.offsets.into_iter().zip(known).enumerate() {
                let Some(state) = state.filter(|_| known.is_none() == begins) else { continue };
                let Some(code) = median_code(lines, Some(state)) else {
                    // There was no room for the ambiguity of the system's first satellite.
                    if let (true, Some(offset)) = (begins, self.offsets.get_mut(place)) {
                        *offset = None;
                    }
                    continue;
                };
                let beside = if begins { 0.0 } else { self.state(state) };
                let clock = *clock.get_or_insert(code - beside);
                if begins {
                    self.estimate.reset_at(state, code - clock, CLOCK_VARIANCE)?;
                }
            }
        }
        let Some(clock) = clock else { return Ok(()) };
        Ok(self.estimate.reset_at(CLOCK, clock, CLOCK_VARIANCE)?)
    }

    /// Updates with the lines, and again after relinearisation if the solution is far from where they were linearised.
    fn settle<'r>(
        &mut self,
        receiver: &Receiver<'r>,
        site: &mut Site<'r>,
        lines: &mut Lines<'_, '_, N>,
        decisions: &mut Decisions<N>,
        config: &Config<impl Weighting>,
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
                let moves = matches!(config.motion, Motion::Kinematic { .. });
                self.rest.follow(&expected, deviation, &found, moves);
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

    /// Updates once with all lines; `offset` leads from where they are linearised to the prediction.
    fn update(
        &mut self,
        lines: &Lines<'_, '_, N>,
        offset: &Vector3<f64>,
        decisions: &mut Decisions<N>,
        config: &Config<impl Weighting>,
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

    /// Updates the phase monitors. An error common to all phases is not the noise of any one.
    fn monitor(
        &mut self,
        lines: &Lines<'_, '_, N>,
        decisions: &Decisions<N>,
        config: &Config<impl Sized>,
    ) {
        let judged = decisions.iter().map(|[_, phase]| phase).filter(|phase| is_judged(phase));
        let squares: Vec<f64, N> = collected(judged.map(|it| it.standardised * it.standardised));
        let median = median(&squares).unwrap_or_default();
        let common = (median / MEDIAN_OF_SQUARES).max(1.0);
        self.channels.iter_mut().flatten().for_each(|channel| channel.monitor.miss());
        for ((_, line), [_, phase]) in lines.iter().zip(decisions) {
            if let Some(Some(channel)) = self.channels.get_mut(line.state) {
                channel.monitor.update(phase, line, common, config.motion);
            }
        }
    }

    /// The standard deviation of the position according to the filter, m.
    fn deviation(&self) -> f64 {
        let variance = |axis| self.estimate.covariance.get(axis, axis).unwrap_or(0.0);
        libm::sqrt((0..3).map(variance).sum())
    }

    fn has_gradients(&self) -> bool {
        self.first == BEHIND_GRADIENTS
    }

    /// The gradients to the north and to the east, m; zero if they are not estimated.
    pub(crate) fn gradients(&self) -> [f64; 2] {
        if self.has_gradients() { GRADIENTS.map(|state| self.state(state)) } else { [0.0; 2] }
    }

    pub(crate) fn state(&self, index: usize) -> f64 {
        self.estimate.mean.as_array().get(index).copied().unwrap_or(0.0)
    }

    pub(crate) fn position(&self) -> Vector3<f64> {
        Vector3::new(self.state(0), self.state(1), self.state(2))
    }
}

/// The median code of the satellites of a system, given by the state of its clock offset, if there are any.
#[inline(never)]
fn median_code<const N: usize>(lines: &Lines<'_, '_, N>, state: Option<usize>) -> Option<f64> {
    let of_system = lines.iter().map(|(_, line)| line).filter(|it| it.offset == state);
    median(&collected::<_, N>(of_system.map(|line| line.code)))
}
