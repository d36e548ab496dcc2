//! The recorded walks whose results are reported.

use crate::system::DataFile::There;
use crate::system::{Measure, Over, Recorded, Study, Together};

/// The log and truth of a walk over measured footprints.
macro_rules! files {
    ($number:literal) => {
        &[
            ("log", There(concat!("pedestrian/gcp/exp", $number, "_imu.csv"))),
            ("truth", There(concat!("pedestrian/gcp/exp", $number, "_gcp.csv"))),
        ]
    };
}

/// A walk over measured footprints.
macro_rules! gcp {
    ($number:literal) => {
        Recorded::new(concat!("exp", $number), files!($number), &[])
    };
}

/// A walk over measured footprints, tracked by the paper's method.
macro_rules! published {
    ($number:literal) => {
        Recorded::new(concat!("exp", $number), files!($number), PUBLISHED).published()
    };
}

/// A walk under motion-capture cameras.
macro_rules! vicon {
    ($name:literal) => {
        Recorded::new(
            $name,
            &[
                ("log", There(concat!("pedestrian/vicon/", $name, ".csv"))),
                ("truth", There(concat!("pedestrian/vicon/", $name, "_strides.csv"))),
            ],
            &[],
        )
    };
}

/// The settings of the paper's method: integration, and stance by the magnitude of the specific force.
const PUBLISHED: &[(&str, &str)] = &[("tracker", "lite"), ("detector", "magnitude:0.1")];

/// The studies of walks with known footprints, measured with a ruler or under cameras.
pub(super) const STUDIES: &[Study] = &[
    Study {
        id: "gcp",
        title: "Eight walks over footprints measured with a ruler",
        note: "Recordings of mtahakoroglu/LLIO. Published: what the best other program reaches on them.",
        recordings: &[
            gcp!("31"),
            gcp!("36"),
            gcp!("41"),
            gcp!("46"),
            gcp!("48"),
            gcp!("57"),
            gcp!("72"),
            gcp!("81"),
            published!("31"),
            published!("36"),
            published!("41"),
            published!("46"),
            published!("48"),
            published!("57"),
            published!("72"),
            published!("81"),
        ],
        measures: &[
            PATH.together(&[Together::new(Over::Mean).known(0.7), Together::new(Over::Worst)]),
            POSITION.together(&[Together::new(Over::Median).known(0.36)]),
            RATIO,
        ],
        figures: &["path"],
    },
    Study {
        id: "vicon",
        title: "Nine walks under Vicon cameras",
        note: "Recordings of the University of Toronto (Wagstaff et al.). Published: what the best other program reaches on them.",
        recordings: &[
            vicon!("2017-11-22-11-22-03"),
            vicon!("2017-11-22-11-25-20"),
            vicon!("2017-11-22-11-26-46"),
            vicon!("2017-11-22-11-35-59"),
            vicon!("2017-11-22-11-48-35"),
            vicon!("2017-11-27-11-11-24"),
            vicon!("2017-11-27-11-13-10"),
            vicon!("2017-12-15-17-59-19"),
            vicon!("2017-12-15-18-01-51"),
        ],
        measures: &[PATH, POSITION.together(&[Together::new(Over::Median).known(0.08)]), RATIO],
        figures: &["path"],
    },
];

const PATH: Measure =
    Measure::new("error of the path length", "%", "/accuracy/path_length_error_percent");
const POSITION: Measure = Measure::new("RMSE of the footprints", "m", "/accuracy/rmse_m");
const RATIO: Measure =
    Measure::new("error over standard deviation", "", "/accuracy/error_over_sigma");
