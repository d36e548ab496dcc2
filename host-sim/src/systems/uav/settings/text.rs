//! Parsing of lists of numbers.

use kestirim_observer_design::Complex;

/// Parses two standard deviations.
///
/// # Errors
/// A sentence that says what was expected.
pub fn two_numbers(text: &str) -> Result<[f64; 2], String> {
    numbers(text, "two numbers above 0")
}

/// Parses four standard deviations.
///
/// # Errors
/// A sentence that says what was expected.
pub fn four_numbers(text: &str) -> Result<[f64; 4], String> {
    numbers(text, "four numbers above 0")
}

fn numbers<const N: usize>(text: &str, expected: &str) -> Result<[f64; N], String> {
    let parsed = text.split(',').map(|field| {
        field.trim().parse::<f64>().ok().filter(|number| *number > 0.0 && *number < 1e6)
    });
    let parsed: Option<Vec<f64>> = parsed.collect();
    parsed.and_then(|all| all.try_into().ok()).ok_or_else(|| format!("expected {expected}"))
}

/// Parses four poles such as −3 or −3+2i, each complex one with its conjugate.
///
/// # Errors
/// A sentence that says what was expected.
pub fn poles(text: &str) -> Result<[Complex<f64>; 4], String> {
    let expected =
        || "expected four poles left of 0, such as -3 or -3+2i, with conjugates".to_owned();
    let parsed: Option<Vec<_>> = text.split(',').map(|field| pole(field.trim())).collect();
    let poles: [Complex<f64>; 4] =
        parsed.and_then(|all| all.try_into().ok()).ok_or_else(expected)?;
    let conjugated = poles.iter().all(|pole| poles.contains(&Complex { im: -pole.im, ..*pole }));
    let decaying = poles.iter().all(|pole| pole.re < 0.0 && pole.re > -1e6 && pole.im.abs() < 1e6);
    if conjugated && decaying { Ok(poles) } else { Err(expected()) }
}

fn pole(text: &str) -> Option<Complex<f64>> {
    let Some(both) = text.strip_suffix(['i', 'j']) else {
        return Some(Complex { re: text.parse().ok()?, im: 0.0 });
    };
    // The last sign that is not part of an exponent separates the two parts.
    let sign = both.char_indices().rev().find(|&(place, sign)| {
        (sign == '+' || sign == '-') && place > 0 && !both[..place].ends_with(['e', 'E'])
    })?;
    let (re, im) = both.split_at(sign.0);
    Some(Complex { re: re.parse().ok()?, im: im.parse().ok()? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poles_are_read() {
        let read = poles("-3+2i, -3-2j,-5e0,-1e-1").unwrap();
        let pairs = read.map(|pole| (pole.re, pole.im));
        assert_eq!(pairs, [(-3.0, 2.0), (-3.0, -2.0), (-5.0, 0.0), (-0.1, 0.0)]);
        for wrong in
            ["", "-1,-2,-3", "-1,-2,-3,-4,-5", "-1,-2,-3,4", "-1,-2,-3,x", "-1+i,-1-i,-1,-1"]
        {
            assert!(poles(wrong).is_err(), "{wrong}");
        }
        assert!(poles("-1+2i,-1+2i,-3,-4").is_err());
        assert!(poles("-1,-2,-3,nan").is_err());
    }

    #[test]
    fn deviations_are_above_zero() {
        assert_eq!(two_numbers("0.1, 2"), Ok([0.1, 2.0]));
        for wrong in ["0,1", "1", "1,2,3", "-1,1", "nan,1", "1,inf"] {
            assert!(two_numbers(wrong).is_err(), "{wrong}");
        }
    }
}
