//! Parsing of numbers from bytes.

/// Every integer below this is exactly a double.
const EXACT: u64 = 1 << 53;
/// The powers of ten that are exactly doubles.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// The double nearest to a decimal number, whose exponent may be marked E or, as Fortran writes it, D. `None` for
/// anything else, and beyond the range of doubles.
pub(crate) fn decimal(field: &[u8]) -> Option<f64> {
    let (negative, digits) = signed(field);
    let magnitude = plain(digits).or_else(|| with_exponent(digits))?;
    Some(if negative { -magnitude } else { magnitude })
}

/// Parses a number whose digits and power of ten are exactly doubles, so that their quotient is rounded once.
#[inline]
fn plain(digits: &[u8]) -> Option<f64> {
    let (mut mantissa, mut point) = (0_u64, None);
    for (place, &byte) in digits.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if byte == b'.' && point.is_none() {
            point = Some(place);
        } else {
            return None;
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    let power = POWERS.get(point.map_or(0, |point| digits.len() - 1 - point))?;
    ((1..=19).contains(&count) && mantissa < EXACT).then(|| mantissa as f64 / power)
}

fn with_exponent(digits: &[u8]) -> Option<f64> {
    let (mut mantissa, mut count, mut decimals, mut exponent) = (0_u64, 0, None, 0);
    for (i, &byte) in digits.iter().enumerate() {
        match byte {
            b'0'..=b'9' => {
                mantissa = mantissa.wrapping_mul(10).wrapping_add(u64::from(byte - b'0'));
                count += 1;
            }
            b'.' if decimals.is_none() => decimals = Some(count),
            b'E' | b'e' | b'D' | b'd' => {
                exponent = integer(&digits[i + 1..])?;
                break;
            }
            _ => return None,
        }
    }
    if count == 0 {
        return None;
    }
    let scale = exponent.checked_sub(decimals.map_or(0, |before| count - before))?;
    let power = POWERS.get(scale.unsigned_abs() as usize);
    match power {
        // The product or quotient of two exact doubles is rounded once.
        Some(power) if count <= 19 && mantissa < EXACT => {
            let mantissa = mantissa as f64;
            Some(if scale < 0 { mantissa / power } else { mantissa * power })
        }
        _ => slowly(digits),
    }
}

fn slowly(digits: &[u8]) -> Option<f64> {
    let text: String = digits
        .iter()
        .map(|byte| if byte.eq_ignore_ascii_case(&b'd') { 'e' } else { char::from(*byte) })
        .collect();
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// Parses a 32-bit integer; `None` for anything else.
pub(crate) fn integer(field: &[u8]) -> Option<i32> {
    large_integer(field)?.try_into().ok()
}

/// Parses a 64-bit integer; `None` for anything else.
pub(crate) fn large_integer(field: &[u8]) -> Option<i64> {
    let (negative, digits) = signed(field);
    let mut number = 0_i64;
    for &byte in digits {
        let digit = byte.checked_sub(b'0').filter(|&digit| digit < 10)?;
        number = number.checked_mul(10)?.checked_add(i64::from(digit))?;
    }
    let number = if negative { -number } else { number };
    (!digits.is_empty()).then_some(number)
}

fn signed(field: &[u8]) -> (bool, &[u8]) {
    match field.strip_prefix(b"-") {
        Some(digits) => (true, digits),
        None => (false, field.strip_prefix(b"+").unwrap_or(field)),
    }
}

/// The first blank-separated field, and the rest of the bytes.
pub(crate) fn first_field(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let begin = bytes.iter().position(|byte| !byte.is_ascii_whitespace())?;
    let rest = bytes.get(begin..)?;
    let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
    rest.split_at_checked(end)
}

/// The blank-separated fields.
pub(crate) fn blank_separated(bytes: &[u8]) -> impl Iterator<Item = &[u8]> {
    bytes.split(u8::is_ascii_whitespace).filter(|field| !field.is_empty())
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::system::satellite;

    #[test]
    fn numbers_as_files_write_them() {
        assert_eq!(decimal(b"24129473.423"), Some(24_129_473.423));
        assert_eq!(decimal(b"-.25"), Some(-0.25));
        assert_eq!(decimal(b"+3."), Some(3.0));
        assert_eq!(decimal(b"0.159438015248E-04"), Some(0.159_438_015_248e-4));
        assert_eq!(decimal(b"0.159438015248D-04"), Some(0.159_438_015_248e-4));
        assert_eq!(decimal(b"12345678901234567890123"), Some(12_345_678_901_234_567_890_123.0));
        assert_eq!(decimal(b"1D-300"), Some(1e-300));
    }

    #[test]
    fn anything_else_is_no_number() {
        let junk: [&[u8]; 12] = [
            b"",
            b"-",
            b".",
            b"E5",
            b"1E",
            b"nan",
            b"inf",
            b"1e999",
            b"1.2.3",
            b"12\xff",
            b"1 2",
            b"1e99999999999",
        ];
        for field in junk {
            assert_eq!(decimal(field), None, "{field:?}");
        }
        assert_eq!(integer(b"-17"), Some(-17));
        assert_eq!(integer(b"1.0"), None);
        assert_eq!(integer(b"99999999999"), None);
    }

    proptest! {
        #[test]
        fn decimals_are_read_as_the_standard_library_reads_them(number: f64, places in 0_usize..20) {
            for text in [format!("{number:e}"), format!("{:.places$}", number % 1e15)] {
                let expected = text.parse().ok().filter(|number: &f64| number.is_finite());
                prop_assert_eq!(decimal(text.as_bytes()), expected);
            }
        }

        #[test]
        fn no_bytes_are_too_wild(bytes: Vec<u8>) {
            let _ = (decimal(&bytes), integer(&bytes), satellite(&bytes));
        }
    }
}
