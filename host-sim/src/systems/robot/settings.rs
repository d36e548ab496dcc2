//! The settings of the tracking of a tag.

pub(super) mod firmware;

use kestirim_replay::ScalarKind;
use kestirim_replay::robot::{Anchors, Dimensions, KnownHeight, Setup, TrackerKind, Tuning};

use super::height;
use super::recording::{Heights, Part, Recording};
use super::simulate::scenario::ANCHORS;
use crate::Error;
use crate::system::{Idle, Setting, Settings};

/// The range of the height's slider above and below the anchors (m).
const HEIGHTS: f64 = 5.0;
/// The largest possible height above or below the floor (m).
const HIGHEST: f64 = 1e4;
/// The value of the setting for a room bounded by the outermost anchors.
const WITHIN_ANCHORS: &str = "anchors";

/// The available settings.
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
        Setting::one_of("scalar", "Number type of the tracker", &ScalarKind::F32).live(),
        Setting::switch(
            "smooth",
            "Smooth: each position from what was measured before and after, too (not for firmware)",
            false,
        ),
        Setting::switch("calibrated", "Use the calibration of the anchors", true).live(),
    ]
}

/// Why a setting has no effect given the recording and the other settings.
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
        | "smooth"
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

/// The setup of the default tracker in the paper's office, without calibration.
pub fn of_the_office(scalar: ScalarKind) -> Setup {
    Setup { scalar, ..Setup::new(&ANCHORS, 0.0) }
}

/// The setup for a recording. A height that is not given is found from the ranges.
///
/// # Errors
/// [`Error::Usage`] if the ranges do not determine the height.
pub fn of_recording(recording: &Recording, settings: &Settings) -> Result<Setup, Error> {
    let has_wheels = recording.parts.iter().any(Part::has_wheels);
    let setup = of(settings, &recording.anchors, recording.biases.as_deref());
    let setup = Setup { has_wheels, ..setup };
    if !height::is_missing(recording, settings) {
        return Ok(setup);
    }
    let found = height::of_recording(recording, &setup)?;
    Ok(setup.at(found))
}

/// The knowledge of the tag's height. If the ranges do not determine it, the tracker reports that.
pub(super) fn known_height(recording: &Recording, settings: &Settings) -> KnownHeight {
    if recording.heights == Heights::Read {
        return KnownHeight::Varying;
    }
    let is_in_plane = settings.chosen::<Dimensions>("dim") == Dimensions::Two;
    let height = is_in_plane.then(|| of_recording(recording, settings).ok()).flatten();
    match height.map(|setup| setup.height_m) {
        None if is_in_plane => KnownHeight::NotFound,
        None => KnownHeight::Unknown,
        Some(metres) if settings.is_given("height") => KnownHeight::Said(metres),
        Some(metres) => KnownHeight::Found(metres),
    }
}

/// The setup for anchors and their biases (m), if known. A height that is not set is the anchors' mean height.
pub fn of(settings: &Settings, anchors: &Anchors, biases: Option<&[f64]>) -> Setup {
    let room = settings.text("room").and_then(|text| match text.as_str() {
        WITHIN_ANCHORS => Some(anchors.rectangle()),
        corners => parse_room(corners).ok(),
    });
    Setup {
        tracker: settings.chosen("tracker"),
        dimensions: settings.chosen("dim"),
        scalar: settings.chosen("scalar"),
        room,
        height_m: settings.number("height").unwrap_or_else(|| anchors.mean_height()),
        anchors: anchors.positions.clone(),
        biases: biases.filter(|_| settings.is_on("calibrated")).map(<[f64]>::to_vec),
        has_wheels: false,
        found: None,
        tuning: tuning(settings),
    }
}

fn tuning(settings: &Settings) -> Tuning {
    let huber = ["huber-long", "huber-short"].map(|name| settings.decided(name));
    Tuning {
        range_sigma_m: settings.decided("range-sigma"),
        acceleration_density: settings.decided("acceleration"),
        gate_sigmas: settings.is_on("gating").then(|| settings.decided("gate")),
        huber_sigmas: settings.is_on("huber").then_some(huber),
        decay_time_s: settings.number("decay"),
        learns: settings.is_on("learning"),
    }
}

fn check_room(text: &str) -> Result<(), String> {
    if text == WITHIN_ANCHORS { Ok(()) } else { parse_room(text).map(drop) }
}

/// Parses `X0,Y0,X1,Y1`, two opposite corners.
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
        let expected = of_the_office(ScalarKind::F32);
        assert_eq!(of(&settings, &anchors, None), expected);
        let expected = Setup { biases: Some(biases.to_vec()), ..expected };
        assert_eq!(of(&settings, &anchors, Some(&biases)), expected);
    }
}
