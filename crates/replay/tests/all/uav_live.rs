//! A flight in progress gives what the complete one does.

use kestirim_replay::uav::{Deviations, EstimatorKind, Log, ModelFile, Options, Sample, build};
use serde_json::json;

const INTERVAL_US: i64 = 20_000;

#[test]
fn an_observer_in_flight_knows_of_the_direct_inputs() {
    let file = json!({
        "A": [[-4.2, 0.97, -0.03, 0.0], [-42.0, -5.1, 0.0, 0.0], [4.0, 0.0, -0.2, -9.8], [0.0, 1.0, 0.0, 0.0]],
        "B": [[-0.2, 0.0], [-35.0, 0.0], [0.0, 8.0], [0.0, 0.0]],
        "outputs": ["q", "V"],
        "C": [[0, 1, 0, 0], [0, 0, 1, 0]],
        "D": [[0.5, 0], [0, 2]],
    });
    let model = serde_json::from_value::<ModelFile>(file).unwrap().model().unwrap();
    let samples: Vec<_> = (0..200)
        .map(|k| {
            let phase = 0.05 * k as f64;
            let input = [0.1 * phase.sin(), 0.2 * phase.cos()];
            let measured = vec![Some(0.2 * phase.cos()), Some(phase.sin())];
            Sample { t_us: k * INTERVAL_US, input, measured }
        })
        .collect();
    let options = Options { estimator: EstimatorKind::Luenberger, ..Options::default() };
    let mut live = build(&model, &[0, 1], &options).unwrap();
    live.set_usual(INTERVAL_US as f64 * 1e-6);
    for sample in &samples {
        live.take(sample).unwrap();
    }
    let log = Log::new(vec![0, 1], samples).unwrap();
    let complete = Deviations::new(model, log, None, false).unwrap().follow(&options).unwrap();
    let last = complete.estimates.last().unwrap().state;
    assert!(last.norm() > 0.1 && (live.estimate() - last).norm() < 1e-9, "{last}");
}
