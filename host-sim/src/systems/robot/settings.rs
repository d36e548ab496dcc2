//! How a tag is tracked: what can be set, and what it means.

mod firmware;
pub mod tuning;

use clap::ValueEnum;
use kestirim_uwb_ranging::Room;

use self::tuning::Tuning;
use super::height::{self, FoundHeight};
use super::recording::anchors::Anchors;
use super::recording::{Heights, Part, Recording};
use super::simulate::scenario::ANCHORS;
use crate::Error;
use crate::system::{Idle, ScalarKind, Setting, Settings};

/// Number types the trackers are built for.
pub const SCALARS: [ScalarKind; 3] = [ScalarKind::F32, ScalarKind::F64, ScalarKind::Fixed];

/// Farther above or below the anchors no slider looks for a tag, m.
const HEIGHTS: f64 = 5.0;
/// Nor does anything else, m above or below the floor.
const HIGHEST: f64 = 1e4;
/// The room that ends at the outermost anchors.
const WITHIN_ANCHORS: &str = "anchors";

/// What can be set.
pub(super) fn table(recording: Option<&Recording>) -> Vec<Setting> {
    let own = Tuning::default();
    let [long, short] = own.huber_sigmas.unwrap_or_default();
    let height = recording.map_or(0.0, |recording| recording.anchors.mean_height());
    let [least, most] = match recording {
        Some(_) => [height - HEIGHTS, height + HEIGHTS],
        None => [-HIGHEST, HIGHEST],
    };
    let sigmas = [0.1, 5.0, 0.1];
    vec![
        Setting::one_of("tracker", "How ranges become positions", &TrackerKind::default()).live(),
        Setting::one_of("dim", "Dimensions of the position", &Dimensions::default()).live(),
        Setting::number(
            "height",
            "Height of the tag in two dimensions [default: from the ranges, between floor and highest anchor]",
            "m",
            [least, most, 0.05],
            height,
        )
        .undecided()
        .live(),
        Setting::text(
            "room",
            "Where the tag can be: two opposite corners, m, or the rectangle around the anchors",
            "X0,Y0,X1,Y1|anchors",
            check_room,
        )
        .live(),
        Setting::decades(
            "range-sigma",
            "Standard deviation of a range to begin with",
            "m",
            [0.01, 1.0],
            own.range_sigma_m,
        )
        .live(),
        Setting::decades(
            "acceleration",
            "Power spectral density of the acceleration",
            "m²/s³",
            [0.001, 10.0],
            own.acceleration_density,
        )
        .live(),
        Setting::switch("gating", "Leave out ranges beyond the gate", true).live(),
        Setting::number(
            "gate",
            "Standard deviations beyond which a range is left out",
            "σ",
            [1.0, 15.0, 0.5],
            own.gate_sigmas.unwrap_or_default(),
        )
        .live(),
        Setting::switch("huber", "Weaken ranges that do not fit, after Huber", true).live(),
        Setting::number(
            "huber-long",
            "Standard deviations beyond which a range that is too long is weakened",
            "σ",
            sigmas,
            long,
        )
        .live(),
        Setting::number(
            "huber-short",
            "Standard deviations beyond which a range that is too short is weakened",
            "σ",
            sigmas,
            short,
        )
        .live(),
        Setting::switch("learning", "Learn the variance of each anchor's ranges", own.learns)
            .live(),
        Setting::decades(
            "decay",
            "Time constant with which a velocity decays",
            "s",
            [0.2, 20.0],
            own.decay_time_s.unwrap_or_default(),
        )
        .live(),
        Setting::some_of("scalar", "Number type of the tracker", &SCALARS, &ScalarKind::F32).live(),
        Setting::switch("calibrated", "Use the calibration of the anchors", true).live(),
    ]
}

/// Why a setting has no effect as the recording and the others are.
pub(super) fn idle(recording: Option<&Recording>, settings: &Settings, name: &str) -> Option<Idle> {
    use TrackerKind::{Aekf, AekfPublished, Default, Ekf, Lsq};
    let tracker = settings.chosen::<TrackerKind>("tracker");
    let has = |what: fn(&Recording) -> bool| recording.is_some_and(what);
    match name {
        "height" if settings.chosen::<Dimensions>("dim") == Dimensions::Three => {
            Some(Idle::implied("is estimated with --dim 3"))
        }
        "height" if has(|recording| recording.heights == Heights::Read) => {
            Some(Idle::implied("is that of the file of heights"))
        }
        "room" if matches!(tracker, Lsq | AekfPublished) => {
            Some(Idle::implied("does not act with --tracker lsq and aekf-published"))
        }
        "range-sigma" | "acceleration" if !matches!(tracker, Ekf | Aekf | Default) => {
            Some(Idle::foreign("is for --tracker ekf, aekf or default"))
        }
        "gating" | "gate" | "huber" | "huber-long" | "huber-short" | "learning" | "decay"
            if tracker != Default =>
        {
            Some(Idle::foreign("is for --tracker default"))
        }
        "gate" if !settings.is_on("gating") => Some(Idle::foreign("does not act with --no-gating")),
        "huber-long" | "huber-short" if !settings.is_on("huber") => {
            Some(Idle::foreign("does not act with --no-huber"))
        }
        "calibrated" if has(|recording| recording.biases.is_none()) => {
            Some(Idle::foreign("is for recordings with --calibration"))
        }
        _ => None,
    }
}

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
    /// The adaptive filter as published (eqs 18, 19)
    #[value(alias = "aekf-printed")]
    AekfPublished,
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

    /// The default tracker in the paper's office, without calibration.
    pub fn of_the_office(scalar: ScalarKind) -> Self {
        Self { scalar, ..Self::new(&ANCHORS, 0.0) }
    }

    /// As set, for what was recorded. A height that nobody says is found from the ranges.
    ///
    /// # Errors
    /// [`Error::Usage`]: the ranges do not tell it.
    pub fn of_recording(recording: &Recording, settings: &Settings) -> Result<Self, Error> {
        let has_wheels = recording.parts.iter().any(Part::has_wheels);
        let setup = Self::of(settings, &recording.anchors, recording.biases.as_deref());
        let setup = Self { has_wheels, ..setup };
        if !height::is_missing(recording, settings) {
            return Ok(setup);
        }
        let found = height::of_recording(recording, &setup)?;
        Ok(setup.at(found))
    }

    /// The same for a tag at the height that was found.
    pub(super) fn at(self, found: FoundHeight) -> Self {
        Self { height_m: found.metres, found: Some(found), ..self }
    }

    /// As set, for anchors and what they measure too long by (m), if that is known. A height that is not set is the
    /// anchors' mean height.
    pub fn of(settings: &Settings, anchors: &Anchors, biases: Option<&[f64]>) -> Self {
        let room = settings.text("room").and_then(|text| match text.as_str() {
            WITHIN_ANCHORS => Some(anchors.rectangle()),
            corners => parse_room(corners).ok(),
        });
        Self {
            tracker: settings.chosen("tracker"),
            dimensions: settings.chosen("dim"),
            scalar: settings.chosen("scalar"),
            room,
            height_m: settings.number("height").unwrap_or_else(|| anchors.mean_height()),
            anchors: anchors.positions.clone(),
            biases: biases.filter(|_| settings.is_on("calibrated")).map(<[f64]>::to_vec),
            has_wheels: false,
            found: None,
            tuning: Tuning::of(settings),
        }
    }

    /// Whether the default tracker is moved by the wheels: in the plane.
    pub(super) fn is_wheeled(&self) -> bool {
        self.has_wheels && self.dimensions == Dimensions::Two
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
        let of = |biases: Option<&Vec<f64>>| biases?.get(anchor).copied();
        let found = self.found.as_ref().map(|found| &found.biases);
        of(self.biases.as_ref()).unwrap_or_default() + of(found).unwrap_or_default()
    }
}

fn check_room(text: &str) -> Result<(), String> {
    if text == WITHIN_ANCHORS { Ok(()) } else { parse_room(text).map(drop) }
}

/// Reads `X0,Y0,X1,Y1`, two opposite corners.
fn parse_room(text: &str) -> Result<[f64; 4], String> {
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|field| field.trim().parse()).collect();
    let corners = numbers.ok().and_then(|numbers| <[f64; 4]>::try_from(numbers).ok());
    match corners {
        Some([x0, y0, x1, y1]) if x0 != x1 && y0 != y1 && (x0 + y0 + x1 + y1).is_finite() => {
            Ok([x0, y0, x1, y1])
        }
        _ => Err("expected two opposite corners X0,Y0,X1,Y1 in metres, or anchors".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rooms_are_two_corners() {
        assert_eq!(parse_room("0, 0,4.8,6.4"), Ok([0.0, 0.0, 4.8, 6.4]));
        for text in ["", "1,2,3", "1,2,1,3", "1,2,3,4,5", "a,b,c,d", "0,0,inf,1", "0,0,NaN,1"] {
            assert!(check_room(text).is_err(), "{text}");
        }
        assert!(check_room("anchors").is_ok());
    }

    #[test]
    fn nothing_set_is_the_default_tracker() {
        let settings = Settings::new(table(None));
        let anchors = Anchors { positions: ANCHORS.to_vec(), ..Anchors::default() };
        let biases = [0.1; 4];
        let expected = Setup::of_the_office(ScalarKind::F32);
        assert_eq!(Setup::of(&settings, &anchors, None), expected);
        let expected = Setup { biases: Some(biases.to_vec()), ..expected };
        assert_eq!(Setup::of(&settings, &anchors, Some(&biases)), expected);
    }
}
