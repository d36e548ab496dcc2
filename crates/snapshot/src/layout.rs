use core::fmt;

use kestirim_scalar::Scalar;

/// What an estimator's stored state is: a snapshot of anything else is refused.
///
/// Whoever changes a field of an estimator, or of what it is made of, raises its [`Layout::VERSION`].
pub trait Layout {
    /// The estimator, as people know it: up to 16 letters, such as `pedestrian/ekf`.
    const NAME: &'static str;
    /// Raised with each change of what is stored.
    const VERSION: u16;
    /// Whether all its floats are finite, always. Otherwise it has logarithms of probabilities, and −∞ is loaded, too; NaN
    /// and +∞ never are.
    const IS_FINITE: bool = true;

    /// The numbers that it computes in.
    fn number() -> Number;
    /// Its sizes: const parameters such as the number of states, and the [`Name::code`](crate::Name::code) of parts
    /// that may be exchanged; 0 where there are none.
    fn sizes() -> [u32; 4];
}

/// A format of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Number(u8);

impl Number {
    const FIXED: u8 = 0x80;

    /// The format of a scalar.
    pub fn of<T: Scalar>() -> Self {
        // Of f64 there is nothing left at 2⁻³⁰.
        let epsilon = T::EPSILON.to_binary(-30);
        let fraction = 30_u32.saturating_sub(epsilon.unsigned_abs().checked_ilog2().unwrap_or(0));
        let is_fixed = !T::MAX.is_finite();
        match (size_of::<T>(), is_fixed) {
            (8, _) => Self(52),
            (_, true) => Self(fraction as u8 | Self::FIXED),
            (_, false) => Self(fraction as u8),
        }
    }

    pub(crate) const fn from_byte(byte: u8) -> Self {
        Self(byte)
    }

    pub(crate) const fn to_byte(self) -> u8 {
        self.0
    }
}

impl fmt::Display for Number {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            23 => formatter.write_str("f32"),
            52 => formatter.write_str("f64"),
            byte if byte & Self::FIXED != 0 => {
                let fraction = byte & !Self::FIXED;
                write!(formatter, "Q{}.{fraction}", 32_u8.saturating_sub(fraction))
            }
            byte => write!(formatter, "numbers of format {byte}"),
        }
    }
}

/// Implements [`Layout`]: `[parameters] for estimator as name, version, scalar, [sizes]`, and `, infinite` where
/// floats may be −∞.
///
/// ```
/// # use kestirim_scalar::Scalar;
/// struct Mean<T, const N: usize>([T; N]);
///
/// kestirim_snapshot::layout! {
///     [T: Scalar, const N: usize] for Mean<T, N> as "mean", 1, T, [N]
/// }
/// ```
#[macro_export]
macro_rules! layout {
    ($([$($parameters:tt)*] for $estimator:ty as $name:expr, $version:expr, $scalar:ty, [$($size:expr),*]
        $(, $infinite:ident)?);* $(;)?) => {
        $(impl<$($parameters)*> $crate::Layout for $estimator {
            const NAME: &'static str = $name;
            const VERSION: u16 = $version;
            $($crate::layout!(@$infinite);)?

            fn number() -> $crate::Number {
                $crate::Number::of::<$scalar>()
            }

            fn sizes() -> [u32; 4] {
                let mut all = [0; 4];
                let sizes: &[u32] = &[$($size as u32),*];
                for (size, &own) in all.iter_mut().zip(sizes) {
                    *size = own;
                }
                all
            }
        })*
    };
    (@infinite) => { const IS_FINITE: bool = false; };
}
