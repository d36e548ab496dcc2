//! What can be turned.

use kestirim_gnss_ppp::Corrections;

use super::super::options::{FilterKind, HIGHEST_MASK, PROCESS_NOISE};
use super::super::parts::{Part, all_but};
use crate::explore::{Control, Settings};

/// Parts of the observation model, each with the name of its switch and what people call it.
const PARTS: [(Part, &str, &str); 9] = [
    (Part::SolidTide, "solid-tide", "tide of the solid Earth"),
    (Part::OceanLoading, "ocean-loading", "load of the oceans' tides"),
    (Part::Troposphere, "troposphere", "hydrostatic troposphere"),
    (Part::WindUp, "wind-up", "wind-up of the antennas"),
    (Part::SatelliteAntenna, "satellite-antenna", "phase centre of the satellite's antenna"),
    (Part::ReceiverAntenna, "receiver-antenna", "phase centre of the receiver's antenna"),
    (Part::Relativity, "relativity", "relativity of the satellite's clock"),
    (Part::Shapiro, "shapiro", "delay in the Earth's gravity"),
    (Part::Sagnac, "sagnac", "rotation of the Earth while the signal travels"),
];

/// All of them, for a recording from and to some hour.
pub(super) fn controls([first, last]: [f64; 2]) -> Vec<Control> {
    let options =
        [FilterKind::Default, FilterKind::Gkf, FilterKind::Rkf, FilterKind::Skf, FilterKind::Ikf]
            .into_iter()
            .chain([FilterKind::Adaptive])
            .map(|filter| (filter.name(), filter.title()));
    let modes = [("static", "it stands still"), ("kinematic", "it may move")];
    let mut controls = vec![
        Control::choice("filter", "filter", &options.collect::<Vec<_>>()),
        Control::switch("compare", "all filters in the first figure", false),
        Control::switch("printed", "the paper's filters by the letter", false),
        Control::choice("mode", "receiver", &modes),
        Control::decades(
            "process-noise",
            "process noise if it may move",
            "m²/s",
            [1e-6, 1e4],
            PROCESS_NOISE,
        ),
        Control::switch("thresholds", "thresholds of IGG III by hand", false),
        Control::slider("k0", "k0, full weight up to", "σ", [1.0, 6.0, 0.1], 2.5),
        Control::slider("k1", "k1, no weight beyond", "σ", [6.0, 16.0, 0.1], 8.0),
        Control::slider("mask", "lowest elevation", "°", [0.0, HIGHEST_MASK, 1.0], 8.0),
        Control::playable("until", "until", "h", [first, last, (last - first) / 200.0], last),
    ];
    controls.extend(PARTS.map(|(_, name, label)| Control::switch(name, label, true)));
    controls
}

/// The chosen filter.
pub(super) fn filter(settings: &Settings) -> FilterKind {
    let chosen = settings.choice("filter");
    FilterKind::ALL.into_iter().find(|filter| filter.name() == chosen).unwrap_or_default()
}

/// What is corrected.
pub(super) fn corrections(settings: &Settings) -> Corrections {
    let off = PARTS.into_iter().filter(|(_, name, _)| !settings.is_on(name));
    all_but(&off.map(|(part, ..)| part).collect::<Vec<_>>())
}
