//! Measures how the cost of the hot steps grows with the size of their input: for each, the cost per unit (particle,
//! row, epoch, measurement) relative to the smallest case. A level line means linear growth. Draws the book's figures:
//!
//! ```text
//! cargo bench -p kestirim-tests --bench growth
//! ```
//!
//! A number is the processor time of the fastest of several rounds.

mod robust;

use std::fmt::Write as _;
use std::hint::black_box;
use std::thread;
use std::time::Duration;

use host_sim::figure::{Colour, Figure, Mark, Series};
use kestirim_air_to_ground::{Channel, Environment, Measurement};
use kestirim_gnss_ppp::{Corrections, Receiver};
use kestirim_import::{Table, Text};
use kestirim_particle_filter::{Region, Xoshiro128PlusPlus};
use kestirim_ppp_filter::{Config, Motion, PppFilter};
use kestirim_replay::gnss::STATES;
use kestirim_simulate::gnss::{Day, Rates, UTC_MINUS_GPS};
use kestirim_tests::book::draw_figure;
use kestirim_user_locator::{PublishedLocator, PublishedSettings};
use rand_core::SeedableRng;
use rustix::time::{ClockId, clock_gettime};

/// The stack size, bytes: a hundred thousand particles take some megabytes.
const STACK: usize = 1 << 28;

/// The processor time, s, over the size of the input.
type Curve = Vec<(f64, f64)>;

fn main() -> anyhow::Result<()> {
    let particles = thread::Builder::new().stack_size(STACK).spawn(particles)?;
    let particles = particles.join().map_err(|_| anyhow::anyhow!("no stack for particles"))?;
    let curves = [
        ("particles of a step", particles),
        ("rows of a CSV file", rows()?),
        ("epochs of a station's day", epochs()),
        ("measurements of a robust update", robust::measurements()),
    ];
    let mut figure = Figure::new("growth", "The cost of one, over that in the smallest case")
        .axes("how many", "cost of one, relative");
    (figure.x.logarithmic, figure.y.range) = (true, Some([0.0, 2.0]));
    for (index, (name, curve)) in curves.into_iter().enumerate() {
        let (size, seconds) = curve[0];
        let relative = curve.iter().map(|(n, s)| (*n, (s / n) / (seconds / size)));
        let relative: Vec<_> = relative.collect();
        print(name, &relative, "of one, over that in the smallest case");
        figure = figure.with(series(name, relative).coloured(Colour::Other(index)));
    }
    draw_figure(&figure)?;
    let outliers = robust::outliers();
    let clean = outliers[0].1;
    let outliers: Vec<_> = outliers.into_iter().map(|(n, s)| (n, s / clean)).collect();
    let name = "outliers among 80 measurements";
    print(name, &outliers, "clean updates");
    let mut figure = Figure::new("growth-outliers", "What outliers cost a robust update")
        .axes(name, "clean updates")
        .with(series("worst first", outliers));
    figure.y.range = Some([0.0, 4.0]);
    Ok(draw_figure(&figure)?)
}

fn series(name: &str, curve: Curve) -> Series {
    let (x, y) = curve.into_iter().unzip();
    Series::new(name, Mark::LineAndPoints, x, y)
}

fn print(name: &str, curve: &Curve, unit: &str) {
    let all: Vec<_> = curve.iter().map(|(n, cost)| format!("{n:.0}: {cost:.2}")).collect();
    println!("{name:33} {}  ({unit})", all.join("  "));
}

/// A step of the thesis' filter with resampling and moments.
fn particles() -> Curve {
    vec![step::<100>(), step::<1_000>(), step::<10_000>(), step::<100_000>()]
}

fn step<const L: usize>() -> (f64, f64) {
    const STEPS: u32 = 12;
    let mut rng = Xoshiro128PlusPlus::seed_from_u64(1);
    let region = Region::new([0.0; 2], [3000.0; 2]).expect("a square");
    let channel = Channel::new(&Environment::urban(), 0.15).expect("a channel");
    let settings = PublishedSettings { threshold: 2.0, ..PublishedSettings::thesis() };
    let mut filter = PublishedLocator::<f64, L>::new(channel, &region, settings, &mut rng);
    let around = (0..STEPS).map(|index| {
        let angle = f64::from(index) / f64::from(STEPS) * std::f64::consts::TAU;
        let [x, y] = [1500.0 + 1000.0 * angle.cos(), 1500.0 + 1000.0 * angle.sin()];
        let distance = ((x - 1200.0).powi(2) + (y - 900.0).powi(2) + 250_000.0).sqrt();
        Measurement::new([x, y], 500.0, 39.5 + 20.0 * distance.log10()).expect("a loss")
    });
    let around: Vec<_> = around.collect();
    let lap = fastest(if L < 10_000 { 60 } else { 15 }, || {
        for measurement in &around {
            filter.measure(measurement, &mut rng).expect("a loss that particles explain");
            black_box(filter.moments());
        }
    });
    (L as f64, lap / f64::from(STEPS))
}

/// Reading rows of seven numbers.
fn rows() -> anyhow::Result<Curve> {
    let mut curve = Vec::new();
    for rows in [1_000, 10_000, 100_000, 500_000] {
        let mut file = String::from("t,ax,ay,az,gx,gy,gz\n");
        for row in 0..rows {
            let (t, sine) = (f64::from(row) * 0.005, f64::from(row).sin());
            let [a, b, c, d] = [-0.5, 0.1, 0.2, 0.3].map(|of| of * sine);
            writeln!(file, "{t:.6},{sine:.6},{a:.6},9.806650,{b:.6},{c:.6},{d:.6}")?;
        }
        let read = || Table::read(&Text::new(file.as_bytes())?).map(|table| table.lines.len());
        anyhow::ensure!(read()? == rows as usize, "not {rows} rows");
        curve.push((f64::from(rows), fastest(if rows < 100_000 { 100 } else { 7 }, read)));
    }
    Ok(curve)
}

/// Precise point positioning with the default filter over the first epochs of a synthetic day of GPS.
fn epochs() -> Curve {
    let day = Day::new(1, 0, &Rates::NONE);
    let receiver = Receiver {
        antenna: None,
        galileo_antenna: None,
        glonass_antenna: None,
        beidou_antenna: None,
        eccentricity: [0.0; 3],
        ocean_loading: None,
        pole: None,
        ut1_minus_gps: UTC_MINUS_GPS,
        corrections: Corrections::ALL,
    };
    let solve = |epochs: usize| {
        let mut filter = PppFilter::<STATES>::new(Config::new(Motion::Static));
        for epoch in &day.epochs[..epochs] {
            let seen = epoch.satellites.iter();
            let seen = seen.filter_map(|it| day.products.observation(epoch.time, it).ok());
            let seen: Vec<_> = seen.collect();
            black_box(filter.process(epoch.time, &receiver, &seen)).expect("a position");
        }
    };
    [90, 360, 1440, 2880].map(|epochs| (epochs as f64, fastest(7, || solve(epochs)))).into()
}

/// The processor time of the fastest round, s.
fn fastest<T>(rounds: usize, mut work: impl FnMut() -> T) -> f64 {
    let now = || Duration::try_from(clock_gettime(ClockId::ThreadCPUTime)).unwrap_or_default();
    let round = |_| {
        let begin = now();
        black_box(work());
        now().saturating_sub(begin).as_secs_f64()
    };
    (0..rounds).map(round).fold(f64::INFINITY, f64::min)
}
