//! Sums, products and quotients in integers as IEEE 754 defines them, rounded to nearest, ties to even, for all numbers
//! including subnormal ones, infinities and NaN. They work on bits, so that nothing here calls the routines it
//! implements. Sums and products are short rather than fast: they handle what the assembler leaves out.

const SIGN: u32 = 0x8000_0000;
const INFINITY: u32 = 0x7f80_0000;
const LEADING: u32 = 0x0080_0000;
const NAN: u32 = 0x7fc0_0000;

/// Exponent and 24-bit integer of a finite number, which is the integer times 2^(exponent − 150). The leading bit of
/// the integer is 1, except for zero.
#[inline(never)]
fn parts(x: u32) -> (i32, u32) {
    let mut exponent = ((x & INFINITY) >> 23) as i32;
    let mut integer = x & (LEADING - 1) | LEADING;
    if exponent == 0 {
        exponent = 1;
        integer ^= LEADING;
        while integer != 0 && integer < LEADING {
            integer <<= 1;
            exponent -= 1;
        }
    }
    (exponent, integer)
}

/// x shifted right by `by` bits; the last bit is set if any lost bit was.
#[inline(never)]
fn shifted(x: u32, by: u32) -> u32 {
    let kept = x.checked_shr(by).unwrap_or(0);
    kept | u32::from(kept.checked_shl(by).unwrap_or(0) != x)
}

/// The number nearest to m·2^(exponent − 158), with the given sign.
#[inline(never)]
fn rounded(sign: u32, mut exponent: i32, mut m: u32) -> u32 {
    while m & SIGN == 0 && exponent > 1 {
        m <<= 1;
        exponent -= 1;
    }
    if exponent < 1 {
        m = shifted(m, exponent.abs_diff(1));
        exponent = 1;
    }
    if exponent >= 255 {
        return sign | INFINITY;
    }
    let even = m >> 8 & 1;
    // The leading bit adds to the exponent, and so does a carry, which may give infinity.
    let magnitude = ((exponent as u32 - 1) << 23) + (m >> 8) + u32::from((m & 0xff) + even > 0x80);
    sign | magnitude
}

/// a + b, on bits.
pub(crate) fn add(mut a: u32, mut b: u32) -> u32 {
    if a << 1 < b << 1 {
        (a, b) = (b, a);
    }
    let sign = a & SIGN;
    let negative = (a ^ b) & SIGN != 0;
    if negative && a << 1 == b << 1 {
        return if a << 1 < INFINITY << 1 { 0 } else { NAN };
    }
    if a << 1 >= INFINITY << 1 {
        return if a << 1 > INFINITY << 1 { NAN } else { a };
    }
    let ((exponent, m), (of_b, n)) = (parts(a), parts(b));
    let n = shifted(n << 7, exponent.abs_diff(of_b));
    let m = m << 7;
    rounded(sign, exponent + 1, if negative { m - n } else { m + n })
}

/// a · b, on bits.
pub(crate) fn multiply(mut a: u32, mut b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    (a, b) = (a & !SIGN, b & !SIGN);
    if a < b {
        (a, b) = (b, a);
    }
    if a >= INFINITY {
        return if a > INFINITY || b == 0 { NAN } else { sign | INFINITY };
    }
    let ((of_a, m), (of_b, n)) = (parts(a), parts(b));
    // In halves of 12 bits. Of the 48 bits of the product the first 31 are kept, the last of which also stands for the
    // rest.
    let (m1, m0, n1, n0) = (m >> 12, m & 0xfff, n >> 12, n & 0xfff);
    let middle = m1 * n0 + m0 * n1 + ((m0 * n0) >> 12);
    let lost = middle << 27 | (m0 * n0) << 20;
    let upper = (((m1 * n1) << 7) + (middle >> 5)) | u32::from(lost != 0);
    rounded(sign, of_a + of_b - 125, upper)
}

/// a / b, on bits.
pub(crate) fn divide(mut a: u32, mut b: u32) -> u32 {
    let sign = (a ^ b) & SIGN;
    (a, b) = (a & !SIGN, b & !SIGN);
    if a > INFINITY || b > INFINITY || a == b && (a == 0 || a == INFINITY) {
        return NAN;
    }
    if a == INFINITY || b == 0 {
        return sign | INFINITY;
    }
    if a == 0 || b == INFINITY {
        return sign;
    }
    let ((of_a, m), (of_b, n)) = (parts(a), parts(b));
    // 2³⁹/n, from a straight line and by Newton's iteration.
    let digits = n >> 8;
    let mut y = 0x1_67a7 - ((digits * 0x771f) >> 15);
    for _ in 0..2 {
        let unity = (digits * y) >> 15;
        y = y.wrapping_add_signed((y as i32 * (0x1_0000 - unity as i32)) >> 16);
    }
    // The quotient with 15 binary places, then with 25. Remainders are small, so products modulo 2³² give them exactly.
    let upper = ((m >> 8) * y) >> 16;
    let rest = (m << 15).wrapping_sub(upper.wrapping_mul(n)) as i32;
    let mut quotient = (upper << 10).wrapping_add_signed(((rest >> 11) * y as i32) >> 18);
    let mut rest = (m << 25).wrapping_sub(quotient.wrapping_mul(n)) as i32;
    if rest < 0 {
        quotient -= 1;
        rest += n as i32;
    } else if rest >= n as i32 {
        quotient += 1;
        rest -= n as i32;
    }
    rounded(sign, of_a - of_b + 127, quotient << 6 | u32::from(rest != 0))
}
