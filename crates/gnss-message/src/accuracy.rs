//! Accuracy indices.

/// The user range accuracy (URA) of GPS and BeiDou for an index, m: the nominal value, as RINEX has it. `None` for index 15, which
/// predicts nothing. (IS-GPS-200, 20.3.3.3.1.3; BDS-SIS-ICD-B1I, 5.2.4.5.)
pub fn ura(index: u8) -> Option<f64> {
    match index {
        0..=6 => [2.0, 2.8, 4.0, 5.7, 8.0, 11.3, 16.0].get(usize::from(index)).copied(),
        7..=14 => Some(f64::from(1_u16 << (index - 2))),
        _ => None,
    }
}

/// The signal-in-space accuracy (SISA) of Galileo for an index, m. `None` where nothing is predicted, and for index 0: no range is free
/// of errors, and files treat such an accuracy alike. (OS SIS ICD, 5.1.12.)
pub fn sisa(index: u8) -> Option<f64> {
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
    use super::*;

    #[test]
    fn steps_of_sisa() {
        let told = [1, 49, 50, 75, 100, 107, 125].map(|index| sisa(index).expect("an accuracy"));
        for (found, table) in told.into_iter().zip([0.01, 0.49, 0.5, 1.0, 2.0, 3.12, 6.0]) {
            assert!((found - table).abs() < 1e-12, "{found} {table}");
        }
        assert_eq!([0, 126, 255].map(sisa), [None; 3]);
    }

    #[test]
    fn steps_of_ura() {
        let told = [0, 1, 6, 7, 14].map(|index| ura(index).expect("an accuracy"));
        assert_eq!(told, [2.0, 2.8, 16.0, 32.0, 4096.0]);
        assert_eq!([15, 16, 255].map(ura), [None; 3]);
    }
}
