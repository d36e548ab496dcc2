//! Outages: why epochs have no solution, in words that help.

use std::fmt;

use kestirim_ppp_filter::Error;

/// Numbers of observed satellites that are not used, by the reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Unused {
    /// The number of satellites observed.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub observed: usize,
    /// Satellites of which a code or a phase is missing.
    pub incomplete: usize,
    /// Satellites without an orbit at the time.
    pub no_orbit: usize,
    /// Satellites without a clock at the time.
    pub no_clock: usize,
    /// Satellites below the elevation mask.
    pub below_mask: usize,
}

impl Unused {
    /// Adds the numbers of another epoch.
    pub const fn add(&mut self, other: &Self) {
        self.observed += other.observed;
        self.incomplete += other.incomplete;
        self.no_orbit += other.no_orbit;
        self.no_clock += other.no_clock;
        self.below_mask += other.below_mask;
    }

    /// The number of satellites for each reason that occurs, in words.
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
            (0, _) => f.write_str("no satellite was observed"),
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
    /// The error of the filter.
    pub error: Error,
    /// The time, s since the midnight before the first epoch.
    pub t: f64,
    /// The satellites that were not given to the filter.
    pub unused: Unused,
}

impl fmt::Display for Outage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} ({})", self.error, self.unused)
    }
}

/// The epochs without a solution: for each kind of error, the first one and their number.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outages(Vec<(Outage, usize)>);

impl Outages {
    /// Adds an epoch without a solution.
    pub fn add(&mut self, outage: Outage) {
        match self.0.iter_mut().find(|(first, _)| first.error == outage.error) {
            Some((_, count)) => *count += 1,
            None => self.0.push((outage, 1)),
        }
    }

    /// The number of epochs without a solution.
    pub fn count(&self) -> usize {
        self.0.iter().map(|(_, count)| count).sum()
    }

    /// The first epoch without a solution.
    pub fn first(&self) -> Option<&Outage> {
        self.0.first().map(|(outage, _)| outage)
    }

    /// A sentence for each kind of error.
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
        assert_eq!(Unused::default().to_string(), "no satellite was observed");
    }
}
