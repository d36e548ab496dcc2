//! Accuracies that messages tell by an index.

use std::f64::consts::PI;

/// Radians of a semicircle.
pub(super) const SEMICIRCLE: f64 = PI;

/// URA of GPS, m: the nominal value of an index, as RINEX has it (IS-GPS-200, 20.3.3.3.1.3); none without a prediction.
pub(super) fn ura(index: u8) -> Option<f64> {
    // To a decimal: 2.8 m, 5.7 m, 11.3 m.
    let rounded = |metres: f64| (10.0 * metres).round() / 10.0;
    match index {
        0..=6 => Some(rounded(2_f64.powf(1.0 + f64::from(index) / 2.0))),
        7..=14 => Some(2_f64.powi(i32::from(index) - 2)),
        _ => None,
    }
}

/// SISA of Galileo, m (OS SIS ICD, 5.1.12); none without a prediction, and none of index 0: no range is free of errors, and files
/// with such an accuracy are read alike.
pub(super) fn sisa(index: u8) -> Option<f64> {
    let above = |first: u8, step: f64| f64::from(index - first) * step;
    match index {
        1..50 => Some(above(0, 0.01)),
        50..75 => Some(0.5 + above(50, 0.02)),
        75..100 => Some(1.0 + above(75, 0.04)),
        100..=125 => Some(2.0 + above(100, 0.16)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::sisa;

    #[test]
    fn steps_of_sisa() {
        let told = [1, 49, 50, 75, 100, 107, 125].map(|index| sisa(index).expect("an accuracy"));
        for (found, table) in told.into_iter().zip([0.01, 0.49, 0.5, 1.0, 2.0, 3.12, 6.0]) {
            assert!((found - table).abs() < 1e-12, "{found} {table}");
        }
        assert_eq!([0, 126, 255].map(sisa), [None; 3]);
    }
}
