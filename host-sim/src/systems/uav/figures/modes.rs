//! The table of a model's modes.

use std::f64::consts::{LN_2, TAU};

use crate::system::Sheet;

/// The frequency ratio above which two oscillatory modes are named differently.
const APART: f64 = 2.0;

/// The table of the properties of each pole, or pair of poles, of a model (1/s).
pub(super) fn table(poles: &[[f64; 2]]) -> Sheet {
    let mut modes: Vec<[f64; 2]> = poles.iter().copied().filter(|[_, im]| *im >= 0.0).collect();
    modes.sort_by(|a, b| size(*b).total_cmp(&size(*a)));
    let turning: Vec<f64> = modes.iter().filter(|[_, im]| *im > 0.0).map(|it| size(*it)).collect();
    let named = match turning[..] {
        [fast, slow] if fast > APART * slow => Some([fast, slow]),
        _ => None,
    };
    let row = |mode: &[f64; 2]| {
        let [re, im] = *mode;
        let is_pair = im > 0.0;
        let name = match named {
            _ if !is_pair => "aperiodic",
            Some([fast, _]) if size(*mode) >= fast => "short period",
            Some(_) => "phugoid",
            None => "oscillation",
        };
        let pair = || vec![number(size(*mode)), number(-re / size(*mode)), number(TAU / im)];
        let pole = if is_pair { format!("{} ± {} i", number(re), number(im)) } else { number(re) };
        let half = if re == 0.0 { "never".to_owned() } else { number(LN_2 / re.abs()) };
        let kind = if re > 0.0 { " (grows)" } else { "" };
        let mut cells = vec![format!("{name}{kind}"), pole];
        cells.extend(if is_pair { pair() } else { vec![String::new(); 3] });
        cells.push(half);
        cells
    };
    Sheet::new(
        "modes",
        "Modes of the model",
        &[
            "mode",
            "pole, 1/s",
            "natural frequency, rad/s",
            "damping ratio",
            "period, s",
            "halved or doubled after, s",
        ],
    )
    .caption("Two oscillations of which one is twice as fast as the other are the short period and the phugoid.")
    .with(modes.iter().map(row))
}

fn size([re, im]: [f64; 2]) -> f64 {
    re.hypot(im)
}

fn number(value: f64) -> String {
    format!("{value:.3}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_told_by_their_poles() {
        let table = table(&[[-0.01, 0.2], [-3.0, 4.0], [-0.01, -0.2], [-3.0, -4.0]]);
        let expected = [
            ["short period", "-3.000 ± 4.000 i", "5.000", "0.600", "1.571", "0.231"],
            ["phugoid", "-0.010 ± 0.200 i", "0.200", "0.050", "31.416", "69.315"],
        ];
        assert_eq!(table.rows, expected);
    }

    #[test]
    fn what_cannot_be_told_has_no_name() {
        let table = table(&[[-3.0, 4.0], [-3.0, -4.0], [0.5, 0.0], [-2.0, 0.0]]);
        let names: Vec<_> = table.rows.iter().map(|row| row[0].as_str()).collect();
        assert_eq!(names, ["oscillation", "aperiodic", "aperiodic (grows)"]);
        assert!(table.rows[1][2].is_empty());
    }
}
