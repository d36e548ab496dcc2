//! The two carriers of GPS and their linear combinations.

use crate::constants::SPEED_OF_LIGHT;

/// Carrier frequencies of L1 and L2, Hz (IS-GPS-200).
pub const FREQUENCY: [f64; 2] = [1_575.42e6, 1_227.60e6];

/// Wavelengths of L1 and L2, m.
pub const WAVELENGTH: [f64; 2] = [SPEED_OF_LIGHT / FREQUENCY[0], SPEED_OF_LIGHT / FREQUENCY[1]];

/// Wavelength of the narrow lane, c/(f1 + f2), m: a cycle on both carriers in the ionosphere-free phase.
pub const NARROW_LANE: f64 = SPEED_OF_LIGHT / (FREQUENCY[0] + FREQUENCY[1]);

/// Wavelength of φ1 − φ2, c/(f1 − f2), m.
pub const WIDE_LANE: f64 = SPEED_OF_LIGHT / (FREQUENCY[0] - FREQUENCY[1]);

const L1_SHARE: f64 =
    FREQUENCY[0] * FREQUENCY[0] / (FREQUENCY[0] * FREQUENCY[0] - FREQUENCY[1] * FREQUENCY[1]);

/// (f1²·a1 − f2²·a2)/(f1² − f2²): free of the ionosphere to first order (codes or phases, m).
pub const fn ionosphere_free(both: [f64; 2]) -> f64 {
    L1_SHARE * both[0] - (L1_SHARE - 1.0) * both[1]
}

/// L1 − L2, m: free of all that is common to both carriers; the ionosphere and slips remain.
///
/// `phase` in cycles.
pub const fn geometry_free(phase: [f64; 2]) -> f64 {
    WAVELENGTH[0] * phase[0] - WAVELENGTH[1] * phase[1]
}

/// The Melbourne–Wübbena combination: φ1 − φ2 less what the codes say of it, in cycles of the wide
/// lane: free of geometry and ionosphere; code noise and slips remain.
///
/// `phase` in cycles, `code` in m.
pub const fn melbourne_wuebbena(phase: [f64; 2], code: [f64; 2]) -> f64 {
    let weighted =
        (FREQUENCY[0] * code[0] + FREQUENCY[1] * code[1]) / (FREQUENCY[0] + FREQUENCY[1]);
    phase[0] - phase[1] - weighted / WIDE_LANE
}

/// The ionosphere-free phase, m; `phase` in cycles.
pub const fn ionosphere_free_phase(phase: [f64; 2]) -> f64 {
    ionosphere_free([WAVELENGTH[0] * phase[0], WAVELENGTH[1] * phase[1]])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_combinations_cancel_what_they_should() {
        let (range, ionosphere) = (22e6, 7.0);
        let ratio = (FREQUENCY[0] / FREQUENCY[1]).powi(2);
        let code = [range + ionosphere, range + ratio * ionosphere];
        let phase =
            [(range - ionosphere) / WAVELENGTH[0], (range - ratio * ionosphere) / WAVELENGTH[1]];
        assert!((ionosphere_free(code) - range).abs() < 1e-7);
        assert!((ionosphere_free_phase(phase) - range).abs() < 1e-7);
        assert!((geometry_free(phase) - (ratio - 1.0) * ionosphere).abs() < 1e-7);
        assert!(melbourne_wuebbena(phase, code).abs() < 1e-6);
        assert!((melbourne_wuebbena([phase[0] + 5.0, phase[1] + 4.0], code) - 1.0).abs() < 1e-6);
        assert!((ionosphere_free_phase([1.0, 1.0]) - NARROW_LANE).abs() < 1e-12);
    }
}
