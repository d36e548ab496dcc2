//! Where the user is known to be: a polygon.

use std::path::Path;

use crate::table;
use crate::{Error, text::TextFile};

/// The corners of a polygon, m, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    corners: Vec<[f64; 2]>,
}

impl Area {
    /// Reads columns x,y.
    ///
    /// # Errors
    /// The file, the line, and what was expected there.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let mut corners = Vec::new();
        table::read(
            path,
            "the corners of an area",
            |header| header.require(["x", "y"]),
            |&[x, y], row| {
                corners.push([row.coordinate("x", x)?, row.coordinate("y", y)?]);
                Ok(())
            },
        )?;
        let area = Self { corners };
        if area.size() < 1.0 {
            let problem =
                "expected the corners of an area of a square metre at least, one after the other";
            return Err(TextFile::read(path)?.error(problem));
        }
        Ok(area)
    }

    /// In the order of their file, m.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    /// m².
    fn size(&self) -> f64 {
        let sum: f64 = self.sides().map(|([ax, ay], [bx, by])| ax * by - ay * bx).sum();
        sum.abs() / 2.0
    }

    fn sides(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().copied().zip(next.copied())
    }

    /// Whether a place is inside: a line from it to the east crosses the border an odd number of times.
    pub fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let crossings = self.sides().filter(|&([ax, ay], [bx, by])| {
            (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
        });
        crossings.count() % 2 == 1
    }

    /// Smallest and largest coordinates.
    pub fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in &self.corners {
            for axis in 0..2 {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        (low, high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polygon_knows_its_inside() {
        let corners = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 1.0], [0.0, 4.0]];
        let area = Area { corners };
        assert!(area.contains([0.5, 0.5]) && area.contains([3.5, 2.0]));
        assert!(!area.contains([2.0, 2.0]) && !area.contains([5.0, 1.0]));
        assert_eq!(area.bounds(), ([0.0, 0.0], [4.0, 4.0]));
        assert!((area.size() - 10.0).abs() < 1e-12);
    }
}
