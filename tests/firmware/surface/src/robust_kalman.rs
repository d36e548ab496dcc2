//! Calls everything of `kestirim-robust-kalman`.

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use kestirim_robust_kalman::{
    Adaptive, AnyFactor, AnyScale, Block, Decision, Descent, Discrepancy, Error, Huber, Igg3,
    Measurement, NoFactor, Order, Reweighting, Robust, Scale, TTest, UnitScale, Weight,
    WeightFunction, jump, student_quantile,
};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, maybe, number, numbers, one_of, slice, slice_mut,
    whole,
};

fn block() -> Block {
    any(Block::new(whole(), whole()))
}

fn descent() -> Descent {
    one_of([Descent::Published, Descent::Squared])
}

/// An arbitrary configuration.
fn robust<T: Scalar>() -> Robust<T> {
    let adaptive = maybe(Adaptive {
        discrepancy: one_of([Discrepancy::Innovation, Discrepancy::Block, Discrepancy::Prediction]),
        c0: number(),
        c1: number(),
        descent: descent(),
        floor: number(),
        order: one_of([Order::AfterWeights, Order::BeforeWeights, Order::ByMajority]),
        ..Adaptive::new(block())
    });
    any(Robust {
        weight: one_of([
            Weight::Huber(Huber { k: number() }),
            Weight::Igg3(Igg3 { k0: number(), k1: number(), descent: descent() }),
            Weight::TTest(TTest { alpha0: number(), alpha1: number(), descent: descent() }),
        ]),
        scale: one_of([
            Scale::Unit,
            Scale::Epoch,
            Scale::Innovations { floor: number() },
            Scale::Residuals { floor: number() },
        ]),
        reweighting: one_of([
            Reweighting::Never,
            Reweighting::OneShot,
            Reweighting::WorstFirst { most: whole() },
        ]),
        least_redundancy: number(),
        adaptive,
    })
}

fn presets<T: Scalar>() {
    keep::<Robust<T>>(Robust::plain());
    keep::<Robust<T>>(Robust::igg3());
    keep::<Robust<T>>(Robust::t_test());
    keep::<Robust<T>>(Robust::iterative_igg3());
    keep::<Robust<T>>(Robust::adaptive(block()));
    let robust = any(robust::<T>());
    keep(AnyScale::<T>::choice(&robust.scale));
    keep(AnyFactor::<T>::choice(&robust.adaptive));
    keep::<Robust<T>>(Robust::published(robust));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
}

fn functions<T: Scalar, W: WeightFunction<T>>(weight: &W) {
    keep(WeightFunction::thresholds(weight, whole()));
    keep(WeightFunction::factor(weight, number(), any((number(), number()))));
    keep(WeightFunction::<T>::is_valid(weight));
    keep(WeightFunction::<T>::is_t_test(weight));
}

fn weights<T: Scalar>() {
    keep(student_quantile(number::<T>(), whole()));
    keep(Descent::factor(descent(), number::<T>(), number(), number()));
    functions(&robust::<T>().weight);
    functions(&any(Huber { k: number::<T>() }));
    functions(&any(Igg3 { k0: number::<T>(), k1: number(), descent: descent() }));
    functions(&any(TTest { alpha0: number::<T>(), alpha1: number(), descent: descent() }));
    keep(Adaptive::factor(&any(Adaptive::<T>::new(block())), number()));
    keep(Decision::was_treated(&any(<Decision<T> as Default>::default())));
}

fn updates<T: Scalar, const N: usize, const K: usize, const M: usize>() {
    let mut estimate = any(Gaussian::<T, N>::new(matrix(), Covariance::from_variances(&numbers())));
    let row = any(SparseRow::new([(whole(), number()); K]));
    let measurement = any(Measurement::new(&row, number(), number()));
    let other = any(Measurement { row: slice(row.entries()), ..measurement });
    let measurements = any([other; M]);
    let mut decisions = any([Decision::NONE; M]);
    let (measurements, decisions) = (slice(&measurements), slice_mut(&mut decisions));
    keep(Robust::update(&robust(), any(&mut estimate), measurements, decisions));
    let huber = Robust::with_weight(robust(), any(Huber { k: number() }));
    keep(Robust::update(&huber, any(&mut estimate), measurements, decisions));
    let lean = Robust::lean(robust(), any(Huber { k: number() }));
    keep(AnyScale::<T>::choice(&UnitScale));
    keep(AnyFactor::<T>::choice(&NoFactor));
    keep(Robust::update(&lean, any(&mut estimate), measurements, decisions));
    keep(jump(&estimate, measurements, block()));
}

fn all_of<T: Scalar>() {
    call_each([presets::<T>, weights::<T>, updates::<T, 4, 2, 4>, updates::<T, 9, 4, 7>]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
