//! Surveys of anchors: their places from the ranges between them.
//!
//! A free network: the places that fit the ranges best, robustly (Student's distribution with one degree of freedom,
//! after Cauchy), by damped least squares from many starts; its covariance is that of inner constraints (Baarda 1973),
//! about the anchors' centre.

mod network;

use self::network::{Network, Shape};

/// The ranges between two anchors.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The indices of the anchors in the list, the smaller first.
    pub anchors: [usize; 2],
    /// The median of the ranges in either direction, m.
    pub metres: f64,
    /// The number of ranges.
    pub count: usize,
}

/// The places of anchors, as surveyed.
#[derive(Debug, Clone, PartialEq)]
pub struct Survey {
    /// The places of the anchors, m: the first is the origin, the second on the positive x axis, the next that is
    /// beside it at positive y in the plane z = 0, and the next beside that plane above it.
    pub places: Vec<[f64; 3]>,
    /// Standard deviations of each place along the axes, m, about the centre of all.
    pub sigmas: Vec<[f64; 3]>,
    /// The standard deviation of a range from all residuals, m; `None` without redundancy.
    pub range_sigma: Option<f64>,
    /// The pairs that do not fit, and by how much each is too long, m.
    pub left_out: Vec<(Pair, f64)>,
    /// The anchors for which another place fits nearly as well.
    pub ambiguous: Vec<usize>,
}

/// Why anchors cannot be placed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Unplaced {
    /// There are too few anchors.
    #[error("{dimensions} dimensions need ranges between {} anchors at least, found {found}", dimensions + 1)]
    TooFew {
        /// The number of dimensions.
        dimensions: usize,
        /// The number of anchors.
        found: usize,
    },
    /// These anchors have fewer ranges to others than there are dimensions, or are in one line or plane with those.
    #[error("the ranges do not determine where these anchors are, counted from 0: {0:?}")]
    Loose(Vec<usize>),
    /// All anchors stand in one plane (in two dimensions: one line), or so nearly that the ranges do not tell how far off
    /// it, and on which side, each is.
    #[error(
        "the anchors stand in one {}, or nearly: their ranges do not tell {dimensions} coordinates",
        if *.dimensions > 2 { "plane" } else { "line" }
    )]
    Flat {
        /// The number of dimensions.
        dimensions: usize,
    },
}

/// The deviation beyond which a pair does not fit, in standard deviations.
const OUTLIER: f64 = 5.0;
/// The standard deviation of a range if nothing better is known, and (`LEAST_SIGMA`) its lower limit, m.
const USUAL_SIGMA: f64 = 0.1;
const LEAST_SIGMA: f64 = 0.02;
/// The difference of costs up to which two shapes remain undecided: half the square of two standard deviations.
const ALIKE: f64 = 2.0;
/// The difference in an anchor's distances beyond which two shapes differ, m.
const DIFFERENT: f64 = 0.5;
/// The standard deviation beyond which a place is not determined, m.
const LOOSE: f64 = 2.0;

/// Groups measurements by pairs: indices of two anchors and a range in m, any number of each; each pair has the median.
pub fn pairs(ranges: impl IntoIterator<Item = ([usize; 2], f64)>) -> Vec<Pair> {
    let mut all = std::collections::BTreeMap::<[usize; 2], Vec<f64>>::new();
    for ([one, other], metres) in ranges {
        if one != other && metres.is_finite() && metres > 0.0 {
            all.entry([one.min(other), one.max(other)]).or_default().push(metres);
        }
    }
    let pair = |(anchors, metres): ([usize; 2], Vec<f64>)| Pair {
        anchors,
        metres: crate::metrics::median(&metres),
        count: metres.len(),
    };
    all.into_iter().map(pair).collect()
}

/// Computes the places of `anchors` anchors from the ranges between them, in two or three dimensions. Their mirror
/// image fits as well: only somebody who sees the room can tell.
///
/// # Errors
/// [`Unplaced`].
pub fn survey(anchors: usize, pairs: &[Pair], dimensions: usize) -> Result<Survey, Unplaced> {
    if anchors <= dimensions {
        return Err(Unplaced::TooFew { dimensions, found: anchors });
    }
    let mut network = Network { anchors, dimensions, pairs, sigma: USUAL_SIGMA };
    let loose = network.loose();
    if !loose.is_empty() {
        return Err(Unplaced::Loose(loose));
    }
    let mut shapes = network.shapes();
    let spare = pairs.len().saturating_sub(network.unknowns());
    let mut range_sigma = None;
    if spare > 0
        && let Some(best) = shapes.first()
    {
        // The scale of the ranges that fit, once that is known.
        let sigma = network.spread(best, spare).max(LEAST_SIGMA);
        range_sigma = Some(sigma);
        network.sigma = sigma;
        shapes = shapes.iter().map(|shape| network.settled(shape)).collect();
        shapes.sort_by(|one, other| one.cost.total_cmp(&other.cost));
    }
    let Some(best) = shapes.first() else { return Err(Unplaced::Loose((0..anchors).collect())) };
    let flat = Unplaced::Flat { dimensions };
    if network.fits_flattened(best) {
        return Err(flat);
    }
    let ambiguous = ambiguous(&network, best, &shapes);
    let best = best.turned(dimensions);
    let Some(sigmas) = network.sigmas(&best) else { return Err(flat) };
    let vague: Vec<_> =
        (0..anchors).filter(|&i| sigmas[i].iter().any(|sigma| *sigma > LOOSE)).collect();
    if vague.len() == anchors {
        return Err(flat);
    }
    if !vague.is_empty() {
        return Err(Unplaced::Loose(vague));
    }
    let left_out = pairs.iter().filter_map(|pair| {
        let excess = pair.metres - best.distance(pair.anchors);
        (excess.abs() > OUTLIER * network.sigma).then(|| (pair.clone(), excess))
    });
    let left_out = left_out.collect();
    Ok(Survey { places: best.places, sigmas, range_sigma, left_out, ambiguous })
}

/// The anchors with another place in a different shape that fits nearly as well.
fn ambiguous(network: &Network<'_>, best: &Shape, shapes: &[Shape]) -> Vec<usize> {
    let alike = shapes.iter().filter(|shape| shape.cost - best.cost < ALIKE);
    let mut found: Vec<usize> = alike.flat_map(|shape| network.moved(best, shape)).collect();
    found.sort_unstable();
    found.dedup();
    found
}
