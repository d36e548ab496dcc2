use kestirim_gnss_ppp::Carriers;

/// The fractional-cycle biases of a satellite's two phases.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PhaseBias {
    /// The bias to be added to the Melbourne–Wübbena combination, cycles of the wide lane.
    pub wide_lane: f64,
    /// The bias to be subtracted from the ionosphere-free phase, m; zero where the satellite's clock contains it
    /// (integer clocks).
    pub ionosphere_free: f64,
}

impl PhaseBias {
    /// Converts absolute biases of both phases, m, where the codes are corrected for theirs.
    pub fn absolute(carriers: Carriers, phases: [f64; 2]) -> Self {
        let [of_first, of_second] = carriers.wavelength();
        let [first, second] = phases;
        Self {
            wide_lane: second / of_second - first / of_first,
            ionosphere_free: carriers.ionosphere_free(phases),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without its biases a phase is an integer: the wide lane, and the remainder on the first carrier.
    #[test]
    fn absolute_biases_leave_whole_cycles() {
        for carriers in [Carriers::L1L2, Carriers::E1E5a] {
            let (range, biases, cycles) = (22e6, [0.037, -0.052], [17.0, 12.0]);
            let wavelength = carriers.wavelength();
            let phase = [0, 1].map(|i| (range + biases[i]) / wavelength[i] + cycles[i]);
            let PhaseBias { wide_lane, ionosphere_free } = PhaseBias::absolute(carriers, biases);
            let wide = carriers.melbourne_wuebbena(phase, [range; 2]) + wide_lane;
            assert!((wide - 5.0).abs() < 1e-6, "{wide}");
            let [first, second] = carriers.frequency();
            let left = carriers.ionosphere_free_phase(phase) - range - ionosphere_free;
            let narrow = left / carriers.narrow_lane() - second / (first - second) * wide;
            assert!((narrow - 17.0).abs() < 1e-4, "{narrow}");
        }
    }
}
