//! The deviation of observers in `f32` and fixed point from those in `f64`, as a fraction of the error of the latter:
//! the aeroplane with noise on inputs and outputs, placed poles and steady-state Kalman gains, two sets of sensors, 100
//! Hz and 1 kHz.

use host_sim::random::{normal, stream};
use kestirim_kalman::{Covariance, steady_state};
use kestirim_luenberger::{CurrentGains, CurrentObserver, Plant, Predictor, PredictorGains};
use kestirim_scalar::{Components, Q16_16, Scalar};
use kestirim_tests::uav;
use nalgebra::{Matrix4, SMatrix, SVector};

/// The noise of the inputs (rad, throttle) and of the measured states (rad, rad/s, m/s, rad), as standard deviations.
const INPUT_SIGMAS: [f64; 2] = [0.008_726_646_259_971_648, 0.02];
const STATE_SIGMAS: [f64; 4] =
    [0.008_726_646_259_971_648, 0.008_726_646_259_971_648, 0.5, 0.008_726_646_259_971_648];

/// Samples of a flight: commanded inputs, measured outputs, true states.
type Flight<const P: usize> = Vec<(SVector<f64, 2>, SVector<f64, P>, SVector<f64, 4>)>;

/// A flight of a minute, after half a minute in which the observers converge.
fn fly<const P: usize>(plant: &Plant<4, 2, P>, interval: f64, sine: bool) -> Flight<P> {
    let mut rng = stream(5, 0);
    let mut state = SVector::from([0.0, 0.0, 40.0, 0.53]);
    let sigmas = plant.c * SVector::from(STATE_SIGMAS);
    let moment = |k: u32| {
        let turns = std::f64::consts::TAU * interval * f64::from(k);
        let input = if sine {
            SVector::from([0.025 * (0.5 * turns).sin(), 0.155 * (0.2 * turns).sin()])
        } else {
            SVector::from([0.025, 0.155])
        };
        let before = state;
        let applied = input + SVector::from(INPUT_SIGMAS.map(|sigma| normal(&mut rng, sigma)));
        state = plant.a * state + plant.b * applied;
        (input, plant.c * before + sigmas.map(|sigma| normal(&mut rng, sigma)), before)
    };
    (0..(90.0 / interval) as u32).map(moment).collect()
}

/// The estimates after the first half minute.
type Estimates = Vec<SVector<f64, 4>>;

fn settled(estimates: impl Iterator<Item = SVector<f64, 4>>, interval: f64) -> Estimates {
    estimates.skip((30.0 / interval) as usize).collect()
}

fn predicted<T: Scalar, const P: usize>(
    gains: &PredictorGains<4, 2, P>,
    flight: &Flight<P>,
    interval: f64,
) -> Estimates {
    let start = SVector::from(uav::START.map(T::from_f32));
    let mut observer = Predictor::<T, 4, 2, P>::new(gains, &start).unwrap();
    let estimates = flight.iter().map(|(input, measured, _)| {
        let estimate = observer.estimate().map(T::to_f64);
        observer.step(&input.map(T::from_f64), &measured.map(T::from_f64)).unwrap();
        estimate
    });
    settled(estimates, interval)
}

fn corrected<T: Scalar, const P: usize>(
    gains: &CurrentGains<4, 2, P>,
    flight: &Flight<P>,
    interval: f64,
) -> Estimates {
    let start = SVector::from(uav::START.map(T::from_f32));
    let mut observer = CurrentObserver::<T, 4, 2, P>::new(gains, &start).unwrap();
    let estimates = flight.iter().map(|(input, measured, _)| {
        observer.correct(&measured.map(T::from_f64)).unwrap();
        let estimate = observer.estimate().map(T::to_f64);
        observer.predict(&input.map(T::from_f64)).unwrap();
        estimate
    });
    settled(estimates, interval)
}

/// The root mean square of each state's difference.
fn apart(a: &[SVector<f64, 4>], b: &[SVector<f64, 4>]) -> SVector<f64, 4> {
    let sum: SVector<f64, 4> =
        a.iter().zip(b).map(|(a, b)| (a - b).map(|difference| difference.powi(2))).sum();
    sum.map(|sum| (sum / a.len() as f64).sqrt())
}

/// Prints and checks the fractions by which `f32` and Q16.16 differ.
fn check(what: &str, truth: &Estimates, [double, single, fixed]: [Estimates; 3], most: [f64; 2]) {
    let error = apart(&double, truth);
    let fractions = [single, fixed].map(|other| apart(&other, &double).component_div(&error));
    let [f32, q16] = fractions.map(|of_states| of_states.as_array().map(|f| format!("{f:.1e}")));
    println!("{what}: error {:?}\n    f32 {f32:?}, Q16.16 {q16:?}", *error.as_array());
    for (fraction, most) in fractions.iter().zip(most) {
        assert!(fraction.max() <= most, "{what}: {fraction} of the error");
    }
}

/// Compares the gain that places the poles and the steady-state Kalman gain.
fn compare<const P: usize>(
    plant: &Plant<4, 2, P>,
    placed: &SMatrix<f64, 4, P>,
    interval: f64,
    sensors: &str,
) {
    let most = if interval < 0.005 { [2e-3, 0.05] } else { [2e-3, 0.02] };
    let noise = plant.b * SMatrix::from_diagonal(&SVector::from(INPUT_SIGMAS.map(|s| s * s)));
    let q = Covariance::from_lower_triangle(&(noise * plant.b.transpose()));
    let r = Covariance::from_variances(
        (plant.c * SVector::from(STATE_SIGMAS)).map(|s| s * s).as_array(),
    );
    let kalman = steady_state(&plant.a, &q, &plant.c, &r).expect("it settles").gain;
    for sine in [false, true] {
        let flight = fly(plant, interval, sine);
        let truth = settled(flight.iter().map(|(_, _, state)| *state), interval);
        let name = |kind| format!("{kind}, {sensors}, {interval} s, sine {sine}");
        for (kind, gain) in [("placed", *placed), ("Kalman predictor", plant.a * kalman)] {
            let gains = PredictorGains::new(plant, &gain);
            let all = [
                predicted::<f64, P>(&gains, &flight, interval),
                predicted::<f32, P>(&gains, &flight, interval),
                predicted::<Q16_16, P>(&gains, &flight, interval),
            ];
            check(&name(kind), &truth, all, most);
        }
        let gains = CurrentGains::new(plant, &kalman);
        let all = [
            corrected::<f64, P>(&gains, &flight, interval),
            corrected::<f32, P>(&gains, &flight, interval),
            corrected::<Q16_16, P>(&gains, &flight, interval),
        ];
        check(&name("Kalman current"), &truth, all, most);
    }
}

fn compare_at(interval: f64) {
    let plant = uav::plant(interval);
    compare(&plant, &uav::gain(&plant, interval), interval, "q V θ");
    let full = Plant { a: plant.a, b: plant.b, c: Matrix4::identity() };
    let poles = SVector::from([-3.0, -3.5, -4.0, -4.5].map(|pole: f64| (pole * interval).exp()));
    compare(&full, &(plant.a - SMatrix::from_diagonal(&poles)), interval, "all states");
}

#[test]
fn at_100_hz() {
    compare_at(0.01);
}

#[test]
fn at_1_khz() {
    compare_at(0.001);
}
