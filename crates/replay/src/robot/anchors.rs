//! The places of anchors.

/// Anchors in the order of their file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Anchors {
    /// The names of the anchors, as logs use them.
    pub names: Vec<String>,
    /// The places of the anchors in the room (right-handed, z up), m.
    pub positions: Vec<[f64; 3]>,
}

impl Anchors {
    /// The index of an anchor by its name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// The smallest rectangle around the anchors: two opposite corners, m.
    pub fn rectangle(&self) -> [f64; 4] {
        let [least, most] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        self.positions.iter().fold([least[0], least[1], most[0], most[1]], |corners, &[x, y, _]| {
            [corners[0].min(x), corners[1].min(y), corners[2].max(x), corners[3].max(y)]
        })
    }

    /// The mean height of the anchors, which is assumed for a tag of unknown height, m.
    pub fn mean_height(&self) -> f64 {
        self.positions.iter().map(|[_, _, z]| z).sum::<f64>() / self.positions.len().max(1) as f64
    }
}
