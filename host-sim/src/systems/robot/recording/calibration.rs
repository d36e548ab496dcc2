//! Calibrations of anchors, as files of range biases.

use std::path::Path;

use kestirim_replay::robot::Anchors;
use serde::Serialize;

use crate::metrics::{mean, percentile};
use crate::table;
use crate::text::printable;
use crate::{Error, output};

/// The largest plausible bias (m).
const LARGEST_BIAS: f64 = 100.0;

/// The plausible ranges (m); others are left out.
const PLAUSIBLE: std::ops::RangeInclusive<f64> = -1.0..=200.0;
/// The ratio of the standard deviation of normal values to their interquartile range.
const DEVIATION: f64 = 0.7413;

/// The calibration of an anchor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnchorCalibration {
    /// The name of the anchor.
    pub anchor: String,
    /// The bias of its ranges (m), positive if they are too long.
    pub bias_m: f64,
    /// The standard deviation of the remaining error (m).
    pub sigma_m: f64,
    /// The number of ranges used.
    pub ranges: usize,
}

/// The differences between measured and true distances of each anchor.
///
/// Firmware uses `kestirim_uwb_ranging::Quartiles` for this; here there is memory for exact ones.
#[derive(Debug, Clone)]
pub struct Residuals {
    of_anchors: Vec<Vec<f64>>,
    /// The number of implausible ranges of each anchor that were left out.
    left_out: Vec<usize>,
}

impl Residuals {
    /// A collection without ranges.
    pub fn new(anchors: &Anchors) -> Self {
        let count = anchors.names.len();
        Self { of_anchors: vec![Vec::new(); count], left_out: vec![0; count] }
    }

    /// Adds a range measured at a known position.
    pub fn add(&mut self, anchors: &Anchors, anchor: usize, range: f64, truth: [f64; 3]) {
        let (Some(place), Some(residuals)) =
            (anchors.positions.get(anchor), self.of_anchors.get_mut(anchor))
        else {
            return;
        };
        if PLAUSIBLE.contains(&range) {
            let squares: f64 = place.iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum();
            residuals.push(range - squares.sqrt());
        } else {
            self.left_out[anchor] += 1;
        }
    }

    /// Whether more ranges were left out than used, which means that they are in another unit.
    pub fn is_doubtful(&self) -> bool {
        let taken: usize = self.of_anchors.iter().map(Vec::len).sum();
        self.left_out.iter().sum::<usize>() > taken
    }

    /// The calibration of every anchor with ranges.
    pub fn calibrations(&self, anchors: &Anchors) -> Vec<AnchorCalibration> {
        let heard = anchors.names.iter().zip(&self.of_anchors).filter(|(_, of)| !of.is_empty());
        let calibration = |(name, residuals): (&String, &Vec<f64>)| AnchorCalibration {
            anchor: name.clone(),
            bias_m: percentile(residuals, 50.0),
            sigma_m: DEVIATION * (percentile(residuals, 75.0) - percentile(residuals, 25.0)),
            ranges: residuals.len(),
        };
        heard.map(calibration).collect()
    }
}

/// Writes CSV with columns `anchor,bias,sigma,ranges` (m).
///
/// # Errors
/// If the file cannot be written.
pub fn write(path: &Path, calibrations: &[AnchorCalibration]) -> Result<(), Error> {
    output::write_file(path, |file| {
        let mut table = csv::Writer::from_writer(file);
        table.write_record(["anchor", "bias", "sigma", "ranges"])?;
        for calibration in calibrations {
            table.write_record([
                calibration.anchor.clone(),
                format!("{:.6}", calibration.bias_m),
                format!("{:.6}", calibration.sigma_m),
                calibration.ranges.to_string(),
            ])?;
        }
        table.flush()
    })
}

/// The bias of each anchor of the list (m), and warnings about those that the file does not name: their biases are
/// assumed to be the mean of the others.
///
/// # Errors
/// An error that names the file, the line, and what was expected there.
pub fn of(path: &Path, anchors: &Anchors) -> Result<(Vec<f64>, Vec<String>), Error> {
    let known = read(path, anchors)?;
    let found: Vec<f64> = known.iter().flatten().copied().collect();
    let mean = mean(&found);
    let unknown = known.iter().zip(&anchors.names).filter(|(bias, _)| bias.is_none());
    let warnings = unknown.map(|(_, name)| {
        format!("the calibration does not know anchor {name}: the others' mean bias is assumed")
    });
    Ok((known.iter().map(|bias| bias.unwrap_or(mean)).collect(), warnings.collect()))
}

/// The bias of each anchor of the list (m); `None` for those that the file does not name.
fn read(path: &Path, anchors: &Anchors) -> Result<Vec<Option<f64>>, Error> {
    let mut biases = vec![None; anchors.names.len()];
    table::read(
        path,
        "biases of anchors",
        |header| header.require(["anchor", "bias"]),
        |&[name, bias], row| {
            let bias = row.number("bias", bias)?;
            if bias.abs() > LARGEST_BIAS {
                return Err(row
                    .line
                    .error("expected a bias in metres, found one beyond any radio"));
            }
            // A calibration may contain more anchors than are used.
            let Some(place) = anchors.find(&row.text(name)) else { return Ok(()) };
            let Some(known @ None) = biases.get_mut(place) else {
                let found = printable(&row.text(name));
                return Err(row.line.error(format!("expected another anchor, found {found}")));
            };
            *known = Some(bias);
            Ok(())
        },
    )?;
    Ok(biases)
}
