/// How the tides of the oceans move one station: eleven waves, as a BLQ file lists them
/// (M2 S2 N2 K2 K1 O1 P1 Q1 Mf Mm Ssa).
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct OceanLoading {
    /// Amplitudes, m: radially up, tangentially west, tangentially south.
    pub amplitude: [[f64; 11]; 3],
    /// Phase lags behind Greenwich, degrees, in the same order.
    pub lag: [[f64; 11]; 3],
}
