//! The firmware of `tests/apps/gnss` with nothing but a receiver: recorded observations, and ephemerides in the satellites' own
//! words, all as the messages of a u-blox module.
//!
//! The ephemerides are fitted to precise products ([`gnss_broadcast`](super::gnss_broadcast)): they are better than real ones.

use std::collections::VecDeque;
use std::f64::consts::PI;
use std::io;
use std::path::Path;

use embedded_io::{ErrorType, Read, ReadReady, Write};
use gnss_app::{App, Broadcasts, Corrections, Source, Unusable, site};
use kestirim_gnss_files::{Ephemeris, Epoch, Message, Navigation, Observations, Text};
use kestirim_gnss_ppp::{Carriers, Geodetic, Slip};
use kestirim_health::{Health, Reason};
use kestirim_ppp_filter::Slipped;
use kestirim_replay::gnss::ephemeris;
use kestirim_telemetry::{Message as Sent, Receiver as Telemetry};
use kestirim_tests::gnss::ESBC;
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;

use super::gnss_broadcast::{fitted_to_products, products, ssr};
use super::gnss_streams::{ubx, ubx_frame};

/// Epochs of 30 s: six hours.
const EPOCHS: usize = 720;
/// The height of the station's antenna above its marker, m (the header of its observations).
const HEIGHT: f64 = 0.216;
/// Every so many epochs each satellite sends its ephemeris: a receiver repeats it every half minute.
const REPEATED: usize = 10;

/// Telemetry, of which the health of the estimates is read.
#[derive(Default)]
struct Line(Vec<u8>);

impl Line {
    /// How far each epoch's estimate can be relied upon, as sent.
    fn healths(&self) -> Vec<Health> {
        let mut receiver = Telemetry::new();
        let healths = receiver.frames(&self.0).filter_map(|frame| match frame.message {
            Sent::EstimateHealth(health) => Health::from_bits(health.reasons),
            _ => None,
        });
        healths.collect()
    }
}

impl ErrorType for &mut Line {
    type Error = std::convert::Infallible;
}

impl Write for &mut Line {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        self.0.extend(bytes);
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
    let (issue, time) = (i64::from(it.issue), units(second, 4));
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

/// What a board is given: observations and ephemerides, and the satellite among them that is unhealthy.
fn recorded(folder: &Path) -> (Vec<u8>, u8) {
    let navigation = Text::unpack("day.nav", fitted_to_products(folder).into_bytes())
        .and_then(|text| Navigation::parse(&[text]))
        .expect("ephemerides");
    let observations = Observations::read(folder.join(ESBC.observations)).expect("observations");
    let unhealthy = observations.epochs[0].satellites[0].prn;
    (stream(&observations, &navigation, unhealthy), unhealthy)
}

/// The station's marker, were its antenna as high above it as that of the application's site.
fn marker() -> Vector3<f64> {
    let truth = Vector3::from(ESBC.truth);
    let [_, _, height] = site::receiver().eccentricity;
    let up = Geodetic::from_ecef(&truth).enu_from_ecef().row(2).transpose();
    truth + up * (HEIGHT - height)
}

/// Runs the application, which leaves out an unhealthy satellite and has no position in some first epochs. Returns the position's
/// error and deviation after the last epoch, m, and the largest quotient of any two.
fn run(receiver: &[u8], source: impl Source, unhealthy: u8, without: usize) -> [f64; 3] {
    let mut line = Line::default();
    let mut app = App::new(receiver, source, &mut line);
    let truth = marker();
    let (mut epochs, mut told, mut healths) = (0_usize, Vec::new(), Vec::new());
    while let Some(epoch) = app.poll(0).expect("no port fails") {
        epochs += 1;
        let left_out = epoch.unused.iter().find(|it| it.satellite == unhealthy);
        assert!(epochs < 3 || left_out.is_none_or(|it| it.reason == Unusable::Unhealthy));
        healths.push(match epoch.solution {
            Ok(solution) => {
                let sigma = solution.covariance.trace().sqrt();
                told.push(((solution.position - truth).norm(), sigma));
                solution.health.in_short()
            }
            Err(_) => Reason::Dropout.into(),
        });
    }
    let (last, sigma) = *told.last().expect("a position");
    let most = told.iter().map(|(error, sigma)| error / sigma).fold(0.0, f64::max);
    println!(
        "{} of {epochs} epochs, after the last {last:.3} m off, deviation {sigma:.3} m, most {most:.2} deviations",
        told.len()
    );
    assert_eq!((epochs, told.len()), (EPOCHS, EPOCHS - without));
    assert_eq!(line.healths(), healths);
    [last, sigma, most]
}

#[test]
fn a_receiver_alone_finds_its_place() {
    let Some(folder) = folder_of("gnss") else { return };
    let (receiver, unhealthy) = recorded(&folder);
    // The first epoch comes before any ephemeris.
    let [last, sigma, most] = run(&receiver, Broadcasts::default(), unhealthy, 1);
    assert!(last < 1.0 && sigma < 5.0 && most < 1.0);
}

/// A satellite whose first phase was lost while its second was missing has slipped, also if the receiver has tracked it since the
/// last solution of the others.
#[test]
fn a_lock_is_counted_from_the_satellites_own_last_epoch() {
    const ABSENT: std::ops::Range<usize> = 120..124;
    let Some(folder) = folder_of("gnss") else { return };
    let navigation = Text::unpack("day.nav", fitted_to_products(&folder).into_bytes())
        .and_then(|text| Navigation::parse(&[text]))
        .expect("ephemerides");
    let mut observations =
        Observations::read(folder.join(ESBC.observations)).expect("observations");
    let epochs = &mut observations.epochs;
    let seen = |epoch: &Epoch, prn: u8| epoch.satellites.iter().any(|it| it.prn == prn);
    let stays = |prn: &u8| epochs[..=ABSENT.end].iter().all(|epoch| seen(epoch, *prn));
    let victim = (1..=32).find(stays).expect("a satellite that stays");
    for (index, epoch) in epochs[ABSENT].iter_mut().enumerate() {
        let observed = epoch.satellites.iter_mut().find(|it| it.prn == victim);
        let observed = observed.expect("the satellite");
        observed.code[1] = None;
        observed.loss_of_lock[0] = index == 2;
    }
    let receiver = stream(&observations, &navigation, 0);
    let mut line = Line::default();
    let mut app = App::new(&*receiver, Broadcasts::default(), &mut line);
    for index in 0..=ABSENT.end {
        let epoch = app.poll(0).expect("no port fails").expect("an epoch");
        if index == ABSENT.end {
            let told = epoch.solution.expect("a position").satellites;
            let report = told.iter().find(|it| it.satellite == victim).expect("the satellite");
            assert_eq!(report.slipped, Some(Slipped::Seen(Slip::LossOfLock)));
        }
    }
}

/// A modem that delivers the frames of an epoch each time that it is asked.
struct Modem(VecDeque<VecDeque<u8>>);

impl ErrorType for Modem {
    type Error = std::convert::Infallible;
}

impl ReadReady for Modem {
    fn read_ready(&mut self) -> Result<bool, Self::Error> {
        let is_ready = self.0.front().is_some_and(|epoch| !epoch.is_empty());
        if !is_ready {
            self.0.pop_front();
        }
        Ok(is_ready)
    }
}

impl Read for Modem {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Self::Error> {
        self.0.front_mut().map_or(Ok(0), |epoch| io::Read::read(epoch, bytes).or(Ok(0)))
    }
}

#[test]
fn with_the_corrections_of_a_service_it_is_centimetres_off() {
    let Some(folder) = folder_of("gnss") else { return };
    let (receiver, unhealthy) = recorded(&folder);
    // Corrected are the ephemerides as they are sent, with fewer digits than fitted.
    let sent = Text::unpack("day.ubx", receiver.clone())
        .and_then(|text| Navigation::parse(&[text]))
        .expect("ephemerides");
    let of_satellite = |number| {
        let told = sent.satellite(number, Message::Lnav).iter();
        told.filter_map(move |it| Some((number, ephemeris(it, Carriers::L1L2)?)))
    };
    let ephemerides: Vec<_> = sent.satellites().flat_map(of_satellite).collect();
    let frames = ssr::frames(&ephemerides, &products(&folder));
    let modem = Modem(frames.into_iter().map(VecDeque::from).collect());
    // The first corrections that are of use come after the first ephemerides.
    let [last, sigma, most] = run(&receiver, Corrections::new(modem), unhealthy, 2);
    assert!(last < 0.05 && sigma < 0.3 && most < 2.0);
}
