//! Setups: what is known beforehand, such as the tracker, the anchors and the constants.

use kestirim_scalar::Scalar;
use kestirim_uwb_ranging::Room;
use kestirim_uwb_tracker::Anchor;
use nalgebra::SVector;

use super::{FoundHeight, Tuning};
use crate::ScalarKind;

/// The method by which ranges become positions.
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

/// The number of dimensions of positions.
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
    /// The forgetting factor, the least and the greatest variance (m²) of [`Self::Aekf`].
    pub const AEKF_LEARNING: [f64; 3] = [0.99, 0.0025, 9.0];
}

/// The options of a tracker, and its anchors.
#[derive(Debug, Clone, PartialEq)]
pub struct Setup {
    /// The method by which ranges become positions.
    pub tracker: TrackerKind,
    /// The number of dimensions of positions.
    pub dimensions: Dimensions,
    /// Number type of the estimator.
    pub scalar: ScalarKind,
    /// The rectangle in which the tag can be: two opposite corners, m.
    pub room: Option<[f64; 4]>,
    /// The initial height of the tag, m.
    pub height_m: f64,
    /// The places of the anchors, m.
    pub anchors: Vec<[f64; 3]>,
    /// The biases of the anchors, m, if they are calibrated.
    pub biases: Option<Vec<f64>>,
    /// Whether the log contains the robot's wheels.
    pub has_wheels: bool,
    /// The height found from the ranges, if none is given, with the biases of uncalibrated anchors at that height.
    pub found: Option<FoundHeight>,
    /// The constants of the tracker.
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

    /// Sets the height that was found.
    #[must_use]
    pub fn at(self, found: FoundHeight) -> Self {
        Self { height_m: found.metres, found: Some(found), ..self }
    }

    /// Whether the default tracker uses the wheels, which it does in the plane only.
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
