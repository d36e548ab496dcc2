//! Pairs of numbers for tests of the arithmetic: on the host, and in the image `arithmetic` under an emulator, which
//! includes this file and draws the same pairs.

/// Bits of edge cases: of exponents, of the representable range, of rounding.
pub(crate) fn edges() -> impl Iterator<Item = u32> + Clone {
    const EXPONENTS: [u32; 22] = [
        0, 1, 2, 24, 25, 26, 27, 63, 64, 102, 103, 104, 126, 127, 128, 150, 151, 191, 192, 253,
        254, 255,
    ];
    const FRACTIONS: [u32; 12] = [
        0, 1, 2, 0x0f_ffff, 0x2a_aaaa, 0x35_04f3, 0x3f_ffff, 0x40_0000, 0x40_0001, 0x55_5555,
        0x7f_fffe, 0x7f_ffff,
    ];
    EXPONENTS.into_iter().flat_map(|exponent| {
        FRACTIONS
            .into_iter()
            .flat_map(move |fraction| [0, 1].map(|sign| sign << 31 | exponent << 23 | fraction))
    })
}

/// A reproducible sequence of random pairs.
#[derive(Debug)]
pub(crate) struct Pairs {
    a: u32,
    b: u32,
    c: u32,
    counter: u32,
}

impl Pairs {
    /// The sequence of pairs for a seed.
    pub(crate) fn new(seed: u32) -> Self {
        let mut pairs = Self { a: seed, b: 0, c: 0x9e37_79b9, counter: 1 };
        for _ in 0..12 {
            pairs.draw();
        }
        pairs
    }

    /// Chris Doty-Humphrey's sfc32, which needs no multiplication: the emulated processor draws as many numbers as it
    /// tests.
    fn draw(&mut self) -> u32 {
        let sum = self.a.wrapping_add(self.b).wrapping_add(self.counter);
        self.counter = self.counter.wrapping_add(1);
        self.a = self.b ^ self.b >> 9;
        self.b = self.c.wrapping_add(self.c << 3);
        self.c = self.c.rotate_left(21).wrapping_add(sum);
        sum
    }

    /// The bits of the next two numbers: any bits in a quarter of the cases, otherwise exponents up to 31 apart; in
    /// half of the cases few significant digits, which lead to ties and exact results.
    pub(crate) fn pair(&mut self) -> (u32, u32) {
        let (mut a, mut b, shape) = (self.draw(), self.draw(), self.draw());
        if shape & 3 != 0 {
            let near = (a >> 23).wrapping_add(shape >> 8 & 63).wrapping_sub(32) & 0xff;
            b = b & 0x807f_ffff | near << 23;
        }
        if shape & 4 != 0 {
            a &= u32::MAX << (shape >> 16 & 15);
            b &= u32::MAX << (shape >> 20 & 31);
        }
        (a, b)
    }
}

/// A name, and an operation on a pair.
pub(crate) type Operation = (&'static str, fn(f32, f32) -> f32);

/// The operations for which a processor without a floating-point unit calls routines; the function for the root is
/// given.
pub(crate) const fn operations(root: fn(f32, f32) -> f32) -> [Operation; 7] {
    [
        ("sum", |a, b| a + b),
        ("difference", |a, b| a - b),
        ("product", |a, b| a * b),
        ("quotient", |a, b| a / b),
        ("root", root),
        ("order", order),
        ("integers", integers),
    ]
}

/// All comparisons of two numbers, as the bits of one.
fn order(a: f32, b: f32) -> f32 {
    let answers = [a < b, a <= b, a > b, a >= b, a == b, a != b, a.partial_cmp(&b).is_none()];
    f32::from_bits(answers.iter().fold(0, |bits, &answer| bits << 1 | u32::from(answer)))
}

/// Conversions from integers and to integers, combined in one number.
fn integers(a: f32, b: f32) -> f32 {
    let (bits, whole) = (b.to_bits(), a as i32 as u32);
    let back = (bits as i32 as f32).to_bits() ^ (bits as f32).to_bits().rotate_left(13);
    f32::from_bits(whole ^ (a as u32).rotate_left(7) ^ back)
}

/// A digest of all results, which changes if any bit of one differs. All NaN count as equal.
pub(crate) fn digest(
    pairs: impl Iterator<Item = (u32, u32)>,
    operation: fn(f32, f32) -> f32,
) -> u32 {
    pairs.fold(0, |digest: u32, (a, b)| {
        let result = operation(f32::from_bits(a), f32::from_bits(b));
        let bits = if result.is_nan() { 0x7fc0_0000 } else { result.to_bits() };
        (digest.rotate_left(5) ^ bits).wrapping_mul(0x9e37_79b1)
    })
}

/// The digest for `count` random pairs of a seed; for all pairs of edge cases if `count` is zero.
pub(crate) fn digest_of(seed: u32, count: u32, operation: fn(f32, f32) -> f32) -> u32 {
    if count == 0 {
        return digest(edges().flat_map(|a| edges().map(move |b| (a, b))), operation);
    }
    let mut pairs = Pairs::new(seed);
    digest((0..count).map(|_| pairs.pair()), operation)
}
