//! How observations become positions: what can be set, and what it means.

use clap::ValueEnum;
use clap::builder::PossibleValue;
use kestirim_gnss_ppp::{Correction, Corrections};
use kestirim_ppp_filter::{Config, Estimator, Motion, states};
use kestirim_robust_kalman::{Igg3, Weight};
use nalgebra::Vector3;
use serde::Serialize;

use super::recording::Recording;
use super::recording::truth::place;
use crate::system::{Idle, Literal, ScalarKind, Setting, Settings};

/// Number types the filter is built for: ranges of 26 000 km to a millimetre need the digits.
pub const SCALARS: [ScalarKind; 1] = [ScalarKind::F64];

/// States of a filter with room for twenty satellites: from no place on earth more of the 32 are seen.
pub const STATES: usize = states(20);

/// Variance per second of each coordinate of a receiver that may move at will, m²/s: in the 30 s between
/// epochs it gets 55 m away, so that only what is observed in an epoch tells where it is.
pub const PROCESS_NOISE: f64 = 100.0;

/// The highest mask, degrees: above it there are hardly ever four satellites.
const HIGHEST_MASK: f64 = 60.0;

/// What can be set.
pub(super) fn table(recording: Option<&Recording>) -> Vec<Setting> {
    let [first, last] = recording.map_or([0.0, 1e9], Recording::span);
    let step = ((last - first) / 200.0).max(1.0);
    vec![
        Setting::one_of("mode", "Whether the receiver moves", &Mode::default()),
        Setting::decades(
            "process-noise",
            "Variance added to each coordinate of a receiver that may move; 1e-4 holds a slow one together \
             [default: 100, each epoch stands alone]",
            "m²/s",
            [1e-12, 1e6],
            PROCESS_NOISE,
        )
        .undecided(),
        Setting::one_of(
            "filter",
            "What is done about observations that do not fit",
            &Choice::default(),
        ),
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
        .undecided(),
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

/// Why a setting has no effect as the others are.
pub(super) fn idle(settings: &Settings, name: &str) -> Option<Idle> {
    let any = |is: fn(FilterKind) -> bool| {
        settings.chosen::<Choice>("filter").filters().iter().any(|filter| is(*filter))
    };
    match name {
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

/// Everything that can be chosen about how observations become positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setup {
    /// One filter, or all.
    pub filter: Choice,
    /// Whether the receiver moves, and how.
    pub motion: Motion,
    /// Lowest elevation of a satellite, rad; none: the filter's own choice.
    pub mask: Option<f64>,
    /// Whether the paper's filters are taken as published.
    pub published: bool,
    /// Thresholds k0 and k1 of filters with IGG III weights; none: the filter's own.
    pub thresholds: [Option<f64>; 2],
    /// What is corrected.
    pub corrections: Corrections,
    /// The last epoch, s since the midnight before the first one; none: all are taken.
    pub until: Option<f64>,
    /// Where the marker really is, ECEF, m; none: what the recording knows.
    pub truth: Option<Vector3<f64>>,
}

impl Setup {
    /// The defaults with one filter.
    pub fn new(filter: FilterKind, motion: Motion) -> Self {
        Self {
            filter: Choice::One(filter),
            motion,
            mask: None,
            published: false,
            thresholds: [None; 2],
            corrections: Corrections::ALL,
            until: None,
            truth: None,
        }
    }

    /// As set.
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
            mask: settings.number("mask").map(f64::to_radians),
            published: settings.is_on("published"),
            thresholds: ["k0", "k1"].map(|name| settings.number(name)),
            corrections: left_out.fold(Corrections::ALL, |all, part| all.without(part.into())),
            until: settings.number("until"),
            truth: settings.text("truth").and_then(|text| place(&text).ok()),
        }
    }

    /// The settings of a filter.
    pub fn config(&self, filter: FilterKind) -> Config {
        let config = Config::new(self.motion);
        let mut estimator = filter.estimator(self.motion, self.published);
        if let Weight::Igg3(Igg3 { k0, k1, .. }) = &mut estimator.robust.weight {
            for (own, given) in [k0, k1].into_iter().zip(self.thresholds) {
                *own = given.unwrap_or(*own);
            }
        }
        let elevation_mask = self.mask.unwrap_or(config.elevation_mask);
        Config { elevation_mask, estimator, ..config }
    }

    /// Where the marker really is: as set, or else as the recording knows, ECEF, m.
    pub fn truth(&self, recording: &Recording) -> Option<Vector3<f64>> {
        self.truth.or(recording.truth)
    }

    /// The filter of which most is told: the chosen one, or the last of all.
    pub fn main(&self) -> FilterKind {
        match self.filter {
            Choice::One(filter) => filter,
            Choice::All => FilterKind::default(),
        }
    }

    /// The same in firmware: the filter's settings and what of the receiver is corrected.
    pub(super) fn firmware(&self) -> String {
        let filter = self.main();
        let motion = match self.motion {
            Motion::Static => "Motion::Static".to_owned(),
            Motion::Kinematic { process_noise } => {
                format!("Motion::Kinematic {{ process_noise: {process_noise:?} }}")
            }
        };
        let base = format!("Config::new({motion})");
        let imports = "kestirim_ppp_filter::{Config, Motion}";
        let mut literal = Literal::new(imports, ScalarKind::F64, "Config", &base)
            .number_field("elevation_mask", self.mask);
        let constructor = match filter {
            FilterKind::Gkf => "plain()",
            FilterKind::Rkf => "igg3()",
            FilterKind::Skf => "t_test()",
            FilterKind::Ikf => "iterative_igg3()",
            FilterKind::Adaptive => "adaptive()",
            FilterKind::Default => &format!("guarded({motion})"),
        };
        let mut changes = Vec::new();
        let (published, ours) =
            (self.published && filter.is_published(), filter.estimator(self.motion, false));
        if published {
            changes.push("estimator.robust = estimator.robust.published();".to_owned());
        }
        let weight = self.config(filter).estimator.robust.weight;
        if let (true, Weight::Igg3(Igg3 { k0, k1, descent })) =
            (filter.has_thresholds() && self.thresholds != [None; 2], weight)
        {
            literal = literal.import("kestirim_robust_kalman::{Descent, Igg3, Weight}");
            changes.push(format!(
                "estimator.robust.weight = Weight::Igg3(Igg3 {{ k0: {k0:?}, k1: {k1:?}, descent: \
                 Descent::{descent:?} }});"
            ));
        }
        if !changes.is_empty() || ours != Config::new(self.motion).estimator {
            let value = match &*changes {
                [] => format!("Estimator::{constructor}"),
                changes => format!(
                    "{{\n        let mut estimator = Estimator::{constructor};\n        {}\n        estimator\n    }}",
                    changes.join("\n        ")
                ),
            };
            literal = literal.import("kestirim_ppp_filter::Estimator").field("estimator", value);
        }
        if self.corrections != Corrections::ALL {
            let left_out = Correction::ALL.into_iter().filter(|part| !self.corrections.has(*part));
            let without: String =
                left_out.map(|part| format!(".without(Correction::{part:?})")).collect();
            literal = literal
                .import("kestirim_gnss_ppp::{Correction, Corrections}")
                .then(format!("let corrections = Corrections::ALL{without};"));
        }
        literal.to_string()
    }
}

/// Whether the receiver moves.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// It stands still
    #[default]
    Static,
    /// It may move
    Kinematic,
}

impl Mode {
    /// Of a filter.
    pub const fn of(motion: Motion) -> Self {
        match motion {
            Motion::Static => Self::Static,
            Motion::Kinematic { .. } => Self::Kinematic,
        }
    }
}

/// Which filter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum FilterKind {
    /// The plain Kalman filter (the paper's GKF)
    Gkf,
    /// IGG III weights, all at once (RKF)
    Rkf,
    /// Classification by a t-test (SKF)
    Skf,
    /// IGG III weights, the worst observation first (IKF)
    Ikf,
    /// The same and an adaptive factor on the position (the paper's UKF)
    Adaptive,
    /// Our own: robust, and slips that nothing else shows are found
    #[default]
    Default,
}

impl FilterKind {
    /// Every filter, in the order of tables.
    pub const ALL: [Self; 6] =
        [Self::Gkf, Self::Rkf, Self::Skf, Self::Ikf, Self::Adaptive, Self::Default];

    /// Whether the paper publishes formulas of it from which ours differ.
    pub const fn is_published(self) -> bool {
        matches!(self, Self::Rkf | Self::Skf | Self::Ikf | Self::Adaptive)
    }

    /// Whether it weights by IGG III, between two thresholds.
    const fn has_thresholds(self) -> bool {
        !matches!(self, Self::Gkf | Self::Skf)
    }

    /// As on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Gkf => "gkf",
            Self::Rkf => "rkf",
            Self::Skf => "skf",
            Self::Ikf => "ikf",
            Self::Adaptive => "adaptive",
            Self::Default => "default",
        }
    }

    /// What people call it.
    pub const fn title(self) -> &'static str {
        match self {
            Self::Gkf => "plain (GKF)",
            Self::Rkf => "IGG III (RKF)",
            Self::Skf => "t-test (SKF)",
            Self::Ikf => "iterative IGG III (IKF)",
            Self::Adaptive => "adaptive (UKF)",
            Self::Default => "default",
        }
    }

    /// What is done about observations that do not fit, as the paper publishes it if `published`.
    pub fn estimator(self, motion: Motion, published: bool) -> Estimator {
        let ours = match self {
            Self::Gkf => Estimator::plain(),
            Self::Rkf => Estimator::igg3(),
            Self::Skf => Estimator::t_test(),
            Self::Ikf => Estimator::iterative_igg3(),
            Self::Adaptive => Estimator::adaptive(),
            Self::Default => Estimator::guarded(motion),
        };
        if published && self.is_published() {
            Estimator { robust: ours.robust.published(), ..ours }
        } else {
            ours
        }
    }
}

/// One filter, or all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Choice {
    /// One of them.
    One(FilterKind),
    /// All of them, compared.
    All,
}

impl Choice {
    /// Which, in the order of tables.
    pub const fn filters(&self) -> &[FilterKind] {
        match self {
            Self::One(filter) => std::slice::from_ref(filter),
            Self::All => &FilterKind::ALL,
        }
    }
}

impl Default for Choice {
    fn default() -> Self {
        Self::One(FilterKind::default())
    }
}

impl ValueEnum for Choice {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [Choice; 7] = {
            let mut all = [Choice::All; 7];
            let mut place = 0;
            while place < FilterKind::ALL.len() {
                all[place] = Choice::One(FilterKind::ALL[place]);
                place += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::One(kind) => kind.to_possible_value(),
            Self::All => Some(PossibleValue::new("all").help("All six, compared")),
        }
    }
}

/// A part of the observation model that can be left out.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Part {
    /// The satellite's clock on its eccentric orbit
    Relativity,
    /// The delay in the Earth's gravity
    Shapiro,
    /// The Earth's rotation while the signal travels
    Sagnac,
    /// The hydrostatic troposphere
    Troposphere,
    /// The tide of the solid Earth
    SolidTide,
    /// The load of the oceans' tides
    OceanLoading,
    /// The turning of the antennas against each other
    WindUp,
    /// The phase centre of the satellite's antenna
    SatelliteAntenna,
    /// The phase centre of the receiver's antenna
    ReceiverAntenna,
}

impl From<Part> for Correction {
    fn from(part: Part) -> Self {
        match part {
            Part::Relativity => Self::Relativity,
            Part::Shapiro => Self::Shapiro,
            Part::Sagnac => Self::Sagnac,
            Part::Troposphere => Self::Troposphere,
            Part::SolidTide => Self::SolidTide,
            Part::OceanLoading => Self::OceanLoading,
            Part::WindUp => Self::WindUp,
            Part::SatelliteAntenna => Self::SatelliteAntenna,
            Part::ReceiverAntenna => Self::ReceiverAntenna,
        }
    }
}

#[cfg(test)]
mod tests {
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
    fn what_is_published_is_of_the_robust_filters() {
        let estimator = |kind: FilterKind, published| kind.estimator(Motion::Static, published);
        for kind in FilterKind::ALL {
            assert_eq!(estimator(kind, true) != estimator(kind, false), kind.is_published());
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

    #[test]
    fn firmware_says_what_differs() -> Result<(), crate::Error> {
        let mut settings = Settings::new(table(None));
        assert!(Setup::of(&settings).firmware().ends_with("= Config::new(Motion::Static);"));
        for (name, text) in [("filter", "rkf"), ("published", "true"), ("k0", "2"), ("mask", "15")]
        {
            settings.set(name, text)?;
        }
        let firmware = Setup::of(&settings).firmware();
        for line in [
            "elevation_mask: 0.2617993877991494",
            "let mut estimator = Estimator::igg3();",
            "estimator.robust = estimator.robust.published();",
            "Igg3 { k0: 2.0, k1: 6.0, descent: Descent::Published }",
        ] {
            assert!(firmware.contains(line), "{firmware}");
        }
        Ok(())
    }
}
