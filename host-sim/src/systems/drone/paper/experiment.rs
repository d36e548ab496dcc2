//! `host-sim run drone`: every table and figure of the thesis, and results beyond it.

use std::f64::consts::TAU;

use kestirim_air_to_ground::Rotor;
use kestirim_sweep::{Block, Samples};

use super::published::ENERGY;
use super::report::{Report, Row};
use super::sweeps::{MovingSweeps, STOPS, StaticCell, StaticSweeps, place_of};
use crate::Error;
use crate::metrics::mean;
use crate::system::{RunOptions, ScalarKind, Settings, System, choose_scalar};
use crate::systems::drone::Drone;
use crate::systems::drone::settings::cell;
use crate::systems::drone::simulate::beyond::{self, Stay};
use crate::systems::drone::simulate::moving_user::{self, LOST_M, Policy, Walk};
use crate::systems::drone::simulate::static_user::{FilterSetting, Geometry};
use crate::systems::drone::simulate::trajectory::SIDE_M;
use crate::systems::drone::simulate::trial::{self, Job};

/// The number of trials in a portion of a cell of a stationary user, unless specified otherwise.
const PORTION: u64 = 110;
/// The ratio of standard error to mean at which no further portion is run.
const PRECISION: f64 = 0.03;
/// The maximum number of portions.
const MOST_PORTIONS: u64 = 16;
/// The number of trials of a cell of a moving user, each of which has hundreds of measurements.
const MOVING_TRIALS: u64 = 12;
/// The table name of results that are in no table of the thesis.
const BEYOND: &str = "beyond the thesis";
/// The default speed of the drone (km/h).
const SPEED_KMH: f64 = 40.0;

/// The trials of one cell, or of all.
///
/// # Errors
/// If the number type is not supported.
pub fn trials(options: &RunOptions, cell: &Settings) -> Result<Vec<Block>, Error> {
    let experiment = Experiment::of(options)?;
    Ok(match (cell.given().next().is_some(), cell.is_on("moving")) {
        (false, _) => experiment.everything(),
        (true, false) => vec![experiment.staying(0, job_of(cell))],
        (true, true) => vec![experiment.walking(0, cell::walk(cell))],
    })
}

/// Evaluates the samples of the trials.
///
/// # Errors
/// Those of [`trials`].
pub fn report(options: &RunOptions, cell: &Settings, samples: &[Samples]) -> Result<Report, Error> {
    let Experiment { seed, scalar, .. } = Experiment::of(options)?;
    let (rows, refused) = match (cell.given().next().is_some(), cell.is_on("moving")) {
        (false, _) => everything(samples),
        (true, false) => static_cell(cell, &samples[0]),
        (true, true) => (vec![moving_cell(cell, &samples[0])], 0),
    };
    Ok(Report { system: Drone::NAME, seed, scalar, refused, rows })
}

struct Experiment {
    seed: u64,
    /// The requested number of trials; `None` for as many as the precision takes.
    trials: Option<u64>,
    moving_trials: u64,
    scalar: ScalarKind,
}

impl Experiment {
    fn of(options: &RunOptions) -> Result<Self, Error> {
        let &RunOptions { seed, trials, scalar } = options;
        let scalar = choose_scalar(Drone::NAME, scalar, &ScalarKind::ALL, ScalarKind::F32)?;
        Ok(Self { seed, trials, moving_trials: trials.unwrap_or(MOVING_TRIALS), scalar })
    }

    /// The blocks of all trials, in the order in which [`everything`] reads them.
    fn everything(&self) -> Vec<Block> {
        let (staying, (moving, _)) = (StaticSweeps::thesis(), moving());
        let jobs = staying.jobs.into_iter().enumerate();
        let walks = moving.walks.into_iter().enumerate();
        let mut blocks: Vec<_> = jobs.map(|(place, job)| self.staying(place, job)).collect();
        blocks.extend(walks.map(|(place, walk)| self.walking(place, walk)));
        let seed = self.seed;
        let errors = |name: String, trials, trial: Box<dyn Fn(u64) -> f64 + Send + Sync>| {
            Block::new(name, ["error_m".to_owned()], trials, move |index| Ok(vec![trial(index)]))
        };
        let trials = self.trials.unwrap_or(2 * PORTION);
        blocks.extend(Stay::ALL.map(|stay| {
            let name = format!("stays: {}", stay.description());
            errors(name, trials, Box::new(move |index| stay.trial(seed, index)))
        }));
        let users = Box::new(move |index| beyond::several_users(seed, index));
        blocks.push(errors("three users".to_owned(), self.moving_trials, users));
        blocks
    }

    fn staying(&self, place: usize, job: Job) -> Block {
        let (scalar, seed) = (self.scalar, self.seed);
        let trials = self.trials.unwrap_or(PORTION * MOST_PORTIONS);
        let block = Block::new(format!("staying {place}"), job.columns(), trials, move |index| {
            Ok(trial::trial(&job, scalar, seed, index).numbers())
        });
        if self.trials.is_some() {
            return block;
        }
        block.until(PORTION, |samples| {
            let row = Row::of(&samples.column(0));
            row.se_m.zip(row.mean_m).is_some_and(|(error, mean)| error < PRECISION * mean)
        })
    }

    fn walking(&self, place: usize, walk: Walk) -> Block {
        let (scalar, seed) = (self.scalar, self.seed);
        let columns = moving_user::Outcome::COLUMNS.map(str::to_owned);
        Block::new(format!("walking {place}"), columns, self.moving_trials, move |index| {
            Ok(moving_user::trial(&walk, scalar, seed, index).numbers().into())
        })
    }
}

/// All walks, and those beyond the thesis by index, as some are among those of the sweeps.
fn moving() -> (MovingSweeps, Vec<(&'static str, usize)>) {
    let mut moving = MovingSweeps::thesis();
    let walks = beyond::walks().into_iter();
    let beyond = walks.map(|(words, walk)| (words, place_of(&mut moving.walks, walk))).collect();
    (moving, beyond)
}

fn everything(samples: &[Samples]) -> (Vec<Row>, u32) {
    let (staying, (moving, beyond)) = (StaticSweeps::thesis(), moving());
    let (stayed, samples) = samples.split_at(staying.jobs.len());
    let (walked, samples) = samples.split_at(moving.walks.len());
    let (stays, users) = samples.split_at(Stay::ALL.len());
    let stayed = staying.jobs.iter().zip(stayed);
    let outcomes: Vec<_> = stayed.map(|(job, samples)| outcomes(job, samples)).collect();
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
    for cell in &moving.cells {
        let row = moving_row(&moving.walks[cell.walk], &walked[cell.walk], cell.speed_kmh);
        rows.push(Row { table: cell.table, cell: cell.cell.clone(), ..row });
    }
    let of = |errors: &Samples| Row { table: BEYOND, filter: "best", ..Row::of(&errors.column(0)) };
    rows.extend(Stay::ALL.iter().zip(stays).map(|(stay, errors)| Row {
        cell: format!("stays: {}", stay.description()),
        ..of(errors)
    }));
    for (description, walk) in beyond {
        let row = moving_row(&moving.walks[walk], &walked[walk], SPEED_KMH);
        rows.push(Row { table: BEYOND, cell: format!("walks: {description}"), ..row });
    }
    let cell = "walk: three users, one filter each".to_owned();
    let lost_percent = Some(lost_percent(&users[0].column(0)));
    rows.push(Row { cell, lost_percent, ..of(&users[0]) });
    (rows, refused)
}

fn job_of(cell: &Settings) -> Job {
    let (published, bests) = match cell::filter(cell) {
        FilterSetting::Published(filter) => (vec![filter], vec![]),
        FilterSetting::Best(points) => (vec![], vec![points]),
    };
    Job { geometry: cell::geometry(cell), published, bests, limit: true }
}

fn static_cell(cell: &Settings, samples: &Samples) -> (Vec<Row>, u32) {
    let job = job_of(cell);
    let outcomes = outcomes(&job, samples);
    let refused = outcomes.iter().map(|outcome| outcome.refused).sum();
    let (particles, row) = match job.published.first() {
        Some(filter) => (filter.particles, published_row(&outcomes, 0, None, false)),
        None => (job.bests[0], best_row(&outcomes, 0)),
    };
    let Geometry { stops, height_m, .. } = job.geometry;
    let radius_m = cell.number("radius").unwrap_or(SIDE_M / 3.0);
    let words = cell::described(cell);
    let name = format!("L={particles} T={stops} h={height_m} r={radius_m:.1}, {words}");
    let energy_j = Some(job.geometry.energy_j(cell.decided("speed")));
    (vec![Row { table: "static user", cell: name, energy_j, ..row }], refused)
}

fn moving_cell(cell: &Settings, samples: &Samples) -> Row {
    let walk = cell::walk(cell);
    let Walk { particles, height_m, user_radius_m, end_time, .. } = walk;
    let words = cell::described(cell);
    let name = format!("L={particles} h={height_m} r={user_radius_m} T_end={end_time}, {words}");
    let row = moving_row(&walk, samples, cell.decided("speed"));
    Row { table: "moving user", cell: name, ..row }
}

fn outcomes(job: &Job, samples: &Samples) -> Vec<trial::Outcome> {
    samples.rows().map(|row| trial::Outcome::of_numbers(job, row)).collect()
}

/// The rows of the thesis' filter and of ours in one cell.
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

fn moving_row(walk: &Walk, samples: &Samples, speed_kmh: f64) -> Row {
    let rows = samples.rows().filter_map(|row| row.try_into().ok());
    let outcomes: Vec<_> = rows.map(moving_user::Outcome::of_numbers).collect();
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

/// The rows of Fig. 3.4: by the published formulas, and with another power, energy of a stop and spacing of the grid,
/// which reproduce all eight published numbers.
fn energies() -> Vec<Row> {
    /// The power at 40 km/h (W); the published constants give 1245.8.
    const POWER_W: f64 = 1125.0;
    /// The energy of a stop (J); the published constants give 5 s · 1021.75 W = 5108.8.
    const STOP_J: f64 = 6314.0;
    let speed = SPEED_KMH / 3.6;
    let rotor = Rotor::<f64>::base_station();
    let mut rows = Vec::new();
    for (name, published) in ["grid", "circle"].into_iter().zip(ENERGY) {
        for (stops, published) in STOPS.into_iter().zip(published) {
            let points = f64::from(stops);
            // Eqs 2.16 and 2.17: the thesis prints D/3 as the grid's spacing for every T.
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
