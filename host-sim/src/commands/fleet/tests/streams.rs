//! Estimators that can be stored, and messages for them.

use std::sync::Arc;

use kestirim_telemetry::{Imu, Message, Range};

use crate::commands::fleet::keyed::Fleet;
use crate::system::{Files, Outcome, Plan, Settings};
use crate::systems::ALL;

/// Makes the message of a device at a step, for the estimator of a plan.
pub(super) type Maker = fn(&dyn Plan, u32, u64) -> Message;

/// The height of a tag above the items on the map.
const HEIGHT_M: f64 = 0.5;

/// The plans whose estimators can be stored, each with a maker of messages.
pub(super) fn plans() -> Vec<(&'static str, Arc<dyn Plan>, Maker)> {
    let mut plans = Vec::new();
    for system in ALL {
        let mut settings = Settings::new(system.settings());
        let _ = settings.set("height", &HEIGHT_M.to_string());
        let Ok(Some(plan)) = system.online(&settings, &Files::default()) else { continue };
        for message in [imu as Maker, range] {
            // An estimator that follows other devices also uses these messages, but has no position.
            let mut online = plan.build().unwrap();
            let mut take = |step| online.take(&message(plan.as_ref(), 0, step)) == Outcome::Taken;
            let is_taken = (0..100).all(&mut take);
            if is_taken && online.position().is_some() && Fleet::new(system.name(), &plan).is_ok() {
                plans.push((system.name(), Arc::clone(&plan), message));
                break;
            }
        }
    }
    plans
}

/// The IMU of a foot that is shaken intermittently.
fn imu(_: &dyn Plan, device: u32, step: u64) -> Message {
    let shake = if step % 100 < 50 { 0.0 } else { (step as f32 * 0.3 + device as f32).sin() };
    let specific_force = [3.0 * shake, shake, 9.81];
    Imu { time_us: step * 10_000, specific_force, angular_rate: [shake, 0.1 * shake, 0.0] }.into()
}

/// The ranges of a tag that circles among the items on the map.
fn range(plan: &dyn Plan, device: u32, step: u64) -> Message {
    let map = plan.map();
    let anchors = map.first().map_or(Vec::new(), |it| it.x.iter().zip(&it.y).collect());
    let count = anchors.len().max(1) as u64;
    let (anchor, epoch) = (step % count, step / count);
    let (angle, radius) = (epoch as f64 * 0.05 + f64::from(device), 1.0);
    let middle =
        |axis: fn(&(&f64, &f64)) -> f64| anchors.iter().map(axis).sum::<f64>() / count as f64;
    let (x, y) =
        (middle(|it| *it.0) + radius * angle.cos(), middle(|it| *it.1) + radius * angle.sin());
    let distance = anchors.get(anchor as usize).map_or(1.0, |(ax, ay)| (*ax - x).hypot(*ay - y));
    let range = distance.hypot(HEIGHT_M) as f32;
    Range { time_us: epoch * 100_000, anchor: anchor as u16, range }.into()
}
