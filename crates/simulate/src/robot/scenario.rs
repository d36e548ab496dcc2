//! The paper's office, and the errors of ranges in it.
//!
//! The error model and its numbers are those of 90 recorded points in a room with the same layout (biases, noise) and
//! of recordings with a person in the way (blocking); the frequency of reflections was chosen so that trilateration
//! errs as much as the paper's does.

use kestirim_replay::metrics::{distance, median};
use kestirim_replay::robot::{Anchors, RangeRow};
use rand_core::Rng;
use rand_distr::{Distribution, Exp};

use crate::random::{normal, uniform};

/// The positions of the anchors A1 to A4, m.
pub const ANCHORS: [[f64; 3]; 4] =
    [[0.0, 0.0, 0.0], [4.8, 6.4, 0.0], [0.0, 6.4, 0.0], [4.8, 0.0, 0.0]];
/// The anchors with their names.
pub fn office_anchors() -> Anchors {
    let names = (1..=ANCHORS.len()).map(|number| format!("A{number}")).collect();
    Anchors { names, positions: ANCHORS.to_vec() }
}

/// The number of epochs at each point.
pub const EPOCHS: usize = 50;
/// The time between epochs, µs.
pub const EPOCH_US: i64 = 100_000;

/// The common bias of all links, m; anchors and links deviate from it by `ANCHOR_SIGMA` and `LINK_SIGMA`.
pub const COMMON_BIAS: f64 = 0.19;
/// The standard deviation of an anchor's bias, which is the same everywhere, m.
pub const ANCHOR_SIGMA: f64 = 0.057;
/// The standard deviation of the bias of a link between an anchor and a place, m.
pub const LINK_SIGMA: f64 = 0.067;
/// The standard deviation of the white noise, m.
pub const NOISE_SIGMA: f64 = 0.03;

/// The probability per epoch that a reflection begins on a link.
const BURST_BEGINS: f64 = 0.006;
/// The probability per epoch that a reflection ends.
const BURST_ENDS: f64 = 0.1;
/// The mean length that a reflection adds to the range, m.
const BURST_MEAN: f64 = 0.3;
/// The share of the points at which a person blocks one link, and the number of epochs for which it is blocked.
const BLOCKED: f64 = 1.0 / 3.0;
const BLOCKED_EPOCHS: usize = 20;
/// The interval of the length that a blocked link adds to the range, m.
const BLOCKED_FROM: f64 = 0.2;
const BLOCKED_TO: f64 = 0.8;
/// The speed of the robot, m/s, and the corners of its paths: a line, and a round through the office, m.
const SPEED: f64 = 0.2;
const LINE: [[f64; 2]; 2] = [[0.8, 0.8], [4.0, 5.6]];
const ROUND: [[f64; 2]; 5] = [[0.8, 0.8], [4.0, 0.8], [4.0, 5.6], [0.8, 5.6], [0.8, 0.8]];
/// In a crowd, a person blocks each anchor in turn for one part in this many of the path.
const CROWD_SHARE: usize = 6;

/// The fifteen points, m. The paper does not say where its own were.
pub fn points() -> [[f64; 2]; 15] {
    std::array::from_fn(|index| {
        let (column, row) = (index % 3, index / 3);
        [1.2 + 1.2 * column as f64, 1.0 + 1.1 * row as f64]
    })
}

/// Six marked places between the points, at which the anchors are calibrated, m.
pub fn marks() -> [[f64; 2]; 6] {
    std::array::from_fn(|index| {
        let (column, row) = (index % 2, index / 2);
        [1.8 + 1.2 * column as f64, 1.55 + 1.65 * row as f64]
    })
}

/// The positions of the robot on its straight line, at each epoch, m.
pub fn line() -> Vec<[f64; 2]> {
    along(&LINE)
}

/// The positions of the robot on a round through the office, at each epoch, m; it ends where it began.
pub fn round() -> Vec<[f64; 2]> {
    along(&ROUND)
}

/// The positions at each epoch of a path from corner to corner, m.
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

/// An office on one day, with the biases of its anchors.
#[derive(Debug, Clone, Copy)]
pub struct Office {
    biases: [f64; 4],
}

impl Office {
    /// Draws the anchors' biases.
    pub fn draw<R: Rng>(rng: &mut R) -> Self {
        Self { biases: std::array::from_fn(|_| COMMON_BIAS + normal(rng, ANCHOR_SIGMA)) }
    }

    /// The ranges along a path, four at each epoch.
    pub fn measure<R: Rng>(&self, rng: &mut R, path: &[[f64; 2]]) -> Vec<RangeRow> {
        let links = self.links(rng);
        let person = Person::draw(rng, path.len());
        Self::ranges(rng, path, links, &[person])
    }

    /// The ranges along a path in a crowd: a person blocks each anchor for a while, one after the other.
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

    /// The measured bias of each anchor, m: the median at the marked places.
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

    /// The biases of the links from a place to the anchors, m.
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

/// The length that a reflection adds to the range in the next epoch, m.
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

/// A person who blocks one link for a while.
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
