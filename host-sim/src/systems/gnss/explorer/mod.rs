//! A receiver's recording, and what the filters make of it while one turns at them.

mod controls;
mod open;

use std::path::PathBuf;

use kestirim_ppp_filter::Motion;
use nalgebra::Vector3;
use rayon::prelude::*;

use super::figures;
use super::follow::Followed;
use super::options::{FilterKind, Setup};
use super::recording::Recording;
use super::session::Session;
use crate::Error;
use crate::explore::{Answer, Control, Explorer, Settings};
use crate::figure::Figure;

pub use open::SOURCE;

/// A recording that is open.
#[derive(Debug)]
struct Receiver {
    log: PathBuf,
    recording: Recording,
    truth: Option<Vector3<f64>>,
}

impl Explorer for Receiver {
    fn controls(&self) -> Vec<Control> {
        let epochs = self.recording.epochs(None);
        let hours = |epoch| self.recording.seconds(epoch) / 3600.0;
        controls::controls([epochs.first().map_or(0.0, hours), epochs.last().map_or(24.0, hours)])
    }

    fn answer(&self, settings: &Settings) -> Result<Answer, Error> {
        let session = self.session(settings);
        let chosen = controls::filter(settings);
        let (report, followed) = session.one(chosen, true)?;
        let about = self.truth.unwrap_or_else(|| report.position_ecef_m.into());
        let others: Vec<_> = if settings.is_on("compare") {
            let others = FilterKind::ALL.into_par_iter().filter(|&filter| filter != chosen);
            // A filter without a position has nothing to draw.
            others.filter_map(|filter| Some((filter, session.one(filter, false).ok()?.1))).collect()
        } else {
            Vec::new()
        };
        let mut answer = Answer { warnings: report.warnings.clone(), ..Answer::default() };
        for (name, value) in report.facts() {
            answer.fact(name, value);
        }
        answer.figures = self.figures(&about, chosen, &followed, &others);
        Ok(answer)
    }
}

impl Receiver {
    fn session(&self, settings: &Settings) -> Session<'_> {
        let process_noise = settings.number("process-noise");
        let motion = if settings.choice("mode") == "kinematic" {
            Motion::Kinematic { process_noise }
        } else {
            Motion::Static
        };
        let until = 3600.0 * settings.number("until");
        let thresholds = [settings.number("k0"), settings.number("k1")];
        Session {
            log: &self.log,
            recording: &self.recording,
            // The slider begins at the first epoch: one there is always.
            epochs: self.recording.epochs(Some(until)),
            setup: Setup {
                motion,
                mask: Some(settings.number("mask").to_radians()),
                printed: settings.is_on("printed"),
                thresholds: settings.is_on("thresholds").then_some(thresholds),
            },
            corrections: controls::corrections(settings),
            truth: self.truth.as_ref(),
        }
    }

    fn figures(
        &self,
        about: &Vector3<f64>,
        chosen: FilterKind,
        followed: &Followed,
        others: &[(FilterKind, Followed)],
    ) -> Vec<Figure> {
        let origin = if self.truth.is_some() { "the truth" } else { "the last position" };
        let lines = others.iter().map(|(filter, followed)| (*filter, followed));
        let lines = lines.chain([(chosen, followed)]);
        vec![
            figures::errors(Figure::new("error", "Distance"), lines, about)
                .caption(format!("Distance from {origin}.")),
            figures::components(Figure::new("components", "East, north, up"), followed, about)
                .caption(format!("To the east, north and up of {origin}.")),
            figures::residuals(
                Figure::new("residuals", "Residuals of the codes"),
                followed,
                |report| &report.code,
            )
            .caption("Over √(Qᵥ/γ), a colour a satellite; the legend shows the rejected ones."),
            figures::residuals(
                Figure::new("phases", "Residuals of the phases"),
                followed,
                |report| &report.phase,
            )
            .caption("Over √(Qᵥ/γ), a colour a satellite; the legend shows the rejected ones."),
            figures::deviations(
                Figure::new("sigma", "Standard deviations as reported"),
                followed,
                self.truth.as_ref(),
            )
            .caption(
                "What the filter says of itself, and how far off it is where the truth is known.",
            ),
            figures::satellites(Figure::new("satellites", "Satellites"), followed).caption(
                "When each was used, what of it was rejected, and where its ambiguity began anew.",
            ),
            figures::plan(Figure::new("plan", "Plan"), followed, about)
                .caption(format!("About {origin}; the legend shows the first hour.")),
        ]
    }
}

#[cfg(test)]
mod tests;
