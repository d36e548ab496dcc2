//! Tests of `host-sim design`: exit status, standard output, standard error, files.

use std::fs;
use std::process::Command;

use crate::program::{Desk, host_sim, json, refusal, text};
use serde_json::{Value, json as value};

/// One solvable case of each kind, and one unsolvable.
fn cases() -> Value {
    let (a, c) = (value!([[1.0, 0.1], [0.0, 1.0]]), value!([[1.0, 0.0]]));
    let poles = value!([[0.5, 0.0], [0.25, 0.0]]);
    value!({
        "conventions": "not looked at",
        "care": [{"id": "not looked at"}],
        "pole_placement": [
            {"id": "cart", "A": a, "C": c, "poles": poles, "source": "more than is needed"},
            {"id": "pair", "A": a, "C": c, "poles": [[0.5, 0.2], [0.5, -0.2]]},
            {"id": "null", "A": [[null, 0.1], [0.0, 1.0]], "C": c, "poles": poles},
            {"id": "ragged", "A": [[1.0, 0.1], [0.0]], "C": c, "poles": poles},
            {"id": "too few", "A": a, "C": c, "poles": [[0.5, 0.0]]},
            {"id": "narrow", "A": a, "C": [[1.0]], "poles": poles},
            {"id": 7, "A": a, "C": c},
            "no case",
        ],
        "must_reject": [{"id": "speed only", "A": a, "C": [[0.0, 1.0]], "poles": poles}],
        "dare": [{"id": "cart", "A": a, "C": c, "Q": [[0.0, 0.0], [0.0, 1e-4]], "R": [[0.01]]}],
        "dare_reject": [{"id": "skew", "A": a, "C": c, "Q": [[1.0, 0.5], [0.0, 1.0]], "R": [[0.01]]}],
        "c2d": [
            {"id": "cart", "A": [[0.0, 1.0], [0.0, 0.0]], "B": [[0.0], [1.0]], "h": 0.5},
            {"id": "backwards", "A": [[0.0]], "B": [[1.0]], "h": -0.5},
        ],
        "lyapunov": [
            {"id": "plain", "A": [[0.5]], "Q": [[3.0]]},
            {"id": "observer", "A": [[1.0]], "C": [[1.0]], "L": [[0.5]], "B": [[2.0]], "Q_input": [[0.25]], "R": [[2.0]]},
            {"id": "unstable", "A": [[1.5]], "Q": [[1.0]]},
        ],
        "reduced_order": [
            {"id": "cart", "A": a, "measured": [0], "unmeasured": [1], "poles": [[0.5, 0.0]]},
            {"id": "wrong way", "A": a, "measured": [1], "unmeasured": [0], "poles": [[0.5, 0.0]]},
        ],
        "airframe": [
            {"id": "x8", "airframe": "skywalker_x8", "airspeed": [15, 18.5, 24], "climb_angle": 0.05},
            {"id": "another", "coefficients": glider(), "airspeed": 20},
            {"id": "too fast", "airframe": "skywalker_x8", "airspeed": 60},
            {"id": "unknown", "airframe": "kite", "airspeed": 60},
            {"id": "both", "airframe": "skywalker_x8", "coefficients": glider(), "airspeed": 20},
            {"id": "no speed", "airframe": "skywalker_x8", "airspeed": []},
            {"id": "partly", "airframe": "skywalker_x8", "airspeed": [7, 18], "climb_angel": 0.1},
        ],
    })
}

/// The coefficients of an imaginary glider.
fn glider() -> Value {
    value!({
        "mass": 5.0, "Jx": 0.5, "Jy": 0.3, "Jz": 0.7, "S_wing": 0.8, "b": 3, "c": 0.27, "S_prop": 0.1, "k_motor": 50,
        "C_L_0": 0.3, "C_L_alpha": 5.1, "C_D_p": 0.02, "e": 0.95,
        "C_m_alpha": -0.9, "C_m_q": -12.5, "C_m_delta_e": -1.1,
    })
}

fn answers(desk: &Desk) -> Value {
    json(&host_sim(&["design", "--input", &desk.file("cases.json", cases().to_string()), "--json"]))
}

fn named<'a>(answers: &'a Value, section: &str, id: &str) -> &'a Value {
    let list = answers[section].as_array().expect("a list");
    list.iter().find(|answer| answer["id"] == id).expect("an answer of that name")
}

#[test]
fn every_case_has_its_answer() {
    let answers = answers(&Desk::new());
    let sections: Vec<_> =
        answers.as_object().expect("an object").keys().map(String::as_str).collect();
    let expected = [
        "pole_placement",
        "must_reject",
        "dare",
        "dare_reject",
        "c2d",
        "lyapunov",
        "reduced_order",
        "airframe",
    ];
    for section in expected {
        assert_eq!(
            answers[section].as_array().map(Vec::len),
            cases()[section].as_array().map(Vec::len),
            "{section}"
        );
    }
    assert_eq!(sections.len(), expected.len());

    let first =
        |section: &str, id: &str, matrix: &str| named(&answers, section, id)[matrix].clone();
    assert_eq!(first("pole_placement", "cart", "L"), value!([[1.25], [3.75]]));
    assert_eq!(first("reduced_order", "cart", "L"), value!([[5.0]]));
    assert_eq!(first("c2d", "cart", "Ad"), value!([[1.0, 0.5], [0.0, 1.0]]));
    assert_eq!(first("c2d", "cart", "Bd"), value!([[0.125], [0.5]]));
    assert_eq!(first("lyapunov", "plain", "P"), value!([[4.0]]));
    assert_eq!(first("lyapunov", "observer", "P"), value!([[2.0]]));
    let filter = named(&answers, "dare", "cart");
    assert!(filter["P"][0][0].as_f64().is_some_and(|variance| variance > 0.0));
    assert!(filter["K_filter"][0][0].as_f64().is_some_and(|gain| (0.0..1.0).contains(&gain)));
    let flights = first("airframe", "x8", "flights");
    let throttle = flights[0]["trim"]["u"][1].as_f64().expect("a throttle");
    assert!((throttle - 0.431_495_063).abs() < 1e-9, "{throttle}");
    assert_eq!(flights.as_array().map(Vec::len), Some(3));
    let partly = named(&answers, "airframe", "partly");
    assert_eq!(partly["flights"].as_array().map(Vec::len), Some(1));
    assert_eq!(
        partly["refused"],
        value!(["7 m/s: the wing is stalled at the angle of attack that it takes"])
    );
    let another = first("airframe", "another", "flights");
    assert_eq!(another[0]["A"][3], value!([0.0, 1.0, 0.0, 0.0]));
    assert!(filter["doublings"].as_u64().is_some_and(|doublings| doublings < 20));
}

#[test]
fn what_is_wrong_with_a_case_is_its_answer_alone() {
    let answers = answers(&Desk::new());
    for (section, id, sentence) in [
        ("pole_placement", "null", "a number is not finite"),
        (
            "pole_placement",
            "ragged",
            "A: expected a list of rows of numbers, all of the same length",
        ),
        ("pole_placement", "too few", "poles: expected 2, one for each state, found 1"),
        ("pole_placement", "narrow", "C: expected 1 × 2 numbers, found 1 × 1"),
        ("must_reject", "speed only", "no output sees the mode 1 (mostly state 0)"),
        ("dare_reject", "skew", "a covariance is not symmetric"),
        ("c2d", "backwards", "the interval is not positive"),
        ("lyapunov", "unstable", "the mode 1.5 (mostly state 0) does not decay"),
        ("reduced_order", "wrong way", "no output sees the mode 1 (mostly state 0)"),
        ("airframe", "too fast", "60 m/s: no throttle from 0 to 1 holds this flight"),
        (
            "airframe",
            "unknown",
            "airframe: unknown variant `kite`, expected `aerosonde` or `skywalker_x8`",
        ),
        ("airframe", "both", "expected airframe or coefficients, found both"),
        ("airframe", "no speed", "airspeed: expected a number or a list of some"),
    ] {
        let answer = named(&answers, section, id);
        assert_eq!(answer["error"], sentence, "{section} {id}");
        assert_eq!(answer.as_object().map(serde_json::Map::len), Some(2), "{answer}");
    }
    let list = answers["pole_placement"].as_array().expect("a list");
    assert_eq!(list[6], value!({"id": 7, "error": "poles is missing"}));
    assert_eq!(list[7], value!({"id": null, "error": "expected an object"}));
}

#[test]
fn a_file_that_holds_no_cases_is_refused_with_a_sentence() {
    let desk = Desk::new();
    for (contents, complaint) in [
        ("", "line 1: expected a JSON object of cases: EOF while parsing a value"),
        ("[]", "line 1: expected a JSON object of cases: invalid type: sequence, expected a map"),
        ("{\"dare\": [\n{\"id\": 1,}]}", "line 2: expected a JSON object of cases: trailing comma"),
        ("{\"dare\": {}}", "dare: expected a list of cases"),
    ] {
        let file = desk.file("cases.json", contents);
        let sentence = refusal(&["design", "--input", &file, "--json"]);
        assert!(sentence.contains(complaint), "{sentence}");
    }
    assert!(refusal(&["design", "--input", &desk.named("absent.json")]).contains("cannot be read"));
    let file = desk.file("cases.json", cases().to_string());
    assert!(refusal(&["design", "--input", &file, "--rust", &file]).contains("would overwrite"));
    assert_eq!(
        fs::read_to_string(desk.path("cases.json")).expect("it is still there"),
        cases().to_string()
    );
}

#[test]
fn a_file_without_a_section_has_no_answers() {
    let output = host_sim(&[
        "design",
        "--input",
        &Desk::new().file("cases.json", "{\"care\": []}"),
        "--json",
    ]);
    assert!(text(&output.stderr).contains("expected one of pole_placement, must_reject, dare,"));
    assert_eq!(json(&output), value!({}));
}

#[test]
fn tables_are_for_people() {
    let desk = Desk::new();
    let output = host_sim(&["design", "--input", &desk.file("cases.json", cases().to_string())]);
    let warned = text(&output.stderr);
    assert!(warned.contains("partly: not used: climb_angel"), "{warned}");
    let table = text(&output.stdout);
    for part in [
        "pole_placement",
        "digits lost",
        "refused: the interval is not positive",
        "doublings",
        "RMSE 2",
    ] {
        assert!(table.contains(part), "{part} in {table}");
    }
}

#[test]
fn constants_compile_and_hold_every_bit() {
    let desk = Desk::new();
    let file = desk.file("cases.json", cases().to_string());
    let constants = desk.named("gains.rs");
    let output = host_sim(&["design", "--input", &file, "--rust", &constants, "--json"]);
    let answers = json(&output);
    let bits = |section: &str, id: &str, matrix: &str| {
        let number = named(&answers, section, id)[matrix][1][0].as_f64().expect("a number");
        format!("{:#x}", number.to_bits())
    };
    let program = desk.file(
        "main.rs",
        format!(
            "#![deny(warnings)]\n#[allow(dead_code)]\nmod gains;\nfn main() {{\n\
             assert_eq!(gains::CART_L[1][0].to_bits(), {});\n\
             assert_eq!(gains::PAIR_L[1][0].to_bits(), {});\n\
             assert_eq!(gains::CART_K[1][0].to_bits(), {});\n\
             let _ = (gains::ANOTHER_A_20, gains::ANOTHER_B_20, gains::X8_A_15, gains::X8_B_15, gains::X8_A_18_5, gains::X8_B_18_5, gains::X8_C_24, gains::X8_D_24, gains::PARTLY_X_18, gains::PARTLY_U_18, gains::PARTLY_Y_18);\n\
             let _ = (gains::CART_L_2, gains::CART_L_3, gains::CART_A, gains::CART_B, gains::PLAIN_P, gains::OBSERVER_P);\n}}",
            bits("pole_placement", "cart", "L"),
            bits("pole_placement", "pair", "L"),
            bits("dare", "cart", "K_filter"),
        ),
    );
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let compiled = Command::new(compiler)
        .args(["--edition", "2024", "-o", &desk.named("program"), &program])
        .output()
        .expect("the compiler runs");
    assert!(compiled.status.success(), "{}", text(&compiled.stderr));
    assert!(Command::new(desk.path("program")).status().expect("it runs").success());
}
