//! √ in integers, for processors that only multiply 32 bits by 32 to 32 and have neither a root nor a division:
//! Newton's iteration for 1/√x, then a correction by the remainder of the root, which the product modulo 2³² gives
//! exactly.

/// √x, rounded to the nearest number.
pub(crate) fn sqrt(x: f32) -> f32 {
    const LEADING: u32 = 0x0080_0000;
    const INFINITY: u32 = 0x7f80_0000;
    let bits = x.to_bits();
    if bits << 1 == 0 || bits == INFINITY {
        return x;
    }
    if bits > INFINITY {
        return f32::NAN;
    }
    let (mut exponent, mut m) = (bits >> 23, bits & (LEADING - 1) | LEADING);
    if exponent == 0 {
        m ^= LEADING;
        exponent = 1;
        while m < LEADING {
            m <<= 1;
            exponent = exponent.wrapping_sub(1);
        }
    }
    // x = n·4^…, with n from 1 to 4 in 30 binary places; y = 1/√n in 16, with a straight line as its start.
    let is_odd = exponent & 1 != 0;
    let n = m << if is_odd { 7 } else { 8 };
    let (constant, slope) = if is_odd { (0x1_439e, 0x4950) } else { (0xe4d5, 0x33d7) };
    let mut y = constant - (((m >> 8) * slope) >> 15);
    for _ in 0..2 {
        let unity = (((y * y) >> 16) * (n >> 16)) >> 14;
        y = y.wrapping_add_signed((y as i32 * (0x1_0000 - unity as i32)) >> 17);
    }
    // The root with 15 places, then with 23, then rounded to nearest: it is never halfway between two numbers.
    let upper = ((n >> 16) * y) >> 15;
    let rest = n.wrapping_sub(upper * upper) as i32;
    let mut root = (upper << 8).wrapping_add_signed(((rest >> 5) * y as i32) >> 19);
    let rest = (n << 16).wrapping_sub(root.wrapping_mul(root)) as i32;
    if rest > root as i32 {
        root += 1;
    } else if rest <= -(root as i32) {
        root -= 1;
    }
    f32::from_bits(((exponent.wrapping_add(125) >> 1) << 23) + root)
}
