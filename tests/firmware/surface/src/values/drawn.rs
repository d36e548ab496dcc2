//! Values on the host: ordinary ones, with extreme ones among them.

use std::cell::Cell;
use std::fmt::Debug;

use kestirim_scalar::Scalar;

use super::Whole;

/// Whether everything is called with all numbers and sizes: on the host always.
pub const LONG_FORM: bool = true;

thread_local! {
    static STATE: Cell<u64> = const { Cell::new(1) };
    /// One value in this many is extreme.
    static TAME: Cell<u64> = const { Cell::new(1) };
}

/// Starts drawing from a seed, with one extreme value in `tame`.
pub fn start_from(seed: u64, tame: u64) {
    STATE.set(seed);
    TAME.set(tame.max(1));
}

/// Random bits by Vigna's splitmix64.
fn bits() -> u64 {
    let state = STATE.get().wrapping_add(0x9E37_79B9_7F4A_7C15);
    STATE.set(state);
    let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

fn below(limit: u64) -> u64 {
    bits() % limit.max(1)
}

fn is_wild() -> bool {
    below(TAME.get()) == 0
}

/// An arbitrary number.
pub fn number<T: Scalar>() -> T {
    let fraction = f64::from(bits() as u32) / f64::from(u32::MAX);
    if !is_wild() {
        return match below(8) {
            0 => T::ZERO,
            1 => T::ONE,
            2 => T::from_f64(6.0 * fraction - 3.0),
            3 => T::from_f64(100.0 * fraction),
            _ => T::from_f64(fraction),
        };
    }
    match below(12) {
        0 => T::from_f64(f64::NAN),
        1 => T::from_f64(f64::INFINITY),
        2 => T::from_f64(f64::NEG_INFINITY),
        3 => T::MAX,
        4 => T::MIN,
        5 => T::EPSILON,
        6 => -T::ZERO,
        7 => -T::EPSILON,
        8 => T::from_f64((fraction - 0.5) * 1e10),
        9 => T::from_f64((fraction - 0.5) * 1e4),
        10 => T::from_f32(f32::from_bits(bits() as u32)),
        _ => T::from_f64(f64::from_bits(bits())),
    }
}

/// An arbitrary integer.
pub fn whole<I: Whole>() -> I {
    let any = bits();
    I::of_bits(match if is_wild() { below(5) } else { 4 } {
        0 => any,
        1 => any >> 32,
        2 => u64::MAX - any % 3,
        3 => u64::MAX / 2 + any % 3,
        _ => any % 8,
    })
}

/// The number of times that a step is taken.
pub fn rounds() -> u32 {
    below(30) as u32
}

/// An arbitrary one of the choices.
pub fn one_of<T: Copy, const N: usize>(choices: [T; N]) -> T {
    choices[below(N as u64) as usize]
}

/// The value, or `None`.
pub fn maybe<T>(value: T) -> Option<T> {
    (below(4) > 0).then_some(value)
}

/// A prefix of arbitrary length of a slice.
pub fn slice<T>(values: &[T]) -> &[T] {
    &values[..below(values.len() as u64 + 1) as usize]
}

/// A prefix of arbitrary length of a slice.
pub fn slice_mut<T>(values: &mut [T]) -> &mut [T] {
    let length = below(values.len() as u64 + 1) as usize;
    &mut values[..length]
}

/// Takes a step that may be refused, in which case the state must be unchanged.
///
/// # Panics
/// It is not.
pub fn try_on<S: Debug, R, E: Debug>(state: &mut S, step: impl FnOnce(&mut S) -> Result<R, E>) {
    let before = format!("{state:?}");
    if let Err(error) = step(state) {
        assert_eq!(format!("{state:?}"), before, "{error:?}");
    }
}
