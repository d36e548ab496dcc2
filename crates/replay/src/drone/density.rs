//! The density of a cloud: how much is known, and the smallest region that holds nine tenths.

/// The number of cells along each axis.
const CELLS: usize = 40;
/// The middle of the last cell, in cells from the middle of the first: weights beyond it are not counted.
const END_OF_CELLS: f64 = (CELLS - 1) as f64;
/// The reach of the grid from the mean, in standard deviations.
const REACH: f64 = 4.0;
/// The wider kernels that are tried, relative to Scott's rule for each axis, which is right for a single clump.
const WIDE: [f64; 2] = [1.0, 0.6];
/// The narrower kernels that are tried, for rings and several clumps: equal along both axes, relative to Scott's rule
/// for the longer one.
const NARROW: [f64; 3] = [0.36, 0.2, 0.1];
/// The kernel width for points of a lattice, in side lengths of the area of each point.
const ROOM: f64 = 0.6;
/// The reach of a kernel, in its standard deviations.
const END: f64 = 2.5;
/// The largest number of points by which a width is judged.
const JUDGES: usize = 256;
/// The number of times that the interval containing the border's density is halved.
const HALVINGS: usize = 12;
/// Weights below this share of the largest count as zero.
const LEAST: f64 = 1e-9;

/// A place, m, and its weight.
pub(super) type Weighed = ([f64; 2], f64);

/// The summary of a density in the plane.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Region {
    /// Differential entropy −∫ p log₂(p · 1 m²), bits.
    pub entropy_bits: f64,
    /// Area of the smallest region that holds the requested share, m².
    pub area_m2: f64,
    /// The border of that region: the ends of short straight lines, in no order, m.
    pub border: Vec<[[f64; 2]; 2]>,
}

impl Region {
    /// The smallest region that holds `share` of the weight, which is positive somewhere.
    ///
    /// Weights are counted in cells and smoothed by a normal kernel (Silverman, *Density Estimation*, 1986, ch. 4). For
    /// randomly placed points, the one of five widths is taken with which they predict each other best (likelihood
    /// cross-validation, Duin, IEEE Trans. Computers 25 (1976)), so it suits rings and several clumps, too. Points of a
    /// lattice each have an area `room` (m²), and their kernel is as wide. Particles seem to be spread over a larger
    /// area than they are, most of all in small clumps far from each other, where a cell is a good part of a clump.
    pub(super) fn of(
        points: &[Weighed],
        mean: [f64; 2],
        deviation: [f64; 2],
        room: Option<f64>,
        share: f64,
    ) -> Self {
        let most = points.iter().fold(0.0, |most: f64, (_, weight)| most.max(*weight));
        let mut points: Vec<_> =
            points.iter().copied().filter(|(_, weight)| *weight > LEAST * most).collect();
        let all: f64 = points.iter().map(|(_, weight)| weight).sum();
        for (_, weight) in &mut points {
            *weight /= all;
        }
        let effective = 1.0 / points.iter().map(|(_, weight)| weight * weight).sum::<f64>();
        // A cloud that is a single place still has some extent.
        let scott = deviation.map(|sigma| sigma.max(1e-3) * effective.powf(-1.0 / 6.0));
        let widths = if let Some(room) = room {
            vec![[ROOM * room.sqrt(); 2]]
        } else {
            let wide = WIDE.iter().map(|width| scott.map(|scott| width * scott));
            let narrow = NARROW.iter().map(|width| [width * scott[0].max(scott[1]); 2]);
            wide.chain(narrow).collect()
        };
        let grid = Grid::around(&points, mean, deviation, widths[0]);
        let counted = grid.counted(&points);
        let smoothed = widths.iter().map(|width| {
            let kernels = [0, 1].map(|axis| kernel(width[axis] / grid.side[axis]));
            let smooth = smooth(&counted, &kernels);
            (grid.support(&points, &smooth, kernels[0][0] * kernels[1][0]), smooth)
        });
        let best = smoothed.max_by(|(a, _), (b, _)| a.total_cmp(b));
        best.map_or_else(Self::default, |(_, cells)| grid.region(&cells, share))
    }
}

/// Cells over the part of the plane where the weight is.
struct Grid {
    low: [f64; 2],
    /// The side lengths of a cell, m.
    side: [f64; 2],
}

impl Grid {
    fn around(points: &[Weighed], mean: [f64; 2], deviation: [f64; 2], room: [f64; 2]) -> Self {
        let end = |axis: usize, sign: f64| {
            let places = points.iter().map(|(place, _)| sign * (place[axis] - mean[axis]));
            let farthest = places.fold(0.0, f64::max);
            mean[axis] + sign * (farthest.min(REACH * deviation[axis]) + 2.0 * room[axis])
        };
        let low = [0, 1].map(|axis| end(axis, -1.0));
        Self { low, side: [0, 1].map(|axis| (end(axis, 1.0) - low[axis]) / CELLS as f64) }
    }

    fn cell(&self, place: [f64; 2]) -> Option<usize> {
        let along = |axis: usize| {
            let cell = (place[axis] - self.low[axis]) / self.side[axis];
            (cell >= 0.0 && cell < CELLS as f64).then_some(cell as usize)
        };
        Some(along(1)? * CELLS + along(0)?)
    }

    /// Distributes each weight over the four cells around its place, more to the nearer ones.
    fn counted(&self, points: &[Weighed]) -> Vec<f64> {
        let mut cells = vec![0.0; CELLS * CELLS];
        for (place, weight) in points {
            let [x, y] = [0, 1].map(|axis| (place[axis] - self.low[axis]) / self.side[axis] - 0.5);
            if !(0.0..END_OF_CELLS).contains(&x) || !(0.0..END_OF_CELLS).contains(&y) {
                continue;
            }
            let corner = y as usize * CELLS + x as usize;
            let [right, up] = [x.fract(), y.fract()];
            cells[corner] += weight * (1.0 - right) * (1.0 - up);
            cells[corner + 1] += weight * right * (1.0 - up);
            cells[corner + CELLS] += weight * (1.0 - right) * up;
            cells[corner + CELLS + 1] += weight * right * up;
        }
        cells
    }

    /// The mean logarithm of the density that the other points predict at each point.
    fn support(&self, points: &[Weighed], smooth: &[f64], own: f64) -> f64 {
        let judges = points.iter().step_by(points.len().div_ceil(JUDGES).max(1));
        let told = judges.filter_map(|(place, weight)| {
            let others = smooth.get(self.cell(*place)?)? - weight * own;
            Some((weight * others.max(f64::MIN_POSITIVE).ln(), *weight))
        });
        let [sum, all] = told.fold([0.0, 0.0], |[sum, all], (log, by)| [sum + log, all + by]);
        sum / all
    }

    fn region(&self, cells: &[f64], share: f64) -> Region {
        let all: f64 = cells.iter().sum();
        let area = self.side[0] * self.side[1];
        let told = cells.iter().filter(|cell| **cell > LEAST * all);
        let entropy = told.map(|cell| -cell / all * (cell / all / area).log2()).sum();
        let above = |level: f64| cells.iter().filter(move |cell| **cell >= level);
        let (mut low, mut level) = (0.0, cells.iter().copied().fold(0.0, f64::max));
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + level);
            let holds = above(middle).sum::<f64>() >= share * all;
            *(if holds { &mut low } else { &mut level }) = middle;
        }
        let area_m2 = above(low).count() as f64 * area;
        Region { entropy_bits: entropy, area_m2, border: self.border(cells, low) }
    }

    /// The line on which the density crosses a level, between the middles of cells (marching squares).
    fn border(&self, cells: &[f64], level: f64) -> Vec<[[f64; 2]; 2]> {
        // The density is zero beyond the grid.
        let at = |[x, y]: [usize; 2]| match (x.checked_sub(1), y.checked_sub(1)) {
            (Some(x), Some(y)) if x < CELLS && y < CELLS => cells[y * CELLS + x],
            _ => 0.0,
        };
        let middle = |axis: usize, at: f64| self.low[axis] + (at - 0.5) * self.side[axis];
        let mut lines = Vec::new();
        for (y, x) in (0..=CELLS).flat_map(|y| (0..=CELLS).map(move |x| (y, x))) {
            let corners = [[x, y], [x + 1, y], [x + 1, y + 1], [x, y + 1]];
            let heights = corners.map(at);
            let is_in = heights.map(|height| height >= level);
            if is_in == [is_in[0]; 4] {
                continue;
            }
            let sides = [(0, 1), (1, 2), (2, 3), (3, 0)].into_iter();
            let mut crossings =
                sides.filter(|(from, to)| is_in[*from] != is_in[*to]).map(|(from, to)| {
                    let part = (level - heights[from]) / (heights[to] - heights[from]);
                    [0, 1].map(|axis| {
                        let [a, b] = [corners[from][axis], corners[to][axis]].map(|it| it as f64);
                        middle(axis, a + part * (b - a))
                    })
                });
            // A saddle has two lines; which way they run matters little.
            while let (Some(from), Some(to)) = (crossings.next(), crossings.next()) {
                lines.push([from, to]);
            }
        }
        lines
    }
}

/// One half of a normal kernel with a sum of 1 over both halves, whose standard deviation is given in cells.
fn kernel(deviation: f64) -> Vec<f64> {
    let end = (END * deviation).ceil().min(CELLS as f64) as usize;
    let weight = |cell: usize| (-0.5 * (cell as f64 / deviation).powi(2)).exp();
    let half: Vec<f64> = (0..=end).map(weight).collect();
    let sum = 2.0 * half.iter().sum::<f64>() - half[0];
    half.into_iter().map(|weight| weight / sum).collect()
}

/// Smooths along both axes.
fn smooth(cells: &[f64], kernels: &[Vec<f64>; 2]) -> Vec<f64> {
    let along_x = spread(cells, &kernels[0], 1);
    spread(&along_x, &kernels[1], CELLS)
}

/// Smooths along the axis on which neighbours are `stride` apart; nothing returns from beyond the ends.
fn spread(cells: &[f64], kernel: &[f64], stride: usize) -> Vec<f64> {
    let mut spread: Vec<f64> = cells.iter().map(|cell| kernel[0] * cell).collect();
    // A run is a line of cells, or all lines of cells side by side.
    let run = CELLS * stride;
    for (from, to) in cells.chunks_exact(run).zip(spread.chunks_exact_mut(run)) {
        for (far, part) in kernel.iter().enumerate().skip(1).take(CELLS - 1) {
            let far = far * stride;
            for (sum, cell) in to[far..].iter_mut().zip(from) {
                *sum += part * cell;
            }
            for (sum, cell) in to.iter_mut().zip(&from[far..]) {
                *sum += part * cell;
            }
        }
    }
    spread
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_distr::{Distribution, StandardNormal, StandardUniform};
    use rand_xoshiro::Xoshiro256PlusPlus;
    use rand_xoshiro::rand_core::SeedableRng;

    /// The weights of a grid of points.
    fn points(weight: impl Fn(f64, f64) -> f64) -> Vec<Weighed> {
        let axis = || (0..45).map(|i| f64::from(i) * 10.0 - 220.0);
        axis()
            .flat_map(|x| axis().map(move |y| [x, y]))
            .map(|[x, y]| ([x, y], weight(x, y)))
            .collect()
    }

    /// The region of a lattice whose points have an area of `room`, or of particles.
    fn told(points: &[Weighed], room: Option<f64>) -> Region {
        let all: f64 = points.iter().map(|(_, weight)| weight).sum();
        let mean = |of: &dyn Fn([f64; 2]) -> f64| {
            points.iter().map(|(place, weight)| weight * of(*place)).sum::<f64>() / all
        };
        let centre = [0, 1].map(|axis| mean(&|place| place[axis]));
        let deviation =
            [0, 1].map(|axis| mean(&|place| (place[axis] - centre[axis]).powi(2)).sqrt());
        Region::of(points, centre, deviation, room, 0.9)
    }

    fn close(found: f64, known: f64, share: f64) {
        assert!((found / known - 1.0).abs() < share, "{found} instead of {known}");
    }

    /// Particles of equal weight, their coordinates drawn from a distribution and multiplied by a scale.
    fn drawn(count: usize, from: impl Distribution<f64> + Copy, scale: [f64; 2]) -> Vec<Weighed> {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut place = || (scale.map(|scale| scale * from.sample(&mut random)), 1.0);
        (0..count).map(|_| place()).collect()
    }

    fn normal(count: usize, sigma: [f64; 2]) -> Vec<Weighed> {
        drawn(count, StandardNormal, sigma)
    }

    #[test]
    fn a_normal_cloud_has_its_ellipse_and_entropy() {
        let (sx, sy) = (50.0, 30.0);
        let lattice = points(|x, y| (-0.5 * ((x / sx).powi(2) + (y / sy).powi(2))).exp());
        let known = std::f64::consts::TAU * sx * sy;
        let entropy = (known * std::f64::consts::E).log2();
        let reach = (-2.0 * 0.1_f64.ln()).sqrt();
        for (cloud, room, share) in
            [(lattice, Some(100.0), 0.05), (normal(1000, [sx, sy]), None, 0.15)]
        {
            let found = told(&cloud, room);
            close(found.area_m2, known * -(0.1_f64.ln()), share);
            let off = found.entropy_bits - entropy;
            assert!(off.abs() < share, "{off}");
            let reaches = found.border.iter().flatten().map(|[x, y]| (x / sx).hypot(y / sy));
            let reaches: Vec<f64> = reaches.collect();
            close(crate::metrics::mean(&reaches), reach, share);
            assert!(reaches.len() > 80);
        }
    }

    #[test]
    fn of_a_uniform_square_it_is_nine_tenths() {
        let lattice = points(|x, y| f64::from(u8::from(x.abs() < 101.0 && y.abs() < 101.0)));
        let cast = drawn(2000, StandardUniform, [210.0; 2]);
        for (cloud, room, share) in [(lattice, Some(100.0), 0.15), (cast, None, 0.15)] {
            let found = told(&cloud, room);
            close(found.area_m2, 0.9 * 210.0 * 210.0, share);
            let off = found.entropy_bits - 2.0 * 210.0_f64.log2();
            assert!(off.abs() < share, "{off}");
        }
    }

    #[test]
    fn a_ring_is_not_filled_and_two_clumps_are_not_joined() {
        let ring = points(|x, y| (-0.5 * ((x.hypot(y) - 150.0) / 15.0).powi(2)).exp());
        let ring = told(&ring, Some(100.0));
        // Nine tenths of a normal distribution are within 1.645 deviations.
        close(ring.area_m2, std::f64::consts::TAU * 150.0 * 2.0 * 1.645 * 15.0, 0.15);
        assert!(ring.border.iter().flatten().all(|[x, y]| x.hypot(*y) > 90.0));
        let mut two = normal(1000, [20.0; 2]);
        for ([x, _], _) in two.iter_mut().skip(500) {
            *x += 400.0;
        }
        let two = told(&two, None);
        // As cells are a third of the clumps wide, they seem larger than they are.
        close(two.area_m2, 2.0 * std::f64::consts::TAU * 400.0 * -(0.1_f64.ln()), 0.45);
        assert!(two.border.iter().flatten().all(|[x, _]| (x - 200.0).abs() > 100.0));
    }

    #[test]
    fn a_single_place_has_a_small_region() {
        let found = told(&[([5.0, 7.0], 1.0)], None);
        assert!(
            found.area_m2 > 0.0 && found.area_m2 < 1.0 && found.entropy_bits < 0.0,
            "{found:?}"
        );
    }
}
