use prost::Message;
use prost_types::Timestamp;

use super::foxglove::{
    Color, LinePrimitive, Pose, PoseInFrame, Quaternion, SceneEntity, SceneUpdate, Vector3,
};
use crate::figure::Colour;

/// The frame of all positions.
const FRAME: &str = "world";

/// The columns of a stream that hold a position.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Place {
    x: usize,
    y: usize,
    z: Option<usize>,
}

impl Place {
    /// Finds the position columns, if there are any.
    pub(super) fn among(columns: &[String]) -> Option<Self> {
        let find = |name| columns.iter().position(|column| column == name);
        Some(Self { x: find("x_m")?, y: find("y_m")?, z: find("z_m") })
    }

    /// The position in a row; `None` if it is missing or not finite.
    fn of(self, values: &[f64]) -> Option<[f64; 3]> {
        let value = |index: usize| values.get(index).copied().filter(|value| value.is_finite());
        let z = match self.z {
            Some(z) => value(z)?,
            None => 0.0,
        };
        Some([value(self.x)?, value(self.y)?, z])
    }

    /// The position in a row as an encoded `foxglove.PoseInFrame`.
    pub(super) fn pose(self, time: u64, values: &[f64]) -> Option<Vec<u8>> {
        let [x, y, z] = self.of(values)?;
        let position = Some(Vector3 { x, y, z });
        let orientation = Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 });
        let pose = PoseInFrame {
            timestamp: Some(stamp(time)),
            frame_id: FRAME.to_owned(),
            pose: Some(Pose { position, orientation }),
        };
        Some(pose.encode_to_vec())
    }

    /// The positions of all rows as an encoded `foxglove.SceneUpdate`: a line, interrupted where there is no position.
    pub(super) fn path(self, time: u64, id: &str, rows: &[(f64, Vec<f64>)]) -> Vec<u8> {
        let places: Vec<_> = rows.iter().map(|(_, values)| self.of(values)).collect();
        let stretches = places.split(Option::is_none).filter(|stretch| stretch.len() > 1);
        let entity = SceneEntity {
            timestamp: Some(stamp(time)),
            frame_id: FRAME.to_owned(),
            id: id.to_owned(),
            lines: stretches.map(|stretch| line(stretch.iter().flatten(), colour_of(id))).collect(),
        };
        SceneUpdate { entities: vec![entity] }.encode_to_vec()
    }
}

/// The colour of a topic: the truth is drawn as in the figures.
fn colour_of(topic: &str) -> Colour {
    if topic.ends_with("/truth") { Colour::Truth } else { Colour::Ours }
}

fn line<'a>(places: impl Iterator<Item = &'a [f64; 3]>, colour: Colour) -> LinePrimitive {
    let [r, g, b] = colour.rgb().map(|part| f64::from(part) / 255.0);
    LinePrimitive {
        thickness: 2.0,
        scale_invariant: true,
        points: places.map(|&[x, y, z]| Vector3 { x, y, z }).collect(),
        color: Some(Color { r, g, b, a: 1.0 }),
    }
}

fn stamp(time: u64) -> Timestamp {
    const SECOND: u64 = 1_000_000_000;
    Timestamp { seconds: (time / SECOND) as i64, nanos: (time % SECOND) as i32 }
}
