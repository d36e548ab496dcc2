//! The reader that `host-sim` had before the importer: what it reads, the importer reads identically, bit for bit.

use std::array;

use kestirim_import::STANDARD_GRAVITY;
use kestirim_import::inertial::Sample;

const CSV: [&str; 7] = ["t", "ax", "ay", "az", "gx", "gy", "gz"];
const TRUTH: [&str; 3] = ["gt_x", "gt_y", "gt_z"];

/// A log with its ground truth.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Log {
    pub(crate) samples: Vec<Sample>,
    pub(crate) truth: Option<Vec<[f64; 3]>>,
}

/// Reads a log; `None` if it is refused.
pub(crate) fn read(bytes: &[u8]) -> Option<Log> {
    let text = String::from_utf8(bytes.to_vec()).ok()?;
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    let lines = || text.lines().map(str::trim).filter(|line| !line.is_empty());
    let starts_with_number = |line: &str| {
        line.split([',', ' ', '\t']).next().is_some_and(|field| field.parse::<f64>().is_ok())
    };
    let first = lines().next()?;
    let is_csv = lines().find(|line| starts_with_number(line)).unwrap_or(first).contains(',');
    let mut log = Log::default();
    if is_csv {
        let names: Vec<_> = first.split(',').map(str::trim).collect();
        let place = |name: &str| names.iter().position(|&known| known == name);
        let mut places = [0; 7];
        for (at, name) in places.iter_mut().zip(CSV) {
            *at = place(name)?;
        }
        let truth = TRUTH.map(place);
        log.truth = truth[0].map(|_| Vec::new());
        for line in lines().skip(1) {
            let fields: Vec<_> = line.split(',').map(str::trim).collect();
            if fields.len() != names.len() {
                return None;
            }
            push(&mut log, numbers(places.map(|at| fields[at]))?)?;
            if let (Some(log), [Some(x), Some(y), Some(z)]) = (&mut log.truth, truth) {
                log.push(numbers([x, y, z].map(|at| fields[at]))?);
            }
        }
    } else {
        for line in lines().skip(usize::from(!starts_with_number(first))) {
            let fields: Vec<_> = line.split_whitespace().collect();
            let values: [f64; 7] = numbers(array::from_fn(|i| fields[i]))?;
            let [t, ax, ay, az, gx, gy, gz] = values;
            let [ax, ay, az] = [ax, ay, az].map(|force| force * STANDARD_GRAVITY);
            let [gx, gy, gz] = [gx, gy, gz].map(f64::to_radians);
            push(&mut log, [t * 1e-3, ax, ay, az, gx, gy, gz])?;
        }
    }
    (!log.samples.is_empty()).then_some(log)
}

fn numbers<const N: usize>(fields: [&str; N]) -> Option<[f64; N]> {
    let mut values = [0.0; N];
    for (value, field) in values.iter_mut().zip(fields) {
        *value = field.parse().ok().filter(|value: &f64| value.is_finite())?;
    }
    Some(values)
}

fn push(log: &mut Log, values: [f64; 7]) -> Option<()> {
    let [t, ax, ay, az, gx, gy, gz] = values;
    let time_us = (t * 1e6).round() as u64;
    if t < 0.0 || log.samples.last().is_some_and(|last| time_us < last.time_us) {
        return None;
    }
    log.samples.push(Sample { time_us, specific_force: [ax, ay, az], angular_rate: [gx, gy, gz] });
    Some(())
}
