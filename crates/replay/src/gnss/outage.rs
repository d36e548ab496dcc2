//! Why epochs have no solution, in words that help.

use std::fmt;

use kestirim_ppp_filter::Error;

/// Observed satellites that serve for nothing, by the reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Unused {
    /// How many were observed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub observed: usize,
    /// A code or a phase is missing.
    pub incomplete: usize,
    /// There is no orbit at the time.
    pub no_orbit: usize,
    /// There is no clock at the time.
    pub no_clock: usize,
    /// It stands too low.
    pub below_mask: usize,
}

impl Unused {
    /// Adds those of an epoch.
    pub const fn add(&mut self, other: &Self) {
        self.observed += other.observed;
        self.incomplete += other.incomplete;
        self.no_orbit += other.no_orbit;
        self.no_clock += other.no_clock;
        self.below_mask += other.below_mask;
    }

    /// How many there are for each reason that there is.
    fn reasons(&self) -> Vec<String> {
        let reasons = [
            (self.no_orbit, "without an orbit"),
            (self.no_clock, "without a clock"),
            (self.incomplete, "with incomplete observations"),
            (self.below_mask, "below the mask"),
        ];
        let some = reasons.into_iter().filter(|(count, _)| *count > 0);
        some.map(|(count, reason)| format!("{count} {reason}")).collect()
    }
}

impl fmt::Display for Unused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let reasons = self.reasons();
        let plural = if self.observed == 1 { "" } else { "s" };
        match (self.observed, &*reasons) {
            (0, _) => f.write_str("no satellite of GPS was observed"),
            (observed, []) => write!(f, "of {observed} observed satellite{plural}"),
            (observed, _) => {
                write!(f, "of {observed} observed satellite{plural} {}", reasons.join(", "))
            }
        }
    }
}

/// An epoch without a solution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outage {
    /// What the filter says.
    pub error: Error,
    /// When, s since the midnight before the first epoch.
    pub t: f64,
    /// Which satellites it was not given.
    pub unused: Unused,
}

impl fmt::Display for Outage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.error, self.unused)
    }
}

/// The epochs without a solution: of each kind the first, and how many there are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outages(Vec<(Outage, usize)>);

impl Outages {
    /// Adds one.
    pub fn add(&mut self, outage: Outage) {
        match self.0.iter_mut().find(|(first, _)| first.error == outage.error) {
            Some((_, count)) => *count += 1,
            None => self.0.push((outage, 1)),
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.0.iter().map(|(_, count)| count).sum()
    }

    /// The first of all.
    pub fn first(&self) -> Option<&Outage> {
        self.0.first().map(|(outage, _)| outage)
    }

    /// A sentence for each kind.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(outage, count)| {
            let (epochs, the_first) =
                if *count == 1 { ("epoch", "") } else { ("epochs", "the first ") };
            format!("{count} {epochs} without a solution, {the_first}at {} s: {outage}", outage.t)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_told() {
        let unused = Unused { observed: 11, no_orbit: 8, below_mask: 1, ..Unused::default() };
        let outage = |t| Outage { error: Error::TooFewSatellites, t, unused };
        let mut outages = Outages::default();
        outages.add(outage(85_530.0));
        outages.add(outage(85_560.0));
        outages.add(Outage {
            error: Error::PoorGeometry,
            unused: Unused { observed: 1, ..Unused::default() },
            ..outage(86_000.5)
        });
        assert_eq!(outages.count(), 3);
        let warnings: Vec<_> = outages.warnings().collect();
        assert_eq!(
            warnings,
            [
                "2 epochs without a solution, the first at 85530 s: fewer than four usable satellites (of 11 \
                 observed satellites 8 without an orbit, 1 below the mask)",
                "1 epoch without a solution, at 86000.5 s: the satellites' geometry fixes no position (of 1 \
                 observed satellite)",
            ]
        );
        assert_eq!(Unused::default().to_string(), "no satellite of GPS was observed");
    }
}
