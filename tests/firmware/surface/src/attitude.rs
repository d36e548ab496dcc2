//! Calls everything of `kestirim-attitude`.

use kestirim_attitude::{Ahrs, Gains, Orientation};
use kestirim_scalar::{Q12_20, Scalar};

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, maybe, number, numbers, rounds, try_on,
};

fn orientations<T: Scalar>() {
    keep::<Orientation<T>>(Orientation::identity());
    keep(Orientation::<T>::from_specific_force(&matrix()));
    let Some(orientation) = any(Orientation::<T>::from_quaternion(numbers())) else { return };
    keep(Orientation::quaternion(&orientation));
    keep(Orientation::turned_in_body(&orientation, &matrix()));
    keep(Orientation::turned_in_earth(&orientation, &matrix()));
    keep(Orientation::to_earth(&orientation, &matrix()));
    keep(Orientation::to_body(&orientation, &matrix()));
    keep(Orientation::up_in_body(&orientation));
    keep(Orientation::heading(&orientation));
    keep(Orientation::renormalised(&orientation));
    keep(Orientation::levelled(&orientation, &matrix()));
}

fn references<T: Scalar>() {
    let gains = any(<Gains<T> as Default>::default());
    let gains = any(Gains { tilt: number(), bias: number(), ..gains });
    let mut ahrs = any(Ahrs::new(any(Orientation::identity()), matrix(), gains));
    for _ in 0..rounds() {
        let force = maybe(matrix());
        try_on(&mut ahrs, |ahrs| Ahrs::update(ahrs, &matrix(), force.as_ref(), number()));
        Ahrs::turn_in_earth(any(&mut ahrs), &matrix());
        Ahrs::turn_in_body(any(&mut ahrs), &matrix());
    }
    keep(Ahrs::orientation(&ahrs));
    keep(Ahrs::gyro_bias(&ahrs));
}

fn all_of<T: Scalar>() {
    call_each([orientations::<T>, references::<T>]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>]);
    }
    call_each([all_of::<Q12_20>]);
}
