//! Calls everything of `kestirim-uav-estimator`.

use kestirim_observer_design::{Complex, Discrete};
use kestirim_scalar::{Q16_16, Scalar};
use kestirim_uav_estimator::{
    AugmentedFilter, AugmentedFlight, AugmentedModel, Drift, Dynamics, Error, Estimator,
    FlightFilter, FlightObserver, Gust, KalmanFilter, LocalModel, Noise, Output, Reference, Sample,
    ScheduledFilter, ScheduledFlight, Step, Transition, current_gain, observer_gain,
};
use kestirim_uav_longitudinal::StateSpace;

use super::values::{
    LONG_FORM, any, call_each, keep, matrix, number, option, rounds, try_on, whole, yes_or_no,
};

fn plant() -> Discrete<4, 2> {
    any(Discrete { a: matrix(), b: matrix() })
}

fn step() -> Step {
    any(Step { transition: plant(), noise: matrix() })
}

fn dynamics() -> Dynamics {
    any(if yes_or_no() {
        Dynamics::Continuous(StateSpace { a: matrix(), b: matrix() })
    } else {
        Dynamics::Discrete { step: plant(), interval: number() }
    })
}

fn measured<const P: usize>() -> [Option<f64>; P] {
    any([(); P].map(|()| option()))
}

/// A sample after an interval of a few microseconds, or an arbitrary one.
fn sample<const P: usize>(time_us: &mut i64) -> Sample<P> {
    *time_us = time_us.wrapping_add(whole::<u64>() as i64);
    any(Sample { time_us: *time_us, input: matrix(), measured: measured() })
}

fn poles() -> [Complex<f64>; 4] {
    any([(); 4].map(|()| Complex { re: number(), im: 0.0 }))
}

fn designs<const P: usize>() {
    keep(Dynamics::over(&dynamics(), number(), number(), &matrix()));
    keep(observer_gain::<P>(&plant(), &matrix(), &poles()));
    keep(current_gain::<P>(&plant(), &matrix()));
}

fn errors() {
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
    keep::<Error>(From::from(any(kestirim_luenberger::Error::NotFinite)));
    keep::<Error>(From::from(any(kestirim_observer_design::Error::NotFinite)));
}

fn filters<T: Scalar, const P: usize>() {
    let filter = KalmanFilter::<T, P>::new(&matrix(), &matrix(), &matrix(), &matrix());
    let Ok(mut filter) = any(filter) else { return };
    for _ in 0..rounds() {
        let transition = any(Transition::new(&step()));
        try_on(&mut filter, |filter| KalmanFilter::predict(filter, &transition, &matrix()));
        try_on(&mut filter, |filter| KalmanFilter::correct(filter, &measured()));
    }
    keep(KalmanFilter::estimate(&filter));
    keep(KalmanFilter::covariance(&filter));
    keep(KalmanFilter::sigma(&filter));
}

fn estimators<T: Scalar, const P: usize>() {
    let estimator = if yes_or_no() {
        Estimator::<T, P>::constant_gain(&plant(), &matrix(), &matrix(), &matrix())
    } else {
        Estimator::<T, P>::time_varying(&step(), &matrix(), &matrix(), &matrix(), &matrix())
    };
    let Ok(mut estimator) = any(estimator) else { return };
    for _ in 0..rounds() {
        try_on(&mut estimator, |estimator| Estimator::step(estimator, &matrix(), &measured()));
    }
    keep(Estimator::estimate(&estimator));
    keep(Estimator::sigma(&estimator));
}

fn flight_filters<T: Scalar, const P: usize>() {
    let noise = any(Noise::<P> { inputs: matrix(), outputs: matrix() });
    let filter = FlightFilter::<T, P, 2>::new(&dynamics(), &matrix(), &noise, number());
    let Ok(mut filter) = any(filter) else { return };
    let mut time_us = 0;
    for _ in 0..rounds() {
        try_on(&mut filter, |filter| FlightFilter::take(filter, &sample(&mut time_us)));
    }
    FlightFilter::set_usual(any(&mut filter), number());
    try_on(&mut filter, |filter| FlightFilter::take(filter, &sample(&mut time_us)));
    keep(FlightFilter::filter(&filter));
    keep(FlightFilter::rejected(&filter));
    keep(FlightFilter::health(&filter));
}

fn flight_observers<T: Scalar, const P: usize>() {
    let observer = FlightObserver::<T, P, 2>::new(&dynamics(), &matrix(), &poles(), number());
    let Ok(mut observer) = any(observer) else { return };
    let mut time_us = 0;
    for _ in 0..rounds() {
        try_on(&mut observer, |observer| FlightObserver::take(observer, &sample(&mut time_us)));
    }
    keep(FlightObserver::estimate(&observer));
    keep(FlightObserver::rejected(&observer));
    keep(FlightObserver::health(&observer));
}

fn output() -> Output {
    let reference = match (yes_or_no(), yes_or_no()) {
        (true, _) => Reference::Pressure { steady: number(), airspeed: number() },
        (false, true) => Reference::Ground,
        (false, false) => Reference::Air,
    };
    let (row, direct) = ([(); 4].map(|()| number()), [(); 2].map(|()| number()));
    let given = any(Output { row, direct, sigma: number(), reference });
    if yes_or_no() { given } else { Output::state(whole::<usize>(), number()) }
}

fn drift() -> Drift {
    any(Drift { sigma: number(), rate: number() })
}

type Model = AugmentedModel<9, 6, 3>;

fn augmented_model() -> Option<Model> {
    let plant = any(StateSpace { a: matrix(), b: matrix() });
    let mut model =
        AugmentedModel::<9, 6, 3>::new(&plant, &matrix(), &[(); 3].map(|()| output())).ok()?;
    for _ in 0..rounds() {
        let gust = any(Gust {
            sigmas: [(); 2].map(|()| number()),
            lengths: [(); 2].map(|()| number()),
            airspeed: number(),
        });
        for next in [
            AugmentedModel::with_gust(model, &gust),
            AugmentedModel::with_bias(model, whole::<usize>(), &drift()),
            AugmentedModel::with_wind(model, &drift()),
            AugmentedModel::with_density(model, &drift()),
            AugmentedModel::with_force(model, whole::<usize>(), &drift()),
        ] {
            model = any(next).unwrap_or(model);
        }
    }
    keep(AugmentedModel::start(&model));
    Some(model)
}

fn augmented_filters<T: Scalar>() {
    let Some(model) = augmented_model() else { return };
    let Ok(mut filter) = any(AugmentedFilter::<T, 9, 6, 3>::new(&model)) else { return };
    let scalars = || any([(); 3].map(|()| option::<T>()));
    for _ in 0..rounds() {
        let Ok(step) = any(AugmentedModel::over(&model, number(), number(), &matrix())) else {
            continue;
        };
        let transition = any(AugmentedFilter::transition(&filter, &step));
        let input = matrix();
        try_on(&mut filter, |filter| AugmentedFilter::predict(filter, &transition, &input));
        try_on(&mut filter, |filter| AugmentedFilter::correct(filter, &scalars(), &input));
        let outputs = scalars();
        try_on(&mut filter, |filter| {
            AugmentedFilter::step(filter, &transition, &input, &outputs, &input)
        });
    }
    keep(AugmentedFilter::estimate(&filter));
    keep(AugmentedFilter::sigma(&filter));
    keep(AugmentedFilter::state(&filter));
    keep(AugmentedFilter::state_units(&filter));
    keep(AugmentedFilter::output_units(&filter));
    keep(AugmentedFilter::begun_anew(&filter));
}

fn augmented_flights<T: Scalar>() {
    let Some(model) = augmented_model() else { return };
    let filter = AugmentedFlight::<T, 9, 6, 3, 2>::new(&model, &matrix(), number());
    let Ok(mut filter) = any(filter) else { return };
    let mut time_us = 0;
    for _ in 0..rounds() {
        try_on(&mut filter, |filter| AugmentedFlight::take(filter, &sample(&mut time_us)));
    }
    AugmentedFlight::set_usual(any(&mut filter), number());
    try_on(&mut filter, |filter| AugmentedFlight::take(filter, &sample(&mut time_us)));
    keep(AugmentedFlight::filter(&filter));
    keep(AugmentedFlight::rejected(&filter));
    keep(AugmentedFlight::health(&filter));
}

/// Models of one kind, or of two that do not belong together.
fn local_models() -> Option<[LocalModel<9, 6, 3>; 2]> {
    let model = augmented_model()?;
    let local =
        |model| any(LocalModel { model, state: matrix(), input: matrix(), outputs: matrix() });
    Some([local(model), local(if yes_or_no() { model } else { augmented_model()? })])
}

fn scheduled_filters<T: Scalar>() {
    let Some(models) = local_models() else { return };
    let Ok(mut filter) = any(ScheduledFilter::<T, 9, 6, 3, 2>::new(&models)) else { return };
    let scalars = || any([(); 3].map(|()| option::<T>()));
    for _ in 0..rounds() {
        let [one, other] = &models;
        let over = |local: &LocalModel<9, 6, 3>| {
            any(AugmentedModel::over(&local.model, number(), number(), &matrix()))
        };
        let (Ok(one), Ok(other)) = (over(one), over(other)) else { continue };
        let transition = any(ScheduledFilter::transition(&filter, &[one, other]));
        let input = matrix();
        try_on(&mut filter, |filter| ScheduledFilter::predict(filter, &transition, &input));
        try_on(&mut filter, |filter| ScheduledFilter::correct(filter, &scalars(), &input));
        let outputs = scalars();
        try_on(&mut filter, |filter| {
            ScheduledFilter::step(filter, &transition, &input, &outputs, &input)
        });
    }
    keep(ScheduledFilter::filter(&filter));
    keep(ScheduledFilter::begun_anew(&filter));
}

fn scheduled_flights<T: Scalar>() {
    let Some(models) = local_models() else { return };
    let filter = ScheduledFlight::<T, 9, 6, 3, 2, 2>::new(&models, &matrix(), number());
    let Ok(mut filter) = any(filter) else { return };
    let mut time_us = 0;
    for _ in 0..rounds() {
        try_on(&mut filter, |filter| ScheduledFlight::take(filter, &sample(&mut time_us)));
    }
    ScheduledFlight::set_usual(any(&mut filter), number());
    try_on(&mut filter, |filter| ScheduledFlight::take(filter, &sample(&mut time_us)));
    keep(ScheduledFlight::filter(&filter));
    keep(ScheduledFlight::rejected(&filter));
    keep(ScheduledFlight::health(&filter));
}

fn all_of<T: Scalar>() {
    call_each([
        scheduled_filters::<T>,
        scheduled_flights::<T>,
        augmented_filters::<T>,
        augmented_flights::<T>,
        filters::<T, 3>,
        estimators::<T, 3>,
        flight_filters::<T, 3>,
        flight_observers::<T, 3>,
    ]);
}

/// Calls everything in this module.
pub fn run() {
    if LONG_FORM {
        call_each([all_of::<f32>, all_of::<f64>, designs::<4>]);
    }
    call_each([designs::<3>, errors, all_of::<Q16_16>]);
}
