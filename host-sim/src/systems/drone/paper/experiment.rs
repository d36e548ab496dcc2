//! `host-sim run drone`: every table and figure of the thesis, and beyond.

use std::f64::consts::TAU;

use indicatif::{ParallelProgressIterator, ProgressBar};
use kestirim_air_to_ground::Rotor;
use rayon::prelude::*;

use super::beyond::{self, Stay};
use super::published::ENERGY;
use super::report::{Report, Row};
use super::sweeps::{MovingSweeps, STOPS, StaticCell, StaticSweeps, place_of};
use crate::metrics::mean;
use crate::system::{RunOptions, ScalarKind, Settings, System, choose_scalar};
use crate::systems::drone::Drone;
use crate::systems::drone::settings::cell;
use crate::systems::drone::simulate::moving_user::{self, LOST_M, Policy, Walk};
use crate::systems::drone::simulate::static_user::{FilterSetting, Geometry};
use crate::systems::drone::simulate::trajectory::SIDE_M;
use crate::systems::drone::simulate::trial::{self, Job};
use crate::{Error, output};

/// Trials of a cell of a user who stays unless told otherwise: portions of so many, until …
const PORTION: u32 = 110;
/// … the standard error is this share of the mean, …
const PRECISION: f64 = 0.03;
/// … or there are so many portions.
const MOST_PORTIONS: u32 = 16;
/// Trials of a cell of a user who moves, of whom each has hundreds of measurements.
const MOVING_TRIALS: u32 = 12;
/// What no table of the thesis has.
const BEYOND: &str = "beyond the thesis";
/// Speed of the drone unless told otherwise, km/h.
const SPEED_KMH: f64 = 40.0;

/// Runs one cell, or all.
///
/// # Errors
/// If the scalar is not supported.
pub fn run(options: &RunOptions, cell: &Settings) -> Result<Report, Error> {
    let all = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];
    let scalar = choose_scalar(Drone::NAME, options.scalar, &all, ScalarKind::F32)?;
    let experiment = Experiment {
        seed: options.seed,
        trials: options.trials,
        moving_trials: options.trials.unwrap_or(MOVING_TRIALS),
        scalar,
    };
    Ok(match (cell.given().next().is_some(), cell.is_on("moving")) {
        (false, _) => experiment.everything(),
        (true, false) => experiment.static_cell(cell),
        (true, true) => experiment.moving_cell(cell),
    })
}

struct Experiment {
    seed: u64,
    /// As asked for; else as many as it takes.
    trials: Option<u32>,
    moving_trials: u32,
    scalar: ScalarKind,
}

impl Experiment {
    fn report(&self, rows: Vec<Row>, refused: u32) -> Report {
        Report { system: Drone::NAME, seed: self.seed, scalar: self.scalar, refused, rows }
    }

    fn everything(&self) -> Report {
        let (staying, mut moving) = (StaticSweeps::thesis(), MovingSweeps::thesis());
        // Beside the sweeps' own cells, which some of these are.
        let beyond: Vec<_> = beyond::walks()
            .into_iter()
            .map(|(description, walk)| (description, place_of(&mut moving.walks, walk)))
            .collect();
        let still = staying.jobs.len() + Stay::ALL.len();
        let in_motion = moving.walks.len() + 1;
        let flights = u64::from(self.trials.unwrap_or(4 * PORTION)) * still as u64
            + u64::from(self.moving_trials) * in_motion as u64;
        let bar = output::progress(flights, "flights");
        let outcomes: Vec<_> = staying.jobs.iter().map(|job| self.staying(job, &bar)).collect();
        let refused = outcomes.iter().flatten().map(|outcome| outcome.refused).sum();
        let mut rows = Vec::new();
        for cell in &staying.cells {
            let job = &staying.jobs[cell.job];
            let energy = job.geometry.energy_j(SPEED_KMH);
            for row in both(&outcomes[cell.job], cell) {
                let (table, cell) = (cell.table, cell.cell.clone());
                rows.push(Row { table, cell, energy_j: Some(energy), ..row });
            }
        }
        rows.extend(energies());
        let walks: Vec<_> = moving.walks.iter().map(|walk| self.walking(walk, &bar)).collect();
        for cell in &moving.cells {
            let walk = &moving.walks[cell.walk];
            let row = moving_row(walk, &walks[cell.walk], cell.speed_kmh);
            rows.push(Row { table: cell.table, cell: cell.cell.clone(), ..row });
        }
        rows.extend(self.beyond_staying(&bar));
        for (description, walk) in beyond {
            let row = moving_row(&moving.walks[walk], &walks[walk], SPEED_KMH);
            rows.push(Row { table: BEYOND, cell: format!("walks: {description}"), ..row });
        }
        rows.push(self.several_users(&bar));
        bar.finish_and_clear();
        self.report(rows, refused)
    }

    fn static_cell(&self, cell: &Settings) -> Report {
        let (geometry, filter) = (cell::geometry(cell), cell::filter(cell));
        let (particles, published, bests) = match filter {
            FilterSetting::Published(filter) => (filter.particles, vec![filter], vec![]),
            FilterSetting::Best(points) => (points, vec![], vec![points]),
        };
        let is_published = !published.is_empty();
        let job = Job { geometry, published, bests, limit: true };
        let bar = output::progress(self.trials.unwrap_or(4 * PORTION).into(), "flights");
        let outcomes = self.staying(&job, &bar);
        bar.finish_and_clear();
        let refused = outcomes.iter().map(|outcome| outcome.refused).sum();
        let row = if is_published {
            published_row(&outcomes, 0, None, false)
        } else {
            best_row(&outcomes, 0)
        };
        let Geometry { stops, height_m, .. } = geometry;
        let radius_m = cell.number("radius").unwrap_or(SIDE_M / 3.0);
        let words = cell::described(cell);
        let name = format!("L={particles} T={stops} h={height_m} r={radius_m:.1}, {words}");
        let energy_j = Some(geometry.energy_j(cell.decided("speed")));
        let row = Row { table: "static user", cell: name, energy_j, ..row };
        self.report(vec![row], refused)
    }

    fn moving_cell(&self, cell: &Settings) -> Report {
        let walk = cell::walk(cell);
        let bar = output::progress(self.moving_trials.into(), "flights");
        let outcomes = self.walking(&walk, &bar);
        bar.finish_and_clear();
        let Walk { particles, height_m, user_radius_m, end_time, .. } = walk;
        let words = cell::described(cell);
        let name =
            format!("L={particles} h={height_m} r={user_radius_m} T_end={end_time}, {words}");
        let row = moving_row(&walk, &outcomes, cell.decided("speed"));
        self.report(vec![Row { table: "moving user", cell: name, ..row }], 0)
    }

    fn staying(&self, job: &Job, bar: &ProgressBar) -> Vec<trial::Outcome> {
        let mut outcomes = Vec::new();
        let portions = self.trials.map_or(MOST_PORTIONS, |_| 1);
        for portion in 0..u64::from(portions) {
            let size = u64::from(self.trials.unwrap_or(PORTION));
            let more = (portion * size..(portion + 1) * size)
                .into_par_iter()
                .progress_with(bar.clone())
                .map(|index| trial::trial(job, self.scalar, self.seed, index));
            outcomes.extend(more.collect::<Vec<_>>());
            let limits: Vec<f64> = outcomes.iter().map(|outcome| outcome.limit).collect();
            let row = Row::of(&limits);
            if row.se_m.zip(row.mean_m).is_some_and(|(error, mean)| error < PRECISION * mean) {
                break;
            }
        }
        outcomes
    }

    fn walking(&self, walk: &Walk, bar: &ProgressBar) -> Vec<moving_user::Outcome> {
        (0..u64::from(self.moving_trials))
            .into_par_iter()
            .progress_with(bar.clone())
            .map(|index| moving_user::trial(walk, self.scalar, self.seed, index))
            .collect()
    }

    fn beyond_staying(&self, bar: &ProgressBar) -> Vec<Row> {
        let row = |stay: Stay| {
            let errors: Vec<f64> = (0..u64::from(self.trials.unwrap_or(2 * PORTION)))
                .into_par_iter()
                .progress_with(bar.clone())
                .map(|index| stay.trial(self.seed, index))
                .collect();
            let cell = format!("stays: {}", stay.description());
            Row { table: BEYOND, cell, filter: "best", ..Row::of(&errors) }
        };
        Stay::ALL.into_iter().map(row).collect()
    }

    fn several_users(&self, bar: &ProgressBar) -> Row {
        let errors: Vec<f64> = (0..u64::from(self.moving_trials))
            .into_par_iter()
            .progress_with(bar.clone())
            .map(|index| beyond::several_users(self.seed, index))
            .collect();
        let cell = "walk: three users, one filter each".to_owned();
        let lost_percent = Some(lost_percent(&errors));
        Row { table: BEYOND, cell, filter: "best", lost_percent, ..Row::of(&errors) }
    }
}

/// The thesis' filter and ours in one cell.
fn both(outcomes: &[trial::Outcome], cell: &StaticCell) -> Vec<Row> {
    let row = published_row(outcomes, cell.published_filter, cell.published, cell.maximum);
    if cell.maximum { vec![row] } else { vec![row, best_row(outcomes, cell.best)] }
}

fn limit(outcomes: &[trial::Outcome]) -> f64 {
    mean(&outcomes.iter().map(|outcome| outcome.limit).collect::<Vec<_>>())
}

fn published_row(
    outcomes: &[trial::Outcome],
    filter: usize,
    published: Option<f64>,
    maximum: bool,
) -> Row {
    let errors: Vec<f64> = outcomes.iter().map(|outcome| outcome.published[filter]).collect();
    let row = match published {
        Some(published) if maximum => Row::of_maximum(&errors, published),
        _ => Row { limit_m: Some(limit(outcomes)), ..Row::of(&errors).beside(published, &errors) },
    };
    Row { filter: "published", ..row }
}

fn best_row(outcomes: &[trial::Outcome], best: usize) -> Row {
    let errors: Vec<f64> = outcomes.iter().map(|outcome| outcome.bests[best]).collect();
    let credible = outcomes.iter().filter(|outcome| outcome.credible).count();
    let credible_percent =
        (best == 0).then(|| 100.0 * credible as f64 / outcomes.len().max(1) as f64);
    Row { filter: "best", limit_m: Some(limit(outcomes)), credible_percent, ..Row::of(&errors) }
}

fn moving_row(walk: &Walk, outcomes: &[moving_user::Outcome], speed_kmh: f64) -> Row {
    let errors: Vec<f64> = outcomes.iter().map(|outcome| outcome.error_m).collect();
    let energies: Vec<f64> =
        outcomes.iter().map(|outcome| outcome.flown.energy_j(speed_kmh)).collect();
    let paths: Vec<f64> = outcomes.iter().map(|outcome| outcome.flown.path_m / 1000.0).collect();
    Row {
        filter: if matches!(walk.policy, Policy::Hover(_)) { "published" } else { "best" },
        energy_j: Some(mean(&energies)),
        lost_percent: Some(lost_percent(&errors)),
        note: Some(format!("{:.1} km", mean(&paths))),
        ..Row::of(&errors)
    }
}

fn lost_percent(errors: &[f64]) -> f64 {
    let lost = errors.iter().filter(|&&error| error >= LOST_M).count();
    100.0 * lost as f64 / errors.len().max(1) as f64
}

/// Fig. 3.4: by the published formulas, and by three other numbers with which all eight come out as published.
fn energies() -> Vec<Row> {
    /// Power at 40 km/h, W, where the published constants give 1245.8.
    const POWER_W: f64 = 1125.0;
    /// Energy of a stop, J, where they give 5 s · 1021.75 W = 5108.8.
    const STOP_J: f64 = 6314.0;
    let speed = SPEED_KMH / 3.6;
    let rotor = Rotor::<f64>::base_station();
    let mut rows = Vec::new();
    for (name, published) in ["grid", "circle"].into_iter().zip(ENERGY) {
        for (stops, published) in STOPS.into_iter().zip(published) {
            let points = f64::from(stops);
            // Eqs 2.16 and 2.17: the grid's spacing is printed as D/3 for every T.
            let (published_m, flown) = if name == "grid" {
                (SIDE_M / 3.0, SIDE_M / points.sqrt())
            } else {
                let chord = SIDE_M / 3.0 * (2.0 - 2.0 * (TAU / points).cos()).sqrt();
                (chord, chord)
            };
            let path = (points - 1.0) * published_m;
            let energy = rotor.energy(path, speed, 5.0 * points).expect("a speed above zero");
            let refitted = (points - 1.0) * flown / speed * POWER_W + points * STOP_J;
            rows.push(Row {
                table: "Fig. 3.4 (energy)",
                cell: format!("{name} T={stops}"),
                filter: "formulas",
                published: Some(published),
                energy_j: Some(energy),
                note: Some(format!("{:.1} kJ with 1125 W, 6314 J a stop and D/√T", refitted / 1e3)),
                ..Row::default()
            });
        }
    }
    rows
}
