//! The range bias as a function of the level, against recorded exchanges at surveyed distances.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use kestirim_uwb_ranging::LevelBias;

/// Standard deviation of the medians at each distance, m.
fn spread(errors: &BTreeMap<u32, Vec<f64>>) -> f64 {
    let median = |errors: &Vec<f64>| {
        let mut sorted = errors.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() / 2]
    };
    let medians: Vec<f64> = errors.values().map(median).collect();
    let mean = medians.iter().sum::<f64>() / medians.len() as f64;
    let squares: f64 = medians.iter().map(|median| (median - mean).powi(2)).sum();
    (squares / medians.len() as f64).sqrt()
}

#[test]
fn recorded_distances_depend_less_on_the_distance() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../../../shared/data/robot/cucu_static_los_nlos/ranges.csv");
    let Ok(log) = fs::read_to_string(&file) else {
        println!("SKIPPED: there is no {}", file.display());
        return;
    };
    let tables = [LevelBias::<f64, 18>::aps011_prf64(), LevelBias::dw1000_prf64()];
    for (place, most) in [("LOS", 0.055), ("NLOS", 0.045)] {
        let mut errors: [BTreeMap<u32, Vec<f64>>; 3] = Default::default();
        for line in log.lines().skip(1) {
            let fields: Vec<_> = line.split(',').collect();
            let number = |index: usize| fields[index].parse::<f64>().ok();
            let (Some(distance), Some(range), Some(level)) = (number(2), number(3), number(4))
            else {
                continue;
            };
            let error = range - distance;
            // Larger errors have another cause.
            if fields[0] != place || error.abs() >= 2.0 {
                continue;
            }
            let biases = [0.0, tables[0].bias(level), tables[1].bias(level)];
            for (errors, bias) in errors.iter_mut().zip(biases) {
                errors.entry((10.0 * distance).round() as u32).or_default().push(error - bias);
            }
        }
        let [raw, true_level, estimate] = errors.map(|errors| spread(&errors));
        println!(
            "{place}: {raw:.3} m as it is, {true_level:.3} by the level, {estimate:.3} by the estimate"
        );
        assert!(estimate < most && estimate < 0.65 * raw && true_level < raw, "{place}");
    }
}
