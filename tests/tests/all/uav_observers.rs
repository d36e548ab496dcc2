//! The observers, compared with trajectories and matrices computed elsewhere with 60 digits.
//!
//! They are in `../shared/data/uav/cases.json`, beside the repository. Where it is absent these tests print SKIPPED and
//! pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead.

use kestirim_luenberger::{
    CurrentGains, CurrentObserver, Plant, Predictor, PredictorGains, ReducedGains, ReducedObserver,
};
use kestirim_tests::recordings::folder_of;
use nalgebra::{SMatrix, SVector};
use serde_json::Value;

/// The accepted difference of the trajectories (SI units and radians).
const SAME: f64 = 1e-11;

fn cases(section: &str) -> Vec<Value> {
    let Some(folder) = folder_of("uav") else { return Vec::new() };
    let text = std::fs::read_to_string(folder.join("cases.json")).expect("the cases");
    let mut cases: Value = serde_json::from_str(&text).expect("JSON");
    serde_json::from_value(cases[section].take()).expect("a list of cases")
}

fn matrix<const R: usize, const C: usize>(case: &Value, name: &str) -> SMatrix<f64, R, C> {
    let rows: Vec<Vec<f64>> = serde_json::from_value(case[name].clone()).expect("rows");
    assert!(rows.len() == R && rows.iter().all(|row| row.len() == C), "{name}");
    SMatrix::from_fn(|row, column| rows[row][column])
}

fn vector<const N: usize>(case: &Value, name: &str) -> SVector<f64, N> {
    let numbers: Vec<f64> = serde_json::from_value(case[name].clone()).expect("numbers");
    SVector::from_column_slice(&numbers)
}

/// The generator of the cases: a normal number is the sum of twelve uniform ones.
struct Noise(u32);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / 2_f64.powi(32)
    }

    fn vector<const N: usize>(&mut self, sigmas: &SVector<f64, N>) -> SVector<f64, N> {
        sigmas.map(|sigma| sigma * ((0..12).map(|_| self.uniform()).sum::<f64>() - 6.0))
    }
}

fn follow<const P: usize>(case: &Value) {
    let id = case["id"].as_str().expect("a name");
    let h = case["h"].as_f64().expect("an interval");
    let plant =
        Plant::<4, 2, P> { a: matrix(case, "Ad"), b: matrix(case, "Bd"), c: matrix(case, "C") };
    let gain = |name| matrix::<4, P>(case, name);
    let start = vector::<4>(case, "xhat0");
    let new = |l| Predictor::<f64, 4, 2, P>::new(&PredictorGains::new(&plant, &l), &start).unwrap();
    let (mut luenberger, mut kalman) = (new(gain("L_luenberger")), new(gain("K_predictor")));
    let filter_gain = plant.a.try_inverse().unwrap() * gain("K_predictor");
    let gains = CurrentGains::new(&plant, &filter_gain);
    let mut current = CurrentObserver::<f64, 4, 2, P>::new(&gains, &start).unwrap();
    let (su, sy) = (vector::<2>(case, "su"), vector::<P>(case, "sy"));
    let noisy = f64::from(id.ends_with("noise=1"));
    let (mut w, mut v) = (Noise(12345), Noise(67890));
    let mut state = vector::<4>(case, "x0");
    let mut apart = 0_f64;
    for k in 0..=1000 {
        let t = h * f64::from(k);
        let input = if id.contains("sine") {
            let turns = std::f64::consts::TAU * t;
            SVector::from([0.025 * (0.5 * turns).sin(), 0.155 * (0.2 * turns).sin()])
        } else {
            SVector::from([0.025, 0.155])
        };
        let measured = plant.c * state + v.vector(&sy) * noisy;
        let sample = &case["samples"][k.to_string()];
        if sample.is_object() {
            let mut check = |ours: &SVector<f64, 4>, name| {
                apart = apart.max((ours - vector::<4>(sample, name)).amax());
            };
            check(&state, "x");
            check(luenberger.estimate(), "luenberger");
            check(kalman.estimate(), "kalman_ss");
            check(current.estimate(), "kalman_ss");
        }
        luenberger.step(&input, &measured).unwrap();
        kalman.step(&input, &measured).unwrap();
        current.correct(&measured).unwrap();
        current.predict(&input).unwrap();
        state = plant.a * state + plant.b * (input + w.vector(&su) * noisy);
    }
    println!("{id}: {apart:e} apart");
    assert!(apart < SAME, "{id}: {apart:e} apart");
}

#[test]
fn trajectories_are_reproduced() {
    for case in cases("trajectories") {
        match case["C"].as_array().map(Vec::len) {
            Some(3) => follow::<3>(&case),
            Some(4) => follow::<4>(&case),
            other => panic!("{other:?} outputs"),
        }
    }
}

/// The response of one step to a unit, with everything else zero, is a column of F, G or H.
#[test]
fn the_reduced_observer_has_its_reference_matrices() {
    for case in cases("reduced_order") {
        let measured: [usize; 2] = serde_json::from_value(case["measured"].clone()).unwrap();
        let (a, b, l) = (matrix(&case, "A"), matrix(&case, "B"), matrix(&case, "L"));
        let gains = ReducedGains::<4, 2, 2, 2>::new(&a, &b, &measured, &l).unwrap();
        let zero = SVector::<f64, 2>::zeros();
        let step = |w, measured, input| {
            let mut observer = ReducedObserver::<f64, 4, 2, 2, 2>::new(&gains, &w, &zero).unwrap();
            observer.step(&input, &measured).unwrap();
            observer.unmeasured(&zero)
        };
        for column in 0..2 {
            let unit = SVector::ith(column, 1.0);
            for (name, ours) in [
                ("F", step(unit, zero, zero)),
                ("G_y", step(zero, unit, zero)),
                ("H_u", step(zero, zero, unit)),
            ] {
                let reference = matrix::<2, 2>(&case, name).column(column).into_owned();
                assert!((ours - reference).amax() < 1e-13, "{name}: {ours} or {reference}");
            }
        }
        let shown = ReducedObserver::<f64, 4, 2, 2, 2>::new(&gains, &zero, &zero).unwrap();
        assert!((shown.unmeasured(&SVector::from([1.0, 0.0])) - l.column(0)).amax() < 1e-13);
    }
}
