//! The firmware of `tests/apps/gnss` with nothing but a receiver: recorded observations, and ephemerides in the satellites' own
//! words, all as the messages of a u-blox module.
//!
//! The ephemerides are fitted to precise products ([`gnss_broadcast`](super::gnss_broadcast)): they are better than real ones.

use std::f64::consts::PI;

use embedded_io::{ErrorType, Write};
use gnss_app::{App, Broadcasts, Unusable};
use kestirim_gnss_files::{Ephemeris, Message, Navigation, Observations, Text};
use kestirim_tests::gnss::ESBC;
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;

use super::gnss_broadcast::fitted_to_products;
use super::gnss_streams::{ubx, ubx_frame};

/// Epochs of 30 s: six hours.
const EPOCHS: usize = 720;
/// Every so many epochs each satellite sends its ephemeris: a receiver repeats it every half minute.
const REPEATED: usize = 10;

/// Telemetry that nobody reads.
struct Sink;

impl ErrorType for Sink {
    type Error = std::convert::Infallible;
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// A message UBX-RXM-SFRBX with a subframe of L1 C/A: numbers with their widths, behind the telemetry and hand-over words.
fn subframe(satellite: u8, number: i64, fields: &[(i64, usize)]) -> Vec<u8> {
    let front = [(0x8b << 16, 24), (0, 19), (number, 3), (0, 2)];
    let bits = front.iter().chain(fields).flat_map(|&(value, width)| {
        (0..width).rev().map(move |bit| u32::from(value >> bit & 1 == 1))
    });
    let bits: Vec<_> = bits.collect();
    assert!(bits.len() <= 240);
    let mut held = vec![0, satellite, 0, 0, 10, 0, 2, 0];
    for word in 0..10 {
        let bit = |place: usize| bits.get(24 * word + place).copied().unwrap_or_default();
        let data = (0..24).fold(0, |data, place| data << 1 | bit(place));
        // With parity that is not looked at.
        held.extend((data << 6 | 0x2a).to_le_bytes());
    }
    ubx_frame(0x13, &held)
}

/// The three subframes of an ephemeris.
fn subframes(satellite: u8, it: &Ephemeris, health: i64) -> Vec<u8> {
    let units = |value: f64, power| (value / 2_f64.powi(power)).round() as i64;
    let turns = |angle: f64, power| {
        // Within half a turn of zero.
        let half = angle / PI;
        units(half - 2.0 * (half / 2.0).round(), power)
    };
    let rates = |rate: f64| units(rate / PI, -43);
    let second = f64::from((it.time.day() - 44_244).rem_euclid(7)) * 86_400.0 + it.time.second();
    let (issue, time) = (units(second, 4) & 0xff, units(second, 4));
    let ([cuc, cus], [crc, crs], [cic, cis]) =
        (it.latitude_terms, it.radius_terms, it.inclination_terms);
    let [offset, drift, ageing] = it.clock;
    let first = [
        (0, 10),
        (0, 2),
        (0, 4),
        (health, 6),
        (0, 2 + 1 + 44),
        (0, 43),
        (units(it.group_delays[0], -31), 8),
        (issue, 8),
        (time, 16),
        (units(ageing, -55), 8),
        (units(drift, -43), 16),
        (units(offset, -31), 22),
    ];
    let second = [
        (issue, 8),
        (units(crs, -5), 16),
        (rates(it.mean_motion_correction), 16),
        (turns(it.mean_anomaly, -31), 32),
        (units(cuc, -29), 16),
        (units(it.eccentricity, -33), 32),
        (units(cus, -29), 16),
        (units(it.root_of_axis, -19), 32),
        (time, 16),
    ];
    let third = [
        (units(cic, -29), 16),
        (turns(it.node, -31), 32),
        (units(cis, -29), 16),
        (turns(it.inclination, -31), 32),
        (units(crc, -5), 16),
        (turns(it.perigee, -31), 32),
        (rates(it.node_rate), 24),
        (issue, 8),
        (rates(it.inclination_rate), 14),
    ];
    [(1, &first[..]), (2, &second), (3, &third)]
        .map(|(number, fields)| subframe(satellite, number, fields))
        .concat()
}

/// The stream of a receiver: observations, and at times what each satellite broadcasts; one of them is unhealthy.
fn stream(observations: &Observations, navigation: &Navigation, unhealthy: u8) -> Vec<u8> {
    let epochs = &observations.epochs[..EPOCHS];
    let mut stream = Vec::new();
    for (index, (epoch, message)) in epochs.iter().zip(ubx(epochs)).enumerate() {
        stream.extend(message);
        if index % REPEATED != 0 {
            continue;
        }
        for observed in &epoch.satellites {
            let away = |it: &&Ephemeris| it.time.since(epoch.time).abs();
            let told = navigation.satellite(observed.prn, Message::Lnav).iter();
            let nearest = told.min_by(|a, b| away(a).total_cmp(&away(b)));
            let health = if observed.prn == unhealthy { 0b10_0000 } else { 0 };
            stream.extend(
                nearest.map(|it| subframes(observed.prn, it, health)).into_iter().flatten(),
            );
        }
    }
    stream
}

#[test]
fn a_receiver_alone_finds_its_place() {
    let Some(folder) = folder_of("gnss") else { return };
    let navigation = Text::unpack("day.nav", fitted_to_products(&folder).into_bytes())
        .and_then(|text| Navigation::parse(&[text]))
        .expect("ephemerides");
    let observations = Observations::read(folder.join(ESBC.observations)).expect("observations");
    let unhealthy = observations.epochs[0].satellites[0].prn;
    let sent = stream(&observations, &navigation, unhealthy);

    let mut app = App::new(&sent[..], Broadcasts::default(), Sink);
    let truth = Vector3::from(ESBC.truth);
    let (mut epochs, mut told) = (0_usize, Vec::new());
    while let Some(epoch) = app.poll(0).expect("no port fails") {
        epochs += 1;
        let left_out = epoch.unused.iter().find(|it| it.satellite == unhealthy);
        assert!(epochs < 3 || left_out.is_none_or(|it| it.reason == Unusable::Unhealthy));
        if let Ok(solution) = epoch.solution {
            let sigma = solution.covariance.trace().sqrt();
            told.push(((solution.position - truth).norm(), sigma));
        }
    }
    let (last, sigma) = *told.last().expect("a position");
    let most = told.iter().map(|(error, sigma)| error / sigma).fold(0.0, f64::max);
    println!(
        "{} of {epochs} epochs, after the last {last:.2} m off, deviation {sigma:.2} m, most {most:.2} deviations",
        told.len()
    );
    assert_eq!(
        (epochs, told.len()),
        (EPOCHS, EPOCHS - 1),
        "the first epoch comes before any ephemeris"
    );
    assert!(last < 1.0 && sigma < 5.0 && most < 1.0);
}
