//! The result, in words and tables.

use std::fmt::{self, Display, Formatter};

use crate::compatibility::Comparison;
use crate::fit::Fit;
use crate::identify::{Correlation, Identified, Known, Parameter};

/// Smallest correlation of successive residuals at which they are reported as coloured.
const COLOURED: f64 = 0.3;
/// Largest number of correlated pairs that are reported.
const MOST_PAIRS: usize = 4;
/// Number of standard errors from the nominal value at which a scale or a delay is reported.
const CLEAR: f64 = 3.0;

impl Identified {
    /// Remarks for the user, a sentence each: what these flights do not determine, which sensors contradict each
    /// other, how far the model can be trusted.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let of = |known: &Known| {
            let names = self.parameters.iter().filter(|it| it.known == *known);
            names.map(|it| it.name).collect::<Vec<_>>().join(", ")
        };
        let mut reasons: Vec<Known> = Vec::new();
        for Parameter { known, .. } in &self.parameters {
            if *known != Known::Identified && !reasons.contains(known) {
                reasons.push(*known);
            }
        }
        for known in reasons {
            let names = of(&known);
            notes.push(match known {
                Known::Fixed(reason) => format!("not identified, {reason}: {names}"),
                _ => format!(
                    "these flights hardly tell {names}: what holds of any aircraft stands for them"
                ),
            });
        }
        self.note_sensors(&mut notes);
        let is_there = |name: &str| self.fits.iter().any(|fit| fit.output == name);
        if !is_there("alpha") && !self.model.outputs.contains(&"climb") {
            notes.push("without alpha or climb, the flights are taken for level on average: α is off by their mean climb".to_owned());
        }
        if !is_there("az") {
            notes.push("without az nothing checks the vane: its scale and its place ahead of the centre of mass are in the derivatives of α".to_owned());
        }
        let mut pairs = self.correlations.clone();
        pairs.sort_by(|one, other| other.value.abs().total_cmp(&one.value.abs()));
        let pair = |it: &Correlation| format!("{} and {} ({:+.2})", it.of[0], it.of[1], it.value);
        let told: Vec<_> = pairs.iter().take(MOST_PAIRS).map(pair).collect();
        if !told.is_empty() {
            notes.push(format!("hard to tell apart (correlation): {}", told.join(", ")));
        }
        let coloured = |fit: &&Fit| fit.whiteness.is_some_and(|it| it.next.abs() > COLOURED);
        let names: Vec<_> = self.fits.iter().filter(coloured).map(|fit| fit.output).collect();
        if !names.is_empty() {
            let names = names.join(", ");
            notes.push(format!(
                "residuals of {names} are coloured: standard errors are widened for it"
            ));
        }
        if self.validation.is_none() {
            notes.push("too short for a part that is held out: fly longer".to_owned());
        }
        let grows = self.modes.iter().map(|[re, _]| *re).fold(0.0, f64::max);
        if grows > 0.0 {
            notes
                .push(format!("a mode grows, in {:.0} s to twice", std::f64::consts::LN_2 / grows));
        }
        notes
    }

    fn note_sensors(&self, notes: &mut Vec<String>) {
        let mut scale = |what: &str, found: Option<Comparison>| {
            let Some(Comparison { scale, scale_sigma, .. }) = found else { return };
            if (scale - 1.0).abs() > CLEAR * scale_sigma {
                notes.push(format!("{what} ({scale:.3} ± {scale_sigma:.3} of it)"));
            }
        };
        let found = &self.compatibility;
        scale("the pitch angle turns otherwise than the gyro says", found.pitch);
        scale("the vane moves otherwise than gyro and accelerometer say", found.vane);
        scale("the airspeed changes otherwise than the accelerometers say", found.airspeed);
        let delay = self.parameters.iter().find(|it| it.name == "delay");
        if let Some(it) = delay.filter(|it| it.value.abs() > CLEAR * it.sigma) {
            notes.push(format!("inputs act {:.0} ms after the log says so", 1e3 * it.value));
        }
    }
}

impl Display for Identified {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<16} {:>10} {:>9}  {:<10} equation error, output error", "", "", "±", "")?;
        for it in &self.parameters {
            if let Known::Fixed(_) = it.known {
                continue;
            }
            let mark = if it.known == Known::Weak { " (hardly told)" } else { "" };
            let output_error =
                it.output_error.map_or("none".to_owned(), |value| format!("{value:.4}"));
            writeln!(
                f,
                "{:<16} {:>10.4} {:>9.4}  {:<10} {:.4}, {output_error}{mark}",
                it.name, it.value, it.sigma, it.unit, it.equation_error
            )?;
        }
        for it in &self.coefficients {
            writeln!(f, "{:<16} {:>10.4} {:>9.4}", it.name, it.value, it.sigma)?;
        }
        writeln!(f, "\nmodes, 1/s:")?;
        for [re, im] in self.modes.iter().filter(|[_, im]| *im >= 0.0) {
            let pair = if *im > 0.0 { format!(" ± {im:.4} i") } else { String::new() };
            writeln!(f, "  {re:+.4}{pair}")?;
        }
        let parts =
            [("", Some(&self.fits)), ("of a part that was held out, ", self.validation.as_ref())];
        for (which, fits) in parts {
            let Some(fits) = fits else { continue };
            writeln!(
                f,
                "\nresiduals, {which}rms one sample ahead, rms without correction, Theil's U:"
            )?;
            for fit in fits {
                let next =
                    fit.whiteness.map(|it| format!(", correlation with the next {:+.2}", it.next));
                let next = next.unwrap_or_default();
                writeln!(
                    f,
                    "  {:<6} {:.3e} {:.3e} {:.3}{next}",
                    fit.output, fit.ahead, fit.alone, fit.theil
                )?;
            }
        }
        for note in self.notes() {
            write!(f, "\n{note}")?;
        }
        Ok(())
    }
}
