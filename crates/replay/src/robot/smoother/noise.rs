//! The noise of each anchor's ranges: its size, and how long it lasts.

use super::knots::{Knots, Measured};

/// The degrees of freedom of Student's distribution for a range that is too long, and for one that is too short.
/// Obstacles lengthen ranges: the fewer the degrees of freedom, the less such a range counts.
const FREEDOM: [f64; 2] = [2.0, 5.0];
/// The smallest scale of the noise, m: a nearby reflection causes as much.
const LEAST_SIGMA: f64 = 0.05;
/// The length of the blocks in which lasting errors are searched for, µs; for a tag that was put down, it is the whole
/// stay.
const BLOCK_US: i64 = 5_000_000;

/// The noise of all anchors.
#[derive(Debug, Clone)]
pub(super) struct Noise {
    links: Vec<Link>,
}

/// The noise of an anchor.
#[derive(Debug, Clone, Copy)]
struct Link {
    /// The scale of the noise, m.
    sigma: f64,
    /// The number of ranges that are worth one with an independent error: 1 or more.
    inflation: f64,
}

/// The weight of a range.
#[derive(Debug, Clone, Copy)]
pub(super) struct Weighed {
    /// The inverse of its variance, 1/m².
    pub(super) information: f64,
    /// −2 ln of its probability, up to a constant.
    pub(super) cost: f64,
}

impl Noise {
    /// The noise of the given number of anchors, each with this standard deviation, m.
    pub(super) fn new(anchors: usize, sigma: f64) -> Self {
        Self { links: vec![Link { sigma, inflation: 1.0 }; anchors] }
    }

    /// Treats each range's error as independent, so that two solutions can be compared for which lasting errors were
    /// estimated differently.
    pub(super) fn forget_lasting(&mut self) {
        for link in &mut self.links {
            link.inflation = 1.0;
        }
    }

    /// The weight of a range that is predicted longer than it was measured by `residual`, m.
    pub(super) fn weigh(&self, anchor: usize, residual: f64) -> Weighed {
        let Link { sigma, inflation } = self.links[anchor];
        let (freedom, square) = (freedom(residual), (residual / sigma).powi(2));
        let share = inflation.recip();
        Weighed {
            information: share * (freedom + 1.0) / ((freedom + square) * sigma * sigma),
            cost: share * ((freedom + 1.0) * (square / freedom).ln_1p() + 2.0 * sigma.ln()),
        }
    }

    /// Learns from the residuals (m) of all ranges, and the variances that the positions add to them (m²); returns
    /// whether anything changed by more than a hundredth.
    ///
    /// The scale is that of expectation maximisation (Lange, Little and Taylor 1989). How long errors last follows from
    /// the means over five seconds, whose variance grows with it: for n ranges with independent errors, the squared sum
    /// is n times the mean square. A lasting error tells nothing new with the next range. Of such errors a share
    /// `left_over` is in the residuals.
    pub(super) fn learn(
        &mut self,
        knots: &Knots,
        left_over: f64,
        residual_of: impl Fn(&Measured) -> (f64, f64),
    ) -> bool {
        let mut sums = vec![Sum::default(); self.links.len()];
        for measured in &knots.measured {
            let (residual, variance) = residual_of(measured);
            let knot = &knots.points[measured.knot];
            let block = (knot.part, knot.epoch.time_us.div_euclid(BLOCK_US));
            sums[measured.anchor].add(self.links[measured.anchor].sigma, residual, variance, block);
        }
        for sum in &mut sums {
            sum.end_block();
        }
        let heard = sums.iter().filter(|sum| sum.count > 0.0);
        let inflation = |sum: &Sum| sum.inflation() / left_over;
        let mean = heard.clone().map(inflation).sum::<f64>() / heard.count().max(1) as f64;
        let mut changed = false;
        for (link, sum) in self.links.iter_mut().zip(&sums).filter(|(_, sum)| sum.count > 0.0) {
            let sigma = (sum.squares / sum.count).sqrt().max(LEAST_SIGMA);
            // An anchor that positions follow shows less of its errors than there is.
            let inflation = inflation(sum).max(mean);
            let moved = |before: f64, now: f64| (now - before).abs() > 0.01 * before;
            changed |= moved(link.sigma, sigma) || moved(link.inflation, inflation);
            *link = Link { sigma, inflation };
        }
        changed
    }
}

fn freedom(residual: f64) -> f64 {
    FREEDOM[usize::from(residual >= 0.0)]
}

/// The sums over the ranges of an anchor.
#[derive(Debug, Clone, Copy, Default)]
struct Sum {
    count: f64,
    /// Weighted squares, m².
    squares: f64,
    /// The current block, and (`of_block`) the sum of its weighted residuals, m.
    block: (usize, i64),
    of_block: f64,
    /// Over all blocks, the squared sums, and (`single_squares`) the sums of squares, m².
    squared_sums: f64,
    single_squares: f64,
}

impl Sum {
    fn add(&mut self, sigma: f64, residual: f64, variance: f64, block: (usize, i64)) {
        if block != self.block {
            self.end_block();
            self.block = block;
        }
        let freedom = freedom(residual);
        let weight = |square: f64| (freedom + 1.0) / (freedom + square / (sigma * sigma));
        let square = residual * residual + variance;
        self.count += 1.0;
        self.squares += weight(square) * square;
        let clipped = weight(residual * residual).min(1.0) * residual;
        self.of_block += clipped;
        self.single_squares += clipped * clipped;
    }

    fn end_block(&mut self) {
        self.squared_sums += self.of_block * self.of_block;
        self.of_block = 0.0;
    }

    fn inflation(&self) -> f64 {
        if self.single_squares > 0.0 {
            (self.squared_sums / self.single_squares).max(1.0)
        } else {
            1.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::Epoch;
    use super::super::knots::Knot;
    use super::*;
    use kestirim_health::Health;

    /// Two anchors, one range of each every tenth of a second.
    fn knots(count: usize) -> Knots {
        let knot = |index: usize| Knot {
            part: 0,
            begin: [0.0; 3],
            epoch: Epoch {
                time_us: index as i64 * 100_000,
                position: None,
                spread: None,
                height_variance: None,
                mirror: None,
                health: Health::GOOD,
            },
        };
        let measured = |knot| [0, 1].map(|anchor| Measured { knot, anchor, metres: 0.0 });
        Knots {
            points: (0..count).map(knot).collect(),
            measured: (0..count).flat_map(measured).collect(),
            ..Knots::default()
        }
    }

    #[test]
    fn the_scale_and_how_long_errors_last_are_found() {
        let knots = knots(5000);
        let mut noise = Noise::new(2, 1.0);
        // The first anchor's errors are independent; the second's last for five seconds.
        let residual = |measured: &Measured| {
            let step = if measured.anchor == 0 { measured.knot } else { measured.knot / 50 };
            let draw = (step as f64 * 12.9898).sin() * 43758.5453;
            (0.2 * (draw - draw.floor() - 0.5) * 12_f64.sqrt(), 0.0)
        };
        let rounds = (0..50).take_while(|_| noise.learn(&knots, 1.0, residual)).count();
        assert!(rounds < 50, "it ends");
        for link in &noise.links {
            assert!((0.1..0.3).contains(&link.sigma), "{noise:?}");
        }
        // A lasting error counts as one in fifty ranges; and no anchor's errors are assumed to last shorter than the
        // mean.
        let [own, lasting] = [noise.links[0].inflation, noise.links[1].inflation];
        assert!((40.0..60.0).contains(&lasting) && (20.0..30.0).contains(&own), "{noise:?}");
    }

    #[test]
    fn what_is_far_too_long_hardly_counts() {
        let noise = Noise::new(1, 0.1);
        let [near, long, short] = [0.01, -5.0, 5.0].map(|residual| noise.weigh(0, residual));
        assert!(long.information < 1e-2 * near.information && long.cost > near.cost);
        assert!(long.information < short.information, "obstacles lengthen");
    }
}
