//! Pairs of carriers and their linear combinations.

use crate::constants::SPEED_OF_LIGHT;

/// Carrier frequencies of L1 and L2 of GPS, Hz (IS-GPS-200).
pub const FREQUENCY: [f64; 2] = [1_575.42e6, 1_227.60e6];

/// Wavelengths of L1 and L2 of GPS, m.
pub const WAVELENGTH: [f64; 2] = [SPEED_OF_LIGHT / FREQUENCY[0], SPEED_OF_LIGHT / FREQUENCY[1]];

/// The frequency of E5a of Galileo, Hz (Galileo OS SIS ICD), and of B2a of BeiDou; E1 is L1.
const E5A: f64 = 1_176.45e6;
/// The frequency of E5b of Galileo, Hz (Galileo OS SIS ICD), and of B2I of BeiDou.
const E5B: f64 = 1_207.14e6;

/// The frequency of G1 of GLONASS on channel 0, Hz (GLONASS ICD L1, L2, 3.3.1.1).
const G1: f64 = 1_602e6;
/// The frequency of G2 of GLONASS on channel 0, Hz (GLONASS ICD L1, L2, 3.3.1.1).
const G2: f64 = 1_246e6;
/// The frequency step of a GLONASS channel, as a share of either carrier.
const CHANNEL: f64 = 1.0 / 2_848.0;
/// The number of GLONASS channels.
const CHANNELS: usize = 14;
/// The index of channel 0 among the GLONASS channels.
const CHANNEL_0: usize = 7;

/// The frequency of B1I of BeiDou, Hz (BDS-SIS-ICD-B1I); B1C is on L1.
const B1I: f64 = 1_561.098e6;
/// The frequency of B3I of BeiDou, Hz (BDS-SIS-ICD-B3I).
const B3I: f64 = 1_268.52e6;

/// A satellite system.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Constellation {
    /// GPS, to whose time a receiver's clock refers.
    #[default]
    Gps,
    /// Galileo.
    Galileo,
    /// GLONASS.
    Glonass,
    /// BeiDou.
    BeiDou,
}

impl Constellation {
    /// All systems, GPS first.
    pub const ALL: [Self; 4] = [Self::Gps, Self::Galileo, Self::Glonass, Self::BeiDou];
}

/// The two carriers on which a satellite is observed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Carriers {
    /// L1 and L2 of GPS.
    #[default]
    L1L2,
    /// E1 and E5a of Galileo.
    E1E5a,
    /// E1 and E5b of Galileo.
    E1E5b,
    /// G1 and G2 of GLONASS.
    G1G2 {
        /// The satellite's frequency channel, −7 to 6.
        channel: i8,
    },
    /// B1I and B3I of BeiDou.
    B1B3,
    /// B1I and B2I of BeiDou.
    B1B2,
    /// B1C and B2a of BeiDou.
    B1cB2a,
}

/// The constants of a pair of carriers and its combinations.
#[derive(Clone, Copy)]
struct Pair {
    frequency: [f64; 2],
    wavelength: [f64; 2],
    /// The weight of the first carrier in the ionosphere-free combination: f1²/(f1² − f2²).
    share: f64,
    /// The narrow lane c/(f1 + f2), m: a cycle on both carriers in the ionosphere-free phase.
    narrow_lane: f64,
    /// The wide lane c/(f1 − f2), m.
    wide_lane: f64,
}

impl Pair {
    const fn new(first: f64, second: f64) -> Self {
        Self {
            frequency: [first, second],
            wavelength: [SPEED_OF_LIGHT / first, SPEED_OF_LIGHT / second],
            share: first * first / (first * first - second * second),
            narrow_lane: SPEED_OF_LIGHT / (first + second),
            wide_lane: SPEED_OF_LIGHT / (first - second),
        }
    }
}

static L1L2: Pair = Pair::new(FREQUENCY[0], FREQUENCY[1]);
static E1E5A: Pair = Pair::new(FREQUENCY[0], E5A);
static E1E5B: Pair = Pair::new(FREQUENCY[0], E5B);
/// The GLONASS pairs by channel, from the lowest on.
static G1G2: [Pair; CHANNELS] = {
    let mut pairs = [Pair::new(G1, G2); CHANNELS];
    let mut place = 0;
    while place < CHANNELS {
        let scale = 1.0 + (place as f64 - CHANNEL_0 as f64) * CHANNEL;
        pairs[place] = Pair::new(scale * G1, scale * G2);
        place += 1;
    }
    pairs
};
static B1B3: Pair = Pair::new(B1I, B3I);
static B1B2: Pair = Pair::new(B1I, E5B);

impl Carriers {
    #[inline(never)] // Not once for each combination.
    const fn pair(self) -> &'static Pair {
        match self {
            Self::L1L2 => &L1L2,
            Self::E1E5a | Self::B1cB2a => &E1E5A,
            Self::E1E5b => &E1E5B,
            Self::G1G2 { channel } => {
                // Below the lowest channel this wraps to a large number.
                let place = channel.wrapping_add(CHANNEL_0 as i8) as u8 as usize;
                &G1G2[if place < CHANNELS { place } else { CHANNEL_0 }]
            }
            Self::B1B3 => &B1B3,
            Self::B1B2 => &B1B2,
        }
    }

    /// The system whose satellites transmit the carriers.
    pub const fn constellation(self) -> Constellation {
        match self {
            Self::L1L2 => Constellation::Gps,
            Self::E1E5a | Self::E1E5b => Constellation::Galileo,
            Self::G1G2 { .. } => Constellation::Glonass,
            Self::B1B3 | Self::B1B2 | Self::B1cB2a => Constellation::BeiDou,
        }
    }

    /// The frequencies, Hz; for a GLONASS channel that does not exist, those of channel 0.
    pub const fn frequency(self) -> [f64; 2] {
        self.pair().frequency
    }

    /// The wavelengths, m.
    pub const fn wavelength(self) -> [f64; 2] {
        self.pair().wavelength
    }

    /// The wavelength of the narrow lane, c/(f1 + f2), m: a cycle on both carriers in the ionosphere-free phase.
    pub const fn narrow_lane(self) -> f64 {
        self.pair().narrow_lane
    }

    /// The wavelength of the wide lane φ1 − φ2, c/(f1 − f2), m.
    pub const fn wide_lane(self) -> f64 {
        self.pair().wide_lane
    }

    /// The ionosphere-free combination (f1²·a1 − f2²·a2)/(f1² − f2²) of codes or phases, m: free of the ionosphere to
    /// first order.
    pub const fn ionosphere_free(self, both: [f64; 2]) -> f64 {
        let share = self.pair().share;
        share * both[0] - (share - 1.0) * both[1]
    }

    /// The ionosphere-free phase, m; `phase` in cycles.
    pub const fn ionosphere_free_phase(self, phase: [f64; 2]) -> f64 {
        let wavelength = self.wavelength();
        self.ionosphere_free([wavelength[0] * phase[0], wavelength[1] * phase[1]])
    }

    /// The geometry-free combination, the first phase minus the second, m: free of all that is common to both carriers;
    /// the ionosphere and slips remain.
    ///
    /// `phase` in cycles.
    pub const fn geometry_free(self, phase: [f64; 2]) -> f64 {
        let wavelength = self.wavelength();
        wavelength[0] * phase[0] - wavelength[1] * phase[1]
    }

    /// The Melbourne–Wübbena combination: φ1 − φ2 minus its value from the codes, in cycles of the wide lane. It is
    /// free of geometry and ionosphere; code noise and slips remain.
    ///
    /// `phase` in cycles, `code` in m.
    pub const fn melbourne_wuebbena(self, phase: [f64; 2], code: [f64; 2]) -> f64 {
        let Pair { frequency: [first, second], wide_lane, .. } = self.pair();
        let weighted = (*first * code[0] + *second * code[1]) / (*first + *second);
        phase[0] - phase[1] - weighted / *wide_lane
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_combinations_cancel_what_they_should() {
        let of_glonass = [-7, 0, 6].map(|channel| Carriers::G1G2 { channel });
        let others = [
            Carriers::L1L2,
            Carriers::E1E5a,
            Carriers::E1E5b,
            Carriers::B1B3,
            Carriers::B1B2,
            Carriers::B1cB2a,
        ];
        for carriers in others.into_iter().chain(of_glonass) {
            let (range, ionosphere) = (22e6, 7.0);
            let ([first, second], wavelength) = (carriers.frequency(), carriers.wavelength());
            let ratio = (first / second).powi(2);
            let code = [range + ionosphere, range + ratio * ionosphere];
            let phase = [
                (range - ionosphere) / wavelength[0],
                (range - ratio * ionosphere) / wavelength[1],
            ];
            assert!((carriers.ionosphere_free(code) - range).abs() < 1e-7);
            assert!((carriers.ionosphere_free_phase(phase) - range).abs() < 1e-7);
            let geometry_free = carriers.geometry_free(phase);
            assert!((geometry_free - (ratio - 1.0) * ionosphere).abs() < 1e-7);
            assert!(carriers.melbourne_wuebbena(phase, code).abs() < 1e-6);
            let slipped = carriers.melbourne_wuebbena([phase[0] + 5.0, phase[1] + 4.0], code);
            assert!((slipped - 1.0).abs() < 1e-6);
            let narrow = carriers.ionosphere_free_phase([1.0, 1.0]);
            assert!((narrow - carriers.narrow_lane()).abs() < 1e-12);
        }
        assert_eq!(Carriers::L1L2.wavelength(), WAVELENGTH);
        assert!((Carriers::E1E5a.wide_lane() - 0.751).abs() < 1e-3);
        // ICD, table 3.1.
        let [first, second] = Carriers::G1G2 { channel: -7 }.frequency();
        assert!((first - 1_598.062_5e6).abs() < 1e-3 && (second - 1_242.937_5e6).abs() < 1e-3);
        for none in [-8, 7, i8::MIN, i8::MAX] {
            assert_eq!(Carriers::G1G2 { channel: none }.frequency(), [G1, G2]);
        }
    }
}
