//! Single-epoch positions from codes.

use crate::collected::collected;
use crate::consistency::Consistency;
use crate::line::code_bias;
use crate::median::median;
use crate::running::GROUND;
use crate::start::code_position;
use crate::{
    Config, Contradiction, Error, Health, Motion, SatelliteObservation, SatelliteReport, Solution,
};
use heapless::Vec;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{
    Carriers, Constellation, Expected, FREQUENCY, Geodetic, GpsTime, Klobuchar, Pattern, Receiver,
    SatelliteState, Site,
};
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_robust_kalman::{Decision, Measurement, Robust};
use kestirim_scalar::Components;
use nalgebra::{Matrix3, SVector, Vector3};

/// The prior variance of unknowns, m²: the first position is good to metres.
const UNKNOWN: f64 = 1e10;
/// The assumed wet zenith delay, m: that of a temperate climate.
const WET_DELAY: f64 = 0.1;
/// The noise of a single carrier relative to that of the combination of two.
const ALONE: f64 = 1.0 / 3.0;
/// The share of the ionospheric delay that remains after the broadcast correction (IS-GPS-200, 20.3.3.5.2.5).
const LEFT: f64 = 0.5;
/// The standard deviation of the ionospheric delay without a broadcast model, m: of L1 at the zenith.
const NOT_TOLD: f64 = 5.0;
/// The lower limit of the sine of the elevation in mapping delays and weights.
const LOWEST: f64 = 0.1;
/// The number of rounds of least squares, each from where the preceding one led, and with the noise that it revealed.
const ROUNDS: usize = 3;
/// The largest standard deviation of codes relative to that configured which is noise: beyond it they contradict each other.
const NOISIEST: f64 = 10.0;
/// The standard deviation of normally distributed errors relative to the median of their sizes.
const OF_MEDIAN: f64 = 1.4826;
/// The number of common states: the coordinates and the receiver's clock.
const COMMON: usize = 4;
/// The number of all states: the common ones and the clock offsets of further systems.
const STATES: usize = COMMON + Constellation::ALL.len() - 1;

/// The codes of one satellite in an epoch, and the satellite's state.
#[derive(Clone, Copy, Debug)]
pub struct CodeObservation<'a> {
    /// The satellite's number, unique among all systems.
    pub satellite: u8,
    /// The carriers on which the satellite is observed.
    pub carriers: Carriers,
    /// The codes on both carriers, m: the first alone is enough.
    pub code: [Option<f64>; 2],
    /// By how much the satellite's clock is ahead of that of the first carrier alone, s.
    pub group_delay: f64,
    /// The satellite's state at the time of transmission.
    pub state: SatelliteState,
    /// The satellite's antenna on both carriers, where known: states from precise orbits are those of centres of mass.
    pub antenna: Option<[Pattern<'a>; 2]>,
}

impl<'a> CodeObservation<'a> {
    /// An equivalent observation with two equal codes, free of the ionosphere or of the first carrier alone.
    fn whole(&self) -> Option<SatelliteObservation<'a>> {
        let (range, _) = self.range()?;
        Some(SatelliteObservation {
            satellite: self.satellite,
            carriers: self.carriers,
            code: [range; 2],
            phase: [0.0; 2],
            lock_lost: false,
            state: self.state,
            antenna: self.antenna,
        })
    }

    /// The ionosphere-free code, or that of the first carrier alone, and whether it is alone.
    fn range(&self) -> Option<(f64, bool)> {
        match self.code {
            [Some(first), Some(second)] => {
                Some((self.carriers.ionosphere_free([first, second]), false))
            }
            [Some(first), None] => Some((first - SPEED_OF_LIGHT * self.group_delay, true)),
            [None, _] => None,
        }
    }
}

/// The position of an epoch from its codes alone: free of the ionosphere where there are two, otherwise corrected with
/// `ionosphere`.
///
/// Outliers lose weight as in the filter with the same settings. A code's variance is (a² + b²·cot²E)/2 of
/// `config.code`, as nothing averages the errors of low satellites, or more if the median of the residuals shows a noisier receiver;
/// the covariance grows with the residuals of the codes that keep their weight. No phase is used, and nothing of any other epoch.
///
/// # Errors
/// [`Error`]: why there is no position.
pub fn single_point<const N: usize>(
    time: GpsTime,
    receiver: &Receiver<'_>,
    codes: &[CodeObservation<'_>],
    ionosphere: Option<&Klobuchar>,
    config: &Config,
) -> Result<Solution<N>, Error> {
    let start = code_position(&collected::<_, N>(codes.iter().filter_map(CodeObservation::whole)))?;
    let mut position = start.position;
    let mut found = Epoch::<N>::at(position, start.clock);
    let mut scale = 1.0;
    for _ in 0..ROUNDS {
        found = Epoch { scale, ..Epoch::at(position, start.clock) };
        found.observe(time, receiver, codes, ionosphere, config);
        found.update(config)?;
        position += found.estimate.mean.xyz();
        scale = found.residual_scale();
    }
    if !GROUND.contains(&position.norm()) {
        return Err(Error::Contradictory);
    }
    Ok(found.solution(time, position, scale))
}

/// The linearised code of one satellite.
#[derive(Clone, Copy, Debug)]
struct Line {
    satellite: u8,
    system: Constellation,
    expected: Expected,
    /// Observed minus expected, m.
    innovation: f64,
    variance: f64,
    row: [(usize, f64); COMMON + 1],
}

/// An epoch linearised at a position.
struct Epoch<const N: usize> {
    place: Vector3<f64>,
    clock: f64,
    /// The standard deviation of the codes relative to that configured.
    scale: f64,
    estimate: Gaussian<f64, STATES>,
    lines: Vec<Line, N>,
    decisions: Vec<Decision<f64>, N>,
}

impl<const N: usize> Epoch<N> {
    fn at(place: Vector3<f64>, clock: f64) -> Self {
        let covariance = Covariance::from_variances(&[UNKNOWN; STATES]);
        let estimate = Gaussian::new(SVector::zeros(), covariance);
        Self { place, clock, scale: 1.0, estimate, lines: Vec::new(), decisions: Vec::new() }
    }

    fn observe(
        &mut self,
        time: GpsTime,
        receiver: &Receiver<'_>,
        codes: &[CodeObservation<'_>],
        ionosphere: Option<&Klobuchar>,
        config: &Config,
    ) {
        let site = Site::new(receiver, &self.place, time);
        let place = Geodetic::from_ecef(&self.place);
        let system = |it: &CodeObservation<'_>| it.carriers.constellation();
        // The clocks of further systems are offsets from that of the first system.
        let is_there = |of: &Constellation| codes.iter().any(|it| system(it) == *of);
        let there: Vec<_, { Constellation::ALL.len() }> =
            collected(Constellation::ALL.into_iter().filter(is_there));
        self.lines = collected(codes.iter().enumerate().filter_map(|(index, it)| {
            let before = codes.get(..index).unwrap_or(&[]);
            if before.iter().any(|other| other.satellite == it.satellite) {
                return None;
            }
            let (range, is_alone) = it.range()?;
            let expected = site.expect(&it.state, it.carriers, it.antenna.as_ref(), None)?;
            let direction = expected.direction;
            // Phrased so that NaN is not above the mask.
            let above = direction.elevation >= config.elevation_mask;
            if !above {
                return None;
            }
            let sine = expected.local.z;
            // Both delays are given for L1.
            let ratio = FREQUENCY[0] / it.carriers.frequency()[0];
            let (delay, left) = match (is_alone, ionosphere) {
                (false, _) => (0.0, 0.0),
                (true, Some(model)) => {
                    let delay = square(ratio) * model.delay(&place, &direction, time);
                    (delay, LEFT * delay)
                }
                (true, None) => (0.0, square(ratio) * NOT_TOLD / sine.max(LOWEST)),
            };
            let noise =
                config.code.variance_of_one_epoch(sine.max(LOWEST)) + code_bias(it.carriers);
            let noise = noise * if is_alone { ALONE * ALONE } else { 1.0 };
            let wet = config.wet_delay * expected.wet_mapping;
            let known = self.clock + expected.wet_mapping * WET_DELAY + delay;
            let [x, y, z] = *expected.sight.as_array();
            let beside = there.iter().skip(1).position(|of| *of == system(it));
            let own = beside.map_or((COMMON, 0.0), |place| (COMMON + place, 1.0));
            Some(Line {
                satellite: it.satellite,
                system: system(it),
                expected,
                innovation: range - expected.range - known,
                variance: square(self.scale)
                    * (noise + square(left) + square(wet) + square(it.state.accuracy)),
                row: [(0, -x), (1, -y), (2, -z), (3, 1.0), own],
            })
        }));
    }

    fn update(&mut self, config: &Config) -> Result<(), Error> {
        if self.lines.len() < self.unknowns() {
            return Err(Error::TooFewSatellites);
        }
        let measurements: Vec<_, N> = collected(self.lines.iter().map(|line| Measurement {
            row: &line.row,
            innovation: line.innovation,
            variance: line.variance,
        }));
        self.decisions = collected(self.lines.iter().map(|_| Decision::NONE));
        let robust = Robust { adaptive: None, ..config.estimator.robust };
        robust.update(&mut self.estimate, &measurements, &mut self.decisions)?;
        Ok(())
    }

    /// The number of unknowns that the lines determine: coordinates, and the clock of each of their systems.
    fn unknowns(&self) -> usize {
        let is_heard = |of: &Constellation| self.lines.iter().any(|line| line.system == *of);
        3 + Constellation::ALL.iter().filter(|of| is_heard(of)).count().max(1)
    }

    /// The standard deviation of the codes relative to that configured, at least 1, from the median of all residuals: of those, too,
    /// that were rejected, since of a noisy receiver these are many.
    fn residual_scale(&self) -> f64 {
        let spare = self.lines.len().saturating_sub(self.unknowns());
        let both = self.lines.iter().zip(&self.decisions);
        let sizes: Vec<_, N> =
            collected(both.map(|(line, it)| it.residual.abs() / libm::sqrt(line.variance)));
        let share = libm::sqrt(self.lines.len() as f64 / spare as f64);
        let scale = self.scale * OF_MEDIAN * share * median(&sizes).unwrap_or(0.0);
        if spare == 0 { 1.0 } else { scale.clamp(1.0, NOISIEST) }
    }

    /// The variance factor of the codes that were used, at least 1: receivers may be noisier than configured, and their
    /// surroundings may reflect.
    fn variance_factor(&self) -> f64 {
        let used = || self.lines.iter().zip(&self.decisions).filter(|(_, it)| it.weight > 0.0);
        let squares = used().map(|(line, it)| it.weight * square(it.residual) / line.variance);
        let spare = used().count().saturating_sub(self.unknowns());
        if spare == 0 { 1.0 } else { (squares.sum::<f64>() / spare as f64).max(1.0) }
    }

    /// The solution, if the residuals show codes this many times as noisy as configured.
    fn solution(&self, time: GpsTime, position: Vector3<f64>, scale: f64) -> Solution<N> {
        let estimate = &self.estimate;
        let formal = Matrix3::from_fn(|i, j| estimate.covariance.get(i, j).unwrap_or(0.0));
        let covariance = formal * self.variance_factor();
        let mut consistency = Consistency::default();
        consistency.update(self.decisions.iter(), [].iter(), Motion::Static);
        let rotation = Geodetic::from_ecef(&position).enu_from_ecef();
        let satellites =
            self.lines.iter().zip(&self.decisions).map(|(line, code)| SatelliteReport {
                satellite: line.satellite,
                direction: line.expected.direction,
                code: *code,
                phase: Decision::NONE,
                slipped: None,
            });
        let contradiction = consistency
            .contradiction()
            .or_else(|| (scale >= NOISIEST).then_some(Contradiction::Residuals));
        let heard = self.decisions.iter().filter(|code| code.weight > 0.0).count();
        Solution {
            time,
            position,
            covariance,
            covariance_enu: rotation * covariance * rotation.transpose(),
            clock: self.clock + estimate.mean.as_array().get(3).copied().unwrap_or(0.0),
            wet_delay: WET_DELAY,
            gradients: [0.0; 2],
            // The accuracy is always metres: no ambiguity is ever known.
            health: if let Some(contradiction) = contradiction {
                Health::Contradicted(contradiction)
            } else if heard > self.unknowns() + 1 {
                Health::Converging
            } else {
                Health::Unchecked
            },
            milliseconds: 0,
            satellites: collected(satellites),
        }
    }
}

fn square(number: f64) -> f64 {
    number * number
}
