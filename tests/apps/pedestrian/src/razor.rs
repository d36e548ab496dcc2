//! The Razor's text log: a line has ms, 3 × g, 3 × °/s, separated by blanks.

use core::fmt::{Result, Write};

use crate::Counts;

/// The longest line, bytes.
pub(crate) const LONGEST: usize = 80;

/// Writes a line at the sensor's resolution: 0.0001 g and 0.01 °/s.
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

/// Converts a count to the sensor's unit, rounded.
fn rounded(count: i32) -> i32 {
    let half = Counts::PER_UNIT / 2;
    (if count < 0 { count - half } else { count + half }) / Counts::PER_UNIT
}

/// Writes a blank, and `number` / `scale` with its decimals. (Formatting an `f32` takes 10 kB of flash.)
fn decimal(text: &mut impl Write, number: i32, scale: u32, decimals: usize) -> Result {
    let sign = if number < 0 { "-" } else { "" };
    let (whole, part) = (number.unsigned_abs() / scale, number.unsigned_abs() % scale);
    write!(text, " {sign}{whole}.{part:0decimals$}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use heapless::String;

    #[test]
    fn every_count_is_written_to_half_a_decimal() {
        for count in i16::MIN..=i16::MAX {
            let mut text = String::<LONGEST>::new();
            line(&mut text, u64::MAX, &Counts { accel: [count; 3], gyro: [count; 3] }).unwrap();
            let mut fields = text.split_ascii_whitespace().map(str::parse::<f64>);
            fields.next();
            let (unit, mut field) = (f64::from(count) / 2048.0, || fields.next().unwrap().unwrap());
            for _ in 0..3 {
                assert!((field() - unit).abs() <= 0.5e-4 + 1e-9, "{text}");
            }
            for _ in 0..3 {
                assert!((field() - unit * 125.0).abs() <= 0.5e-2 + 1e-9, "{text}");
            }
        }
    }
}
