//! Statements of the thesis (in Turkish; longitudinal states by a Luenberger observer and a Kalman filter) about its
//! figures: it prints no numbers of errors.

/// Table 3.1: the steady flight, as α, q, V and θ.
pub const TRIM: [&str; 4] = ["8°", "0", "40 m/s", "12°"];
/// Sections 4.2.1 and 4.2.2: the required ranks of [B AB …] and [C; CA; …].
pub const RANK: &str = "rank 4";
/// Fig. 5.2: the time after which step responses have settled (s).
pub const SETTLING_S: f64 = 600.0;
/// Figs 5.5 to 5.8, constant inputs: the quantity, and the statement about it.
pub const CONSTANT_INPUTS: [[&str; 2]; 6] = [
    ["α after 1.5 s, rad (Fig. 5.5)", "about −0.17"],
    ["α after 10 s, rad (Fig. 5.5)", "about −0.17"],
    ["lowest q, when (Fig. 5.6)", "about 0.1 s"],
    ["lowest V, m/s (Fig. 5.7)", "above 35"],
    ["lowest θ, rad (Fig. 5.8)", "0.48"],
    ["θ after 10 s, rad (Fig. 5.8)", "about 0.75"],
];
/// The times at which the noise-free Kalman filter has caught α, q, V and θ (s); V is said to take 1.5 s longer than α
/// and q.
pub const KALMAN_CAUGHT: ([&str; 4], &str) = (["≈ 5", "≈ 2", "3.5–6.5", "8–9"], "Figs 6.1–6.4");
/// The times at which the noise-free Luenberger observer has caught α, q, V and θ (s).
pub const LUENBERGER_CAUGHT: ([&str; 4], &str) =
    (["≈ 1.5", "≈ 2", "invisible", "< 1"], "Figs 6.13–6.17");
/// The times at which the noise-free Luenberger observer has caught α, q, V and θ with sine inputs (s).
pub const SINE_CAUGHT: ([&str; 4], &str) = (["≈ 0.25", "≈ 0.25", "≈ 0.25", "≈ 0.25"], "Fig. 6.25");
