//! The paper's office, and what goes wrong with ranges in it.
//!
//! The error model and its numbers are those of 90 recorded points in a room with the same layout (biases,
//! noise) and of recordings with a person in the way (blocking); how often reflections come was chosen so that
//! trilateration errs as much as the paper's does.

use kestirim_replay::metrics::{distance, median};
use kestirim_replay::robot::{Anchors, RangeRow};
use rand_core::Rng;
use rand_distr::{Distribution, Exp};

use crate::random::{normal, uniform};

/// The anchors A1 to A4, m.
pub const ANCHORS: [[f64; 3]; 4] =
    [[0.0, 0.0, 0.0], [4.8, 6.4, 0.0], [0.0, 6.4, 0.0], [4.8, 0.0, 0.0]];
/// The anchors with their names.
pub fn office_anchors() -> Anchors {
    let names = (1..=ANCHORS.len()).map(|number| format!("A{number}")).collect();
    Anchors { names, positions: ANCHORS.to_vec() }
}

/// Epochs at each point.
pub const EPOCHS: usize = 50;
/// Time between epochs, µs.
pub const EPOCH_US: i64 = 100_000;

/// What the common bias of all links is, m; per anchor and per link it differs by these standard deviations.
pub const COMMON_BIAS: f64 = 0.19;
/// Standard deviation of the bias of an anchor, the same everywhere, m.
pub const ANCHOR_SIGMA: f64 = 0.057;
/// Standard deviation of the bias of a link between an anchor and a place, m.
pub const LINK_SIGMA: f64 = 0.067;
/// Standard deviation of the white noise, m.
pub const NOISE_SIGMA: f64 = 0.03;

/// A reflection begins in this share of the epochs of a link, …
const BURST_BEGINS: f64 = 0.006;
/// … ends in this share of those it lasts, …
const BURST_ENDS: f64 = 0.1;
/// … and lengthens the range by this on average, m.
const BURST_MEAN: f64 = 0.3;
/// In this share of the points a person stands in the way of one link for 20 epochs, …
const BLOCKED: f64 = 1.0 / 3.0;
const BLOCKED_EPOCHS: usize = 20;
/// … which lengthens it by something between these, m.
const BLOCKED_FROM: f64 = 0.2;
const BLOCKED_TO: f64 = 0.8;
/// The robot drives at this speed, m/s, from one point of the office to another.
const SPEED: f64 = 0.2;
const LINE: [[f64; 2]; 2] = [[0.8, 0.8], [4.0, 5.6]];
const ROUND: [[f64; 2]; 5] = [[0.8, 0.8], [4.0, 0.8], [4.0, 5.6], [0.8, 5.6], [0.8, 0.8]];
/// Who meets a crowd has a person before each anchor in turn, for this share of the path.
const CROWD_SHARE: usize = 6;

/// The fifteen points, m. The paper does not say where its own were.
pub fn points() -> [[f64; 2]; 15] {
    std::array::from_fn(|index| {
        let (column, row) = (index % 3, index / 3);
        [1.2 + 1.2 * column as f64, 1.0 + 1.1 * row as f64]
    })
}

/// Six marked places between them, at which the anchors are calibrated, m.
pub fn marks() -> [[f64; 2]; 6] {
    std::array::from_fn(|index| {
        let (column, row) = (index % 2, index / 2);
        [1.8 + 1.2 * column as f64, 1.55 + 1.65 * row as f64]
    })
}

/// Where the robot is at each epoch of its straight line, m.
pub fn line() -> Vec<[f64; 2]> {
    along(&LINE)
}

/// And of a round through the office, back to where it began.
pub fn round() -> Vec<[f64; 2]> {
    along(&ROUND)
}

/// At each epoch of a path from corner to corner.
fn along(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let stretch = |(from, to): (&[f64; 2], &[f64; 2])| {
        let (from, to) = (*from, *to);
        let epochs = (distance(from, to) / SPEED / (EPOCH_US as f64 * 1e-6)) as usize;
        let share = move |epoch: usize| epoch as f64 / epochs as f64;
        (1..=epochs).map(move |epoch| {
            [0, 1].map(|axis| from[axis] + share(epoch) * (to[axis] - from[axis]))
        })
    };
    let stretches = corners.iter().zip(corners.iter().skip(1)).flat_map(stretch);
    corners.first().copied().into_iter().chain(stretches).collect()
}

/// An office on one day: what its anchors measure too long.
#[derive(Debug, Clone, Copy)]
pub struct Office {
    biases: [f64; 4],
}

impl Office {
    /// Draws the anchors' biases.
    pub fn draw<R: Rng>(rng: &mut R) -> Self {
        Self { biases: std::array::from_fn(|_| COMMON_BIAS + normal(rng, ANCHOR_SIGMA)) }
    }

    /// Ranges along a path, four at each epoch.
    pub fn measure<R: Rng>(&self, rng: &mut R, path: &[[f64; 2]]) -> Vec<RangeRow> {
        let links = self.links(rng);
        let person = Person::draw(rng, path.len());
        Self::ranges(rng, path, links, &[person])
    }

    /// The same in a crowd: before each anchor somebody stands for a while, one after the other.
    pub fn measure_in_a_crowd<R: Rng>(&self, rng: &mut R, path: &[[f64; 2]]) -> Vec<RangeRow> {
        let links = self.links(rng);
        let persons = std::array::from_fn::<_, 4, _>(|anchor| {
            Person::before(
                rng,
                anchor,
                path.len() * (anchor + 1) / CROWD_SHARE,
                path.len() / CROWD_SHARE,
            )
        });
        Self::ranges(rng, path, links, &persons)
    }

    /// What each anchor measures too long, m: the median at the marked places.
    pub fn calibrate<R: Rng>(&self, rng: &mut R) -> Vec<f64> {
        let mut excess = [const { Vec::new() }; 4];
        for place in marks() {
            for row in self.measure(rng, &[place; EPOCHS]) {
                let Some(range) = row.range else { continue };
                let [x, y, _] = ANCHORS[row.anchor];
                excess[row.anchor].push(range - distance(place, [x, y]));
            }
        }
        excess.iter().map(|excess| median(excess)).collect()
    }

    /// What the links from a place to the anchors measure too long, m.
    fn links<R: Rng>(&self, rng: &mut R) -> [f64; 4] {
        self.biases.map(|bias| bias + normal(rng, LINK_SIGMA))
    }

    fn ranges<R: Rng>(
        rng: &mut R,
        path: &[[f64; 2]],
        links: [f64; 4],
        persons: &[Person],
    ) -> Vec<RangeRow> {
        let mut bursts = [0.0; 4];
        let mut rows = Vec::with_capacity(4 * path.len());
        for (epoch, &[x, y]) in path.iter().enumerate() {
            for (anchor, place) in ANCHORS.iter().enumerate() {
                bursts[anchor] = next_burst(rng, bursts[anchor]);
                let blocked: f64 =
                    persons.iter().map(|person| person.lengthens(anchor, epoch)).sum();
                let range = (x - place[0]).hypot(y - place[1])
                    + links[anchor]
                    + bursts[anchor]
                    + blocked
                    + normal(rng, NOISE_SIGMA);
                let time_us = epoch as i64 * EPOCH_US;
                rows.push(RangeRow { time_us, anchor, range: Some(range) });
            }
        }
        rows
    }
}

/// By how much a reflection lengthens the range in the next epoch, m.
fn next_burst<R: Rng>(rng: &mut R, burst: f64) -> f64 {
    let chance: f64 = uniform(rng);
    if burst > 0.0 {
        return if chance < BURST_ENDS { 0.0 } else { burst };
    }
    if chance >= BURST_BEGINS {
        return 0.0;
    }
    Exp::new(1.0 / BURST_MEAN).map_or(0.0, |size| size.sample(rng))
}

/// Somebody in the way of one link for a while.
#[derive(Debug, Clone, Copy)]
struct Person {
    anchor: usize,
    from: usize,
    epochs: usize,
    length: f64,
}

impl Person {
    fn draw<R: Rng>(rng: &mut R, epochs: usize) -> Self {
        let there = uniform(rng) < BLOCKED;
        let anchor = ((uniform(rng) * 4.0) as usize).min(3);
        let latest = epochs.saturating_sub(BLOCKED_EPOCHS) as f64;
        let from = (uniform(rng) * latest) as usize;
        let person = Self::before(rng, anchor, from, BLOCKED_EPOCHS);
        Self { length: if there { person.length } else { 0.0 }, ..person }
    }

    fn before<R: Rng>(rng: &mut R, anchor: usize, from: usize, epochs: usize) -> Self {
        let length = BLOCKED_FROM + uniform(rng) * (BLOCKED_TO - BLOCKED_FROM);
        Self { anchor, from, epochs, length }
    }

    fn lengthens(&self, anchor: usize, epoch: usize) -> f64 {
        let in_the_way = (self.from..self.from + self.epochs).contains(&epoch);
        if anchor == self.anchor && in_the_way { self.length } else { 0.0 }
    }
}
