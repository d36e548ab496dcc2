//! The cells of the thesis, and the trials that they need.

use kestirim_particle_filter::Resampler;

use super::published::{
    EQUAL_ENERGY, HEIGHT, PARTICLES, RADIUS, RESAMPLERS_MAXIMUM, RESAMPLERS_MEAN, TRAJECTORIES,
};
use crate::systems::drone::settings::choices::{ResamplerKind, name};
use crate::systems::drone::simulate::moving_user::{Policy, Walk};
use crate::systems::drone::simulate::static_user::{Geometry, PublishedFilter};
use crate::systems::drone::simulate::trajectory::Trajectory;
use crate::systems::drone::simulate::trial::Job;

/// The number of points of our filter, unless the cell says otherwise.
const POINTS: usize = 500;
/// The numbers of measurements of Figs 3.2 and 3.3.
const MEASUREMENTS: [u32; 7] = [10, 15, 20, 25, 30, 35, 40];
/// The numbers of points of Figs 3.4 and 3.5.
pub const STOPS: [u32; 4] = [4, 9, 16, 25];

/// A cell with a stationary user.
#[derive(Debug, Clone, PartialEq)]
pub struct StaticCell {
    /// The table or figure of the thesis.
    pub table: &'static str,
    /// The name of the cell.
    pub cell: String,
    /// The thesis' number (m).
    pub published: Option<f64>,
    /// Whether the thesis' number is the maximum of its trials rather than their mean.
    pub maximum: bool,
    /// The index of the job with the cell's trials.
    pub job: usize,
    /// The index of the job's filter that is the thesis' own.
    pub published_filter: usize,
    /// The index of the job's filter that is ours.
    pub best: usize,
}

/// All cells with stationary users; cells with the same measurements share a job.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StaticSweeps {
    /// The jobs to run.
    pub jobs: Vec<Job>,
    /// The cells of all tables and figures.
    pub cells: Vec<StaticCell>,
}

impl StaticSweeps {
    /// The cells of Table 3.2 and Figs 3.2, 3.3 and 3.5.
    pub fn thesis() -> Self {
        let mut sweeps = Self::default();
        sweeps.table_3_2();
        sweeps.resamplers();
        sweeps.trajectories();
        sweeps
    }

    fn table_3_2(&mut self) {
        let filter = |particles| PublishedFilter { particles, resampler: Resampler::Systematic };
        for (divisor, published) in (2..).zip(RADIUS) {
            let trajectory = Trajectory::Circle { radius_m: 2000.0 / f64::from(divisor) };
            let geometry = Geometry { trajectory, ..Geometry::circle(12, 500.0) };
            let cell = format!("L=1000 T=12 h=500 r=2000/{divisor}");
            self.add("Table 3.2", cell, published, geometry, filter(1000), POINTS);
        }
        for (height, published) in (1..).map(|k| 200.0 * f64::from(k)).zip(HEIGHT) {
            let cell = format!("L=1000 T=12 h={height} r=2000/3");
            let geometry = Geometry::circle(12, height);
            self.add("Table 3.2", cell, published, geometry, filter(1000), POINTS);
        }
        let numbers = [100, 500, 1000, 1500, 2000, 2500, 3000];
        for (particles, published) in numbers.into_iter().zip(PARTICLES) {
            let cell = format!("L={particles} T=12 h=800 r=2000/3");
            let geometry = Geometry::circle(12, 800.0);
            self.add(
                "Table 3.2",
                cell,
                published,
                geometry,
                filter(particles),
                particles.min(POINTS),
            );
        }
    }

    fn resamplers(&mut self) {
        let figures = [
            ("Fig. 3.2", RESAMPLERS_MEAN, false),
            ("Fig. 3.3 (maximum)", RESAMPLERS_MAXIMUM, true),
        ];
        for (table, published, maximum) in figures {
            for (kind, published) in ResamplerKind::OF_THE_THESIS.into_iter().zip(published) {
                for (stops, published) in MEASUREMENTS.into_iter().zip(published) {
                    let cell = format!("{} T={stops}", name(&kind));
                    let filter = PublishedFilter { particles: 500, resampler: kind.into() };
                    let geometry = Geometry::circle(stops, 800.0);
                    self.add(table, cell, published, geometry, filter, POINTS);
                    if let Some(cell) = self.cells.last_mut() {
                        cell.maximum = maximum;
                    }
                }
            }
        }
    }

    fn trajectories(&mut self) {
        let filter = PublishedFilter { particles: 500, resampler: Resampler::Systematic };
        let names = ["grid", "circle"];
        for (shape, published) in names.into_iter().zip(TRAJECTORIES) {
            for (stops, published) in STOPS.into_iter().zip(published) {
                let trajectory =
                    if shape == "grid" { Trajectory::grid(stops) } else { Trajectory::CIRCLE };
                // The printed errors require several measurements per point and a lower flight: a single one cannot
                // come that close.
                let as_printed = Geometry { per_stop: 3, ..Geometry::circle(stops, 450.0) };
                for geometry in [Geometry::circle(stops, 800.0), as_printed] {
                    let geometry = Geometry { trajectory, ..geometry };
                    let cell = format!("{shape} T={stops}, {}", measured(&geometry));
                    self.add("Fig. 3.5", cell, published, geometry, filter, POINTS);
                }
            }
        }
        let paths = [("circle", Trajectory::CIRCLE), ("small grid", Trajectory::small_grid(16))];
        for ((shape, trajectory), published) in paths.into_iter().zip(EQUAL_ENERGY) {
            let geometry = Geometry { trajectory, ..Geometry::circle(16, 800.0) };
            let cell = format!("{shape} T=16, {}", measured(&geometry));
            self.add("Fig. 3.1 c", cell, published, geometry, filter, POINTS);
        }
    }

    fn add(
        &mut self,
        table: &'static str,
        cell: String,
        published: f64,
        geometry: Geometry,
        filter: PublishedFilter,
        points: usize,
    ) {
        let known = self.jobs.iter().position(|job| job.geometry == geometry);
        let job = known.unwrap_or_else(|| {
            self.jobs.push(Job { geometry, published: Vec::new(), bests: Vec::new(), limit: true });
            self.jobs.len() - 1
        });
        let published_filter = place_of(&mut self.jobs[job].published, filter);
        let best = place_of(&mut self.jobs[job].bests, points);
        let (published, maximum) = (Some(published), false);
        let more = StaticCell { table, cell, published, maximum, job, published_filter, best };
        self.cells.push(more);
    }
}

fn measured(geometry: &Geometry) -> String {
    let Geometry { per_stop, height_m, .. } = geometry;
    let times = if *per_stop == 1 { "once".to_owned() } else { format!("{per_stop} times") };
    format!("{times} at h={height_m}")
}

/// The index of a value in a list, to which it is appended if it is not there yet.
pub(super) fn place_of<T: PartialEq>(list: &mut Vec<T>, value: T) -> usize {
    list.iter().position(|known| *known == value).unwrap_or_else(|| {
        list.push(value);
        list.len() - 1
    })
}

/// A cell with a moving user.
#[derive(Debug, Clone, PartialEq)]
pub struct MovingCell {
    /// The figure of the thesis.
    pub table: &'static str,
    /// The name of the cell.
    pub cell: String,
    /// The index of the walk with the cell's trials.
    pub walk: usize,
    /// The speed of the drone (km/h).
    pub speed_kmh: f64,
}

/// All cells with moving users; cells of the same walk share its trials.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MovingSweeps {
    /// The walks to run.
    pub walks: Vec<Walk>,
    /// The cells of all figures.
    pub cells: Vec<MovingCell>,
}

impl MovingSweeps {
    /// The cells of Figs 3.7 to 3.12.
    pub fn thesis() -> Self {
        const SPEED: f64 = 40.0;
        let mut sweeps = Self::default();
        let policies = [Policy::Hover(Resampler::Systematic), Policy::Orbit];
        let mut add = |table, cell: String, change: &dyn Fn(&mut Walk), speed_kmh| {
            for policy in policies {
                let mut walk = Walk::thesis(policy);
                change(&mut walk);
                let walk = place_of(&mut sweeps.walks, walk);
                sweeps.cells.push(MovingCell { table, cell: cell.clone(), walk, speed_kmh });
            }
        };
        for particles in [250, 500, 1000, 2000] {
            add("Fig. 3.7", format!("L={particles}"), &|walk| walk.particles = particles, SPEED);
        }
        for (table, height_m) in [("Fig. 3.8 (h=500)", 500.0), ("Fig. 3.9 (h=1000)", 1000.0)] {
            for user_radius_m in (3..=10).map(|k| 200.0 * f64::from(k)) {
                let change = |walk: &mut Walk| {
                    (walk.height_m, walk.user_radius_m) = (height_m, user_radius_m);
                };
                add(table, format!("r={user_radius_m}"), &change, SPEED);
            }
        }
        for end_time in (4..=10).map(|k| 100 * k) {
            add("Fig. 3.11", format!("T_end={end_time}"), &|walk| walk.end_time = end_time, SPEED);
        }
        for speed in [30.0, 40.0, 50.0, 60.0, 70.0] {
            add("Fig. 3.12", format!("v={speed} km/h"), &|_| {}, speed);
        }
        sweeps
    }
}
