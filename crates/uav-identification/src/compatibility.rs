//! Consistency of the sensors with one another by kinematics alone, without a model of the aircraft.

use nalgebra::{DMatrix, DVector};

use crate::accuracy::autocorrelation;
use crate::flight::Flight;
use crate::structure::GRAVITY;

/// Integrals drift: duration over which a sensor's bias is taken to be constant, s.
const BLOCK_S: f64 = 25.0;
/// Largest delay that is considered, s.
const LONGEST_DELAY_S: f64 = 0.25;

/// A sensor compared with what other sensors predict: measured = scale · expected + offset.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Comparison {
    /// Scale of the sensor relative to the prediction; 1 if they agree.
    pub scale: f64,
    /// Standard error of the scale, allowing for coloured residuals.
    pub scale_sigma: f64,
    /// Mean slope of the difference, in the sensor's unit per second: a bias of the integrated signal.
    pub drift: f64,
    /// Delay of the sensor relative to the prediction, s.
    pub delay: f64,
    /// Root mean square of the residual, in the sensor's unit.
    pub residual: f64,
}

/// Consistency of the sensors; comparisons for which a sensor is missing are `None`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Compatibility {
    /// The pitch angle against the integral of the gyro's rate; `drift` is the negative bias of the gyro, rad/s.
    pub pitch: Option<Comparison>,
    /// The vane's angle of attack against the integral of q + (`fz` + g·cos γ)/V, rad.
    pub vane: Option<Comparison>,
    /// Distance of the vane ahead of the centre of mass, divided by the airspeed, s.
    pub vane_lead: Option<f64>,
    /// The airspeed against the integral of `fx` − g·sin γ, m/s.
    pub airspeed: Option<Comparison>,
}

/// Compares pitch angle, vane and airspeed of the flights with gyro and accelerometers.
pub(crate) fn compatibility(flights: &[Flight]) -> Compatibility {
    let pitch = compare(flights, "theta", false, |at| at.q);
    let vane = compare(flights, "alpha", true, |at| {
        let (sin, cos) = at.alpha?.sin_cos();
        let across = at.az? * cos - at.ax.unwrap_or(0.0) * sin;
        Some(at.q? + (across + GRAVITY * (at.theta? - at.alpha?).cos()) / at.airspeed?)
    });
    let airspeed = compare(flights, "V", false, |at| {
        let (sin, cos) = at.alpha?.sin_cos();
        Some(at.ax? * cos + at.az? * sin - GRAVITY * (at.theta? - at.alpha?).sin())
    });
    let vane_lead = vane.as_ref().map(|(comparison, lead)| -lead / comparison.scale);
    let first = |of: (Comparison, f64)| of.0;
    Compatibility {
        pitch: pitch.map(first),
        vane: vane.map(first),
        vane_lead,
        airspeed: airspeed.map(first),
    }
}

/// The signals of a flight at one time.
struct Moment {
    alpha: Option<f64>,
    q: Option<f64>,
    airspeed: Option<f64>,
    theta: Option<f64>,
    az: Option<f64>,
    ax: Option<f64>,
}

/// A part of a flight: times, measured and expected values (up to a constant), and the pitch rate.
struct Block {
    times: Vec<f64>,
    measured: Vec<f64>,
    expected: Vec<f64>,
    q: Vec<f64>,
}

fn blocks(flight: &Flight, name: &str, rate: impl Fn(&Moment) -> Option<f64>) -> Vec<Block> {
    let column = |name: &str| flight.column(name);
    let (of, columns) = (column(name), ["alpha", "q", "V", "theta", "az", "ax"].map(column));
    let mut blocks: Vec<Block> = Vec::new();
    let mut last = None;
    for (at, &time) in flight.times.iter().enumerate() {
        let [alpha, q, airspeed, theta, az, ax] = columns.map(|column| column?[at]);
        let moment = Moment { alpha, q, airspeed, theta, az, ax };
        let (Some(measured), Some(rate), Some(q)) = (of.and_then(|of| of[at]), rate(&moment), q)
        else {
            continue;
        };
        let new = last.is_none_or(|(before, _)| time - before > 1.0)
            || blocks.last().is_some_and(|block| time - block.times[0] > BLOCK_S);
        if new {
            blocks.push(Block { times: vec![], measured: vec![], expected: vec![], q: vec![] });
        }
        let Some(block) = blocks.last_mut() else { continue };
        let more = match (new, last) {
            (false, Some((before, slope))) => 0.5 * (slope + rate) * (time - before),
            _ => 0.0,
        };
        let sum = block.expected.last().copied().unwrap_or(0.0) + more;
        block.times.push(time);
        block.measured.push(measured);
        block.expected.push(sum);
        block.q.push(q);
        last = Some((time, rate));
    }
    blocks.retain(|block| block.times[block.times.len() - 1] - block.times[0] > 0.2 * BLOCK_S);
    blocks
}

/// The comparison at the delay with the smallest residual, and the coefficient of q.
fn compare(
    flights: &[Flight],
    name: &str,
    with_rate: bool,
    rate: impl Fn(&Moment) -> Option<f64> + Copy,
) -> Option<(Comparison, f64)> {
    let blocks: Vec<_> = flights.iter().flat_map(|flight| blocks(flight, name, rate)).collect();
    let interval = flights.iter().map(Flight::interval).fold(f64::MAX, f64::min);
    let most = (2.0 * LONGEST_DELAY_S / interval).round().min(50.0) as i32;
    // A lever arm and a delay look nearly alike: where the lever arm is estimated, the delay is zero.
    let delays = if with_rate { 0..=0 } else { -most..=most };
    let found =
        delays.filter_map(|delay| at_delay(&blocks, f64::from(delay) * 0.5 * interval, with_rate));
    found.min_by(|(one, _), (other, _)| one.residual.total_cmp(&other.residual))
}

fn at_delay(blocks: &[Block], delay: f64, with_rate: bool) -> Option<(Comparison, f64)> {
    let unknowns = usize::from(with_rate) + 1;
    let columns = unknowns + 2 * blocks.len();
    let lines: usize = blocks.iter().map(|block| block.times.len()).sum();
    if lines < 4 * columns {
        return None;
    }
    let mut matrix = DMatrix::zeros(lines, columns);
    let mut target = DVector::zeros(lines);
    let mut line = 0;
    for (index, block) in blocks.iter().enumerate() {
        let middle = 0.5 * (block.times[0] + block.times[block.times.len() - 1]);
        for at in 0..block.times.len() {
            let time = block.times[at] - delay;
            let after =
                block.times.partition_point(|it| *it <= time).clamp(1, block.times.len() - 1);
            let span = block.times[after] - block.times[after - 1];
            let share = ((time - block.times[after - 1]) / span).clamp(0.0, 1.0);
            let [a, b] = [block.expected[after - 1], block.expected[after]];
            matrix[(line, 0)] = a + share * (b - a);
            if with_rate {
                matrix[(line, 1)] = block.q[at];
            }
            matrix[(line, unknowns + 2 * index)] = 1.0;
            matrix[(line, unknowns + 2 * index + 1)] = block.times[at] - middle;
            target[line] = block.measured[at];
            line += 1;
        }
    }
    let inverse = matrix.tr_mul(&matrix).cholesky()?.inverse();
    let found = &inverse * matrix.tr_mul(&target);
    let left = &target - &matrix * &found;
    let variance = left.norm_squared() / (lines - columns) as f64;
    let correlation = autocorrelation(left.as_slice(), 2);
    let next = (correlation[1] / correlation[0].max(f64::MIN_POSITIVE)).clamp(0.0, 0.999);
    // Scaled to the number of independent samples.
    let coloured = variance * (1.0 + next) / (1.0 - next);
    let drifts = (0..blocks.len()).map(|index| found[unknowns + 2 * index + 1]);
    let comparison = Comparison {
        scale: found[0],
        scale_sigma: (coloured * inverse[(0, 0)]).max(0.0).sqrt(),
        drift: drifts.sum::<f64>() / blocks.len() as f64,
        delay,
        residual: variance.sqrt(),
    };
    Some((comparison, if with_rate { found[1] } else { 0.0 }))
}
