//! A line of the Razor's text log: ms, 3 × g, 3 × °/s, separated by blanks.

use core::fmt::{Result, Write};

use crate::Counts;

/// The longest line.
pub(crate) const LONGEST: usize = 96;

/// Writes a line, with what the sensor resolves: 0.0001 g and 0.01 °/s.
pub(crate) fn line(text: &mut impl Write, time_us: u64, counts: &Counts) -> Result {
    write!(text, "{}", time_us / 1_000)?;
    for count in counts.accel {
        decimal(text, rounded(i32::from(count) * 10_000), 10_000, 4)?;
    }
    for count in counts.gyro {
        decimal(text, rounded(i32::from(count) * Counts::GYRO_UNIT * 100), 100, 2)?;
    }
    text.write_str("\r\n")
}

/// A count of the sensor's in its unit.
fn rounded(count: i32) -> i32 {
    let half = Counts::PER_UNIT / 2;
    (if count < 0 { count - half } else { count + half }) / Counts::PER_UNIT
}

/// A blank, and `number` / `scale` with its decimals. (Formatting an `f32` takes 10 kB of flash.)
fn decimal(text: &mut impl Write, number: i32, scale: u32, decimals: usize) -> Result {
    let sign = if number < 0 { "-" } else { "" };
    let (whole, part) = (number.unsigned_abs() / scale, number.unsigned_abs() % scale);
    write!(text, " {sign}{whole}.{part:0decimals$}")
}
