//! Contradictions between data and model: innovations that are not what they would be if the model were right.

use super::Followed;
use crate::clipped::Clipped;
use kestirim_health::{Health, Reason};

/// The fewest innovations of an output from which it is judged.
const FEWEST: usize = 200;
/// The limit to which outliers are clipped, in standard deviations.
const LARGEST: f64 = 3.2;
/// The mean square, in variances, beyond which innovations are larger than noise explains. A right model has 1, and
/// noise of one and a half times what was stated is no reason to doubt.
const SQUARE: f64 = 2.25;
/// The mean product of successive innovations, in variances, beyond which they are correlated. A right model has 0, and
/// one whose process noise is too large or too small by a factor of ten has less than this.
const PRODUCT: f64 = 0.4;
/// The mean square of the additional estimated quantities, relative to the model's variances, beyond which the model is
/// doubted.
const BESIDE: f64 = 2.25;
/// The fewest additional estimated quantities from which their mean square is judged.
const FEWEST_BESIDE: usize = 3;

/// The reasons for which single lines are doubted, with their sentences.
const DOUBTED: [(Reason, &str); 3] = [
    (
        Reason::Innovations,
        "model and measurements disagree by far more than noise explains: another aircraft, a unit, a sign, or a sensor with an offset",
    ),
    (
        Reason::Rejected,
        "for a while more than a tenth of the measurements contradict the estimate and are left out",
    ),
    (
        Reason::Time,
        "inputs and measurements do not belong together in time: measurements come late, or inputs do",
    ),
];

/// Why model and measurements contradict each other.
#[derive(Debug, Clone, PartialEq)]
pub enum Contradiction {
    /// The innovations of one of the log's outputs are larger than model and noise explain.
    Large {
        /// The index among the log's outputs.
        output: usize,
        /// Their root mean square, in standard deviations.
        size: f64,
    },
    /// Successive innovations of an output are correlated: for seconds, the output shows something other than what the
    /// model says.
    Coloured {
        /// The index among the log's outputs.
        output: usize,
        /// The share of their variance that each has in common with the next one.
        shared: f64,
    },
    /// The quantities estimated in addition to the states are larger than the model says.
    Beside {
        /// Their root mean square, in the model's standard deviations.
        size: f64,
    },
    /// The estimated airspeed is beyond those of a grid of models, by more than half of the distance between its last
    /// two; or, for a quarter of the flight, more than 12 % from that of a single model.
    Beyond {
        /// The furthest airspeed, m/s.
        airspeed: f64,
        /// The airspeed at the end of the grid, or of the single model, m/s.
        end: f64,
    },
}

impl Contradiction {
    /// The contradiction in a sentence, with the names of the outputs.
    pub fn sentence<'a>(&self, mut names: impl Iterator<Item = &'a str>) -> String {
        let mut name = |output: usize| names.nth(output).unwrap_or_default();
        match *self {
            Self::Large { output, size } => format!(
                "{} contradicts the model: it differs from what is expected by {size:.1} times what noise explains",
                name(output)
            ),
            Self::Coloured { output, shared } => format!(
                "{} contradicts the model: it stays above or below what is expected for many lines in a row ({:.0} % of a \
                 difference is the next line's, too): wind, gusts, a bias, another trim or aircraft",
                name(output),
                100.0 * shared
            ),
            Self::Beside { size } => format!(
                "biases, wind and trim are {size:.1} times as far from the model's as it says they would be: a sensor that \
                 measures something else, or another aircraft"
            ),
            Self::Beyond { airspeed, end } => format!(
                "the airspeed reaches {airspeed:.1} m/s, too far from {end:.1} m/s, where the model was made or its grid ends: \
                 what is estimated there is as the model has it at that airspeed"
            ),
        }
    }
}

impl Followed {
    /// The contradictions to the model, the worst of each output.
    pub fn contradictions(&self) -> Vec<Contradiction> {
        let outputs = self.normalised.iter().enumerate();
        let mut all: Vec<_> = outputs.filter_map(|(output, it)| of_output(output, it)).collect();
        let known = self.beside.iter().filter(|it| it.said > 0.0 && !it.name.starts_with("gust"));
        let squares: Vec<f64> = known.map(|it| (it.value / it.said).powi(2)).collect();
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        if squares.len() >= FEWEST_BESIDE && mean > BESIDE {
            all.push(Contradiction::Beside { size: mean.sqrt() });
        }
        all.extend(self.beyond.map(|[airspeed, end]| Contradiction::Beyond { airspeed, end }));
        all
    }
}

impl Followed {
    /// The health of each line: its own, with what contradicts the model as a whole.
    pub fn lines(&self) -> impl Iterator<Item = Health> {
        let is_doubted = !self.contradictions().is_empty();
        self.healths.iter().map(move |it| it.with(Reason::Innovations, is_doubted))
    }

    /// When and why single lines are doubted: a sentence for each reason.
    pub fn doubted_lines(&self) -> impl Iterator<Item = (Reason, String)> {
        DOUBTED.into_iter().filter_map(|(reason, sentence)| {
            let place = self.healths.iter().position(|health| health.has(reason))?;
            let count = self.healths.iter().filter(|health| health.has(reason)).count();
            let share = 100.0 * count as f64 / self.healths.len() as f64;
            let first = self.estimates.get(place)?.t_us as f64 / 1e6;
            let share = if share < 1.0 { "less than 1".to_owned() } else { format!("{share:.0}") };
            Some((reason, format!("{sentence}; first at {first:.2} s, in {share} % of the lines")))
        })
    }
}

fn of_output(output: usize, innovations: &[f64]) -> Option<Contradiction> {
    if innovations.len() < FEWEST {
        return None;
    }
    let Clipped { square, product } = Clipped::of(innovations.iter().copied(), LARGEST);
    if square > SQUARE {
        Some(Contradiction::Large { output, size: square.sqrt() })
    } else if product > PRODUCT {
        Some(Contradiction::Coloured { output, shared: product / square })
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The contradictions found for innovations of noise that looks random, with something added.
    fn told(added: impl Fn(usize) -> f64) -> Vec<Contradiction> {
        let noise = |at: usize| 1.7 * ((at * at) as f64).sin();
        let normalised = vec![(0..2000).map(|at| noise(at) + added(at)).collect()];
        Followed { normalised, ..Followed::default() }.contradictions()
    }

    #[test]
    fn noise_is_none_and_what_lasts_is_one() {
        assert_eq!(told(|_| 0.0), []);
        assert_eq!(told(|at| if at % 50 == 0 { 30.0 } else { 0.0 }), [], "outliers");
        assert!(matches!(told(|_| 0.8)[..], [Contradiction::Coloured { output: 0, .. }]));
        assert!(matches!(
            told(|at| (at as f64 * 0.02).sin() * 1.2)[..],
            [Contradiction::Coloured { .. }]
        ));
        assert!(matches!(told(|_| 2.0)[..], [Contradiction::Large { .. }]));
    }
}
