//! The settings of the estimation of positions from observations.

mod filter;
mod firmware;
mod part;

use kestirim_gnss_ppp::Corrections;
use kestirim_ppp_filter::{Config, Motion};
use kestirim_replay::gnss::{Ambiguities, FilterKind, Method, Recording, Systems};
use kestirim_robust_kalman::{Igg3, Weight};
use nalgebra::Vector3;

pub use self::filter::{Choice, Mode};
use self::part::Part;
use super::recording::truth::place;
use crate::system::{Idle, ScalarKind, Setting, Settings};

/// The number types that the filter supports: resolving ranges of 26 000 km to a millimetre requires the digits.
pub const SCALARS: [ScalarKind; 1] = [ScalarKind::F64];

/// The variance rate of each coordinate of a freely moving receiver (m²/s): in the 30 s between epochs the standard
/// deviation grows to 55 m, so that only the observations of an epoch determine the position.
pub const PROCESS_NOISE: f64 = 100.0;

/// The highest elevation mask (degrees): above it there are hardly ever four satellites.
const HIGHEST_MASK: f64 = 60.0;

/// The largest gradient (m): ten times that of a weather front.
const STEEPEST: f64 = 0.02;

/// The available settings.
pub(super) fn table(recording: Option<&Recording>) -> Vec<Setting> {
    let [first, last] = recording.map_or([0.0, 1e9], Recording::span);
    let step = ((last - first) / 200.0).max(1.0);
    vec![
        Setting::one_of("mode", "Whether the receiver moves", &Mode::default()).live(),
        Setting::one_of("systems", "Satellites of which systems serve", &Systems::default()).live(),
        Setting::one_of("method", "From what positions are made", &Method::default()).live(),
        Setting::one_of("ambiguities", "Whether ambiguities become whole", &Ambiguities::default()),
        Setting::decades(
            "process-noise",
            "Variance added to each coordinate of a receiver that may move; 1e-4 holds a slow one together \
             [default: 100, each epoch stands alone]",
            "m²/s",
            [1e-12, 1e6],
            PROCESS_NOISE,
        )
        .undecided()
        .live(),
        Setting::one_of(
            "filter",
            "What is done about observations that do not fit",
            &Choice::default(),
        )
        .live(),
        Setting::switch("published", "Take the paper's robust filters as published: worse", false)
            .alias("printed"),
        Setting::number(
            "k0",
            "Standardised residual up to which IGG III gives full weight [default: the filter's own]",
            "",
            [1.0, 6.0, 0.1],
            3.5,
        )
        .undecided(),
        Setting::number(
            "k1",
            "Standardised residual beyond which IGG III gives no weight [default: the filter's own]",
            "",
            [6.0, 16.0, 0.1],
            8.0,
        )
        .undecided(),
        Setting::number(
            "mask",
            "Lowest elevation of a satellite [default: 8]",
            "°",
            [0.0, HIGHEST_MASK, 1.0],
            8.0,
        )
        .undecided()
        .live(),
        Setting::number(
            "gradient",
            "Standard deviation of the troposphere's horizontal gradients; 0: none [default: 0.0005 of the default \
             filter, where clocks come every five minutes or more often; else none]",
            "m",
            [0.0, STEEPEST, 1e-4],
            5e-4,
        )
        .undecided(),
        Setting::switch(
            "smooth",
            "Smooth: put together what is found forwards and backwards (not for firmware)",
            false,
        ),
        Setting::any_of::<Part>(
            "without",
            "Part of the model that is left out, to see what it is worth; may be given again",
        ),
        Setting::text(
            "truth",
            "Where the marker really is, ECEF, m; serves accuracy alone",
            "X,Y,Z",
            |text| place(text).map(|_| ()),
        ),
        Setting::number(
            "until",
            "Last epoch, in seconds since the midnight before the first one, as all times here",
            "s",
            [first, last, step],
            last,
        )
        .undecided()
        .playable(),
        Setting::some_of("scalar", "Number type of the filter", &SCALARS, &ScalarKind::F64),
    ]
}

/// Why a setting has no effect given the others.
pub(super) fn idle(settings: &Settings, name: &str) -> Option<Idle> {
    let any = |is: fn(FilterKind) -> bool| {
        settings.chosen::<Choice>("filter").filters().iter().any(|filter| is(*filter))
    };
    let is_single = settings.chosen::<Method>("method") == Method::Single;
    match name {
        "mode" | "process-noise" | "ambiguities" | "gradient" | "smooth" if is_single => {
            Some(Idle::foreign("is for --method filter"))
        }
        "process-noise" if settings.chosen::<Mode>("mode") == Mode::Static => {
            Some(Idle::foreign("is for --mode kinematic"))
        }
        "published" if !any(FilterKind::is_published) => {
            Some(Idle::foreign("is for --filter rkf, skf, ikf, adaptive or all"))
        }
        "k0" | "k1" if !any(FilterKind::has_thresholds) => {
            Some(Idle::foreign("is for --filter rkf, ikf, adaptive, default or all"))
        }
        "scalar" => {
            Some(Idle::implied("is always f64: 26 000 km to a millimetre need all its digits"))
        }
        _ => None,
    }
}

/// The complete settings of the estimation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// One filter, or all.
    pub filter: Choice,
    /// Whether and how the receiver moves.
    pub motion: Motion,
    /// The satellite systems used.
    pub systems: Systems,
    /// The method by which positions are computed.
    pub method: Method,
    /// Whether ambiguities are fixed to integers.
    pub ambiguities: Ambiguities,
    /// The elevation mask (rad); `None` for the filter's own.
    pub mask: Option<f64>,
    /// The standard deviation of the troposphere's gradients (m); `None` for the filter's own.
    pub gradient: Option<f64>,
    /// Whether the paper's filters are taken as published.
    pub published: bool,
    /// The thresholds k0 and k1 of filters with IGG III weights; `None` for the filter's own.
    pub thresholds: [Option<f64>; 2],
    /// The corrections that are applied.
    pub corrections: Corrections,
    /// Whether the recording is also processed backwards.
    pub is_smoothed: bool,
    /// The time of the last epoch, in seconds since the midnight before the first one; `None` for all epochs.
    pub until: Option<f64>,
    /// The true position of the marker (ECEF, m); `None` for that of the recording.
    pub truth: Option<Vector3<f64>>,
}

impl Setup {
    /// The default settings for one filter.
    pub fn new(filter: FilterKind, motion: Motion) -> Self {
        Self {
            filter: Choice::One(filter),
            motion,
            systems: Systems::default(),
            method: Method::default(),
            ambiguities: Ambiguities::default(),
            mask: None,
            gradient: None,
            published: false,
            thresholds: [None; 2],
            corrections: Corrections::ALL,
            is_smoothed: false,
            until: None,
            truth: None,
        }
    }

    /// The settings as given by the user.
    pub fn of(settings: &Settings) -> Self {
        let motion = match settings.chosen("mode") {
            Mode::Static => Motion::Static,
            Mode::Kinematic => {
                let process_noise = settings.number("process-noise").unwrap_or(PROCESS_NOISE);
                Motion::Kinematic { process_noise }
            }
        };
        let left_out = settings.all_of::<Part>("without").into_iter();
        Self {
            filter: settings.chosen("filter"),
            motion,
            systems: settings.chosen("systems"),
            method: settings.chosen("method"),
            ambiguities: settings.chosen("ambiguities"),
            mask: settings.number("mask").map(f64::to_radians),
            gradient: settings.number("gradient"),
            published: settings.is_on("published"),
            thresholds: ["k0", "k1"].map(|name| settings.number(name)),
            corrections: left_out.fold(Corrections::ALL, |all, part| all.without(part.into())),
            is_smoothed: settings.is_on("smooth")
                && settings.chosen::<Method>("method") == Method::Filter,
            until: settings.number("until"),
            truth: settings.text("truth").and_then(|text| place(&text).ok()),
        }
    }

    /// The configuration of a filter.
    pub fn config(&self, filter: FilterKind) -> Config {
        let mut config = filter.config(self.motion, self.published);
        if let Weight::Igg3(Igg3 { k0, k1, .. }) = &mut config.estimator.robust.weight {
            for (own, given) in [k0, k1].into_iter().zip(self.thresholds) {
                *own = given.unwrap_or(*own);
            }
        }
        let elevation_mask = self.mask.unwrap_or(config.elevation_mask);
        Config { elevation_mask, gradient: self.gradient.unwrap_or(config.gradient), ..config }
    }

    /// The true position of the marker (ECEF, m): the given one, or else that of the recording.
    pub fn truth(&self, recording: &Recording) -> Option<Vector3<f64>> {
        self.truth.or(recording.truth)
    }

    /// The filter that is shown in detail: the chosen one, or the default if all are.
    pub fn main(&self) -> FilterKind {
        match self.filter {
            Choice::One(filter) => filter,
            Choice::All => FilterKind::default(),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::ValueEnum;
    use kestirim_gnss_ppp::Correction;

    use super::*;

    #[test]
    fn numbers_are_where_they_can_be() {
        for setting in table(None) {
            for text in ["", "-1", "nan", "inf", "x", "1e300"] {
                assert!(setting.read(text).is_err(), "{} {text}", setting.name);
            }
        }
    }

    #[test]
    fn parts_can_be_left_out() -> Result<(), crate::Error> {
        let mut settings = Settings::new(table(None));
        settings.set("without", "solid-tide")?;
        settings.set("without", "solid-tide")?;
        let Setup { corrections, .. } = Setup::of(&settings);
        for correction in Correction::ALL {
            assert_eq!(corrections.has(correction), correction != Correction::SolidTide);
        }
        assert_eq!(Part::value_variants().len(), Correction::ALL.len());
        Ok(())
    }
}
