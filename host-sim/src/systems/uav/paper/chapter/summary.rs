//! The few numbers that matter most.

use kestirim_replay::uav::Plant;

use crate::report::Comparison;
use crate::systems::uav::account::states::{shown, times};
use crate::systems::uav::paper::published::SETTLING_S;
use crate::systems::uav::paper::report::Report;

/// Times to catch, claims, and how honest the errors are.
pub(super) fn summary(report: &Report) -> Comparison {
    let mut table = Comparison::new("uav-summary", "UAV: states α, q, V, θ of the aircraft P2");
    if let Some(plant) = report.plants.iter().find(|row| row.plant == Plant::P2) {
        let all = plant.settling_s.iter().flatten().copied();
        let (low, high) =
            all.fold((f64::INFINITY, 0.0), |(l, h), s| (f64::min(l, s), f64::max(h, s)));
        let ours = format!("{low:.0} to {high:.0}");
        table = table.row("steps settle, s", format!("≈ {SETTLING_S}"), ours, "");
    }
    for row in report.catching.iter().filter(|row| row.published.is_some()) {
        let quantity = format!("{}, {} inputs: caught, s", row.estimator, row.inputs.name());
        let published = row.published.map(|times| times.join(" ")).unwrap_or_default();
        table = table.row(quantity, published, times(row.ours_s), times(row.limit_s));
    }
    for claim in report.claims.iter().filter(|claim| !claim.setting.contains("best steady")) {
        let verdict = if claim.holds { "true" } else { "false" };
        let ours = format!("{verdict}: {} | {}", shown(claim.kalman), shown(claim.luenberger));
        let quantity = format!("{}: {}", claim.claim, claim.setting);
        table = table.row(quantity, "true", ours, "");
    }
    let off = report.accuracy.iter().map(|row| 100.0 * row.off().abs()).fold(0.0, f64::max);
    table.note(format!(
        "Claims: RMSE or time of the Kalman filter | of the best observer, state by state. Over {} flights a cell \
         no RMSE is more than {off:.1} % off what Lyapunov's equation says.",
        report.trials
    ))
}
