use core::fmt;

use kestirim_scalar::Scalar;

/// Identification of an estimator's stored state: a snapshot of anything else is refused.
///
/// A change to a field of an estimator, or to one of its parts, requires a higher [`Layout::VERSION`].
pub trait Layout {
    /// Name of the estimator for people: up to 16 letters, such as `pedestrian/ekf`.
    const NAME: &'static str;
    /// Version of the stored form, to be raised with each change of it.
    const VERSION: u16;
    /// Whether all floats of the estimator are always finite. If not, it has logarithms of probabilities, and −∞ is
    /// loaded, too; NaN and +∞ never are.
    const IS_FINITE: bool = true;

    /// The number format that the estimator computes in.
    fn number() -> Number;
    /// Sizes of the estimator: const parameters such as the number of states, and the [`Name::code`](crate::Name::code)
    /// of parts that may be exchanged; 0 for unused places.
    fn sizes() -> [u32; 4];
}

/// A number format, such as `f32` or Q12.20.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Number(u8);

impl Number {
    const FIXED: u8 = 0x80;

    /// The number format of a scalar type.
    pub fn of<T: Scalar>() -> Self {
        // The epsilon of `f64` vanishes at 2⁻³⁰.
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

/// Implements [`Layout`]: `[parameters] for estimator as name, version, scalar, [sizes]`, followed by `, infinite` if
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
