use core::array::from_fn;

use kestirim_kalman::{Gaussian, Innovation, Process};
use kestirim_scalar::{Columns, Components, Scalar};
use nalgebra::{ArrayStorage, SVector};

use super::filter::AugmentedTransition;
use super::local::{Local, LocalModel, in_units};
use super::row::{AIRSPEED, Row, blend, unit_of};
use super::{AugmentedFilter, AugmentedStep};
use crate::Error;
use crate::kalman_filter::UNITS;

/// Steps of all local models in the scalar and the units of a [`ScheduledFilter`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct ScheduledTransition<T: Scalar, const N: usize, const K: usize, const G: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    steps: [LocalTransition<T, N, K>; G],
}

#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
struct LocalTransition<T: Scalar, const N: usize, const K: usize> {
    step: AugmentedTransition<T, N, K>,
    constant: SVector<T, 4>,
}

/// An [`AugmentedFilter`] whose model is that of the airspeed it estimates: of G local models at rising airspeeds, the two
/// about the estimate are blended, with weights linear in the airspeed. Below the first and beyond the last of them it is
/// that one alone.
///
/// What is blended are steps over an interval and rows of outputs, so that a sample takes no matrix exponential. That many
/// linear models which overlap make one nonlinear one is the idea of Takagi and Sugeno (*Fuzzy identification of systems
/// and its applications to modeling and control*, IEEE Trans. SMC 15, 1985) and of Murray-Smith and Johansen (*Multiple Model Approaches to
/// Modelling and Control*, 1997). The covariance follows the blended model as if its weights were known.
///
/// Scalar and units of what goes in and comes out are those of the [`AugmentedFilter`]; all of it deviates from the common
/// origin of the [`LocalModel`]s.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub struct ScheduledFilter<
    T: Scalar,
    const N: usize,
    const K: usize,
    const P: usize,
    const G: usize,
> {
    pub(super) filter: AugmentedFilter<T, N, K, P>,
    pub(super) grid: Grid<T, N, P, G>,
}

impl<T: Scalar, const N: usize, const K: usize, const P: usize, const G: usize>
    ScheduledFilter<T, N, K, P, G>
{
    /// A filter that starts at the origin, with the standard deviations of the models. Two models of one airspeed count as
    /// one, so that a grid of fewer than G repeats its last.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if a number is beyond what the scalar holds; [`Error::Grid`] if airspeeds fall, or the models have not the
    /// same states, outputs and origin.
    pub fn new(models: &[LocalModel<N, K, P>; G]) -> Result<Self, Error> {
        const { assert!(G > 0, "one model at least is blended") };
        let first = models.first().ok_or(Error::Grid)?;
        let mut filter = AugmentedFilter::new(&first.model)?;
        let mut units = [0.0_f64; P];
        for local in models {
            for (unit, output) in units.iter_mut().zip(&local.model.outputs) {
                *unit = unit.max(unit_of(output));
            }
        }
        filter.output_units = SVector::from(units);
        let mut grid = Grid { local: [Local::new(); G] };
        let mut nexts = models.iter().skip(1);
        for (place, local) in grid.local.iter_mut().zip(models) {
            if !local.is_finite() {
                return Err(Error::NotFinite);
            }
            let next = nexts.next().unwrap_or(local);
            let apart = next.state.as_array()[AIRSPEED] - local.state.as_array()[AIRSPEED];
            if !(apart >= 0.0 && local.is_like(first)) {
                return Err(Error::Grid);
            }
            *place = Local::of(local, filter.state_units.as_array(), &units, apart);
            if !place.is_finite() {
                return Err(Error::NotFinite);
            }
        }
        grid.prepare(&mut filter, &mut [None; P])?;
        Ok(Self { filter, grid })
    }

    /// The filter as it was at its start.
    pub fn begun_anew(&self) -> Self {
        Self { filter: self.filter.begun_anew(), ..*self }
    }

    /// The same steps, one a local model, converted once.
    pub fn transition(&self, steps: &[AugmentedStep<N>; G]) -> ScheduledTransition<T, N, K, G> {
        let converted = |index: usize| {
            let step = self.filter.transition(&steps[index]);
            LocalTransition { step, constant: self.grid.local[index].constant(&step) }
        };
        ScheduledTransition { steps: from_fn(converted) }
    }

    /// The filter with its estimate, uncertainty and units. Its outputs' rows are those of the airspeed at which the last were taken
    /// in.
    pub const fn filter(&self) -> &AugmentedFilter<T, N, K, P> {
        &self.filter
    }

    /// Moves on by a step with these inputs δe (rad) and δt, at the airspeed that is estimated before it.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
    pub fn predict(
        &mut self,
        transition: &ScheduledTransition<T, N, K, G>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        self.grid.predict(&mut self.filter, transition, input)
    }

    /// Takes in the outputs that were measured while these inputs were applied, at the airspeed that is estimated before, and
    /// answers with what each said beyond what was expected of it, in the outputs' units.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was.
    pub fn correct(
        &mut self,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let (mut next, mut measured) = (self.filter, *measured);
        self.grid.prepare(&mut next, &mut measured)?;
        let innovations = next.correct(&measured, input)?;
        self.filter = next;
        Ok(innovations)
    }

    /// Moves on by a step with the inputs that were held during it, then takes in the outputs that were measured with
    /// those of now.
    ///
    /// # Errors
    /// [`Error::NotFinite`] or [`Error::Estimate`]; the filter is as it was before both.
    pub fn step(
        &mut self,
        transition: &ScheduledTransition<T, N, K, G>,
        held: &SVector<T, 2>,
        measured: &[Option<T>; P],
        input: &SVector<T, 2>,
    ) -> Result<[Option<Innovation<T>>; P], Error> {
        let (mut next, mut measured) = (self.filter, *measured);
        self.grid.predict(&mut next, transition, held)?;
        self.grid.prepare(&mut next, &mut measured)?;
        let innovations = next.correct(&measured, input)?;
        self.filter = next;
        Ok(innovations)
    }
}

/// The local models of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(
        serialize = "T: serde::Serialize",
        deserialize = "T: Scalar + serde::Deserialize<'de>"
    ))
)]
pub(super) struct Grid<T: Scalar, const N: usize, const P: usize, const G: usize> {
    #[cfg_attr(feature = "serde", serde(with = "kestirim_snapshot::arrays"))]
    local: [Local<T, N, P>; G],
}

impl<T: Scalar, const N: usize, const P: usize, const G: usize> Grid<T, N, P, G> {
    /// The model below an airspeed, and how near it is to the next one: 0 to 1.
    fn place(&self, airspeed: T) -> (usize, T) {
        let (mut place, mut share) = (0, T::ZERO);
        let pairs = self.local.iter().zip(self.local.iter().skip(1)).enumerate();
        for (index, (local, next)) in pairs {
            if index == 0 || airspeed >= local.airspeed {
                // Within both, so that fixed point holds the product.
                let beyond = airspeed.clamp(local.airspeed, next.airspeed) - local.airspeed;
                place = index;
                share = (beyond * local.slope).clamp(T::ZERO, T::ONE);
            }
        }
        (place, share)
    }

    /// Moves a filter on, by the step of the airspeed that it estimates.
    pub(super) fn predict<const K: usize>(
        &self,
        filter: &mut AugmentedFilter<T, N, K, P>,
        transition: &ScheduledTransition<T, N, K, G>,
        input: &SVector<T, 2>,
    ) -> Result<(), Error> {
        let (place, share) = self.place(filter.state.mean.as_array()[AIRSPEED]);
        let (below, above) = about(&transition.steps, place)?;
        let mut step = below.step;
        step.blend(&above.step, share);
        let mut constant = below.constant;
        blend(constant.as_array_mut(), above.constant.as_array(), share);
        let fading = filter.bounded(&step);
        let process = step.forced(&fading, input);
        filter.state.advance(&Shifted { process, constant: &constant })?;
        Ok(())
    }

    /// Gives a filter the outputs of the airspeed that it estimates, and takes from what was measured what these do not see.
    pub(super) fn prepare<const K: usize>(
        &self,
        filter: &mut AugmentedFilter<T, N, K, P>,
        measured: &mut [Option<T>; P],
    ) -> Result<(), Error> {
        let (place, share) = self.place(filter.state.mean.as_array()[AIRSPEED]);
        let (below, above) = about(&self.local, place)?;
        filter.rows = below.rows;
        for (row, above) in filter.rows.iter_mut().zip(&above.rows) {
            row.blend(above, share);
        }
        let mut taken = below.taken;
        blend(taken.as_array_mut(), above.taken.as_array(), share);
        for (measured, taken) in measured.iter_mut().zip(taken.as_array()) {
            *measured = measured.map(|measured| measured - *taken);
        }
        Ok(())
    }
}

impl<T: Scalar, const N: usize, const P: usize> Local<T, N, P> {
    const fn new() -> Self {
        Self {
            airspeed: T::ZERO,
            slope: T::ZERO,
            rows: [Row::new(); P],
            taken: SVector::from_array_storage(ArrayStorage([[T::ZERO; P]])),
            state: SVector::from_array_storage(ArrayStorage([[0.0; 4]])),
            input: SVector::from_array_storage(ArrayStorage([[0.0; 2]])),
        }
    }

    /// Of a model, with the next one so far apart (m/s).
    fn of<const K: usize>(
        local: &LocalModel<N, K, P>,
        state_units: &[f64; N],
        units: &[f64; P],
        apart: f64,
    ) -> Self {
        let [_, _, unit_of_airspeed, _] = UNITS;
        let state = in_units(&local.state);
        let slope = if apart > 0.0 { unit_of_airspeed / apart } else { 0.0 };
        let mut this = Self {
            airspeed: T::from_f64(state.as_array()[AIRSPEED]),
            slope: T::from_f64(slope),
            state,
            input: local.input,
            ..Self::new()
        };
        let columns = local.model.c.as_columns();
        let places = this.rows.iter_mut().zip(this.taken.as_array_mut());
        let outputs = local.model.outputs.iter().zip(local.outputs.as_array()).zip(units);
        for (index, ((row, taken), ((output, shown), unit))) in places.zip(outputs).enumerate() {
            let (seen, constant) = local.seen(output, *shown);
            let parts = from_fn(|state| {
                let own = seen.row.get(state).copied();
                own.or_else(|| columns[state].get(index).copied()).unwrap_or(0.0)
                    * state_units[state]
            });
            *row = Row::of(&seen, parts, *unit);
            *taken = T::from_f64(constant / *unit);
        }
        this
    }
}

/// A place of a list and the next; at the end the same.
fn about<X, const G: usize>(all: &[X; G], place: usize) -> Result<(&X, &X), Error> {
    let below = all.get(place).ok_or(Error::Grid)?;
    Ok((below, all.get(place.wrapping_add(1)).unwrap_or(below)))
}

/// A process after which a constant is added to the four states.
struct Shifted<'a, T, Q> {
    process: Q,
    constant: &'a SVector<T, 4>,
}

impl<T: Scalar, const N: usize, Q: Process<T, N>> Process<T, N> for Shifted<'_, T, Q> {
    #[inline(always)]
    fn advance(&self, estimate: &mut Gaussian<T, N>) {
        self.process.advance(estimate);
        for (mean, constant) in
            estimate.mean.as_array_mut().iter_mut().zip(self.constant.as_array())
        {
            *mean += *constant;
        }
    }
}
