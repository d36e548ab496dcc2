//! The belief of a filter, in a form that can be drawn.

use kestirim_particle_filter::{Moments, Particles, PointMass};
use kestirim_scalar::Scalar;

use super::Region;
use super::density::Weighed;

/// The share of the weight that the heaviest places carry; the others are drawn differently.
const SHARE: f64 = 0.9;
/// The number of points of an ellipse.
const CORNERS: u32 = 64;
/// The largest number of particles of each kind that are drawn.
const MOST: usize = 1500;
/// The largest number of particles from which a region is computed.
const MOST_OF_REGION: usize = 1500;
/// The number of equally weighted places in the sample.
const SAMPLE: usize = 240;

/// Particles or lattice points, and the ellipse that approximates them.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Cloud {
    /// The heaviest places, which carry nine tenths of the weight, m.
    pub heavy: Vec<[f32; 2]>,
    /// The other places, m.
    pub light: Vec<[f32; 2]>,
    /// The mean, m.
    pub mean: [f64; 2],
    /// The lower triangular factor F of the covariance F Fᵀ, m.
    pub factor: [[f64; 2]; 2],
    /// The effective number of particles.
    pub effective: f64,
    /// A few places of equal weight, drawn by systematic resampling without randomness, m.
    pub sample: Vec<[f32; 2]>,
    /// The places and weights from which the region is computed, before they were moved by `moved`.
    points: Vec<([f32; 2], f32)>,
    moved: [f64; 2],
    /// The area for each point of a lattice, m².
    room: Option<f64>,
}

impl Cloud {
    /// The cloud of particles whose first two coordinates are a place.
    pub fn of_particles<T: Scalar, const D: usize, const N: usize>(
        particles: &Particles<T, D, N>,
        effective: f64,
    ) -> Self {
        let moments = particles.moments_of(|state| [state[0], state[1]]);
        let states = (0..particles.len()).filter_map(|index| particles.state(index));
        Self::new(states, particles.log_weights(), &moments, effective, None)
    }

    /// The cloud of the points of a lattice whose first two coordinates are a place.
    pub fn of_lattice<T: Scalar, const D: usize, const N: usize>(
        lattice: &PointMass<T, D, N>,
    ) -> Self {
        let points = (0..lattice.len()).filter_map(|index| lattice.point(index));
        let effective = lattice.effective().to_f64();
        // Points of a space with more dimensions lie at random in the plane.
        let size = || lattice.region().width().iter().map(|side| side.to_f64()).product::<f64>();
        let room = (D == 2).then(|| size() / lattice.len() as f64);
        Self::new(points, lattice.log_weights(), &lattice.moments(), effective, room)
    }

    fn new<T: Scalar, const D: usize, const K: usize>(
        states: impl Iterator<Item = [T; D]>,
        log_weights: &[T],
        moments: &Moments<T, K>,
        effective: f64,
        room: Option<f64>,
    ) -> Self {
        let (mut heavy, mut light) = (Vec::new(), Vec::new());
        let least = least_of_the_heaviest(log_weights.iter().map(|log| log.to_f64()).collect());
        let mut points = Vec::with_capacity(log_weights.len());
        for (state, log_weight) in states.zip(log_weights) {
            let (place, log_weight) = ([state[0], state[1]].map(T::to_f64), log_weight.to_f64());
            let kind = if log_weight >= least { &mut heavy } else { &mut light };
            kind.push(place.map(|axis| axis as f32));
            points.push((place, log_weight.exp()));
        }
        let (mean, factor) = (moments.mean(), moments.factor());
        let factor = [0, 1].map(|row| [factor[row][0].to_f64(), factor[row][1].to_f64()]);
        let mean = [mean[0].to_f64(), mean[1].to_f64()];
        // Particles are interchangeable, so some can be skipped; points of a lattice are not.
        let stride = if room.is_some() { 1 } else { points.len().div_ceil(MOST_OF_REGION).max(1) };
        let few = points.iter().step_by(stride);
        Self {
            points: few.map(|(at, by)| (at.map(|axis| axis as f32), *by as f32)).collect(),
            moved: [0.0; 2],
            room,
            sample: sampled(&points),
            heavy: thinned(&heavy),
            light: thinned(&light),
            mean,
            factor,
            effective,
        }
    }

    /// Moves the cloud to the east and north, m.
    pub fn moved(mut self, by: [f64; 2]) -> Self {
        for place in self.heavy.iter_mut().chain(&mut self.light).chain(&mut self.sample) {
            *place = [place[0] + by[0] as f32, place[1] + by[1] as f32];
        }
        self.moved = [self.moved[0] + by[0], self.moved[1] + by[1]];
        self.mean = [self.mean[0] + by[0], self.mean[1] + by[1]];
        self
    }

    /// The region that holds nine tenths of the weight, and how much is known.
    pub fn region(&self) -> Region {
        let back = |places: [f64; 2]| [0, 1].map(|axis| places[axis] - self.moved[axis]);
        let points: Vec<Weighed> =
            self.points.iter().map(|(at, by)| (at.map(f64::from), f64::from(*by))).collect();
        let [[a, _], [b, c]] = self.factor;
        let deviation = [a.abs(), b.hypot(c)];
        let mut region = Region::of(&points, back(self.mean), deviation, self.room, SHARE);
        for [x, y] in region.border.iter_mut().flatten() {
            (*x, *y) = (*x + self.moved[0], *y + self.moved[1]);
        }
        region
    }

    /// Root mean square distance from the mean, m.
    pub fn spread(&self) -> f64 {
        self.factor.iter().flatten().fold(0.0, |sum: f64, part| sum.hypot(*part))
    }

    /// The radius that holds nine tenths of a normal distribution in the plane, in standard deviations: √(−2 ln 0.1).
    fn reach() -> f64 {
        (-2.0 * 0.1_f64.ln()).sqrt()
    }

    /// Area of the [`ellipse`](Self::ellipse), m².
    pub fn ellipse_m2(&self) -> f64 {
        let [[a, _], [_, b]] = self.factor;
        std::f64::consts::PI * Self::reach().powi(2) * (a * b).abs()
    }

    /// The border, closed, of the region that would hold nine tenths of the weight if it were normally distributed, m.
    pub fn ellipse(&self) -> impl Iterator<Item = [f64; 2]> {
        let reach = Self::reach();
        let ([x, y], factor) = (self.mean, self.factor);
        (0..=CORNERS).map(move |corner| {
            let angle = std::f64::consts::TAU * f64::from(corner) / f64::from(CORNERS);
            let (sine, cosine) = angle.sin_cos();
            let along = |row: [f64; 2]| reach * (row[0] * cosine + row[1] * sine);
            [x + along(factor[0]), y + along(factor[1])]
        })
    }
}

/// The smallest logarithmic weight among the heaviest points, which include all that weigh as much.
fn least_of_the_heaviest(mut logs: Vec<f64>) -> f64 {
    logs.sort_by(|a, b| b.total_cmp(a));
    let all: f64 = logs.iter().map(|log| log.exp()).sum();
    let mut sum = 0.0;
    let last = logs.iter().find(|log| {
        sum += log.exp();
        sum >= SHARE * all
    });
    last.copied().unwrap_or(f64::NEG_INFINITY)
}

/// Draws each place as often as its weight says.
fn sampled(points: &[Weighed]) -> Vec<[f32; 2]> {
    let all: f64 = points.iter().map(|(_, weight)| weight).sum();
    let step = all / SAMPLE as f64;
    let (mut sample, mut sum) = (Vec::with_capacity(SAMPLE), 0.0);
    for (place, weight) in points {
        sum += weight;
        while sample.len() < SAMPLE && sum > (sample.len() as f64 + 0.5) * step {
            sample.push(place.map(|axis| axis as f32));
        }
    }
    sample
}

/// Thins the places evenly to at most `MOST`.
fn thinned(places: &[[f32; 2]]) -> Vec<[f32; 2]> {
    places.iter().step_by(places.len().div_ceil(MOST).max(1)).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_heaviest_carry_nine_tenths_and_equals_stay_together() {
        let logs = [0.03_f64, 0.5, 0.3, 0.05, 0.12].map(f64::ln);
        assert!((least_of_the_heaviest(logs.to_vec()) - logs[4]).abs() < 1e-12);
        assert!(least_of_the_heaviest(vec![0.0; 20]).abs() < 1e-12);
        assert!(least_of_the_heaviest(Vec::new()).is_infinite());
    }

    #[test]
    fn a_sample_has_as_many_of_each_as_it_weighs() {
        let sample = sampled(&[([0.0, 1.0], 0.5), ([2.0, 3.0], 0.0), ([4.0, 5.0], 1.5)]);
        let count = |place| sample.iter().filter(|it| **it == place).count();
        assert_eq!([[0.0, 1.0], [2.0, 3.0], [4.0, 5.0]].map(count), [60, 0, 180]);
    }

    #[test]
    fn an_ellipse_lies_about_its_mean_and_long_clouds_are_thinned() {
        let factor = [[2.0, 0.0], [1.0, 3.0]];
        let cloud = Cloud { factor, ..Cloud::default() }.moved([10.0, -5.0]);
        assert!((cloud.spread() - 14.0_f64.sqrt()).abs() < 1e-12);
        let corners: Vec<_> = cloud.ellipse().collect();
        let middle = corners[0][0].midpoint(corners[32][0]);
        assert!((middle - 10.0).abs() < 1e-9);
        let widest = corners.iter().map(|corner| corner[0] - 10.0).fold(0.0, f64::max);
        assert!((widest - 2.0 * 2.146).abs() < 1e-3, "{widest}");
        let points = vec![([0.0, 0.0], 1.0); 9];
        let region = Cloud { points, ..cloud.clone() }.region();
        assert!(region.border.iter().flatten().all(|[x, y]| (x - 10.0).hypot(y + 5.0) < 5.0));
        assert!(!region.border.is_empty());
        let area = std::f64::consts::PI * 4.605 * 6.0;
        assert!((cloud.ellipse_m2() - area).abs() < 0.1);
        let all = vec![[0.0, 0.0]; 4000];
        assert!(thinned(&all).len() <= MOST && thinned(&all).len() > MOST / 2);
        assert_eq!(thinned(&all[..7]).len(), 7);
    }
}
