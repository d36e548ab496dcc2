/// The phase centre of an antenna on one frequency, as an ANTEX file describes it.
///
/// Values lie on a grid: one row of zenith angles (receivers) or nadir angles (satellites) without
/// azimuth, and, if the antenna was calibrated so, one such row for each azimuth from 0° to 360°.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Pattern<'a> {
    /// Mean phase centre from the antenna's reference point, m: north, east, up of a receiver's;
    /// X, Y, Z of the satellite's body for a satellite's.
    pub offset: [f64; 3],
    /// First angle of the grid, degrees.
    pub first: f64,
    /// Step of the grid, degrees.
    pub step: f64,
    /// Phase centre variation whatever the azimuth (`NOAZI`), m.
    pub mean: &'a [f64],
    /// Step of the azimuths, degrees; zero without them.
    pub azimuth_step: f64,
    /// The rows of all azimuths one after the other, each as long as `mean`, m; or empty.
    pub by_azimuth: &'a [f64],
}
