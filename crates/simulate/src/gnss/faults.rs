//! What goes wrong beyond noise.

use kestirim_gnss_files::Observed;
use kestirim_gnss_ppp::WAVELENGTH;
use kestirim_replay::gnss::Epoch;
use rand_core::Rng;

use crate::random::uniform;

/// How often what goes wrong. Errors are equal on both carriers unless said otherwise: differences between them
/// would give them away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rates {
    /// Share of codes that are off, by 3 to 30 m.
    pub code_outliers: f64,
    /// Share of phases that are off, by 0.05 to 1 m, in a single epoch.
    pub phase_outliers: f64,
    /// Slips a station-day that change the combinations by less than the detectors see: as large as one cycle on
    /// both carriers, four and three, or five and four make the ionosphere-free phase (0.107, 0.805, 0.912 m).
    pub small_slips: u32,
    /// Slips a station-day by up to a hundred cycles, on each carrier others, of which the receiver says nothing.
    pub big_slips: u32,
    /// Times a station-day that three satellites' codes are 10 m too long for 15 minutes.
    pub code_biases: u32,
}

impl Rates {
    /// Nothing goes wrong.
    pub const NONE: Self = Self {
        code_outliers: 0.0,
        phase_outliers: 0.0,
        small_slips: 0,
        big_slips: 0,
        code_biases: 0,
    };

    /// As they were put into the recording `esbc2020177_injected`, and big slips, which no recording is without.
    pub const RECORDING: Self = Self {
        code_outliers: 0.02,
        phase_outliers: 0.01,
        small_slips: 24,
        big_slips: 8,
        code_biases: 2,
    };
}

/// Lengths of small slips, m.
const SMALL_SLIPS_M: [f64; 3] = [0.107, 0.805, 0.912];
/// How many codes have a bias at a time, how large it is, m, and for how many epochs it stays.
const BIASED: usize = 3;
const BIAS_M: f64 = 10.0;
const BIAS_EPOCHS: usize = 30;

/// Puts faults into a day.
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

/// Unseen for so many epochs, a satellite has set: longer than any gap, shorter than it takes to rise again.
const SET: usize = 60;

/// A satellite's phases are others from some epoch until it sets.
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

/// Some of an epoch's satellites, each once.
fn chosen(epoch: &Epoch, count: usize, rng: &mut impl Rng) -> Vec<u8> {
    let mut all: Vec<u8> = epoch.satellites.iter().map(|observed| observed.prn).collect();
    (0..count.min(all.len())).map(|_| all.swap_remove(below(all.len(), rng))).collect()
}

fn below(count: usize, rng: &mut impl Rng) -> usize {
    ((count as f64 * uniform(rng)) as usize).min(count.saturating_sub(1))
}

/// A length between two, of either sign.
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
