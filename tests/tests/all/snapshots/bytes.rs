//! The sizes of snapshots: the table of the book's chapter. `-- --nocapture snapshots::bytes` prints it.

use std::collections::BTreeMap;

use super::streams::{Kind, visit_all};
use super::systems::{Sample, Sleeper};
use super::{Visit, stored};

/// For each estimator and number type: the largest snapshot and the estimator itself, bytes.
#[derive(Default)]
struct Sizes(BTreeMap<String, BTreeMap<String, [usize; 2]>>);

impl Visit for Sizes {
    fn visit<E: Sleeper>(&mut self, _: &Kind, mut estimator: E, samples: &[Sample]) {
        let mut largest = 0;
        for (index, sample) in samples.iter().enumerate() {
            estimator.take(sample);
            if index.is_multiple_of(10) || index + 1 == samples.len() {
                largest = largest.max(stored(&estimator).len());
            }
        }
        let of = self.0.entry(E::NAME.into()).or_default();
        let sizes = of.entry(E::number().to_string()).or_default();
        *sizes = [largest.max(sizes[0]), size_of::<E>()];
        // The space that C reserves: `KESTIRIM_…_SNAPSHOT`.
        assert!(largest <= size_of::<E>() * 5 / 4 + 64, "{}: {largest} bytes", E::NAME);
    }
}

#[test]
fn a_snapshot_is_hardly_larger_than_the_estimator() {
    let mut sizes = Sizes::default();
    visit_all(&mut sizes);
    println!(
        "| estimator | numbers | snapshot, bytes | in memory (this computer), bytes |\n|---|---|---|---|"
    );
    for (name, of) in &sizes.0 {
        for (number, [snapshot, memory]) in of {
            println!("| `{name}` | {number} | {snapshot} | {memory} |");
        }
    }
}
