//! The designs of `../shared/data/uav/cases.json`, whose solutions are known to 60 digits.

use std::path::PathBuf;

use host_sim::commands::design::{Answer, Report, Solution, answers};
use kestirim_observer_design::{
    Complex, StateSpace, discrete_noise, eigenvalues, error_covariance, singular_values, tustin,
};
use kestirim_tests::recordings::folder_of;
use nalgebra::{DMatrix, Matrix4, Matrix4x2, SMatrix, Vector2};
use serde_json::Value;

fn file() -> Option<PathBuf> {
    folder_of("uav").map(|folder| folder.join("cases.json"))
}

fn cases() -> Option<Value> {
    let text = std::fs::read_to_string(file()?).expect("a readable file");
    Some(serde_json::from_str(&text).expect("JSON"))
}

fn section<'a>(cases: &'a Value, name: &str) -> &'a [Value] {
    cases[name].as_array().expect("a list of cases")
}

/// Each case of a section with its answer.
fn answered<'a>(cases: &'a Value, report: &'a Report, name: &str) -> Vec<(&'a Value, &'a Answer)> {
    let (_, answers) =
        report.sections.iter().find(|(section, _)| *section == name).expect("the section");
    let cases = section(cases, name);
    assert_eq!(cases.len(), answers.len());
    cases.iter().zip(answers.iter().map(|answered| &answered.answer)).collect()
}

fn matrix(value: &Value) -> DMatrix<f64> {
    let rows: Vec<Vec<f64>> = serde_json::from_value(value.clone()).expect("rows of numbers");
    let columns = rows[0].len();
    DMatrix::from_row_iterator(rows.len(), columns, rows.into_iter().flatten())
}

fn sized<const R: usize, const C: usize>(value: &Value) -> SMatrix<f64, R, C> {
    let matrix = matrix(value);
    assert_eq!(matrix.shape(), (R, C));
    SMatrix::from_fn(|row, column| matrix[(row, column)])
}

/// The distance between two matrices, relative to the norm of the second.
fn apart(found: &DMatrix<f64>, expected: &DMatrix<f64>) -> f64 {
    (found - expected).norm() / expected.norm()
}

fn apart_sized<const R: usize, const C: usize>(
    found: &SMatrix<f64, R, C>,
    expected: &Value,
) -> f64 {
    (found - sized::<R, C>(expected)).norm() / sized::<R, C>(expected).norm()
}

#[test]
fn poles_are_placed() {
    let (Some(cases), Some(file)) = (cases(), file()) else { return };
    let report = answers(&file).expect("answers");
    for (case, answer) in answered(&cases, &report, "pole_placement") {
        let Answer::Solved(Solution::Gain { gain, pole_error, .. }) = answer else {
            panic!("{}: {answer:?}", case["id"]);
        };
        // With one output the gain is unique: it equals the exact one up to rounding.
        if case["exact_L_60digit"].is_object() {
            let exact = matrix(&case["exact_L_60digit"]["L"]);
            assert!(apart(gain, &exact) <= 1e-14, "{}: {gain} instead of {exact}", case["id"]);
            let reached = case["exact_L_60digit"]["max_rel_pole_error"].as_f64().expect("a number");
            assert!(*pole_error <= reached.mul_add(1.01, 4e-15), "{}: {pole_error:e}", case["id"]);
        } else {
            assert!(*pole_error <= 1e-12, "{}: {pole_error:e}", case["id"]);
        }
    }
}

#[test]
fn what_is_hidden_is_refused_by_name_and_nothing_else_is() {
    let (Some(cases), Some(file)) = (cases(), file()) else { return };
    let report = answers(&file).expect("answers");
    for (case, answer) in answered(&cases, &report, "must_reject") {
        let id = case["id"].as_str().expect("a name");
        match (answer, case["expect"].as_str()) {
            (Answer::Solved(Solution::Gain { pole_error, .. }), Some("accept")) => {
                assert!(*pole_error < 1e-12);
            }
            (Answer::Refused { error }, Some("reject")) => {
                let named = match id.split_whitespace().next() {
                    Some("U1") => "mode -3 (",
                    Some("U5") => "mode 0 (mostly state 4)",
                    Some("U10") => "mode -2 (",
                    Some("R3") => "conjugate",
                    _ => "finite",
                };
                assert!(error.contains(named), "{id}: {error}");
            }
            other => panic!("{id}: {other:?}"),
        }
    }
    for (case, answer) in answered(&cases, &report, "dare_reject") {
        assert!(matches!(answer, Answer::Refused { .. }), "{}: {answer:?}", case["id"]);
    }
}

#[test]
fn equations_are_solved() {
    let (Some(cases), Some(file)) = (cases(), file()) else { return };
    let report = answers(&file).expect("answers");
    for (case, answer) in answered(&cases, &report, "dare") {
        let Answer::Solved(Solution::Filter { prior, filter_gain, predictor_gain, doublings }) =
            answer
        else {
            panic!("{}: {answer:?}", case["id"]);
        };
        assert!(apart(prior, &matrix(&case["P_prior"])) <= 1e-14, "{}", case["id"]);
        assert!(apart(filter_gain, &matrix(&case["K_filter"])) <= 1e-14, "{}", case["id"]);
        let expected = matrix(&case["K_predictor"]);
        assert!((predictor_gain - &expected).norm() <= 1e-14 * expected.norm(), "{}", case["id"]);
        assert!(*doublings <= 25, "{}: {doublings} doublings", case["id"]);
    }
    for (case, answer) in answered(&cases, &report, "c2d") {
        let Answer::Solved(Solution::Discrete { a, b }) = answer else { panic!("{}", case["id"]) };
        assert!(apart(a, &matrix(&case["zoh"]["Ad"])) <= 1e-15, "{}", case["id"]);
        assert!(apart(b, &matrix(&case["zoh"]["Bd"])) <= 1e-15, "{}", case["id"]);
    }
    for (case, answer) in answered(&cases, &report, "lyapunov") {
        let Answer::Solved(Solution::Covariance { covariance }) = answer else {
            panic!("{}", case["id"])
        };
        assert!(apart(covariance, &matrix(&case["P"])) <= 1e-14, "{}", case["id"]);
    }
}

#[test]
fn states_that_are_not_measured_get_the_poles_that_were_asked_for() {
    let (Some(cases), Some(file)) = (cases(), file()) else { return };
    let report = answers(&file).expect("answers");
    for (case, answer) in answered(&cases, &report, "reduced_order") {
        let Answer::Solved(Solution::Gain { gain, pole_error, .. }) = answer else {
            panic!("{}", case["id"])
        };
        assert!(*pole_error <= 1e-12, "{}: {pole_error:e}", case["id"]);
        // An independent check: [α, q] are not measured, [V, θ] are.
        let a = matrix(&case["A"]);
        let dynamics = a.view((0, 0), (2, 2)) - gain * a.view((2, 0), (2, 2));
        let dynamics = SMatrix::<f64, 2, 2>::from_fn(|row, column| dynamics[(row, column)]);
        let mut found = eigenvalues(&dynamics).expect("eigenvalues").map(|pole| pole.re);
        found.sort_by(f64::total_cmp);
        let mut wanted = matrix(&case["poles"]).column(0).iter().copied().collect::<Vec<_>>();
        wanted.sort_by(f64::total_cmp);
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-13, "{found} instead of {wanted}");
        }
    }
}

#[test]
fn other_discretisations_agree() {
    let Some(cases) = cases() else { return };
    for case in section(&cases, "c2d").iter().take(2) {
        let (a, b): (Matrix4<f64>, Matrix4x2<f64>) = (sized(&case["A"]), sized(&case["B"]));
        let interval = case["h"].as_f64().expect("an interval");
        let trapezoid = tustin(&a, &b, interval).expect("no pole at 2/h");
        assert!(apart_sized(&trapezoid.a, &case["tustin_scipy_bilinear"]["Ad"]) <= 1e-14);
        assert!(apart_sized(&trapezoid.b, &case["tustin_scipy_bilinear"]["Bd"]) <= 1e-14);
        let noise =
            discrete_noise(&a, &(b * b.transpose()), interval).expect("a positive interval");
        assert!(apart_sized(&noise, &case["Qd_vanloan_Qc_BBt"]) <= 1e-14);
    }
}

#[test]
fn the_expected_rmse_is_that_of_the_case() {
    let Some(cases) = cases() else { return };
    let case = &section(&cases, "lyapunov")[0];
    let (a, c): (Matrix4<f64>, Matrix4<f64>) = (sized(&case["A"]), sized(&case["C"]));
    let (b, q): (Matrix4x2<f64>, SMatrix<f64, 2, 2>) = (sized(&case["B"]), sized(&case["Q_input"]));
    let covariance = error_covariance((&a, &c), &sized(&case["L"]), (&b, &q), &sized(&case["R"]))
        .expect("stable");
    let expected: [f64; 4] =
        serde_json::from_value(case["rmse_predicted"].clone()).expect("four numbers");
    for (variance, expected) in covariance.diagonal().iter().zip(expected) {
        assert!((variance.sqrt() / expected - 1.0).abs() < 1e-14);
    }
}

#[test]
fn the_plant_answers_as_in_the_reference() {
    let Some(cases) = cases() else { return };
    let case = &section(&cases, "frequency_and_step")[0];
    let plant = StateSpace::new(sized(&case["A"]), sized::<4, 2>(&case["B"]), Matrix4::identity());
    let relative =
        |found: f64, expected: f64| (found - expected).abs() <= 1e-11 * expected.abs().max(1e-12);
    let list =
        |value: &Value| -> Vec<f64> { serde_json::from_value(value.clone()).expect("numbers") };
    for (index, omega) in list(&case["omega"]).into_iter().enumerate() {
        let response = plant.frequency_response(omega).expect("no pole on the axis");
        let gains = singular_values(&response);
        for (found, expected) in gains.into_iter().zip(list(&case["singular_values"][index])) {
            assert!(relative(found, expected), "{found} instead of {expected} at {omega}");
        }
        let (magnitude, phase) =
            (matrix(&case["magnitude"][index]), matrix(&case["phase_rad"][index]));
        for (place, value) in response.iter().enumerate() {
            let expected = Complex::from_polar(magnitude[place], phase[place]);
            assert!(
                (value - expected).norm() <= 1e-12 * expected.norm().max(1e-12),
                "{value} instead of {expected}"
            );
        }
    }
    for (input, name) in [(Vector2::new(1.0, 0.0), "u0"), (Vector2::new(0.0, 1.0), "u1")] {
        for (time, expected) in case["step_samples_h0_01"][name].as_object().expect("times") {
            let steps = (time.parse::<f64>().expect("a time") / 0.01).round() as usize;
            let mut response = plant.step_response(&input, 0.01).expect("a positive interval");
            let found = response.nth(steps).expect("it goes on without end");
            for (found, expected) in found.iter().zip(list(expected)) {
                assert!(
                    (found - expected).abs() <= 1e-9 * expected.abs(),
                    "{found} instead of {expected} at {time}"
                );
            }
        }
    }
}
