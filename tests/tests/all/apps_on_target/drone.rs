//! The drone: a satellite receiver and a `LoRa` module on serial ports, the user's position as telemetry.

use std::f64::consts::TAU;

use anyhow::{Result, bail, ensure};
use drone_app::site::{self, GROUND, LEVEL, ORIGIN, USER};
use drone_app::{Degree, PARTICLES};
use host_sim::random::{normal, stream};
use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_particle_filter::Xoshiro128PlusPlus;
use kestirim_telemetry::{Message, PathLoss, Position};
use kestirim_user_locator::{Health, Reason, Tracker};
use rand_core::{Rng, SeedableRng};
use target_bench::{App, CORTEX_M4F};

use super::{image, telemetry};

/// The position of the user, m, the height of the drone, m, and the duration, s.
const USER_AT: [f64; 2] = [1400.0, 700.0];
const HEIGHT: f64 = 500.0;
const SECONDS: u32 = 120;
/// The resolution of a position, m: half of the last decimal of a sentence, 10⁻⁵ minutes, and of single precision at 2
/// km.
const PLACE_STEP: f64 = 0.02;
/// The resolution of the level, dB: half of its last digit.
const LEVEL_STEP: f64 = 0.501;
const GPS: u16 = 0;
const RADIO: u16 = 1;

/// One second of the flight.
struct Second {
    place: [f64; 3],
    /// The path loss, dB; `None` if nothing was received.
    loss: Option<f64>,
}

/// Two rounds about the centre of the city.
fn fly() -> Vec<Second> {
    let mut rng = stream(4, 0);
    let channel =
        Channel::<f64>::new(&Environment::urban(), site::WAVELENGTH.into()).expect("a channel");
    let second = |second: u32| {
        let angle = TAU * f64::from(second) / 60.0;
        let place = [1000.0 + 667.0 * angle.cos(), 1000.0 + 667.0 * angle.sin(), HEIGHT];
        let distance = (USER_AT[0] - place[0]).hypot(USER_AT[1] - place[1]);
        let expected = channel.path_loss(distance, HEIGHT).expect("a distance");
        let seen = f64::from(rng.next_u32()) / 2_f64.powi(32) < expected.line_of_sight_probability;
        let (mean, sigma) = if seen {
            (expected.line_of_sight_mean, expected.line_of_sight_sigma)
        } else {
            (expected.obstructed_mean, expected.obstructed_sigma)
        };
        let loss = mean + normal(&mut rng, sigma);
        Second { place, loss: (second % 11 != 10).then_some(loss) }
    };
    (0..SECONDS).map(second).collect()
}

/// A sentence with its checksum.
fn sentence(content: &str) -> String {
    let checksum = content.bytes().fold(0, |sum, byte| sum ^ byte);
    format!("${content}*{checksum:02X}\r\n")
}

/// An angle in degrees and minutes.
fn angle(degrees: f64, width: usize) -> String {
    format!("{:0width$}{:08.5}", degrees.trunc() as u32, degrees.fract() * 60.0)
}

/// The lengths of a degree of longitude and of latitude, m, computed from the ellipsoid.
fn degree() -> [f64; 2] {
    let (sine, cosine) = ORIGIN[0].to_radians().sin_cos();
    let (axis, eccentricity) = (6_378_137.0, 0.006_694_379_990_14_f64);
    let root = (1.0 - eccentricity * sine * sine).sqrt();
    let (normal, meridian) = (axis / root, axis * (1.0 - eccentricity) / root.powi(3));
    [normal * cosine, meridian].map(f64::to_radians)
}

/// The output of both modules, as records of the board's tape.
fn encode(flight: &[Second]) -> Vec<u8> {
    let mut tape = Vec::new();
    let mut record = |elapsed_us: u32, port: u16, text: &str| {
        tape.extend(elapsed_us.to_le_bytes());
        tape.extend(port.to_le_bytes());
        tape.extend((text.len() as u16).to_le_bytes());
        tape.extend(text.as_bytes());
    };
    let degree = degree();
    // A beacon before the first fix, and answers to commands.
    record(0, RADIO, &format!("+OK\r\n+READY\r\n+RCV={USER},5,HELLO,-80,9\r\n"));
    for (number, second) in flight.iter().enumerate() {
        let [east, north, up] = second.place;
        let latitude = angle(ORIGIN[0] + north / degree[1], 2);
        let longitude = angle(ORIGIN[1] + east / degree[0], 3);
        let altitude = up + f64::from(GROUND);
        let time = format!("{:02}{:02}{:02}.00", 10, number / 60, number % 60);
        let fix =
            format!("GPGGA,{time},{latitude},N,{longitude},E,1,10,0.8,{altitude:.1},M,36.0,M,,");
        let course = format!("GPRMC,{time},A,{latitude},N,{longitude},E,20.0,90.0,250620,,,A");
        // A damaged sentence, then the whole one in two pieces, and one that is of no interest.
        record(700_000, GPS, &sentence(&fix).replacen('1', "7", 1));
        let whole = sentence(&fix);
        let (first, rest) = whole.split_at(30);
        record(50_000, GPS, first);
        record(50_000, GPS, &format!("{rest}{}", sentence(&course)));
        record(100_000, RADIO, "+RCV=99,3,a,b,-60,10\r\n");
        let level = second.loss.map(|loss| (f64::from(LEVEL) - loss).round());
        let heard =
            level.map_or(String::new(), |level| format!("+RCV={USER},5,HE,LO,{level},8\r\n"));
        record(100_000, RADIO, &heard);
    }
    tape
}

/// The estimates of the host's own tracker from these measurements.
fn on_host(measured: &[PathLoss]) -> Vec<Position> {
    let mut rng = Xoshiro128PlusPlus::from_rng(&mut Xoshiro128PlusPlus::seed_from_u64(7));
    let mut tracker = Tracker::<f32, PARTICLES>::new(
        site::channel().expect("a channel"),
        site::motion(),
        &site::region().expect("a region"),
        &mut rng,
    );
    let mut before = None;
    let step = |measured: &PathLoss| {
        let [x, y, height] = measured.place;
        if let Some(before) = before.replace(measured.time_us) {
            let interval = (measured.time_us - before) as f32 * 1e-6;
            tracker.predict(interval, &mut rng).expect("an interval");
        }
        let measurement = Measurement::new([x, y], height, measured.loss).expect("a measurement");
        tracker.measure(&measurement, &mut rng).expect("somebody explains it");
        let estimate = tracker.estimate();
        let [x, y] = estimate.place;
        let sigma = Some(estimate.spread * std::f32::consts::FRAC_1_SQRT_2);
        Position { time_us: measured.time_us, position: [x, y, 0.0], sigma }
    };
    measured.iter().map(step).collect()
}

/// Checks that the measurements are those of the flight, within the resolution of both modules.
fn check_measurements(told: &[PathLoss], flight: &[Second]) {
    let heard = (1_u64..)
        .zip(flight)
        .filter_map(|(number, second)| Some((number * 1_000_000, second.place, second.loss?)));
    assert_eq!(told.len(), heard.clone().count());
    for (told, (time_us, place, loss)) in told.iter().zip(heard) {
        assert_eq!(told.time_us, time_us);
        let axes = told.place.iter().zip(place);
        let apart =
            axes.map(|(&ours, theirs)| (f64::from(ours) - theirs).abs()).fold(0.0, f64::max);
        assert!(apart < PLACE_STEP + 0.05, "{told:?} is {apart} m off {place:?}");
        assert!((f64::from(told.loss) - loss).abs() < LEVEL_STEP, "{told:?} of {loss}");
    }
}

#[test]
fn a_degree_is_as_long_as_on_the_ellipsoid() {
    let place = |north: f64, east: f64| {
        let (latitude, longitude) = (angle(ORIGIN[0] + north, 2), angle(ORIGIN[1] + east, 3));
        let fix = sentence(&format!("GPGGA,,{latitude},N,{longitude},E,1,,,890.0,M,,M,,"));
        Degree::at_origin().place(fix.trim_end()).expect("a place")
    };
    let [east, north] = degree().map(|metres| metres * 0.01);
    let [x, y, _] = place(0.01, 0.01).map(f64::from);
    assert!((x - east).abs() < 0.05 && (y - north).abs() < 0.05, "{x} {y}, not {east} {north} m");
}

#[test]
fn cortex_m4f() -> Result<()> {
    let Some(app) = App::of(&CORTEX_M4F, "drone-firmware")? else { return Ok(()) };
    let flight = fly();
    let run = app.run(&encode(&flight), None)?;
    ensure!(run.success, "{}", run.console);

    let (mut losses, mut path, mut health, mut doubts) = (Vec::new(), Vec::new(), None, Vec::new());
    for message in telemetry::messages(&run.telemetry) {
        match message {
            Message::PathLoss(loss) => losses.push(loss),
            Message::Position(position) => path.push(position),
            Message::Health(counts) => health = Some(counts),
            Message::EstimateHealth(estimate) => doubts.push(estimate.reasons),
            other => bail!("{other:?}"),
        }
    }
    check_measurements(&losses, &flight);
    let expected = on_host(&losses);
    assert_eq!(path, expected, "the very bits");
    let last = expected.last().map(|last| last.position.map(f64::from)).unwrap_or_default();
    let error = (last[0] - USER_AT[0]).hypot(last[1] - USER_AT[1]);
    ensure!(error < 150.0, "the user is found {error} m off");
    // The beacon before the first fix.
    let counts = health.map(|health| (health.accepted as usize, health.rejected, health.failed));
    assert_eq!(counts, Some((losses.len(), 0, 1)));
    assert_eq!(doubts[0], Health::from(Reason::Dropout).bits());
    assert_eq!(doubts[1..], vec![0; losses.len()]);

    let lines = image::log(&app, &run)?;
    assert_eq!(lines, ["warn NoFix"]);
    println!("{} path losses, the user found within {error:.0} m", losses.len());
    image::check_panics("drone-firmware", &app)
}
