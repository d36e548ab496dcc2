//! Jumps of all phases against their codes: some receivers keep their clock near GPS time by whole milliseconds, and
//! apply the steps to the codes alone, or to the phases alone.

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;

/// The distance that light travels in a millisecond, m.
pub(crate) const MILLISECOND: f64 = SPEED_OF_LIGHT * 1e-3;
/// The smallest clock jump, m: what jumps by less is a slip of its own, or a code outlier. Jumps that agree within this
/// are alike.
const SMALLEST: f64 = 15.0;
/// The minimum number of satellites for detecting a jump.
const FEWEST: usize = 3;

/// A jump common to the phases of all satellites.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) enum ClockJump {
    /// A jump by whole milliseconds.
    Milliseconds(i32),
    /// A jump by any other amount, common to nearly all satellites: all ambiguities are reset.
    Other,
}

impl ClockJump {
    /// The jump that most satellites have in common, from `jumps` in m, whose median is `middle`.
    pub(crate) fn of(jumps: &[f64], middle: f64) -> Option<Self> {
        let like = jumps.iter().filter(|&jump| (jump - middle).abs() < SMALLEST).count();
        if middle.abs() < SMALLEST || jumps.len() < FEWEST || 2 * like <= jumps.len() {
            return None;
        }
        let milliseconds = libm::round(middle / MILLISECOND);
        let whole = (middle - milliseconds * MILLISECOND).abs() < SMALLEST;
        // A clock that is seconds off may jump by any amount.
        let near = milliseconds.abs() < 1e6;
        if whole && near {
            return Some(Self::Milliseconds(milliseconds as i32));
        }
        // Outliers of many codes may agree by chance, which would cost every ambiguity. A real jump persists, so that
        // the next epoch shows it as well.
        (8 * (jumps.len() - like) <= jumps.len()).then_some(Self::Other)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_most_have_in_common() {
        let of = |jumps: &[f64], middle| ClockJump::of(jumps, middle);
        assert_eq!(of(&[0.1, -0.4, 0.2, 299_792.0], 0.1), None);
        assert_eq!(of(&[299_792.0; 2], 299_792.0), None, "of two");
        let most = [299_793.0, 299_790.0, 299_792.0, 20.0];
        assert_eq!(of(&most, 299_792.0), Some(ClockJump::Milliseconds(1)));
        assert_eq!(of(&[-599_585.0; 5], -599_585.0), Some(ClockJump::Milliseconds(-2)));
        assert_eq!(of(&[100.0, 101.0, 99.0], 100.0), Some(ClockJump::Other));
        assert_eq!(of(&[17.0, 17.0, 17.0, 0.0, 0.0], 17.0), None, "outliers of codes");
        assert_eq!(of(&[100.0; 7], 100.0), Some(ClockJump::Other));
        assert_eq!(of(&[100.0, 300.0, 600.0], 300.0), None, "each by its own");
        assert_eq!(of(&[1e20; 4], 1e20), Some(ClockJump::Other));
        assert_eq!(of(&[f64::NAN; 4], f64::NAN), None);
    }
}
