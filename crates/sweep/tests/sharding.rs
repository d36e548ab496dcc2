//! However a plan is cut, in whatever format, the whole is the same.

use std::fs;
use std::path::Path;

use kestirim_sweep::table::ENDINGS;
use kestirim_sweep::{Block, Merge, Plan, Work};
use proptest::prelude::*;

fn plan(folder: &Path) -> Plan {
    let path = folder.join("plan.toml");
    fs::write(&path, "system = 'sky'\ntrials = 40\nseeds = [1, 2, 3]").unwrap();
    Plan::read(&path).unwrap()
}

/// Numbers of many sizes; some are missing.
fn number(seed: u64, index: u64) -> f64 {
    let bits = (seed.wrapping_mul(1_000_003) ^ index).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    if bits.is_multiple_of(7) {
        f64::NAN
    } else {
        (bits as f64 - 9e18) * 10_f64.powi((bits % 40) as i32 - 20)
    }
}

fn work(plan: Plan) -> Work {
    let blocks = plan.studies.iter().map(|study| {
        let (seed, trials) = (study.seed, study.trials.unwrap());
        let columns =
            |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
        let stars = Block::new("stars", columns(&["size", "place"]), trials, move |index| {
            Ok(vec![number(seed, index), index as f64])
        });
        let none = Block::new("none", columns(&["size"]), 0, |_| Ok(vec![0.0]));
        let moons = Block::new("moons", columns(&["phase", "size"]), trials / 2, move |index| {
            Ok(vec![number(seed + 9, index), seed as f64])
        });
        vec![stars, none, moons]
    });
    let blocks = blocks.collect();
    Work::new(plan, blocks).unwrap()
}

/// All numbers, study by study and block by block, to the bit.
fn folded(folder: &Path) -> Vec<Vec<Vec<u64>>> {
    let merge = Merge::open(folder).unwrap();
    let mut all = Vec::new();
    merge
        .studies(&work(merge.plan()), |study, samples| {
            assert_eq!(study, all.len());
            let bits =
                samples.iter().map(|block| block.rows().flatten().map(|it| it.to_bits()).collect());
            all.push(bits.collect());
            Ok(())
        })
        .unwrap();
    all
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_cuts_give_the_same_whole(mut cuts in prop::collection::vec(0_u64..=180, 0..6)) {
        let folder = tempfile::tempdir().unwrap();
        let all = work(plan(folder.path()));
        prop_assert_eq!(all.rows(), 180);
        let [one, many] = ["one", "many"].map(|name| folder.path().join(name));
        fs::create_dir(&one).unwrap();
        fs::create_dir(&many).unwrap();
        all.write(0..180, &one.join("all.csv"), &|| ()).unwrap();
        cuts.extend([0, 180]);
        cuts.sort_unstable();
        for (place, pair) in cuts.windows(2).enumerate() {
            let path = many.join(format!("{place}.{}", ENDINGS[place % ENDINGS.len()]));
            all.write(pair[0]..pair[1], &path, &|| ()).unwrap();
            prop_assert!(all.is_done(&(pair[0]..pair[1]), &path).unwrap());
        }
        prop_assert_eq!(folded(&many), folded(&one));
        let merged = folder.path().join("merged.csv");
        let merge = Merge::open(&many).unwrap();
        merge.write(&all, &merged).unwrap();
        prop_assert_eq!(fs::read(merged).unwrap(), fs::read(one.join("all.csv")).unwrap());
    }
}

#[test]
fn sums_of_a_summary_are_exact() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.toml");
    fs::write(&path, "system = 'sky'\ntrials = 3001").unwrap();
    let all = |plan: Plan| {
        // 1e16 and -1e16 alternate with 1 that a plain sum would lose.
        let value =
            |index: u64| [1e16, 1.0, -1e16][(index % 3) as usize] * f64::from(index != 3000);
        let block = Block::new("cancelling", ["value".to_owned()], 3001, move |index| {
            Ok(vec![value(index)])
        });
        Work::new(plan, vec![vec![block]]).unwrap()
    };
    let work = all(Plan::read(&path).unwrap());
    let rows = folder.path().join("rows");
    fs::create_dir(&rows).unwrap();
    work.write(0..3001, &rows.join("all.csv"), &|| ()).unwrap();
    let merge = Merge::open(&rows).unwrap();
    let mut columns = merge.summary(&work).unwrap();
    let summary = columns[0].summary().unwrap();
    assert_eq!((summary.count, summary.missing), (3001, 0));
    assert_eq!(summary.mean, 1000.0 / 3001.0);
    assert_eq!((summary.least, summary.greatest), (-1e16, 1e16));
    assert_eq!(summary.approximate_percentiles[0], -1e16);
    assert!((summary.deviation / (1e16 * (2.0_f64 / 3.0).sqrt()) - 1.0).abs() < 1e-3);
}
