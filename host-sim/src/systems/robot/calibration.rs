//! What is known of each anchor's ranges: a file of biases.

use std::path::Path;

use kestirim_uwb_ranging::Quartiles;
use serde::Serialize;

use super::anchors::Anchors;
use super::table;
use crate::text::printable;
use crate::{Error, output};

/// Beyond the bias of any radio that works, m.
const LARGEST_BIAS: f64 = 100.0;

/// Beyond it a range is wild, m.
const LARGEST_RESIDUAL: f64 = 3.0;

/// What was found of an anchor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct AnchorCalibration {
    /// Its name.
    pub anchor: String,
    /// What its ranges are too long by, m.
    pub bias_m: f64,
    /// Standard deviation of what is left, m.
    pub sigma_m: f64,
    /// From how many ranges.
    pub ranges: u32,
}

/// The differences between measured and true distances, anchor by anchor.
#[derive(Debug, Clone)]
pub struct Residuals {
    quartiles: Vec<Quartiles<f64>>,
}

impl Residuals {
    /// Nothing yet.
    pub fn new(anchors: &Anchors) -> Self {
        Self {
            quartiles: vec![
                Quartiles::within(-LARGEST_RESIDUAL, LARGEST_RESIDUAL);
                anchors.names.len()
            ],
        }
    }

    /// Takes in a range measured at a known place.
    pub fn add(&mut self, anchors: &Anchors, anchor: usize, range: f64, truth: [f64; 3]) {
        let (Some(place), Some(quartiles)) =
            (anchors.positions.get(anchor), self.quartiles.get_mut(anchor))
        else {
            return;
        };
        let squares: f64 = place.iter().zip(truth).map(|(a, b)| (a - b).powi(2)).sum();
        quartiles.add(range - squares.sqrt());
    }

    /// The calibration of every anchor that was heard.
    pub fn calibrations(&self, anchors: &Anchors) -> Vec<AnchorCalibration> {
        let pairs = anchors.names.iter().zip(&self.quartiles);
        let heard = pairs.filter_map(|(name, quartiles)| {
            Some(AnchorCalibration {
                anchor: name.clone(),
                bias_m: quartiles.median()?,
                sigma_m: quartiles.deviation()?,
                ranges: quartiles.count(),
            })
        });
        heard.collect()
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

/// The bias of each anchor of the list, m; none of those that the file does not name.
///
/// # Errors
/// The file, the line, and what was expected there.
pub fn read(path: &Path, anchors: &Anchors) -> Result<Vec<Option<f64>>, Error> {
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
            // A calibration may know more anchors than are used.
            let Some(place) = anchors.find(row.text(name)) else { return Ok(()) };
            let Some(known @ None) = biases.get_mut(place) else {
                let found = printable(row.text(name));
                return Err(row.line.error(format!("expected another anchor, found {found}")));
            };
            *known = Some(bias);
            Ok(())
        },
    )?;
    Ok(biases)
}
