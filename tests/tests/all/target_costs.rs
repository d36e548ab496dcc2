//! The costs of the estimators on bare metal: limits for the common scenario, and comparisons with the peers and with
//! the recorded baseline.
//!
//! On a machine without the tools these tests print SKIPPED and pass; with
//! `KESTIRIM_REQUIRE_TARGETS=1` they fail instead. `cargo run --release -p target-bench` prints the table.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::sync::OnceLock;

use anyhow::{Context, Result};
use target_bench::baseline::Baseline;
use target_bench::streams::{Common, Encode};
use target_bench::{
    CORTEX_M0, CORTEX_M4F, Images, Profile, RV32IMC, Row, TARGETS, Target, is_short, workloads,
};

/// All measured rows, and the compilers: empty without the tools, fewer in the short form.
type Measured = (Vec<Row>, BTreeMap<String, String>);

fn measure() -> Result<Measured> {
    let (mut rows, mut compilers) = (Vec::new(), BTreeMap::new());
    for target in TARGETS {
        for profile in Profile::ALL {
            let Some(images) = Images::of(target, profile)? else { continue };
            rows.extend(workloads::measure(&images, "")?);
            compilers.insert(target.triple.to_owned(), images.compiler);
        }
    }
    Ok((rows, compilers))
}

fn measured() -> &'static Measured {
    static MEASURED: OnceLock<Result<Measured, String>> = OnceLock::new();
    let measured = MEASURED.get_or_init(|| measure().map_err(|error| format!("{error:?}")));
    measured.as_ref().expect("every image runs")
}

/// The row of a workload; `None` if this target was left out.
fn row<'a>(
    rows: &'a [Row],
    name: &str,
    scalar: &str,
    target: &Target,
    profile: Profile,
) -> Option<&'a Row> {
    let of = [target.triple, profile.opt()];
    let mut here = rows.iter().filter(|row| row.key()[2..] == of).peekable();
    here.peek()?;
    Some(here.find(|row| row.key()[..2] == [name, scalar]).expect("it was measured"))
}

#[test]
fn nothing_costs_more_than_it_did() -> Result<()> {
    let (rows, compilers) = measured();
    if Common::read()?.reference.is_none() {
        return Ok(()); // Other ranges cost other amounts; that they are absent has been said.
    }
    let baseline = Baseline::kept()?;
    if compilers.iter().any(|(target, by)| baseline.compilers.get(target) != Some(by)) {
        // Not `eprintln!`, which the test runner swallows when the test passes.
        writeln!(
            io::stderr(),
            "SKIPPED: the baseline is of {:?}, not of {compilers:?}; \
             `cargo run --release -p target-bench -- --keep` on the last good commit makes one",
            baseline.compilers
        )?;
        return Ok(());
    }
    assert_eq!(baseline.complaints(rows), Vec::<String>::new());
    Ok(())
}

/// A system with time for an estimator's mean step has time for each of its steps: first positions and alignments are
/// spread over several.
#[test]
fn no_step_is_longer_than_ten_means() {
    let (rows, _) = measured();
    for row in rows.iter().filter(|row| !row.is_peer()) {
        assert!(row.instructions_max as f64 <= 10.0 * row.instructions_mean, "{row}");
    }
}

#[test]
fn estimators_link_neither_panics_nor_doubles_nor_static_memory() {
    let (rows, _) = measured();
    for row in rows.iter().filter(|row| !row.is_peer()) {
        assert_eq!((row.panic_symbols, row.ram_bytes), (0, 0), "{row}");
        assert!(row.scalar == "f64" || row.double_symbols == 0, "{row}");
    }
}

#[test]
fn the_common_scenario_is_within_its_bars() {
    let (rows, _) = measured();
    let ours = |scalar, target, profile| row(rows, "ekf4-ranges4", scalar, target, profile);
    let takes_at_most = |most: f64, scalar, target| {
        let Some(row) = ours(scalar, target, Profile::Speed) else { return };
        assert!(row.instructions_mean <= most, "{row}");
    };
    takes_at_most(600.0, "f32", &CORTEX_M4F);
    for scalar in ["q8.24", "q12.20", "q16.16"] {
        takes_at_most(11_200.0, scalar, &CORTEX_M0);
        takes_at_most(4_700.0, scalar, &RV32IMC);
        if let Some(fixed) = ours(scalar, &CORTEX_M0, Profile::Speed) {
            assert!(fixed.jitter() <= 0.01, "{fixed}");
        }
        if let Some(small) = ours(scalar, &CORTEX_M0, Profile::Size) {
            assert!(small.flash_bytes <= 5_000 && small.stack_bytes <= 380, "{small}");
        }
    }
    if let Some(small) = ours("f32", &CORTEX_M4F, Profile::Size) {
        assert!(small.instructions_mean <= 3_300.0, "{small}");
        assert!(small.flash_bytes <= 2_300 && small.stack_bytes <= 260, "{small}");
    }
}

/// With the routines of `kestirim-arithmetic`; with the compiler's it would be 2.6 to 2.9 times as much.
#[test]
fn single_precision_without_a_unit_for_it_is_within_its_bars() {
    let (rows, _) = measured();
    let bars = [
        ("ekf4-ranges4", 15_200.0),
        ("ahrs", 4_400.0),
        ("pedestrian-lite", 9_700.0),
        ("pedestrian-ekf", 18_900.0),
    ];
    for (name, most) in bars {
        let Some(row) = row(rows, name, "f32", &CORTEX_M0, Profile::Speed) else { return };
        assert!(row.instructions_mean <= most, "{row}");
    }
}

/// The peers take more everywhere; almost twice as many in single precision at opt-level 3.
#[test]
fn peers_take_more_instructions() {
    if is_short() {
        return; // The next test says so.
    }
    let (rows, _) = measured();
    let peers = [
        ("peer-adskalman", "f32"),
        ("peer-kfilter", "f32"),
        ("peer-minikalman", "f32"),
        ("peer-minikalman", "q16.16"),
    ];
    for target in TARGETS {
        for profile in Profile::ALL {
            for (peer, scalar) in peers {
                let instructions =
                    |name| Some(row(rows, name, scalar, target, profile)?.instructions_mean);
                let Some((theirs, ours)) = instructions(peer).zip(instructions("ekf4-ranges4"))
                else {
                    continue;
                };
                let ratio = theirs / ours;
                let what = format!("{peer} {scalar} on {} at {}", target.triple, profile.opt());
                println!("{what}: {theirs:.0} instructions, {ratio:.2} times ours");
                let fast_floats = (scalar, profile) == ("f32", Profile::Speed);
                assert!(ratio >= if fast_floats { 1.9 } else { 1.0 }, "{what}: {ratio} times ours");
            }
        }
    }
}

/// If the peers' states differed, their costs would not be comparable.
#[test]
fn peers_find_the_same_states() -> Result<()> {
    let common = Common::read()?;
    let Some(reference) = &common.reference else { return Ok(()) };
    let Some(images) = Images::of_peers(&CORTEX_M4F, Profile::Speed)? else { return Ok(()) };
    let peers = [
        ("peer-adskalman-f32", 1e-4),
        ("peer-kfilter-f32", 1e-4),
        ("peer-minikalman-f32", 1e-4),
        // It rounds each product.
        ("peer-minikalman-q16-16", 0.05),
    ];
    for (peer, tolerance) in peers {
        let told = images.run(peer, &common.encode())?.positions()?;
        assert_eq!(told.len(), 2, "a position every fifty steps");
        for told in told {
            let step = (told.time_us / 100_000 - 1) as usize;
            let [x, y, ..] = reference.states.get(step).context("a step of the scenario")?;
            let [px, py, _] = told.metres;
            let apart = (px - x).hypot(py - y);
            assert!(apart <= tolerance, "{peer} after step {step}: {apart} m");
        }
    }
    Ok(())
}
