//! Decimal numbers as logs mostly write them: a sign, digits that make an integer below 2⁵³, a point.

/// Below this every integer is a double.
const EXACT: u64 = 1 << 53;
/// As many digits fit into 64 bits, whatever they are.
const MOST_DIGITS: usize = 19;
/// Powers of ten, which all are doubles.
const POWERS: [f64; MOST_DIGITS + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19,
];
/// The same as integers.
const TENS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// The number that a text begins with, to the last bit, and its length.
#[inline(always)] // As a call it takes half as long again: a log is hardly anything but numbers.
pub(crate) fn leading(text: &[u8]) -> Option<(f64, usize)> {
    plain(text).or_else(|| fast_float2::parse_partial(text).ok())
}

/// The number that a text is.
pub(crate) fn whole(text: &[u8]) -> Option<f64> {
    leading(text).filter(|(_, length)| *length == text.len()).map(|(number, _)| number)
}

/// As [`leading`], of a number of few digits without an exponent.
#[inline(always)]
fn plain(text: &[u8]) -> Option<(f64, usize)> {
    let is_negative = text.first() == Some(&b'-');
    let start = usize::from(is_negative);
    let (mut mantissa, mut end) = (0_u64, start);
    while let Some(digit) = digit(text, end) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
        end += 1;
    }
    let (mut count, mut decimals) = (end - start, 0);
    if text.get(end) == Some(&b'.') {
        end += 1;
        let begin = end;
        if let Some(chunk) = text.get(end..).and_then(<[u8]>::first_chunk::<8>) {
            let (digits, length) = up_to_eight(*chunk);
            mantissa = mantissa.wrapping_mul(TENS[length]).wrapping_add(digits);
            end += length;
        }
        while let Some(digit) = digit(text, end) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
            end += 1;
        }
        decimals = end - begin;
        count += decimals;
    }
    let is_whole = !matches!(text.get(end), Some(b'e' | b'E'));
    if count == 0 || count > MOST_DIGITS || mantissa >= EXACT || !is_whole {
        return None;
    }
    // Two doubles without error make a quotient that is rounded once.
    let magnitude = mantissa as f64 / POWERS.get(decimals)?;
    // By its bit: signs come as they like, and no branch could be foreseen.
    Some((f64::from_bits(magnitude.to_bits() | u64::from(is_negative) << 63), end))
}

#[inline(always)]
fn digit(text: &[u8], at: usize) -> Option<u64> {
    text.get(at).map(|byte| byte.wrapping_sub(b'0')).filter(|&it| it < 10).map(u64::from)
}

/// The number of which the digits are that eight bytes begin with, and how many these are.
#[inline(always)]
fn up_to_eight(chunk: [u8; 8]) -> (u64, usize) {
    let values = u64::from_le_bytes(chunk) ^ 0x3030_3030_3030_3030;
    // The highest bit of each byte that is no digit; of those above the lowest such byte some may be wrong.
    let others = (values.wrapping_add(0x7676_7676_7676_7676) | values) & 0x8080_8080_8080_8080;
    let count = (others.trailing_zeros() / 8) as usize;
    // Zeros in front of the digits; pairs, then fours, then all.
    let digits = if count == 0 { 0 } else { values << (64 - 8 * count) };
    let pairs = (digits.wrapping_mul(1 + (10 << 8)) >> 8) & 0x00ff_00ff_00ff_00ff;
    let fours = (pairs.wrapping_mul(1 + (100 << 16)) >> 16) & 0x0000_ffff_0000_ffff;
    (fours.wrapping_mul(1 + (10_000 << 32)) >> 32, count)
}

#[cfg(test)]
mod tests {
    use rand_core::{Rng, SeedableRng};
    use rand_xoshiro::Xoshiro256PlusPlus;

    use super::*;

    fn slowly(text: &[u8]) -> Option<(u64, usize)> {
        let number: Option<(f64, usize)> = fast_float2::parse_partial(text).ok();
        number.map(|(number, length)| (number.to_bits(), length))
    }

    fn found(text: &[u8]) -> Option<(u64, usize)> {
        leading(text).map(|(number, length)| (number.to_bits(), length))
    }

    #[test]
    fn numbers_are_those_of_the_slow_way_to_the_last_bit() {
        let texts = [
            "0",
            "-0",
            "-0.0",
            "1",
            "12345678",
            "123456789",
            "1234567.12345678",
            "9007199254740993",
            "0.1",
            "-9.806650",
            ".5",
            "5.",
            "-.5",
            "1e5",
            "1.5E-3",
            "1e",
            "1.e5",
            "+2",
            "-",
            ".",
            "-.",
            "",
            "nan",
            "inf",
            "1.2.3",
            "12,5",
            "1 2",
            "00000000000000000000001",
            "18446744073709551616.5",
            "0.00000000000000000001",
            "3\u{e9}",
            "1234567\u{ff}",
        ];
        for text in texts {
            assert_eq!(found(text.as_bytes()), slowly(text.as_bytes()), "{text}");
        }
        assert_eq!((whole(b"1.5"), whole(b"1.5 "), whole(b"")), (Some(1.5), None, None));
    }

    #[test]
    fn any_text_is_read_as_the_slow_way_reads_it() {
        const LETTERS: &[u8] = b"0123456789012345678901234567890123456789...--+eE, \n\xff";
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        for _ in 0..200_000 {
            let length = rng.next_u32() as usize % 24;
            let letter = |_| LETTERS[rng.next_u32() as usize % LETTERS.len()];
            let text: Vec<_> = (0..length).map(letter).collect();
            assert_eq!(found(&text), slowly(&text), "{:?}", String::from_utf8_lossy(&text));
        }
    }
}
