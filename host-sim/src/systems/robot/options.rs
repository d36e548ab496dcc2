//! How a tag is tracked: what the command line can choose.

use clap::ValueEnum;
use kestirim_uwb_ranging::Room;

use super::scenario::ANCHORS;
use crate::system::ScalarKind;

/// Number types the trackers are built for.
pub const SCALARS: [ScalarKind; 3] = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];

/// How ranges become positions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum TrackerKind {
    /// Linear trilateration of each epoch by itself (eqs 3-7)
    Lsq,
    /// Nonlinear least squares of each epoch by itself
    Nls,
    /// The paper's extended Kalman filter (eqs 8-17)
    Ekf,
    /// The adaptive filter in its safe form
    Aekf,
    /// The adaptive filter as printed (eqs 18, 19)
    AekfPrinted,
    /// Robust, adaptive, with a common bias where the anchors are not calibrated
    #[default]
    Default,
}

/// In how many dimensions.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Dimensions {
    /// In the plane, at a known height
    #[default]
    #[value(name = "2")]
    Two,
    /// In space
    #[value(name = "3")]
    Three,
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
}

impl Setup {
    /// The default tracker in the paper's office, without calibration.
    pub fn of_the_office(scalar: ScalarKind) -> Self {
        Self {
            tracker: TrackerKind::Default,
            dimensions: Dimensions::Two,
            scalar,
            room: None,
            height_m: 0.0,
            anchors: ANCHORS.to_vec(),
            biases: None,
        }
    }

    /// The room in another number type.
    pub fn room<T: kestirim_scalar::Scalar>(&self) -> Option<Room<T>> {
        self.room.map(|corners| {
            let [x0, y0, x1, y1] = corners.map(T::from_f64);
            Room::plane(x0, y0, x1, y1)
        })
    }

    /// The bias of an anchor, m.
    pub fn bias(&self, anchor: usize) -> f64 {
        self.biases.as_ref().and_then(|biases| biases.get(anchor)).copied().unwrap_or_default()
    }
}

/// Reads `X0,Y0,X1,Y1`, two opposite corners.
///
/// # Errors
/// A sentence that says what was expected.
pub fn parse_room(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|field| field.trim().parse()).collect();
    let corners = numbers.ok().and_then(|numbers| <[f64; 4]>::try_from(numbers).ok());
    match corners {
        Some([x0, y0, x1, y1]) if x0 != x1 && y0 != y1 && (x0 + y0 + x1 + y1).is_finite() => {
            Ok([x0, y0, x1, y1])
        }
        _ => Err("expected two opposite corners X0,Y0,X1,Y1 in metres".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_are_two_corners() {
        assert_eq!(parse_room("0, 0,4.8,6.4"), Ok([0.0, 0.0, 4.8, 6.4]));
        for text in ["", "1,2,3", "1,2,1,3", "1,2,3,4,5", "a,b,c,d", "0,0,inf,1", "0,0,NaN,1"] {
            assert!(parse_room(text).is_err(), "{text}");
        }
    }
}
