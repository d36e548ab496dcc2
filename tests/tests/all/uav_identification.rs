//! Derivatives of a recorded flight, compared with those of another method.
//!
//! `attas_elv1` is in `../shared/data/uav/flights`, beside the repository. Where it is absent this test prints SKIPPED.

use host_sim::systems::uav::identify::flight;
use kestirim_tests::recordings::folder_of;
use kestirim_uav_identification::identify;

/// The equation error in the frequency domain (Morelli), computed with `NumPy`: q̇ and az/V from α, q and δe at 0.08 to
/// 1.2 Hz, slopes as jω after subtracting a straight line through the ends; α moved to the centre of mass by the vane's
/// lead of 0.1029 s. No filter, no prior, no az in the first three; no common code.
const INDEPENDENT: [(&str, f64); 6] = [
    ("M_alpha", -4.9103),
    ("M_q", -1.4697),
    ("M_delta_e", -7.0626),
    ("Z_alpha", -0.9626),
    ("Z_q", -0.0211),
    ("Z_delta_e", -0.1147),
];

#[test]
fn derivatives_of_attas_are_those_of_another_method() {
    let Some(folder) = folder_of("uav") else { return };
    let flight = flight(&folder.join("flights/attas_elv1.csv")).expect("a flight");
    let found = identify(&[flight], None).expect("a model");
    for (name, independent) in INDEPENDENT {
        let it = found.parameters.iter().find(|it| it.name == name).expect("a parameter");
        let off = (it.value - independent) / it.sigma;
        println!("{name}: {:.4} ± {:.4}, independent {independent}", it.value, it.sigma);
        assert!(off.abs() < 2.0, "{name} is {off:.1} σ off");
        assert!(it.sigma < 0.1 * it.value.abs().max(1.0), "{name} ± {}", it.sigma);
    }
}
