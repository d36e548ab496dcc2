//! The recorded flight whose results are reported.

use crate::system::DataFile::There;
use crate::system::{Measure, Over, Recorded, Study, Together};

/// The study of a rover on the ground, located from the air.
pub(super) const STUDIES: &[Study] = &[Study {
    id: "afar",
    title: "A real flight over ten minutes, channel unknown",
    note: "Recorded by AERPAW (SunLab-UGA/AERPAW_AFAR). Published: the error of the flight's own search.",
    recordings: &[Recorded::new(
        "afar_1204",
        &[
            ("log", There("drone/afar_1204/stops.csv")),
            ("truth", There("drone/afar_1204/truth.csv")),
            ("area", There("drone/afar_1204/area.csv")),
        ],
        &[],
    )],
    measures: &[
        Measure::new("error of the last estimate", "m", "/accuracy/error_m")
            .together(&[Together::new(Over::One).known(57.0)]),
        Measure::new("its standard deviation", "m", "/sd_m"),
        Measure::new("error over standard deviation", "", "/accuracy/error_over_sigma"),
    ],
    figures: &["map"],
}];
