//! Checks of a day of observations before it is solved.

use kestirim_health::Reason;

use super::{FEWEST_SATELLITES, Recording};
use crate::Finding;
use crate::metrics::median;

/// The findings about a recording.
pub fn check(recording: &Recording) -> Vec<Finding> {
    let epochs = recording.epochs(None);
    let times: Vec<f64> = epochs.iter().map(|epoch| recording.seconds(epoch)).collect();
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let usual = median(&steps);
    let missing: f64 = steps.iter().map(|step| (step / usual).round() - 1.0).sum();
    let [first, last] = recording.span();
    let mut findings = vec![Finding::note(
        "sampling",
        format!("{} epochs, one each {usual:.0} s, {missing:.0} missing between", epochs.len()),
    )];
    let counts: Vec<f64> = epochs.iter().map(|epoch| epoch.satellites.len() as f64).collect();
    let few = recording.sparse().count();
    let doubts = recording.doubts();
    let found = format!(
        "{:.0} usually, {:.0} at least",
        median(&counts),
        counts.iter().copied().fold(f64::INFINITY, f64::min)
    );
    findings.push(if doubts.has(Reason::Dropout) {
        Finding::fault(
            "satellites",
            Reason::Dropout,
            format!("{found}; {few} epochs have fewer than {FEWEST_SATELLITES}"),
            "no position at these times",
            "look at the antenna's sky, and at what the receiver logs of L2",
        )
    } else {
        Finding::note("satellites", found)
    });
    let antenna = match recording.receiver_antenna() {
        Some(name) => Finding::note("antenna", format!("{name} is in the ANTEX file")),
        None => Finding::note("antenna", "the receiver's antenna is not in the ANTEX file"),
    };
    findings.push(antenna);
    let [begin, end] = recording.orbits_span;
    let spans = format!(
        "orbits from {:.1} h to {:.1} h, observations from {:.1} h to {:.1} h",
        begin / 3600.0,
        end / 3600.0,
        first / 3600.0,
        last / 3600.0
    );
    let outside = recording.uncovered().count();
    findings.push(if doubts.has(Reason::Time) {
        Finding::fault(
            "products",
            Reason::Time,
            spans,
            "what lies outside cannot be solved",
            if recording.products().broadcast().is_some() {
                "add the navigation file of the day before or after"
            } else {
                "add the SP3 file of the day before or after"
            },
        )
    } else if outside > 0 {
        let more = "the files of the day before or after have more";
        Finding::note("products", format!("{spans}: {outside} epochs are outside, {more}"))
    } else {
        Finding::note("products", "the orbits cover the observations")
    });
    findings
}
