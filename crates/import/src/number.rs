//! Fast parsing of decimal numbers as logs mostly contain them: a sign, digits that form an integer below 2⁵³, a point.

/// Every integer below this is exactly a double.
const EXACT: u64 = 1 << 53;
/// The number of digits that always fit into 64 bits.
const MOST_DIGITS: usize = 19;
/// Powers of ten, all of which are exactly doubles.
const POWERS: [f64; MOST_DIGITS + 1] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19,
];
/// Powers of ten as integers.
const TENS: [u64; 9] = [1, 10, 100, 1_000, 10_000, 100_000, 1_000_000, 10_000_000, 100_000_000];

/// The number at the beginning of a text, correct to the last bit, and its length.
#[inline(always)] // As a call it takes half as long again: a log is hardly anything but numbers.
pub(crate) fn leading(text: &[u8]) -> Option<(f64, usize)> {
    plain(text).or_else(|| fast_float2::parse_partial(text).ok())
}

/// The number that an entire text represents.
pub(crate) fn whole(text: &[u8]) -> Option<f64> {
    leading(text).filter(|(_, length)| *length == text.len()).map(|(number, _)| number)
}

/// Fast path of [`leading`], for a number of few digits without an exponent.
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
    // The quotient of two exact doubles is rounded only once.
    let magnitude = mantissa as f64 / POWERS.get(decimals)?;
    // The sign is set by its bit: signs are unpredictable, so a branch would often be mispredicted.
    Some((f64::from_bits(magnitude.to_bits() | u64::from(is_negative) << 63), end))
}

#[inline(always)]
fn digit(text: &[u8], at: usize) -> Option<u64> {
    text.get(at).map(|byte| byte.wrapping_sub(b'0')).filter(|&it| it < 10).map(u64::from)
}

/// The number formed by the digits at the beginning of eight bytes, and how many digits these are.
#[inline(always)]
fn up_to_eight(chunk: [u8; 8]) -> (u64, usize) {
    let values = u64::from_le_bytes(chunk) ^ 0x3030_3030_3030_3030;
    // Sets the highest bit of each byte that is not a digit; bytes above the lowest such byte may be marked wrongly.
    let others = (values.wrapping_add(0x7676_7676_7676_7676) | values) & 0x8080_8080_8080_8080;
    let count = (others.trailing_zeros() / 8) as usize;
    // Zeros before the digits; then pairs, fours and all eight are combined.
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
