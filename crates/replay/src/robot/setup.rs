//! What is known beforehand: which tracker, among which anchors, with which constants.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Room;
use kestirim_uwb_tracker::Anchor;
use nalgebra::SVector;

use super::{FoundHeight, Tuning};
use crate::ScalarKind;

/// How ranges become positions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum TrackerKind {
    /// Linear trilateration of each epoch by itself (eqs 3-7)
    Lsq,
    /// Nonlinear least squares of each epoch by itself
    Nls,
    /// The paper's extended Kalman filter (eqs 8-17)
    Ekf,
    /// The adaptive filter in its safe form
    Aekf,
    /// The adaptive filter as published (eqs 18, 19)
    #[cfg_attr(feature = "clap", value(alias = "aekf-printed"))]
    AekfPublished,
    /// Robust, adaptive, with a common bias where the anchors are not calibrated
    #[default]
    Default,
}

/// In how many dimensions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Dimensions {
    /// In the plane, at a known height
    #[default]
    #[cfg_attr(feature = "clap", value(name = "2"))]
    Two,
    /// In space
    #[cfg_attr(feature = "clap", value(name = "3"))]
    Three,
}

impl TrackerKind {
    /// Forgetting factor, least and greatest variance (m²) of [`Self::Aekf`].
    pub const AEKF_LEARNING: [f64; 3] = [0.99, 0.0025, 9.0];
}

/// Everything that can be chosen about a tracker, and the anchors it is for.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// How ranges become positions.
    pub tracker: TrackerKind,
    /// In how many dimensions.
    pub dimensions: Dimensions,
    /// Number type of the estimator.
    pub scalar: ScalarKind,
    /// Where the tag can be, m.
    pub room: Option<[f64; 4]>,
    /// Height of the tag to begin with, m.
    pub height_m: f64,
    /// Places of the anchors, m.
    pub anchors: Vec<[f64; 3]>,
    /// What they measure too long by, m, if they are calibrated.
    pub biases: Option<Vec<f64>>,
    /// Whether the log has the robot's wheels.
    pub has_wheels: bool,
    /// The height as the ranges tell it, if nobody else does, with what uncalibrated anchors measure too long
    /// then.
    pub found: Option<FoundHeight>,
    /// Constants of the tracker.
    pub tuning: Tuning,
}

impl Setup {
    /// The default tracker for a tag at a height (m) among uncalibrated anchors.
    pub fn new(anchors: &[[f64; 3]], height_m: f64) -> Self {
        Self {
            tracker: TrackerKind::Default,
            dimensions: Dimensions::Two,
            scalar: ScalarKind::F32,
            room: None,
            height_m,
            anchors: anchors.to_vec(),
            biases: None,
            has_wheels: false,
            found: None,
            tuning: Tuning::default(),
        }
    }

    /// The same for a tag at the height that was found.
    #[must_use]
    pub fn at(self, found: FoundHeight) -> Self {
        Self { height_m: found.metres, found: Some(found), ..self }
    }

    /// Whether the default tracker is moved by the wheels: in the plane.
    pub fn is_wheeled(&self) -> bool {
        self.has_wheels && self.dimensions == Dimensions::Two
    }

    /// The room in another number type.
    pub fn room<T: Scalar>(&self) -> Option<Room<T>> {
        self.room.map(|corners| {
            let [x0, y0, x1, y1] = corners.map(T::from_f64);
            Room::plane(x0, y0, x1, y1)
        })
    }

    /// The bias of an anchor, m.
    pub fn bias(&self, anchor: usize) -> f64 {
        let of = |biases: Option<&Vec<f64>>| biases?.get(anchor).copied();
        let found = self.found.as_ref().map(|found| &found.biases);
        of(self.biases.as_ref()).unwrap_or_default() + of(found).unwrap_or_default()
    }

    /// The anchors in another number type.
    pub(super) fn anchors<T: Scalar>(&self) -> Vec<Anchor<T>> {
        let places = self.anchors.iter().enumerate();
        let anchor = |(index, place): (usize, &[f64; 3])| Anchor {
            position: SVector::from(place.map(T::from_f64)),
            bias: T::from_f64(self.bias(index)),
        };
        places.map(anchor).collect()
    }
}
