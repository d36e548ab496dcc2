//! The few most important numbers.

use kestirim_replay::uav::{Noise, Plant};

use crate::report::{Comparison, Headline, printed};
use crate::systems::uav::account::states::{shown, times};
use crate::systems::uav::paper::accuracy::{self, Window};
use crate::systems::uav::paper::catching::THESIS_LUENBERGER;
use crate::systems::uav::paper::published::SETTLING_S;
use crate::systems::uav::paper::report::Report;
use crate::systems::uav::simulate::design::Family;
use crate::systems::uav::simulate::plant::Outputs;

/// The headlines of the first page: the times to catch, and the accuracy.
pub(super) fn headlines(report: &Report) -> Vec<Headline> {
    let caught = report.catching.iter().filter(|row| row.published.is_some()).map(|row| Headline {
        quantity: format!(
            "α caught without noise: {}, {} inputs",
            row.estimator,
            row.inputs.name()
        ),
        unit: "s",
        published: row.published.and_then(|texts| printed(texts[0])),
        theirs: row.ours_s.and_then(|times| times[0]),
        ours: None,
        limit: row.limit_s.and_then(|times| times[0]),
    });
    let settled = |is: &dyn Fn(&accuracy::Row) -> bool| {
        report.accuracy.iter().find(|row| {
            let is_of_p2 = row.plant == Plant::P2 && row.outputs == Outputs::Full;
            is_of_p2 && row.noise == Noise::SENSORS && row.window == Window::Settled && is(row)
        })
    };
    let kalman = settled(&|row| row.family == Family::Kalman);
    let observer = settled(&|row| row.estimator == THESIS_LUENBERGER.kind.name());
    let milliradians = |row: &accuracy::Row| 1e3 * row.rmse[0];
    let error = Headline {
        quantity: "RMSE of α with noisy sensors, settled: the thesis' observer, our filter"
            .to_owned(),
        unit: "mrad",
        published: None,
        theirs: observer.map(milliradians),
        ours: kalman.map(milliradians),
        limit: kalman.map(|row| 1e3 * row.predicted[0]),
    };
    caught.chain([error]).collect()
}

/// The times to catch, the claims, and the consistency of the errors with their predictions.
pub(super) fn summary(report: &Report) -> Comparison {
    let mut table = Comparison::new("uav-summary", "UAV: states α, q, V, θ of the aircraft P2");
    if let Some(plant) = report.plants.iter().find(|row| row.plant == Plant::P2) {
        let all = plant.settling_s.iter().flatten().copied();
        let (low, high) =
            all.fold((f64::INFINITY, 0.0), |(l, h), s| (f64::min(l, s), f64::max(h, s)));
        let here = format!("{low:.0} to {high:.0}");
        table = table.repeated("steps settle, s", format!("≈ {SETTLING_S}"), here, "");
    }
    for row in report.catching.iter().filter(|row| row.published.is_some()) {
        let quantity = format!("{}, {} inputs: caught, s", row.estimator, row.inputs.name());
        let published = row.published.map(|times| times.join(" ")).unwrap_or_default();
        table = table.repeated(quantity, published, times(row.ours_s), times(row.limit_s));
    }
    for claim in report.claims.iter().filter(|claim| !claim.setting.contains("best steady")) {
        let verdict = if claim.holds { "true" } else { "false" };
        let here = format!("{verdict}: {} | {}", shown(claim.kalman), shown(claim.luenberger));
        let quantity = format!("{}: {}", claim.claim, claim.setting);
        table = table.repeated(quantity, "true", here, "");
    }
    let off = report.accuracy.iter().map(|row| 100.0 * row.off().abs()).fold(0.0, f64::max);
    table.note(format!(
        "Claims: RMSE or time of the Kalman filter | of the best observer, state by state. Over {} flights a cell \
         no RMSE is more than {off:.1} % off what Lyapunov's equation says.",
        report.trials
    ))
}
