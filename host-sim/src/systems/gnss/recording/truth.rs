//! The true position of the marker.

use std::path::Path;

use nalgebra::Vector3;

use crate::Error;
use crate::text::{TextFile, printable_path};

/// The possible distances of a marker from the Earth's centre (m).
const RADII: std::ops::Range<f64> = 6.3e6..6.5e6;

/// Reads the position from the first line of a file.
///
/// # Errors
/// [`Error::Line`] if it is not a position; [`Error::Usage`] if there is no such file, as the argument may have been
/// meant as a position.
pub fn read(path: &Path) -> Result<Vector3<f64>, Error> {
    if !path.exists() {
        let expected = "expected X,Y,Z, a place on the ground (ECEF, m), or a file of it";
        return Err(Error::Usage(format!("--truth {}: {expected}", printable_path(path))));
    }
    let text = TextFile::read(path)?;
    let Some(line) = text.lines().next() else {
        return Err(text.error("expected X,Y,Z, found an empty file"));
    };
    place(line.text).map_err(|problem| line.error(problem))
}

/// Parses `X,Y,Z`, a position on the ground (ECEF, m).
///
/// # Errors
/// A sentence that says what was expected.
pub fn place(text: &str) -> Result<Vector3<f64>, String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|field| field.trim().parse()).collect();
    numbers
        .ok()
        .and_then(|numbers| <[f64; 3]>::try_from(numbers).ok())
        .map(Vector3::from)
        .filter(|place| RADII.contains(&place.norm()))
        .ok_or_else(|| "expected a place on the ground as X,Y,Z (ECEF, m)".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_on_the_ground() {
        assert_eq!(
            place("3582104.7, 532590.2,-5232755.1"),
            Ok(Vector3::new(3_582_104.7, 532_590.2, -5_232_755.1))
        );
        for text in ["", "1,2,3", "55.5,8.4,60", "3582104,532590", "nan,0,6400000", "a,b,c"] {
            assert!(place(text).is_err(), "{text}");
        }
    }
}
