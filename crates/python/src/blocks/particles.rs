//! The particle filter.

use std::cell::Cell;

use kestirim_particle_filter::{Particles, Region, Resampler, Start};
use kestirim_snapshot::Layout;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use rand_core::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};

use super::of_size;
use super::sleep::{loaded, stored};
use crate::arrays::{Line, Table, values};
use crate::error::{KestirimError, refused, unknown};
use crate::stack;

/// The largest number of particles.
const MOST: usize = 8192;

/// A cloud stored with its generator, so that it draws the same numbers when it is restored.
#[derive(Serialize, Deserialize)]
struct Drawn<const D: usize> {
    cloud: Particles<f64, D, MOST>,
    rng: Xoshiro256PlusPlus,
}

kestirim_snapshot::layout! {
    [const D: usize] for Drawn<D> as "particles/drawn", <Particles<f64, D, MOST> as Layout>::VERSION, f64, [D, MOST], infinite
}

/// The description that a snapshot contains in addition to the number of coordinates.
fn made_for(count: usize) -> String {
    format!("a cloud of {count} particles")
}

/// A cloud of any dimension.
trait AnyCloud: Send + Sync {
    fn len(&self) -> usize;
    fn states(&self) -> Vec<f64>;
    fn weights(&self) -> Vec<f64>;
    fn effective(&self) -> f64;
    /// The mean and the covariance.
    fn moments(&self) -> (Vec<f64>, Vec<f64>);
    fn move_to(&mut self, states: &[f64], rng: &mut Xoshiro256PlusPlus);
    fn update(&mut self, logs: &[f64]) -> PyResult<(f64, f64)>;
    fn resample(&mut self, resampler: Resampler, rng: &mut Xoshiro256PlusPlus) -> PyResult<()>;
    fn jitter(&mut self, deviation: &[f64], rng: &mut Xoshiro256PlusPlus);
    fn regularise(&mut self, scale: f64, rng: &mut Xoshiro256PlusPlus) -> PyResult<()>;
    fn snapshot(&self, rng: &Xoshiro256PlusPlus) -> PyResult<Vec<u8>>;
    /// Restores the cloud and returns the generator.
    fn restore(&mut self, bytes: &[u8]) -> PyResult<Xoshiro256PlusPlus>;
}

impl<const D: usize> AnyCloud for Particles<f64, D, MOST> {
    fn len(&self) -> usize {
        Self::len(self)
    }

    fn states(&self) -> Vec<f64> {
        (0..Self::len(self)).filter_map(|index| self.state(index)).flatten().collect()
    }

    fn weights(&self) -> Vec<f64> {
        (0..Self::len(self)).filter_map(|index| self.weight(index)).collect()
    }

    fn effective(&self) -> f64 {
        Self::effective(self)
    }

    fn moments(&self) -> (Vec<f64>, Vec<f64>) {
        let moments = Self::moments(self);
        (moments.mean().to_vec(), moments.covariance().concat())
    }

    // The cloud asks for its particles one after the other, each once.
    fn move_to(&mut self, states: &[f64], rng: &mut Xoshiro256PlusPlus) {
        let next = Cell::new(0);
        let motion = |state: [f64; D], _: [f64; 0]| {
            let first = next.replace(next.get() + D);
            let moved = states.get(first..first + D);
            moved.and_then(|moved| <[f64; D]>::try_from(moved).ok()).unwrap_or(state)
        };
        self.predict(motion, rng);
    }

    fn update(&mut self, logs: &[f64]) -> PyResult<(f64, f64)> {
        let next = Cell::new(0);
        let update = Self::update(self, |_| {
            let index = next.replace(next.get() + 1);
            logs.get(index).copied().unwrap_or(f64::NEG_INFINITY)
        });
        let update = update.map_err(refused)?;
        Ok((update.effective, update.log_evidence))
    }

    fn resample(&mut self, resampler: Resampler, rng: &mut Xoshiro256PlusPlus) -> PyResult<()> {
        Self::resample(self, resampler, rng).map_err(refused)
    }

    fn jitter(&mut self, deviation: &[f64], rng: &mut Xoshiro256PlusPlus) {
        let of = |axis: usize| deviation.get(axis).copied().unwrap_or_default();
        Self::jitter(self, &std::array::from_fn(of), rng);
    }

    fn regularise(&mut self, scale: f64, rng: &mut Xoshiro256PlusPlus) -> PyResult<()> {
        Self::regularise(self, scale, rng).map_err(refused)
    }

    fn snapshot(&self, rng: &Xoshiro256PlusPlus) -> PyResult<Vec<u8>> {
        let drawn = Drawn { cloud: self.clone(), rng: rng.clone() };
        stored(drawn, &made_for(Self::len(self)))
    }

    fn restore(&mut self, bytes: &[u8]) -> PyResult<Xoshiro256PlusPlus> {
        let Drawn { cloud, rng } = loaded(bytes, &made_for(Self::len(self)))?;
        *self = cloud;
        Ok(rng)
    }
}

fn build<const D: usize>(
    count: usize,
    low: &[f64],
    high: &[f64],
    rng: &mut Xoshiro256PlusPlus,
) -> PyResult<Box<dyn AnyCloud>> {
    let corner = |corner: &[f64]| <[f64; D]>::try_from(corner).map_err(refused);
    let region = Region::new(corner(low)?, corner(high)?).map_err(refused)?;
    let cloud = Particles::<f64, D, MOST>::with_count(count, Start::Random, &region, rng);
    Ok(Box::new(cloud.map_err(refused)?))
}

/// A cloud of particles.
#[pyclass]
pub(crate) struct Cloud {
    cloud: Box<dyn AnyCloud>,
    rng: Xoshiro256PlusPlus,
}

#[pymethods]
impl Cloud {
    #[new]
    fn new(count: usize, low: Line<'_>, high: Line<'_>, seed: u64) -> PyResult<Self> {
        if !(1..=MOST).contains(&count) {
            let sentence = format!("count: expected 1 to {MOST} particles, found {count}");
            return Err(KestirimError::new_err(sentence));
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (low, high) = (values(&low)?, values(&high)?);
        let cloud = stack::with_much(
            || of_size!("coordinates", low.len(), [1 2 3 4 5 6], build(count, low, high, &mut rng)),
        )?;
        Ok(Self { cloud, rng })
    }

    fn states(&self) -> Vec<f64> {
        self.cloud.states()
    }

    fn weights(&self) -> Vec<f64> {
        self.cloud.weights()
    }

    fn effective(&self) -> f64 {
        self.cloud.effective()
    }

    fn moments(&self) -> (Vec<f64>, Vec<f64>) {
        self.cloud.moments()
    }

    /// Replaces the states of the particles, (n, d).
    fn move_to(&mut self, states: Table<'_>) -> PyResult<()> {
        self.cloud.move_to(values(&states)?, &mut self.rng);
        Ok(())
    }

    /// Updates with log-likelihoods (n,); returns the effective number and the logarithm of the evidence.
    fn update(&mut self, logs: Line<'_>) -> PyResult<(f64, f64)> {
        let logs = values(&logs)?;
        if logs.len() != self.cloud.len() {
            let (expected, found) = (self.cloud.len(), logs.len());
            return Err(KestirimError::new_err(format!(
                "expected {expected} likelihoods, found {found}"
            )));
        }
        self.cloud.update(logs)
    }

    fn resample(&mut self, resampler: &str) -> PyResult<()> {
        let resampler = match resampler {
            "systematic" => Resampler::Systematic,
            "stratified" => Resampler::Stratified,
            "residual" => Resampler::Residual,
            "multinomial" => Resampler::Multinomial,
            other => {
                let expected = "'systematic', 'stratified', 'residual' or 'multinomial'";
                return Err(unknown("resampler", other, expected));
            }
        };
        self.cloud.resample(resampler, &mut self.rng)
    }

    fn jitter(&mut self, deviation: Line<'_>) -> PyResult<()> {
        self.cloud.jitter(values(&deviation)?, &mut self.rng);
        Ok(())
    }

    fn regularise(&mut self, scale: f64) -> PyResult<()> {
        self.cloud.regularise(scale, &mut self.rng)
    }

    fn snapshot<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let snapshot = stack::with_much(|| self.cloud.snapshot(&self.rng))?;
        Ok(PyBytes::new(py, &snapshot))
    }

    fn restore(&mut self, snapshot: &[u8]) -> PyResult<()> {
        self.rng = stack::with_much(|| self.cloud.restore(snapshot))?;
        Ok(())
    }
}
