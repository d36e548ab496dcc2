//! Faults beyond noise.

use kestirim_gnss_files::Observed;
use kestirim_gnss_ppp::WAVELENGTH;
use kestirim_replay::gnss::Epoch;
use rand_core::Rng;

use crate::random::uniform;

/// The frequencies of faults. Errors are equal on both carriers unless stated otherwise, because differences between
/// the carriers would reveal them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// The share of codes with an error, of 3 to 30 m.
    pub code_outliers: f64,
    /// The share of phases with an error, of 0.05 to 1 m, in a single epoch.
    pub phase_outliers: f64,
    /// The number of slips per station-day that change the combinations by less than the detectors see: by the effect
    /// on the ionosphere-free phase (0.107, 0.805, 0.912 m) of one cycle on both carriers, of four and three, or of
    /// five and four.
    pub small_slips: u32,
    /// The number of slips per station-day by up to a hundred cycles, independently on each carrier, that the receiver
    /// does not report.
    pub big_slips: u32,
    /// The number of times per station-day that three satellites' codes are 10 m too long for 15 minutes.
    pub code_biases: u32,
}

impl Rates {
    /// No faults.
    pub const NONE: Self = Self {
        code_outliers: 0.0,
        phase_outliers: 0.0,
        small_slips: 0,
        big_slips: 0,
        code_biases: 0,
    };

    /// The faults of the recording `esbc2020177_injected`, and big slips, which every recording has.
    pub const RECORDING: Self = Self {
        code_outliers: 0.02,
        phase_outliers: 0.01,
        small_slips: 24,
        big_slips: 8,
        code_biases: 2,
    };
}

/// The sizes of small slips, m.
const SMALL_SLIPS_M: [f64; 3] = [0.107, 0.805, 0.912];
/// The number of codes biased at the same time, the size of the bias, m, and its duration in epochs.
const BIASED: usize = 3;
const BIAS_M: f64 = 10.0;
const BIAS_EPOCHS: usize = 30;

/// Adds faults to a day.
pub(super) fn disturb(epochs: &mut [Epoch], rates: &Rates, rng: &mut impl Rng) {
    for observed in epochs.iter_mut().flat_map(|epoch| &mut epoch.satellites) {
        if uniform(rng) < rates.code_outliers {
            lengthen_code(observed, between(3.0, 30.0, rng));
        }
        if uniform(rng) < rates.phase_outliers {
            lengthen_phase(observed, [between(0.05, 1.0, rng); 2]);
        }
    }
    for _ in 0..rates.small_slips {
        let size = SMALL_SLIPS_M[below(SMALL_SLIPS_M.len(), rng)];
        slip(epochs, [if uniform(rng) < 0.5 { size } else { -size }; 2], rng);
    }
    for _ in 0..rates.big_slips {
        let cycles = WAVELENGTH.map(|length| length * between(5.0, 100.0, rng).round());
        slip(epochs, cycles, rng);
    }
    for _ in 0..rates.code_biases {
        let start = below(epochs.len(), rng);
        for prn in chosen(&epochs[start], BIASED, rng) {
            let few = epochs.iter_mut().skip(start).take(BIAS_EPOCHS);
            for observed in few.filter_map(|epoch| find(epoch, prn)) {
                lengthen_code(observed, BIAS_M);
            }
        }
    }
}

/// The number of unseen epochs after which a satellite has set: longer than any gap, shorter than it takes to rise
/// again.
const SET: usize = 60;

/// Shifts a satellite's phases from a random epoch until it sets.
fn slip(epochs: &mut [Epoch], metres: [f64; 2], rng: &mut impl Rng) {
    let start = below(epochs.len(), rng);
    let Some(&prn) = chosen(&epochs[start], 1, rng).first() else { return };
    let mut unseen = 0;
    for epoch in &mut epochs[start..] {
        match find(epoch, prn) {
            Some(observed) => {
                lengthen_phase(observed, metres);
                unseen = 0;
            }
            None => unseen += 1,
        }
        if unseen > SET {
            break;
        }
    }
}

fn find(epoch: &mut Epoch, prn: u8) -> Option<&mut Observed> {
    epoch.satellites.iter_mut().find(|observed| observed.prn == prn)
}

/// Some of an epoch's satellites, drawn without repetition.
fn chosen(epoch: &Epoch, count: usize, rng: &mut impl Rng) -> Vec<u8> {
    let mut all: Vec<u8> = epoch.satellites.iter().map(|observed| observed.prn).collect();
    (0..count.min(all.len())).map(|_| all.swap_remove(below(all.len(), rng))).collect()
}

fn below(count: usize, rng: &mut impl Rng) -> usize {
    ((count as f64 * uniform(rng)) as usize).min(count.saturating_sub(1))
}

/// A random value whose magnitude lies between `least` and `most`, of either sign.
fn between(least: f64, most: f64, rng: &mut impl Rng) -> f64 {
    let length = least + (most - least) * uniform(rng);
    if uniform(rng) < 0.5 { length } else { -length }
}

fn lengthen_code(observed: &mut Observed, metres: f64) {
    for code in observed.code.iter_mut().flatten() {
        *code += metres;
    }
}

fn lengthen_phase(observed: &mut Observed, metres: [f64; 2]) {
    let lengths = metres.iter().zip(WAVELENGTH);
    for (phase, (metres, wavelength)) in observed.phase.iter_mut().zip(lengths) {
        if let Some(phase) = phase {
            *phase += metres / wavelength;
        }
    }
}
