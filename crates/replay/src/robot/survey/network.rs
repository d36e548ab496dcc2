//! Shapes of a network of anchors, and their fit.

use nalgebra::{DMatrix, DVector, Vector3};
use rand_distr::{Distribution, StandardUniform};
use rand_xoshiro::Xoshiro256PlusPlus;
use rand_xoshiro::rand_core::SeedableRng;

use super::{DIFFERENT, OUTLIER, Pair};

/// The number of starts that are tried: usually there are as many local minima as there are anchors off the plane of
/// the others.
const STARTS: usize = 60;
const MOST_STEPS: usize = 200;
/// The relative change of the cost below which the search ends.
const SETTLED: f64 = 1e-9;
/// Standard deviations up to which a better fit is chance.
const LIKELY: f64 = 4.0;
/// The share of the largest eigenvalue of the normal equations below which nothing is known in a direction.
const NEGLIGIBLE: f64 = 1e-10;

/// The ranges between anchors, and their standard deviation.
#[derive(Debug)]
pub(super) struct Network<'a> {
    pub(super) anchors: usize,
    pub(super) dimensions: usize,
    pub(super) pairs: &'a [Pair],
    /// Standard deviation of a range, m.
    pub(super) sigma: f64,
}

/// The places of anchors, m, and the cost of the residuals r of the ranges: the sum of ln (1 + (r/σ)²)/2.
#[derive(Debug, Clone)]
pub(super) struct Shape {
    pub(super) places: Vec<[f64; 3]>,
    pub(super) cost: f64,
}

impl Shape {
    pub(super) fn distance(&self, [i, j]: [usize; 2]) -> f64 {
        (self.place(i) - self.place(j)).norm()
    }

    fn place(&self, anchor: usize) -> Vector3<f64> {
        Vector3::from(self.places[anchor])
    }

    /// The shape turned so that the first anchor is at the origin, the second on the x axis, and so on, each at a
    /// positive coordinate.
    pub(super) fn turned(&self, dimensions: usize) -> Self {
        const BESIDE: f64 = 1e-6;
        let origin = self.place(0);
        let mut axes: Vec<Vector3<f64>> = Vec::new();
        for anchor in 1..self.places.len() {
            let offset = self.place(anchor) - origin;
            let beside = axes.iter().fold(offset, |rest, axis| rest - axis * axis.dot(&offset));
            if axes.len() < dimensions && beside.norm() > BESIDE {
                axes.push(beside.normalize());
            }
        }
        let turned = (0..self.places.len()).map(|anchor| {
            let offset = self.place(anchor) - origin;
            std::array::from_fn(|axis| {
                let along = axes.get(axis).map_or(0.0, |axis| axis.dot(&offset));
                // Coordinates that are zero by the choice of axes are set to zero.
                if anchor <= axis { 0.0 } else { along }
            })
        });
        Self { places: turned.collect(), cost: self.cost }
    }
}

/// A plane, or a line in two dimensions.
struct Plane {
    centre: Vector3<f64>,
    normal: Vector3<f64>,
}

impl Plane {
    /// The place moved towards the plane: by once its distance into it, by twice to the other side.
    fn moved(&self, place: [f64; 3], times: f64) -> [f64; 3] {
        let place = Vector3::from(place);
        (place - self.normal * (times * self.normal.dot(&(place - self.centre)))).into()
    }
}

impl Network<'_> {
    /// The number of coordinates without those of the frame.
    pub(super) fn unknowns(&self) -> usize {
        let d = self.dimensions;
        (self.anchors * d).saturating_sub(d * (d + 1) / 2)
    }

    /// The anchors with fewer ranges than dimensions.
    pub(super) fn loose(&self) -> Vec<usize> {
        let count = |anchor| self.pairs.iter().filter(|it| it.anchors.contains(&anchor)).count();
        (0..self.anchors).filter(|&anchor| count(anchor) < self.dimensions).collect()
    }

    /// The locally best shapes, the best first.
    pub(super) fn shapes(&self) -> Vec<Shape> {
        let mut shapes: Vec<_> =
            (0..STARTS).map(|start| self.settled(&self.start(start))).collect();
        shapes.sort_by(|one, other| one.cost.total_cmp(&other.cost));
        // Each anchor is also tried on the other side of the others, which the starts may have missed.
        if let Some(best) = shapes.first().cloned() {
            let mirrored = (0..self.anchors).filter_map(|anchor| self.mirrored(&best, anchor));
            shapes.extend(mirrored.map(|shape| self.settled(&shape)).collect::<Vec<_>>());
            shapes.sort_by(|one, other| one.cost.total_cmp(&other.cost));
        }
        shapes
    }

    /// Random places within the longest range, the same in every run.
    fn start(&self, number: usize) -> Shape {
        let longest = self.pairs.iter().map(|pair| pair.metres).fold(1.0, f64::max);
        let mut random = Xoshiro256PlusPlus::seed_from_u64(number as u64);
        let mut place = || {
            let mut place = [0.0; 3];
            for axis in place.iter_mut().take(self.dimensions) {
                let share: f64 = StandardUniform.sample(&mut random);
                *axis = longest * share;
            }
            place
        };
        Shape { places: (0..self.anchors).map(|_| place()).collect(), cost: f64::INFINITY }
    }

    /// The plane (in two dimensions: the line) along which these places lie.
    fn plane_along(&self, places: &[Vector3<f64>]) -> Plane {
        let centre = places.iter().sum::<Vector3<f64>>() / places.len() as f64;
        let d = self.dimensions;
        let scatter = places.iter().fold(DMatrix::zeros(d, d), |sum, place| {
            let offset = DVector::from_fn(d, |axis, _| place[axis] - centre[axis]);
            sum + &offset * offset.transpose()
        });
        let eigen = scatter.symmetric_eigen();
        let least = eigen.eigenvectors.column(eigen.eigenvalues.imin());
        let mut normal = Vector3::zeros();
        normal.iter_mut().zip(least.iter()).for_each(|(to, from)| *to = *from);
        Plane { centre, normal }
    }

    /// The shape with one anchor mirrored at the plane, or line, along which the anchors lie to which it has ranges.
    fn mirrored(&self, shape: &Shape, anchor: usize) -> Option<Shape> {
        let near: Vec<_> = self
            .pairs
            .iter()
            .filter(|pair| pair.anchors.contains(&anchor))
            .map(|pair| shape.place(pair.anchors[0] + pair.anchors[1] - anchor))
            .collect();
        let plane = self.plane_along(&near);
        let mut mirrored = shape.clone();
        let own = mirrored.places.get_mut(anchor)?;
        *own = plane.moved(*own, 2.0);
        Some(mirrored)
    }

    /// Whether the shape fits no better than noise would make it if all anchors stood in one plane (in two dimensions:
    /// one line). The distance from it, of which ranges depend by its square, has no linear deviation then.
    pub(super) fn fits_flattened(&self, shape: &Shape) -> bool {
        if self.dimensions < 2 {
            return false;
        }
        let places: Vec<_> = (0..self.anchors).map(|anchor| shape.place(anchor)).collect();
        let plane = self.plane_along(&places);
        let flat = shape.places.iter().map(|place| plane.moved(*place, 1.0)).collect();
        let dimensions = self.dimensions - 1;
        let flat = Shape { places: flat, ..*shape }.turned(dimensions);
        let flat = Network { dimensions, ..*self }.settled(&flat);
        // The difference has a χ² distribution of as many degrees of freedom as there are distances from the plane, if
        // all are zero.
        let free = (self.anchors - self.dimensions) as f64;
        self.squares(&flat) - self.squares(shape) < free + LIKELY * (2.0 * free).sqrt()
    }

    /// The sum of the squares of residuals, in standard deviations, of which none counts for more than an outlier.
    fn squares(&self, shape: &Shape) -> f64 {
        let square = |pair: &Pair| {
            let residual = (pair.metres - shape.distance(pair.anchors)) / self.sigma;
            (residual * residual).min(OUTLIER * OUTLIER)
        };
        self.pairs.iter().map(square).sum()
    }

    /// The shape moved to the best fit nearby, by Levenberg–Marquardt steps with weights renewed in each.
    pub(super) fn settled(&self, shape: &Shape) -> Shape {
        let mut best = Shape { cost: self.cost(&shape.places), ..shape.clone() };
        let mut damping = 1e-2;
        for _ in 0..MOST_STEPS {
            let (normal, gradient) = self.equations(&best);
            let size = normal.nrows();
            let scale = normal.diagonal().max().max(f64::MIN_POSITIVE);
            let damped = normal + DMatrix::identity(size, size) * (damping * scale);
            let Some(factors) = damped.cholesky() else { break };
            let step = factors.solve(&gradient);
            let mut places = best.places.clone();
            for (anchor, place) in places.iter_mut().enumerate() {
                for axis in 0..self.dimensions {
                    place[axis] += step[anchor * self.dimensions + axis];
                }
            }
            let cost = self.cost(&places);
            if cost < best.cost {
                let settled = best.cost - cost < SETTLED * best.cost;
                best = Shape { places, cost };
                damping = (damping * 0.3).max(1e-9);
                if settled {
                    break;
                }
            } else {
                damping *= 4.0;
                if damping > 1e6 {
                    break;
                }
            }
        }
        best
    }

    fn cost(&self, places: &[[f64; 3]]) -> f64 {
        let shape = Shape { places: places.to_vec(), cost: 0.0 };
        let square = |pair: &Pair| {
            let residual = (pair.metres - shape.distance(pair.anchors)) / self.sigma;
            0.5 * (residual * residual).ln_1p()
        };
        self.pairs.iter().map(square).sum()
    }

    /// The weighted normal equations of all coordinates, and their right-hand side.
    fn equations(&self, shape: &Shape) -> (DMatrix<f64>, DVector<f64>) {
        let (d, size) = (self.dimensions, self.anchors * self.dimensions);
        let (mut normal, mut gradient) = (DMatrix::zeros(size, size), DVector::zeros(size));
        for pair in self.pairs {
            let [i, j] = pair.anchors;
            let offset = shape.place(i) - shape.place(j);
            let distance = offset.norm().max(1e-9);
            let residual = pair.metres - distance;
            let weight = 1.0 / (self.sigma * self.sigma + residual * residual);
            for a in 0..d {
                let along = offset[a] / distance;
                gradient[i * d + a] += weight * residual * along;
                gradient[j * d + a] -= weight * residual * along;
                for b in 0..d {
                    let product = weight * along * offset[b] / distance;
                    normal[(i * d + a, i * d + b)] += product;
                    normal[(j * d + a, j * d + b)] += product;
                    normal[(i * d + a, j * d + b)] -= product;
                    normal[(j * d + a, i * d + b)] -= product;
                }
            }
        }
        (normal, gradient)
    }

    /// The standard deviation of the ranges from the residuals of those that fit, with `spare` redundant ones.
    pub(super) fn spread(&self, shape: &Shape, spare: usize) -> f64 {
        let mut left: Vec<f64> = self
            .pairs
            .iter()
            .map(|pair| (pair.metres - shape.distance(pair.anchors)).abs())
            .collect();
        left.sort_by(f64::total_cmp);
        // One in ten may have any error.
        let kept = left.len() - (left.len() / 10).min(spare.saturating_sub(1));
        let squares: f64 = left.iter().take(kept).map(|residual| residual * residual).sum();
        (squares / (kept + spare - left.len()).max(1) as f64).sqrt()
    }

    /// The standard deviations of all coordinates about the centre, m; `None` if more than the frame is undetermined.
    pub(super) fn sigmas(&self, shape: &Shape) -> Option<Vec<[f64; 3]>> {
        let d = self.dimensions;
        let eigen = self.equations(shape).0.symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let is_known = |value: f64| value > NEGLIGIBLE * largest;
        let known = eigen.eigenvalues.iter().filter(|value| is_known(**value)).count();
        if known < self.unknowns() {
            return None;
        }
        let variance = |row: usize| -> f64 {
            let columns = eigen.eigenvalues.iter().enumerate().filter(|it| is_known(*it.1));
            columns.map(|(k, value)| eigen.eigenvectors[(row, k)].powi(2) / value).sum()
        };
        let of = |anchor: usize| {
            std::array::from_fn(
                |axis| {
                    if axis < d { variance(anchor * d + axis).sqrt() } else { 0.0 }
                },
            )
        };
        Some((0..self.anchors).map(of).collect())
    }

    /// The anchors with another place in a different shape: the fewest that explain how its distances differ.
    pub(super) fn moved(&self, best: &Shape, other: &Shape) -> Vec<usize> {
        let n = self.anchors;
        let differs =
            |i: usize, j: usize| (best.distance([i, j]) - other.distance([i, j])).abs() > DIFFERENT;
        let mut open: Vec<usize> = (0..n).collect();
        let mut moved = Vec::new();
        loop {
            let count = |i: usize| open.iter().filter(|&&j| j != i && differs(i, j)).count();
            let Some(&worst) = open.iter().max_by_key(|&&i| count(i)) else { break };
            if count(worst) == 0 {
                break;
            }
            moved.push(worst);
            open.retain(|&i| i != worst);
        }
        moved
    }
}
