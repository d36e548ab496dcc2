//! The satellites in use, and the assignment of states to ambiguities.

use heapless::Vec;
use kestirim_gnss_ppp::{Arc, Constellation, Expected, Site, Slip, gradient_mapping};

use super::{Lines, Running};
use crate::channel::Channel;
use crate::clock_jump::ClockJump;
use crate::collected::collected;
use crate::line::Line;
use crate::median::median;
use crate::phase_monitor::PhaseMonitor;
use crate::{Config, SatelliteObservation, Slipped};

impl<const N: usize> Running<N> {
    /// The lines of the satellites above the mask, each with a state for its ambiguity.
    pub(super) fn lines<'a, 'b>(
        &mut self,
        site: &Site<'_>,
        observations: &'a [SatelliteObservation<'b>],
        config: &Config<impl Sized>,
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
                system => {
                    let Some(offset) = self.offset_state(system, observations) else { continue };
                    Some(offset)
                }
            };
            let Some(state) = known.or_else(|| self.free(observations)) else { continue };
            let slipped = self.track(state, observation, &expected, config);
            let phase = self.repaired(observation);
            let mut line = Line::new(observation, phase, expected, state, slipped, config);
            line.offset = offset;
            line.gradients = self.has_gradients().then(|| gradient_mapping(&expected.local));
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

    /// Tracks a satellite whose ambiguity is `state`. Returns whether and why the ambiguity is reset.
    fn track(
        &mut self,
        state: usize,
        observation: &SatelliteObservation<'_>,
        expected: &Expected,
        config: &Config<impl Sized>,
    ) -> Option<Slipped> {
        let SatelliteObservation { satellite, carriers, code, lock_lost, .. } = *observation;
        let phase = self.repaired(observation);
        let clock = matches!(self.jump, Some(ClockJump::Other)).then_some(Slip::Clock);
        let time = self.time;
        let place = self.channels.get_mut(state)?;
        let continues = |channel: &&mut Channel| {
            channel.satellite == satellite && channel.arc.carriers() == carriers
        };
        let Some(channel) = place.as_mut().filter(continues) else {
            *place = Some(Channel {
                satellite,
                arc: Arc::begin(time, carriers, phase, code),
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

    /// The phase jump that most satellites have in common since they were last seen.
    pub(super) fn clock_jump(
        &self,
        observations: &[SatelliteObservation<'_>],
        config: &Config<impl Sized>,
    ) -> Option<ClockJump> {
        let jumps: Vec<f64, N> = collected(observations.iter().filter_map(|observation| {
            let arc = self.channel(self.find(observation.satellite)?)?.arc;
            if arc.carriers() != observation.carriers {
                return None;
            }
            let jump = arc.jump(self.repaired(observation), observation.code);
            (self.time.since(arc.last()).abs() <= config.slips.gap).then_some(jump)
        }));
        let median = median(&jumps).unwrap_or_default();
        ClockJump::of(&jumps, median)
    }

    /// The phases without the milliseconds by which they are ahead of the codes, cycles.
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

    /// The state of a system's clock offset from GPS, allocated if there is none.
    fn offset_state(
        &mut self,
        system: Constellation,
        observations: &[SatelliteObservation<'_>],
    ) -> Option<usize> {
        let place = (system as usize).checked_sub(1)?;
        let known = *self.offsets.get(place)?;
        if known.is_some() {
            return known;
        }
        let state = self.free(observations)?;
        *self.channels.get_mut(state)? = None;
        *self.offsets.get_mut(place)? = Some(state);
        Some(state)
    }

    /// A free state, or that of the satellite unseen for longest.
    fn free(&self, observations: &[SatelliteObservation<'_>]) -> Option<usize> {
        let (mut free, mut longest) = (None, 0.0);
        for (state, channel) in self.channels.iter().enumerate().skip(self.first) {
            let unseen = match channel {
                _ if self.offsets.contains(&Some(state)) => continue,
                Some(channel) if is_seen(channel.satellite, observations) => continue,
                Some(channel) => self.time.since(channel.arc.last()).abs(),
                None => f64::INFINITY,
            };
            if unseen >= longest {
                (free, longest) = (Some(state), unseen);
            }
        }
        free
    }
}

#[inline(never)] // Small beside the loop that it is called in, which would be there several times.
fn is_seen(satellite: u8, observations: &[SatelliteObservation<'_>]) -> bool {
    observations.iter().any(|observation| observation.satellite == satellite)
}
