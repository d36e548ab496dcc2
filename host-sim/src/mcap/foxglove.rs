//! The Foxglove messages that are written, with only the fields that are set. The file describes all fields to readers:
//! the schemas in `assets/foxglove` are complete, as published:
//! <https://docs.foxglove.dev/docs/visualization/message-schemas/introduction>.

use prost::Message;
use prost_types::Timestamp;

/// A schema, which describes the layout of a message to readers.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schema {
    pub(super) name: &'static str,
    /// The encoded `FileDescriptorSet`.
    pub(super) descriptors: &'static [u8],
}

/// The schema of [`PoseInFrame`].
pub(super) const POSE_IN_FRAME: Schema = Schema {
    name: "foxglove.PoseInFrame",
    descriptors: include_bytes!("../../assets/foxglove/PoseInFrame.bin"),
};

/// The schema of [`SceneUpdate`].
pub(super) const SCENE_UPDATE: Schema = Schema {
    name: "foxglove.SceneUpdate",
    descriptors: include_bytes!("../../assets/foxglove/SceneUpdate.bin"),
};

/// The position and orientation of an object in a named frame.
#[derive(Clone, PartialEq, Message)]
pub(super) struct PoseInFrame {
    #[prost(message, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(super) frame_id: String,
    #[prost(message, tag = "3")]
    pub(super) pose: Option<Pose>,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Pose {
    #[prost(message, tag = "1")]
    pub(super) position: Option<Vector3>,
    #[prost(message, tag = "2")]
    pub(super) orientation: Option<Quaternion>,
}

/// A position (m); `foxglove.Point3` has the same layout.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Vector3 {
    #[prost(double, tag = "1")]
    pub(super) x: f64,
    #[prost(double, tag = "2")]
    pub(super) y: f64,
    #[prost(double, tag = "3")]
    pub(super) z: f64,
}

#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Quaternion {
    #[prost(double, tag = "1")]
    pub(super) x: f64,
    #[prost(double, tag = "2")]
    pub(super) y: f64,
    #[prost(double, tag = "3")]
    pub(super) z: f64,
    #[prost(double, tag = "4")]
    pub(super) w: f64,
}

/// An update that adds entities to a scene.
#[derive(Clone, PartialEq, Message)]
pub(super) struct SceneUpdate {
    #[prost(message, repeated, tag = "2")]
    pub(super) entities: Vec<SceneEntity>,
}

#[derive(Clone, PartialEq, Message)]
pub(super) struct SceneEntity {
    #[prost(message, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(super) frame_id: String,
    #[prost(string, tag = "3")]
    pub(super) id: String,
    #[prost(message, repeated, tag = "11")]
    pub(super) lines: Vec<LinePrimitive>,
}

/// A polyline through points: type 0, `LINE_STRIP`, which is the default and not written.
#[derive(Clone, PartialEq, Message)]
pub(super) struct LinePrimitive {
    #[prost(double, tag = "3")]
    pub(super) thickness: f64,
    /// Whether the thickness is in pixels, independent of the distance.
    #[prost(bool, tag = "4")]
    pub(super) scale_invariant: bool,
    #[prost(message, repeated, tag = "5")]
    pub(super) points: Vec<Vector3>,
    #[prost(message, tag = "6")]
    pub(super) color: Option<Color>,
}

/// A colour; its components range from 0 to 1.
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Color {
    #[prost(double, tag = "1")]
    pub(super) r: f64,
    #[prost(double, tag = "2")]
    pub(super) g: f64,
    #[prost(double, tag = "3")]
    pub(super) b: f64,
    #[prost(double, tag = "4")]
    pub(super) a: f64,
}
