//! Figures of how much a filter knows, and how much each measurement adds.

use kestirim_replay::drone::{Cloud, Region, Track};
use rayon::prelude::*;

use crate::figure::{Colour, Figure, Mark, Series};

/// A time (s), a cloud and its region.
pub(super) type Known<'a> = (f64, &'a Cloud, Region);

/// The regions of all estimates that have a cloud.
pub(super) fn regions(track: &Track) -> Vec<Known<'_>> {
    let known = |it| Some((track.seconds(it), it.cloud.as_ref()?, it.cloud.as_ref()?.region()));
    track.estimates.par_iter().filter_map(known).collect()
}

/// A line of one number over time.
fn line(name: &str, known: &[Known<'_>], of: impl Fn(&Known<'_>) -> f64) -> Series {
    Series::path(name, known.iter().map(|it| [it.0, of(it)]))
}

/// The area of the smallest region that holds 90 % of the weight, and that of the corresponding ellipse if the cloud
/// were normally distributed.
pub(super) fn region(known: &[Known<'_>]) -> Figure {
    Figure::new("region", "Area in which the user is with 90 %")
        .over_seconds("area, m²")
        .logarithmic()
        .caption(
            "Far below the ellipse the cloud is a ring, or several clumps: mean and spread do not describe it.",
        )
        .with(line("smallest region", known, |it| it.2.area_m2).coloured(Colour::Ours))
        .with(line("ellipse", known, |it| it.1.ellipse_m2()).coloured(Colour::Other(3)))
}

/// The bits by which each measurement reduces the entropy of the posterior of the position, −∫ p log₂ p (Lindley, *On a
/// Measure of the Information Provided by an Experiment*, Ann. Math. Statist. 27 (1956)), and their sum so far. One bit
/// halves the area of a uniform posterior.
///
/// For a walking user the information lost in the meantime is included: a gain can be negative. The gain of the first
/// measurement is relative to a user anywhere in `searched_m2`, if that is known.
pub(super) fn information(known: &[Known<'_>], searched_m2: Option<f64>) -> Figure {
    let entropies: Vec<_> = known.iter().map(|(t, _, region)| [*t, region.entropy_bits]).collect();
    let [all, gains] = gained(&entropies, searched_m2.map(f64::log2));
    let gains = Series::path("by each estimate's measurements", gains).marked(Mark::Steps);
    Figure::new("information", "Information gained")
        .over_seconds("information, bits")
        .caption(
            "One bit halves the area in which the user may be. A user who walks makes some of it worthless meanwhile.",
        )
        .with(Series::path("all so far", all).coloured(Colour::Other(2)))
        .with(gains.coloured(Colour::Ours))
}

/// From times and entropies: the information gained since the beginning, and since the previous estimate.
fn gained(entropies: &[[f64; 2]], prior: Option<f64>) -> [Vec<[f64; 2]>; 2] {
    let first = prior.or_else(|| Some(entropies.first()?[1])).unwrap_or_default();
    // Without a prior the gain of the first measurement is unknown.
    let told = &entropies[usize::from(prior.is_none()).min(entropies.len())..];
    let mut before = first;
    let gains = told.iter().map(|[t, bits]| [*t, std::mem::replace(&mut before, *bits) - bits]);
    let gains = gains.collect();
    [told.iter().map(|[t, bits]| [*t, first - bits]).collect(), gains]
}

/// The effective sample size: how many particles or points carry the weight.
pub(super) fn effective(known: &[Known<'_>]) -> Figure {
    Figure::new("effective", "Effective sample size")
        .over_seconds("particles or points")
        .caption(
            "(Σw)²/Σw² of the weights after a measurement, before resampling: where it falls to a few, they are too few.",
        )
        .with(line("effective", known, |it| it.1.effective).coloured(Colour::Ours))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_gained_is_what_the_entropy_loses() {
        let entropies = [[0.0, 9.0], [1.0, 7.5], [2.0, 8.0]];
        let [all, gains] = gained(&entropies, Some(10.0));
        assert_eq!(all, [[0.0, 1.0], [1.0, 2.5], [2.0, 2.0]]);
        assert_eq!(gains, [[0.0, 1.0], [1.0, 1.5], [2.0, -0.5]]);
        assert_eq!(gained(&entropies[..2], None), [vec![[1.0, 1.5]], vec![[1.0, 1.5]]]);
        assert!(gained(&[], None).iter().all(Vec::is_empty));
    }
}
