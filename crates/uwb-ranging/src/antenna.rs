//! The antenna delay: the time between the timestamping in the chip and the radiation at the antenna.

use crate::ticks::light_distance;
use crate::{Error, METRES_PER_TICK};
use kestirim_scalar::Scalar;

/// The aggregate antenna delay of one radio (ticks): transmit plus receive path (APS014). About 32 900 in a
/// DW1000 module at 64 MHz PRF, unless its registers `TX_ANTD` and `LDE_RXANTD` already take it off.
///
/// Every two-way distance is too long by half the sum of both radios' delays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AntennaDelay(i32);

impl AntennaDelay {
    /// Creates a delay from ticks; negative if an earlier setting compensates for too much.
    #[inline]
    pub const fn new(ticks: i32) -> Self {
        Self(ticks)
    }

    /// The delay in ticks.
    #[inline]
    pub const fn ticks(self) -> i32 {
        self.0
    }

    /// The excess of a measured distance between the two radios (m), to be subtracted from it.
    pub fn excess<T: Scalar>(self, other: Self) -> T {
        light_distance(i128::from(self.0).wrapping_add(i128::from(other.0)), 2)
    }

    /// The delay of each of two equal radios, from the excess (m) of their mean measured distance over the true
    /// one.
    ///
    /// # Errors
    /// [`Error::NotFinite`], also for an excess beyond 10⁶ m.
    pub fn of_each<T: Scalar>(excess: T) -> Result<Self, Error> {
        Self::from_metres(excess)
    }

    /// The delays of three radios a, b and c from the excesses (m) of their three mean distances ab, ac and bc
    /// over the true ones (APS014's procedure in closed form).
    ///
    /// # Errors
    /// [`Error::NotFinite`], also for delays beyond 10⁶ m.
    pub fn of_three<T: Scalar>(ab: T, ac: T, bc: T) -> Result<[Self; 3], Error> {
        Ok([
            Self::from_metres(ab + ac - bc)?,
            Self::from_metres(ab + bc - ac)?,
            Self::from_metres(ac + bc - ab)?,
        ])
    }

    fn from_metres<T: Scalar>(metres: T) -> Result<Self, Error> {
        let single = metres.to_f32();
        if !metres.is_finite() || !single.is_finite() || single.abs() > 1e6 {
            return Err(Error::NotFinite);
        }
        let ticks = single * const { (1.0 / METRES_PER_TICK) as f32 };
        Ok(Self((if ticks < 0.0 { ticks - 0.5 } else { ticks + 0.5 }) as i32))
    }
}
