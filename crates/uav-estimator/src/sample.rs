use nalgebra::SVector;

/// Inputs and outputs at one time, as deviations from the model's steady flight.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Sample<const P: usize> {
    /// Time of the sample, µs since any epoch.
    pub time_us: i64,
    /// Inputs δe (rad) and δt (0 to 1), applied from this time until the next sample.
    pub input: SVector<f64, 2>,
    /// The outputs, in the order and the units of C's rows; `None` where nothing was measured.
    pub measured: [Option<f64>; P],
}

/// Standard deviations of the white noise that a filter assumes.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Noise<const P: usize> {
    /// Standard deviations, per sample, of the noise on the inputs δe (rad) and δt.
    pub inputs: SVector<f64, 2>,
    /// Standard deviation of each output, in its unit.
    pub outputs: SVector<f64, P>,
}
