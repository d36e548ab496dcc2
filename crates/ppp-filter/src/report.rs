//! The solution of an epoch.

use crate::clock_jump::ClockJump;
use crate::collected::collected;
use crate::running::{Decisions, Lines, Running};
use crate::states::{CLOCK, WET};
use crate::{Config, Contradiction, Health, Motion, SatelliteReport, Solution};
use kestirim_gnss_ppp::Site;
use nalgebra::Matrix3;

/// The standard deviation below which a position has converged ambiguities, m.
const CONVERGED: f64 = 0.1;

impl<const N: usize> Running<N> {
    pub(crate) fn solution(
        &mut self,
        site: &Site<'_>,
        lines: &Lines<'_, '_, N>,
        decisions: &Decisions<N>,
        config: &Config<impl Sized>,
    ) -> Solution<N> {
        let formal = Matrix3::from_fn(|i, j| self.estimate.covariance.get(i, j).unwrap_or(0.0));
        let covariance = formal * self.repetition(config);
        let rotation = site.enu_from_ecef();
        let satellites = lines.iter().zip(decisions).map(|((_, line), &[code, phase])| {
            let direction = line.expected.direction;
            SatelliteReport {
                satellite: line.satellite,
                direction,
                code,
                phase,
                slipped: line.slipped,
            }
        });
        let spread = libm::sqrt(covariance.trace());
        let position = self.position();
        let contradiction = self.consistency.contradiction();
        let rests = matches!(config.motion, Motion::Static) && contradiction.is_none();
        if rests && spread < CONVERGED {
            self.rest.stay(&position, &covariance);
        }
        let moved = self.rest.has_moved(&position).then_some(Contradiction::Motion);
        let (mut heard, mut systems) = (0, 0_u32);
        for ((observation, _), [_, phase]) in lines.iter().zip(decisions) {
            if phase.weight > 0.0 {
                heard += 1;
                systems |= 1 << observation.carriers.constellation() as u32;
            }
        }
        Solution {
            time: self.time,
            position,
            covariance,
            covariance_enu: rotation * covariance * rotation.transpose(),
            clock: self.state(CLOCK),
            wet_delay: self.state(WET),
            gradients: self.gradients(),
            health: if let Some(contradiction) = contradiction.or(moved) {
                Health::Contradicted(contradiction)
            } else if heard < 4 + systems.count_ones().max(1) {
                Health::Unchecked
            } else if spread < CONVERGED {
                Health::Converged
            } else {
                Health::Converging
            },
            milliseconds: match self.jump {
                Some(ClockJump::Milliseconds(milliseconds)) => milliseconds,
                _ => 0,
            },
            satellites: collected(satellites),
        }
    }

    /// The factor by which the filter's own variances are too small, as it treats the errors of each epoch as
    /// independent.
    ///
    /// Within the correlation time τ errors are the same: n epochs Δt apart are worth n·Δt/2τ independent ones. A
    /// moving position does not average them; its part that depends on the ambiguities does.
    pub(crate) fn repetition(&self, config: &Config<impl Sized>) -> f64 {
        let repeated = match self.interval {
            Some(interval) => 1.0 + 2.0 * config.correlation_time / interval,
            None => 1.0,
        };
        match config.motion {
            Motion::Static => repeated,
            Motion::Kinematic { .. } => libm::sqrt(repeated),
        }
    }
}
