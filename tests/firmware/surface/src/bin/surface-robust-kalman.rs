//! Everything of `kestirim-robust-kalman`.

#![no_std]
#![no_main]

use kestirim_kalman::{Covariance, Gaussian, SparseRow};
use kestirim_robust_kalman::{
    Adaptive, Block, Decision, Descent, Discrepancy, Error, Measurement, Order, Reweighting,
    Robust, Scale, Weight, jump, student_quantile,
};
use kestirim_scalar::{Q12_20, Scalar};
use surface::{any, call_each, image, keep, matrix, number, numbers, slice, slice_mut};

fn block() -> Block {
    any(Block::new(any(1), any(1)))
}

/// Any configuration.
fn robust<T: Scalar>() -> Robust<T> {
    let adaptive = any(Some(Adaptive {
        discrepancy: any(Discrepancy::Prediction),
        c0: number(),
        c1: number(),
        descent: any(Descent::Printed),
        floor: number(),
        order: any(Order::ByMajority),
        ..Adaptive::new(block())
    }));
    any(Robust {
        weight: any(Weight::TTest {
            alpha0: number(),
            alpha1: number(),
            descent: any(Descent::Squared),
        }),
        scale: any(Scale::Residuals { floor: number() }),
        reweighting: any(Reweighting::WorstFirst { most: any(1) }),
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
    keep::<Robust<T>>(Robust::printed(any(robust())));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
}

fn weights<T: Scalar>() {
    keep(student_quantile(number::<T>(), any(1)));
    keep(Descent::factor(any(Descent::Squared), number::<T>(), number(), number()));
    let weight = robust::<T>().weight;
    keep(Weight::thresholds(&weight, any(1)));
    keep(Weight::factor(&weight, number(), any((number(), number()))));
    keep(Adaptive::factor(&any(Adaptive::<T>::new(block())), number()));
    keep(Decision::was_treated(&any(<Decision<T> as Default>::default())));
}

fn updates<T: Scalar, const N: usize, const K: usize, const M: usize>() {
    let mut estimate = any(Gaussian::<T, N>::new(matrix(), Covariance::from_variances(&numbers())));
    let row = any(SparseRow::new([(any(1), number()); K]));
    let measurement = any(Measurement::new(&row, number(), number()));
    let other = any(Measurement { row: slice(row.entries()), ..measurement });
    let measurements = any([other; M]);
    let mut decisions = any([Decision::NONE; M]);
    let (measurements, decisions) = (slice(&measurements), slice_mut(&mut decisions));
    keep(Robust::update(&robust(), any(&mut estimate), measurements, decisions));
    keep(jump(&estimate, measurements, block()));
}

fn all_of<T: Scalar>() {
    call_each([presets::<T>, weights::<T>, updates::<T, 4, 2, 4>, updates::<T, 9, 4, 7>]);
}

fn run() {
    call_each([all_of::<f32>, all_of::<Q12_20>]);
}

image!(run);
