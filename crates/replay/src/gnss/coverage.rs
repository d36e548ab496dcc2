//! Coverage: the satellites and times for which the products are sufficient.

use std::collections::BTreeSet;

use kestirim_gnss_files::{
    AntennaModel, Antennas, GpsTime as Time, Message, Navigation, Observations, Orbits, Signals,
    System, satellite_name,
};
use kestirim_gnss_ppp::{Correction, GpsTime};

use super::broadcast::Broadcast;
use super::model::{self, patterns};
use super::products::Products;

/// The satellites other than those of GPS that are not to be used, and warnings about those of which something is
/// unknown.
pub(super) fn left_out(
    observations: &Observations,
    orbits: &Orbits,
    antennas: &Antennas,
    (antex, start): (&str, Time),
    warnings: &mut Vec<(Option<Correction>, String)>,
) -> BTreeSet<u8> {
    let is_unknown = |(number, signals): &(&u8, &Signals)| {
        let antenna = antennas.satellite(**number, start);
        let antenna = antenna.and_then(|antenna| patterns(antenna, signals.carriers));
        !orbits.satellite(**number).is_empty() && antenna.is_none()
    };
    let all = observations.signals.iter();
    let without = |(number, _): &(&u8, &Signals)| orbits.satellite(**number).is_empty();
    let is_gps = |(number, _): &(&u8, &Signals)| System::of(**number) == System::Gps;
    // A satellite that is a metre off is worse than none where GPS does without it; the same holds for the orbits of
    // geostationary satellites.
    let (mut left_out, mut far) = (BTreeSet::new(), BTreeSet::new());
    for (&number, signals) in all.clone().filter(|it| !is_gps(it)) {
        if System::is_geostationary(number) {
            far.insert(number);
        } else if without(&(&number, signals)) || is_unknown(&(&number, signals)) {
            left_out.insert(number);
        }
    }
    let reasons = [
        (&left_out, "orbits or antennas of them are not known"),
        (&far, "orbits of geostationary satellites are not known well enough"),
    ];
    for (satellites, reason) in reasons.into_iter().filter(|(satellites, _)| !satellites.is_empty())
    {
        let names = names(satellites.iter().copied());
        warnings.push((None, format!("{names} are left out: {reason}")));
    }
    left_out.append(&mut far);
    let unknown = all.filter(is_gps).filter(is_unknown);
    let unknown: Vec<_> = unknown.map(|(number, _)| *number).collect();
    if !unknown.is_empty() {
        warnings.push((
            Some(Correction::SatelliteAntenna),
            format!(
                "{antex}: does not know the antennas of {}: they are off by a metre or more",
                names(unknown),
            ),
        ));
    }
    left_out
}

/// The satellites other than those of GPS without ephemerides for the observed signals, and a warning about them.
pub(super) fn without_ephemerides(
    observations: &Observations,
    broadcast: &Broadcast,
    warnings: &mut Vec<(Option<Correction>, String)>,
) -> BTreeSet<u8> {
    let others = observations.signals.keys().filter(|it| System::of(**it) != System::Gps);
    let left_out: BTreeSet<u8> = others.copied().filter(|it| !broadcast.knows(*it)).collect();
    if !left_out.is_empty() {
        let names = names(left_out.iter().copied());
        let what = match broadcast.ssr() {
            Some(_) => "ephemerides for their signals, or corrections of these,",
            None => "ephemerides for their signals",
        };
        warnings.push((None, format!("{names} are left out: {what} are not known")));
    }
    left_out
}

/// A warning about observed satellites whose antennas are not those that orbits and clocks were made with, and could
/// not be converted.
pub(super) fn other_antennas(
    observations: &Observations,
    products: &Products,
    model: Option<AntennaModel>,
) -> Option<(Option<Correction>, String)> {
    let model = model?;
    let is_other = |&number: &u8| products.antenna_model(number).is_some_and(|it| it != model);
    let others: Vec<_> = observations.signals.keys().copied().filter(is_other).collect();
    let other = products.antenna_model(*others.first()?)?;
    let sentence = format!(
        "antennas of {} are those of {other}, orbits and clocks were made with {model}: the height may be a centimetre off",
        names(others),
    );
    Some((Some(Correction::SatelliteAntenna), sentence))
}

/// The span of time covered by orbits, s since midnight.
pub(super) fn span(orbits: &Orbits, midnight: GpsTime) -> [f64; 2] {
    let times = orbits.satellites().filter_map(|prn| {
        let samples = orbits.satellite(prn);
        let ends = [samples.first()?.time, samples.last()?.time];
        Some(ends.map(|time| model::time(time).since(midnight)))
    });
    times.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], [first, last]| {
        [a.min(first), b.max(last)]
    })
}

/// The span of time in which ephemerides hold, two hours around each, s since midnight.
pub(super) fn span_of_broadcast(navigation: &Navigation, midnight: GpsTime) -> [f64; 2] {
    const HOLDS: f64 = 7_200.0;
    let all = navigation.satellites().flat_map(|number| {
        Message::ALL.into_iter().flat_map(move |message| navigation.satellite(number, message))
    });
    all.fold([f64::INFINITY, f64::NEG_INFINITY], |[first, last], it| {
        let at = model::time(it.time).since(midnight);
        [first.min(at - HOLDS), last.max(at + HOLDS)]
    })
}

/// The names of satellites as in files; of many, the first ones and the number of the others.
pub fn names(satellites: impl IntoIterator<Item = u8>) -> String {
    const MOST: usize = 12;
    let mut names: Vec<_> = satellites.into_iter().map(satellite_name).collect();
    let more = names.len().saturating_sub(MOST);
    names.truncate(MOST);
    let named = names.join(" ");
    if more == 0 { named } else { format!("{named} and {more} more") }
}
