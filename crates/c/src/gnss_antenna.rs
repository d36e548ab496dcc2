//! Phase centres of antennas.
#![allow(unsafe_code)] // Pointers from C, which `memory` checks.

use kestirim_gnss_ppp::Pattern;

use crate::Status;
use crate::memory::{array, optional};

/// Phase centre of an antenna on one frequency, as an ANTEX file describes it.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct GnssPattern {
    /// Mean phase centre, m: for a receiver's antenna north, east and up of its reference point; for a satellite's
    /// along X, Y and Z of its body.
    pub offset: [f64; 3],
    /// First angle of the grid, degrees: from the zenith (receiver) or nadir (satellite).
    pub first: f64,
    /// Step of the grid's zenith or nadir angles, degrees.
    pub step: f64,
    /// Azimuth-independent phase centre variation at each angle of the grid, m: `count` numbers.
    pub mean: *const f64,
    /// Number of angles of the grid.
    pub count: usize,
    /// Step of the azimuths, degrees; 0 if the grid has none.
    pub azimuth_step: f64,
    /// Phase centre variations that depend on the azimuth, m: a row like `mean` for each azimuth from 0 to 360 degrees,
    /// one after the other.
    pub by_azimuth: *const f64,
    /// Total number of values in `by_azimuth`; 0 if the grid has no azimuths.
    pub azimuth_count: usize,
}

impl GnssPattern {
    /// The pattern in the form of the models.
    ///
    /// # Safety
    /// Its pointers may be read.
    unsafe fn pattern<'a>(&self) -> Result<Pattern<'a>, Status> {
        // SAFETY: the caller keeps what the header asks for.
        let (mean, by_azimuth) =
            unsafe { (array(self.mean, self.count)?, array(self.by_azimuth, self.azimuth_count)?) };
        let (offset, first, step) = (self.offset, self.first, self.step);
        Ok(Pattern { offset, first, step, mean, azimuth_step: self.azimuth_step, by_azimuth })
    }
}

/// Two antenna patterns behind a pointer that may be null.
///
/// # Safety
/// It and the pointers of the patterns may be read.
pub(crate) unsafe fn antenna<'a>(
    patterns: *const [GnssPattern; 2],
) -> Result<Option<[Pattern<'a>; 2]>, Status> {
    // SAFETY: the caller keeps what the header asks for.
    unsafe {
        let Some([first, second]) = optional(patterns)? else { return Ok(None) };
        Ok(Some([first.pattern()?, second.pattern()?]))
    }
}
