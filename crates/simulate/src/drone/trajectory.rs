//! The stops at which the drone measures a stationary user: the thesis' Fig. 3.1.

use std::f64::consts::TAU;

use kestirim_replay::metrics::polyline_length;

/// The side of the square that holds the user, m.
pub const SIDE_M: f64 = 2000.0;

/// A path through the air.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Trajectory {
    /// A circle about the centre of the square.
    Circle {
        /// The radius, m.
        radius_m: f64,
    },
    /// A grid about the centre, flown row by row, with as many rows as columns.
    Grid {
        /// The distance between neighbouring points, m.
        spacing_m: f64,
    },
}

impl Trajectory {
    /// The thesis' trajectory (b), a circle.
    pub const CIRCLE: Self = Self::Circle { radius_m: SIDE_M / 3.0 };

    /// The thesis' trajectory (a): the centres of as many cells of the square as there are points.
    pub fn grid(points: u32) -> Self {
        Self::Grid { spacing_m: SIDE_M / f64::from(points).sqrt() }
    }

    /// The thesis' trajectory (c): a grid whose path is as long as that of a circle with as many points.
    pub fn small_grid(points: u32) -> Self {
        Self::Grid { spacing_m: SIDE_M / 3.0 * 2.0 * (TAU / 2.0 / f64::from(points)).sin() }
    }

    /// The points in flight order.
    pub fn points(self, count: u32) -> Vec<[f64; 2]> {
        match self {
            Self::Circle { radius_m } => (0..count)
                .map(|k| {
                    let (sine, cosine) = (TAU * f64::from(k) / f64::from(count)).sin_cos();
                    [SIDE_M / 2.0 + radius_m * cosine, SIDE_M / 2.0 + radius_m * sine]
                })
                .collect(),
            Self::Grid { spacing_m } => {
                let columns = f64::from(count).sqrt().ceil() as u32;
                let place = |k: u32| {
                    SIDE_M / 2.0 + (f64::from(k) - f64::from(columns - 1) / 2.0) * spacing_m
                };
                (0..count)
                    .map(|k| {
                        let (row, along) = (k / columns, k % columns);
                        // Rows alternate in direction, so that each leg is one spacing long.
                        let column = if row % 2 == 0 { along } else { columns - 1 - along };
                        [place(column), place(row)]
                    })
                    .collect()
            }
        }
    }

    /// The length of the path from the first point to the last, m.
    pub fn length(self, count: u32) -> f64 {
        polyline_length(&self.points(count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_as_long_as_the_thesis_says() {
        // Eq. 2.16: (T − 1)·√2·R·√(1 − cos(2π/T)).
        let circle = 11.0 * 2_f64.sqrt() * SIDE_M / 3.0 * (1.0 - (TAU / 12.0).cos()).sqrt();
        assert!((Trajectory::CIRCLE.length(12) - circle).abs() < 1e-6);
        assert!((Trajectory::grid(9).length(9) - 8.0 * SIDE_M / 3.0).abs() < 1e-6);
        let (small, circle) = (Trajectory::small_grid(16), Trajectory::CIRCLE);
        assert!((small.length(16) - circle.length(16)).abs() < 1e-6);
        assert!(Trajectory::grid(4).points(4).contains(&[500.0, 1500.0]));
    }
}
