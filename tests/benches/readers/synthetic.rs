//! Synthetic files for the readers.

use std::fmt::Write as _;
use std::path::Path;

use kestirim_gnss_files::Observed;
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_replay::gnss::Products;
use kestirim_simulate::gnss::{Day, EPOCHS, INTERVAL_S, MIDNIGHT, Rates};

use crate::Files;

/// A pseudo-random number between −1 and 1.
fn random(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 * 2.0_f64.powi(-52) - 1.0
}

/// A log of a sensor that lies still, for a thousand seconds at 200 Hz.
pub(crate) fn walk() -> Vec<u8> {
    let mut text = String::from("t,ax,ay,az,gx,gy,gz\n");
    let mut state = 88_172_645_463_325_252;
    for sample in 0..200_000 {
        let mut noise = |size: f64| size * random(&mut state);
        let (force, rate) = ([(); 3].map(|()| noise(0.1)), [(); 3].map(|()| noise(0.01)));
        let ([ax, ay, az], [gx, gy, gz]) = (force, rate);
        let (t, az) = (f64::from(sample) * 0.005, 9.806_65 + az);
        let _ = writeln!(text, "{t:.6},{ax:.6},{ay:.6},{az:.6},{gx:.6},{gy:.6},{gz:.6}");
    }
    text.into_bytes()
}

/// A log of ranges to four anchors.
pub(crate) fn ranges() -> Vec<u8> {
    let mut text = String::from("t,anchor,range\n");
    let mut state = 88_172_645_463_325_252;
    for row in 0..500_000 {
        let (t, range) = (f64::from(row / 4) * 0.02, 6.0 + 3.0 * random(&mut state));
        let _ = writeln!(text, "{t:.3},A{},{range:.3}", row % 4);
    }
    text.into_bytes()
}

/// A station's day with the products of its satellites, in RINEX and SP3.
pub(crate) fn day(folder: &Path) -> anyhow::Result<Files> {
    let day = Day::new(1, 0, &Rates::RECORDING);
    let file = |name: &str, text: String| {
        let path = folder.join(name);
        std::fs::write(&path, text).map(|()| path)
    };
    Ok(Files {
        obs: file("day.19o", observations(&day))?,
        sp3: vec![file("day.sp3", orbits(&day.products))?],
        clk: vec![file("day.clk", clocks(&day.products))?],
        antex: Vec::new(),
        nav: Some(file("day.19n", navigation())?),
    })
}

/// A line of a header.
fn header(content: &str, label: &str) -> String {
    format!("{content:<60}{label}\n")
}

/// The date and time `second` seconds after [`MIDNIGHT`], which begins 1 September 2019.
fn date(second: f64, zeros: bool) -> String {
    let (month, day) = match (second / 86_400.0).floor() {
        ..0.0 => (8, 31),
        0.0 => (9, 1),
        _ => (9, 2),
    };
    let second = second.rem_euclid(86_400.0);
    let (hour, minute) = ((second / 3600.0) as u32, (second / 60.0) as u32 % 60);
    let second = second % 60.0;
    if zeros {
        format!("2019 {month:02} {day:02} {hour:02} {minute:02} {second:010.7}")
    } else {
        format!("2019 {month:2} {day:2} {hour:2} {minute:2} {second:9.6}")
    }
}

/// RINEX 3 with codes, phases, Doppler shifts and strengths.
fn observations(day: &Day) -> String {
    let mut text = header("     3.04           OBSERVATION DATA    G", "RINEX VERSION / TYPE")
        + &header("SYNTHETIC", "MARKER NAME")
        + &header("G    8 C1W L1W D1W S1W C2W L2W D2W S2W", "SYS / # / OBS TYPES")
        + &header("", "END OF HEADER");
    for epoch in &day.epochs {
        let count = epoch.satellites.len();
        let at = date(epoch.time.since(MIDNIGHT), true);
        let _ = writeln!(text, "> {at}  0 {count:2}");
        for it in &epoch.satellites {
            let _ = write!(text, "G{:02}", it.prn);
            for carrier in 0..2 {
                let [code, phase] =
                    [it.code[carrier], it.phase[carrier]].map(Option::unwrap_or_default);
                let lock = if it.loss_of_lock[carrier] { '1' } else { ' ' };
                let _ = write!(
                    text,
                    "{code:14.3}  {phase:14.3}{lock} {:14.3}  {:14.3}  ",
                    1234.5, 45.25
                );
            }
            text.truncate(text.trim_end().len());
            text.push('\n');
        }
    }
    text
}

/// The position (ECEF, m) and clock (s) of a satellite `second` seconds after midnight, from the products.
fn state(products: &Products, prn: u8, second: f64) -> Option<([f64; 3], f64)> {
    let time = MIDNIGHT.plus(second);
    // A signal that arrives at the moment of its transmission: first by the satellite's clock, then by GPS time.
    let at = |code: f64| {
        let observed =
            Observed { prn, code: [Some(code); 2], phase: [Some(0.0); 2], ..Observed::default() };
        products.observation(time, &observed).ok().map(|it| it.state)
    };
    let clock = at(0.0)?.clock;
    let state = at(-clock * SPEED_OF_LIGHT)?;
    Some((state.position.into(), clock))
}

fn orbits(products: &Products) -> String {
    let known = |second| (1..=32).filter(move |prn| state(products, *prn, second).is_some());
    let mut text = orbits_header(&known(0.0).collect::<Vec<_>>());
    for step in -8..=104 {
        let second = f64::from(step) * 900.0;
        if known(second).next().is_none() {
            continue;
        }
        let _ = writeln!(text, "*  {}00", date(second, false));
        for prn in known(second) {
            let Some((position, clock)) = state(products, prn, second) else { continue };
            let [x, y, z] = position.map(|it| it / 1e3);
            let _ = writeln!(text, "PG{prn:02}{x:14.6}{y:14.6}{z:14.6}{:14.6}", clock * 1e6);
        }
    }
    text + "EOF\n"
}

/// The 22 header lines of SP3-c.
fn orbits_header(satellites: &[u8]) -> String {
    let mut text = String::from(
        "#cP2019  9  1  0  0  0.00000000     113 MADE  IGS14 FIT HERE\n\
         ## 2069      0.00000000   900.00000000 58727 0.0000000000000\n",
    );
    for line in 0..5 {
        let count = if line == 0 { satellites.len().to_string() } else { String::new() };
        let _ = write!(text, "+  {count:>3}   ");
        for place in 17 * line..17 * (line + 1) {
            match satellites.get(place) {
                Some(prn) => drop(write!(text, "G{prn:02}")),
                None => text.push_str("  0"),
            }
        }
        text.push('\n');
    }
    text + &format!("++       {}\n", "  0".repeat(17)).repeat(5)
        + "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n\
           %c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n"
        + &"%f  0.0000000  0.000000000  0.00000000000  0.000000000000000\n".repeat(2)
        + &"%i    0    0    0    0      0      0      0      0         0\n".repeat(2)
        + &"/* SYNTHETIC\n".repeat(4)
}

fn clocks(products: &Products) -> String {
    let mut text = header("     3.00           CLOCK DATA          G", "RINEX VERSION / TYPE")
        + &header("", "END OF HEADER");
    for epoch in 0..=EPOCHS {
        let second = f64::from(epoch) * INTERVAL_S;
        for prn in 1..=32 {
            let Some((_, clock)) = state(products, prn, second) else { continue };
            let (at, clock) = (date(second, false), exponential(clock));
            let _ = writeln!(text, "AS G{prn:02}  {at}  1   {clock}");
        }
    }
    text
}

/// A number in Fortran's format E19.12, 19 characters wide.
fn exponential(number: f64) -> String {
    let text = format!("{number:.11e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let exponent: i32 = exponent.parse().unwrap_or_default();
    let (sign, digits) = digits.strip_prefix('-').map_or((" ", digits), |digits| ("-", digits));
    // The point precedes all digits.
    let (exponent, digits) = (exponent + i32::from(number != 0.0), digits.replace('.', ""));
    let mark = if exponent < 0 { '-' } else { '+' };
    format!("{sign}0.{digits}E{mark}{:02}", exponent.abs())
}

/// Empty ephemerides: RTKLIB needs some, even where it uses precise orbits.
fn navigation() -> String {
    let mut text = header("     2.11           N: GPS NAV DATA", "RINEX VERSION / TYPE")
        + &header("", "END OF HEADER");
    for hour in (0..24).step_by(2) {
        for prn in 1..=32 {
            let toe = f64::from(hour) * 3600.0;
            let _ = write!(text, "{prn:2} 19  9  1 {hour:2}  0  0.0");
            let lines = [
                [0.0; 4],
                [1.0, 0.0, 4e-9, 0.0],
                [0.0, 0.005, 0.0, 5153.6],
                [toe, 0.0, 0.0, 0.0],
                [0.96, 0.0, 0.0, -8e-9],
                [0.0, 0.0, 2069.0, 0.0],
                [2.0, 0.0, 0.0, 1.0],
                [toe, 4.0, 0.0, 0.0],
            ];
            for (place, line) in lines.iter().enumerate() {
                let numbers = if place == 0 { &line[1..] } else { &line[..] };
                let indent = if place == 0 { "" } else { "   " };
                let numbers: String = numbers.iter().map(|number| exponential(*number)).collect();
                let _ = writeln!(text, "{indent}{numbers}");
            }
        }
    }
    text
}
