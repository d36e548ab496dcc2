//! Dilution of precision from the directions of the satellites.

use kestirim_gnss_ppp::Direction;
use kestirim_replay::gnss::Followed;
use nalgebra::{Matrix4, Vector4};

use super::arcs::{Arcs, is_used};
use crate::figure::{Colour, Figure, Mark, Series};

/// The largest dilution that is shown: beyond it the directions lie numerically on a cone.
const MOST: f64 = 1e4;

/// A kind of dilution as it is drawn: name, colour and value.
type Kind = (&'static str, Colour, fn(&Dilution) -> f64);

/// Dilution of precision: the ratio of the standard deviation of the solution to that of the ranges, if these are
/// equally accurate, uncorrelated, and the only information.
///
/// Q = (HᵀH)⁻¹ with a row of H for each satellite: the east, north and up components of its direction, and 1 for the
/// receiver's clock, a single one for all systems (Langley, *Dilution of precision*, GPS World 10(5), 1999).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dilution {
    /// The geometric dilution, of position and clock: √tr Q.
    pub geometric: f64,
    /// The dilution of the position.
    pub position: f64,
    /// The horizontal dilution, of east and north.
    pub horizontal: f64,
    /// The vertical dilution, of the height.
    pub vertical: f64,
}

impl Dilution {
    /// The dilution of satellites in these directions; `None` for fewer than four, or if they do not determine a
    /// position.
    pub fn of(directions: impl IntoIterator<Item = Direction>) -> Option<Self> {
        let mut normal = Matrix4::zeros();
        let mut count = 0;
        for Direction { elevation, azimuth } in directions {
            let level = elevation.cos();
            let row =
                Vector4::new(level * azimuth.sin(), level * azimuth.cos(), elevation.sin(), 1.0);
            normal += row * row.transpose();
            count += 1;
        }
        if count < 4 {
            return None;
        }
        let [east, north, up, clock] = normal.cholesky()?.inverse().diagonal().into();
        let geometric = (east + north + up + clock).sqrt();
        (geometric < MOST).then(|| Self {
            geometric,
            position: (east + north + up).sqrt(),
            horizontal: (east + north).sqrt(),
            vertical: up.sqrt(),
        })
    }
}

/// The number of satellites used and their dilution of precision over time, in hours.
pub fn dilution(figure: Figure, followed: &Followed, arcs: &Arcs<'_>) -> Figure {
    let mut hours: Vec<f64> = Vec::new();
    let (mut counts, mut dilutions) = (Vec::new(), Vec::new());
    for epoch in followed.residuals.chunk_by(|(a, _), (b, _)| a == b) {
        let hour = epoch[0].0 / 3600.0;
        if let Some(last) = hours.last().filter(|last| hour - **last > arcs.longest_gap / 3600.0) {
            // Nothing is known about a time without a solution.
            hours.push(*last);
            counts.push(f64::NAN);
            dilutions.push(None);
        }
        let used = || epoch.iter().map(|(_, report)| report).filter(|report| is_used(report));
        hours.push(hour);
        counts.push(used().count() as f64);
        dilutions.push(Dilution::of(used().map(|report| report.direction)));
    }
    let most = counts.iter().copied().fold(6.0, f64::max);
    let kinds: [Kind; 4] = [
        ("GDOP", Colour::Other(3), |it| it.geometric),
        ("PDOP", Colour::Ours, |it| it.position),
        ("HDOP", Colour::Other(1), |it| it.horizontal),
        ("VDOP", Colour::Other(2), |it| it.vertical),
    ];
    let lines = kinds.map(|(name, colour, of)| {
        let values = dilutions.iter().map(|it| it.as_ref().map_or(f64::NAN, of));
        Series::line(name, hours.clone(), values.collect()).coloured(colour)
    });
    figure
        .over_hours("satellites; dilution of precision")
        .showing(None, Some([0.0, most + 1.0]))
        .with(
            Series::new("satellites used", Mark::Steps, hours.clone(), counts)
                .coloured(Colour::Truth),
        )
        .with_all(lines)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One satellite at the zenith, and three at the given elevation, 120° apart in azimuth.
    fn tripod(elevation: f64) -> impl Iterator<Item = Direction> {
        let zenith = Direction { elevation: std::f64::consts::FRAC_PI_2, azimuth: 0.0 };
        let others = (0..3).map(move |third| Direction {
            elevation: elevation.to_radians(),
            azimuth: (40.0 + 120.0 * f64::from(third)).to_radians(),
        });
        std::iter::once(zenith).chain(others)
    }

    /// Computed by hand: with s = sin E the normal matrix has 3(1 − s²)/2 twice on the diagonal, and the block (1 +
    /// 3s², 1 + 3s; 1 + 3s, 4) with the determinant 3(1 − s)².
    #[test]
    fn four_satellites_by_hand() {
        for (elevation, sine) in [(0.0, 0.0), (30.0, 0.5)] {
            let found = Dilution::of(tripod(elevation)).unwrap();
            let level = 4.0 / (3.0 * (1.0 - sine * sine));
            let determinant = 3.0 * (1.0 - sine) * (1.0 - sine);
            let (up, clock) = (4.0 / determinant, (1.0 + 3.0 * sine * sine) / determinant);
            let expected = [level + up + clock, level + up, level, up].map(f64::sqrt);
            let Dilution { geometric, position, horizontal, vertical } = found;
            for (is, expected) in
                [geometric, position, horizontal, vertical].into_iter().zip(expected)
            {
                assert!((is - expected).abs() < 1e-12, "{found:?} {expected}");
            }
        }
        let flat = Dilution::of(tripod(0.0)).unwrap();
        assert!((flat.geometric - 3_f64.sqrt()).abs() < 1e-12, "{flat:?}");
    }

    #[test]
    fn three_satellites_and_a_cone_give_no_place() {
        assert_eq!(Dilution::of(tripod(30.0).take(3)), None);
        let cone = (0..5).map(|fifth| Direction {
            elevation: 0.7,
            azimuth: std::f64::consts::TAU * f64::from(fifth) / 5.0,
        });
        assert_eq!(Dilution::of(cone), None);
    }

    #[test]
    fn another_satellite_never_dilutes_more() {
        let mut directions: Vec<_> = tripod(20.0).collect();
        let few = Dilution::of(directions.clone()).unwrap();
        directions.push(Direction { elevation: 0.4, azimuth: 1.0 });
        let more = Dilution::of(directions).unwrap();
        assert!(
            more.geometric < few.geometric && more.vertical <= few.vertical,
            "{few:?} {more:?}"
        );
    }
}
