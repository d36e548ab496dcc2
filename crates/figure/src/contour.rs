//! Contour lines over a rectangle, by marching squares.

use std::collections::BTreeMap;

/// Values at the corners of square cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid {
    /// The corner with the smallest x and y.
    from: [f64; 2],
    /// The side length of a cell.
    side: f64,
    /// The number of corners along x and along y.
    corners: [usize; 2],
    values: Vec<f64>,
}

/// The four sides of a cell, counter-clockwise from the bottom, each given by its two corners: offsets in columns and
/// rows from the first corner.
const SIDES: [[[usize; 2]; 2]; 4] =
    [[[0, 0], [1, 0]], [[1, 0], [1, 1]], [[0, 1], [1, 1]], [[0, 0], [0, 1]]];

impl Grid {
    /// Evaluates `value` over the rectangle between two opposite corners, with `cells` cells along the longer side.
    pub fn new([x0, y0, x1, y1]: [f64; 4], cells: usize, value: impl Fn([f64; 2]) -> f64) -> Self {
        let (wide, high) = ((x1 - x0).abs(), (y1 - y0).abs());
        let side = wide.max(high) / cells.max(1) as f64;
        let count = |length: f64| if side > 0.0 { (length / side).ceil() as usize + 1 } else { 1 };
        let (from, corners) = ([x0.min(x1), y0.min(y1)], [count(wide), count(high)]);
        let mut grid = Self { from, side, corners, values: Vec::new() };
        let places =
            (0..corners[1]).flat_map(|row| (0..corners[0]).map(move |column| [column, row]));
        grid.values = places.map(|corner| value(grid.place(corner))).collect();
        grid
    }

    /// The lines on which the value is `level`, interpolated linearly between corners. A closed line ends with its
    /// first point.
    pub fn contour(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let mut neighbours: BTreeMap<[[usize; 2]; 2], Vec<[[usize; 2]; 2]>> = BTreeMap::new();
        for row in 1..self.corners[1] {
            for column in 1..self.corners[0] {
                for [a, b] in self.segments([column - 1, row - 1], level) {
                    neighbours.entry(a).or_default().push(b);
                    neighbours.entry(b).or_default().push(a);
                }
            }
        }
        let mut lines = Vec::new();
        // Lines that end at the rim are followed first: those that remain are closed.
        let is_end = |ways: &Vec<_>| ways.len() == 1;
        let ends = neighbours.iter().filter(|(_, ways)| is_end(ways)).map(|(side, _)| *side);
        for begin in ends.chain(neighbours.keys().copied()).collect::<Vec<_>>() {
            let mut line = vec![begin];
            let mut at = begin;
            while let Some(next) = neighbours.get_mut(&at).and_then(Vec::pop) {
                if let Some(back) = neighbours.get_mut(&next) {
                    back.retain(|side| *side != at);
                }
                line.push(next);
                at = next;
            }
            if line.len() > 1 {
                lines.push(line.into_iter().map(|side| self.crossing(side, level)).collect());
            }
        }
        lines
    }

    fn place(&self, [column, row]: [usize; 2]) -> [f64; 2] {
        [self.from[0] + self.side * column as f64, self.from[1] + self.side * row as f64]
    }

    fn value(&self, [column, row]: [usize; 2]) -> f64 {
        self.values[row * self.corners[0] + column]
    }

    /// The segments of the line within a cell, each as the two sides that it joins.
    fn segments(&self, cell: [usize; 2], level: f64) -> Vec<[[[usize; 2]; 2]; 2]> {
        let corner = |[column, row]: [usize; 2]| [cell[0] + column, cell[1] + row];
        let is_above = |corner| self.value(corner) >= level;
        let sides = SIDES.map(|side| side.map(corner));
        let crossed = sides.into_iter().filter(|[a, b]| is_above(*a) != is_above(*b));
        let crossed: Vec<_> = crossed.collect();
        match crossed[..] {
            [a, b] => vec![[a, b]],
            // A saddle: the middle is joined to the first corner, or cuts it off.
            [below, right, above, left] => {
                let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(corner);
                let middle = corners.iter().map(|&it| self.value(it)).sum::<f64>() / 4.0;
                if (middle >= level) == is_above(corners[0]) {
                    vec![[below, right], [above, left]]
                } else {
                    vec![[below, left], [right, above]]
                }
            }
            _ => Vec::new(),
        }
    }

    /// The point at which the line crosses a side.
    fn crossing(&self, [a, b]: [[usize; 2]; 2], level: f64) -> [f64; 2] {
        let share = (level - self.value(a)) / (self.value(b) - self.value(a));
        let (a, b) = (self.place(a), self.place(b));
        [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hill_has_one_closed_line_at_each_height() {
        let grid = Grid::new([-2.0, -1.5, 2.0, 1.5], 40, |[x, y]| -x.hypot(y));
        let lines = grid.contour(-1.0);
        let [line] = lines.as_slice() else { panic!("{} lines", lines.len()) };
        assert_eq!(line.first(), line.last());
        for [x, y] in line {
            assert!((x.hypot(*y) - 1.0).abs() < 2e-3, "{x} {y}");
        }
        let around: f64 =
            line.windows(2).map(|it| (it[1][0] - it[0][0]).hypot(it[1][1] - it[0][1])).sum();
        assert!((around - std::f64::consts::TAU).abs() < 0.02, "{around}");
        assert_eq!(grid.contour(0.5).len(), 0);
    }

    #[test]
    fn a_slope_and_a_saddle_have_lines_from_rim_to_rim() {
        let slope = Grid::new([0.0, 0.0, 3.0, 2.0], 3, |[x, _]| x);
        assert_eq!(slope.contour(1.5), [[[1.5, 0.0], [1.5, 1.0], [1.5, 2.0]]]);
        for level in [0.1, -0.1] {
            let lines = Grid::new([-1.0, -1.0, 1.0, 1.0], 1, |[x, y]| x * y).contour(level);
            assert_eq!(lines.len(), 2, "{lines:?}");
            // Each cuts off one of the corners of its sign, and is right where it crosses the cell's sides.
            let side = |[x, y]: [f64; 2]| x + y * level.signum() > 0.0;
            for line in lines {
                assert!(line.iter().all(|&[x, y]| (x * y - level).abs() < 1e-12));
                assert!(line.iter().all(|&place| side(place) == side(line[0])), "{line:?}");
            }
        }
    }

    #[test]
    fn a_point_has_no_lines() {
        assert_eq!(Grid::new([1.0; 4], 10, |_| 1.0).contour(1.0).len(), 0);
    }
}
