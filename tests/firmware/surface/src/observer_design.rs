//! Calls everything of `kestirim-observer-design`.

use kestirim_observer_design::{
    Complex, Placement, Response, StateSpace, controllability, discrete_noise, eigenvalues,
    error_covariance, hidden_modes, lyapunov, observability, place, riccati, singular_values,
    tustin, zero_order_hold,
};

use super::values::{LONG_FORM, any, call_each, keep, matrix, number};

fn complex() -> Complex<f64> {
    Complex { re: number(), im: number() }
}

fn discretises<const N: usize, const M: usize>() {
    keep(zero_order_hold::<N, M>(&matrix(), &matrix(), number()));
    keep(tustin::<N, M>(&matrix(), &matrix(), number()));
    keep(discrete_noise::<N>(&matrix(), &matrix(), number()));
}

fn analyses<const N: usize, const M: usize, const P: usize>() {
    keep(eigenvalues::<N>(&matrix()));
    keep(observability::<N, P>(&matrix(), &matrix()));
    keep(hidden_modes::<N, P>(&matrix(), &matrix()));
    keep(controllability::<N, M>(&matrix(), &matrix()));
    keep(lyapunov::<N>(&matrix(), &matrix()));
    let (gain, noise) = (matrix(), matrix());
    let (observed, process) = ((&matrix(), &matrix()), (&matrix(), &matrix()));
    keep(error_covariance::<N, M, P>(observed, &gain, process, &noise));
}

fn places<const N: usize, const P: usize>() {
    let placed = any(place::<N, P>(&matrix(), &matrix(), &any([complex(); N])));
    let Ok(placement) = placed else { return };
    keep(Placement::digits_lost(&placement));
}

fn settles<const N: usize, const P: usize>() {
    keep(riccati::<N, P>(&matrix(), &matrix(), &matrix(), &matrix()));
}

fn responds<const N: usize, const M: usize, const P: usize>() {
    let system = any(StateSpace::<N, M, P>::new(matrix(), matrix(), matrix()));
    let transferred = any(StateSpace::transfer(&system, complex()));
    keep(StateSpace::frequency_response(&system, number()));
    if let Ok(gains) = transferred {
        keep(singular_values(&gains));
    }
    keep(StateSpace::impulse_response(&system, &matrix(), number()));
    let response = any(StateSpace::step_response(&system, &matrix(), number()));
    let Ok(mut response) = response else { return };
    keep(<Response<N, P> as Iterator>::next(any(&mut response)));
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([
            discretises::<4, 2>,
            analyses::<4, 2, 3>,
            places::<4, 1>,
            places::<9, 5>,
            settles::<4, 3>,
            responds::<4, 2, 3>,
        ]);
    }
    call_each([
        discretises::<9, 3>,
        analyses::<9, 3, 5>,
        places::<4, 3>,
        settles::<9, 5>,
        responds::<9, 3, 5>,
    ]);
}
