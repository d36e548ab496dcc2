//! `host-sim fleet`: an estimator per device, for any number of devices, behind a broker.
//!
//! `transport` (`nats`, `udp`) → `engine` → `keyed` → [`Online`](crate::system::Online); states go to `store`.

mod counts;
mod engine;
mod keyed;
mod metrics;
mod nats;
mod options;
mod report;
mod silence;
mod store;
#[cfg(test)]
mod tests;
mod transport;
mod udp;

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use clap::ArgMatches;

use self::engine::Engine;
use self::keyed::Fleet;
use self::metrics::Metrics;
use self::options::Options;
pub(super) use self::options::command;
use self::report::Report;
use self::store::Store;
use super::arguments::{chosen, read};
use super::live::options::given;
use crate::text::printable_path;
use crate::{Error, output};

/// The interval at which the metrics are updated: they are not requested more often.
const BEAT: Duration = Duration::from_secs(1);

/// Follows a fleet until the program is interrupted.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    let options = read::<Options>(matches)?;
    let (settings, files) = given(system, matches)?;
    let name = system.name();
    let plan = system.online(&settings, &files)?;
    let plan = plan.ok_or_else(|| Error::Usage(format!("{name} follows no stream")))?;
    let mut fleet = Fleet::new(name, &plan)?;
    let stop = Arc::new(AtomicBool::new(false));
    let seconds = options.seconds.map(Duration::from_secs);
    let until = seconds.and_then(|seconds| Instant::now().checked_add(seconds));
    let (transport, source) = options.transport(name, (&stop, until))?;
    let log = transport.log();
    let store = Store::open(&options.state, name, settings.arguments(), log, &mut fleet)?;
    let metrics = options.metrics.map(Metrics::serve).transpose()?;
    let (known, folder) = (fleet.keyed.devices.len(), printable_path(&options.state));
    output::warn(&format!("following {source}; {known} devices known, states in {folder}"));
    if let Some(metrics) = &metrics {
        output::warn(&format!("metrics: {}", metrics.address()));
    }
    let ended = Arc::clone(&stop);
    // Without a handler Ctrl-C ends the program at once: even so the next run resumes from the stored states.
    let _ = ctrlc::set_handler(move || ended.store(true, Ordering::Relaxed));
    let mut engine = Engine::begin(fleet, store, transport, options.every())?;
    let (messages, seconds) = follow(&mut engine, metrics.as_ref(), &stop, until)?;
    let report = Report::of((name, source), &engine.fleet, messages, seconds);
    for warning in report.warnings() {
        output::warn(&format!("warning: {warning}"));
    }
    output::show(&report, options.json)
}

/// Follows the fleet and returns the number of messages and the duration in seconds.
fn follow(
    engine: &mut Engine,
    metrics: Option<&Metrics>,
    stop: &AtomicBool,
    until: Option<Instant>,
) -> Result<(u64, f64), Error> {
    let (begun, mut shown, mut messages) = (Instant::now(), None::<Instant>, 0);
    while !stop.load(Ordering::Relaxed) && until.is_none_or(|until| Instant::now() < until) {
        messages += engine.step()? as u64;
        if shown.is_none_or(|shown| shown.elapsed() >= BEAT) {
            metrics.inspect(|metrics| metrics.show(engine));
            shown = Some(Instant::now());
        }
    }
    engine.settle()?;
    Ok((messages, begun.elapsed().as_secs_f64()))
}
