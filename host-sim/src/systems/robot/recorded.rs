//! The recordings whose results are reported.

use std::fs;
use std::path::Path;

use super::calibrate;
use crate::system::DataFile::{Made, There};
use crate::system::{DataFile, Making, Measure, Over, Recorded, Study, Together};
use crate::{Error, output};

const POINTS: &str = "robot/lias_static_814/anchors.csv";

/// The anchors in the corners of the hall.
const CORNERS: DataFile = Made(Making {
    name: "corners.csv",
    of: &[POINTS],
    how: "anchors 0, 2, 4 and 6 of lias_static_814/anchors.csv",
    make: corners,
});

/// The biases of the anchors, from a run on the same day with no person in the way.
macro_rules! biases {
    ($free:literal) => {
        Made(Making {
            name: concat!($free, "-biases.csv"),
            of: &[
                concat!("robot/", $free, "/anchors.csv"),
                concat!("robot/", $free, "/ranges.csv"),
                concat!("robot/", $free, "/truth.csv"),
            ],
            how: concat!(
                "host-sim calibrate robot --anchors ",
                $free,
                "/anchors.csv --log ",
                $free,
                "/ranges.csv --truth ",
                $free,
                "/truth.csv --out BIASES.csv"
            ),
            make: |data, to| calibrate::from_truth(&data.join(concat!("robot/", $free)), to),
        })
    };
}

/// A run of a moving tag, with further files and settings.
macro_rules! moving {
    ($name:literal, [$($more:expr),*], $settings:expr) => {
        Recorded::new(
            $name,
            &[
                ("anchors", There(concat!("robot/", $name, "/anchors.csv"))),
                ("log", There(concat!("robot/", $name, "/ranges.csv"))),
                ("truth", There(concat!("robot/", $name, "/truth.csv"))),
                $($more),*
            ],
            $settings,
        )
    };
}

/// A run with a person in front of an anchor; the tag's height is set to the mean of the true one.
macro_rules! blocked {
    ($name:literal, $free:literal, $height:literal) => {
        moving!($name, [("calibration", biases!($free))], &[("height", $height)])
    };
}

/// The studies: points, people in the way, a wall in the way, and a mower.
pub(super) const STUDIES: &[Study] = &[
    Study {
        id: "points",
        title: "90 points among four corner anchors as they come",
        note: "Recordings of LIAS-CUHKSZ; the log has four more anchors, which are left out. Published: the best other program.",
        recordings: &[Recorded::new(
            "lias_static_814",
            &[
                ("anchors", CORNERS),
                ("log", There("robot/lias_static_814/ranges.csv")),
                ("points", There("robot/lias_static_814/points.csv")),
                ("height", There("robot/lias_static_814/points.csv")),
            ],
            &[],
        )],
        measures: &[
            Measure::new("mean error", "cm", "/accuracy/mean_m")
                .times(100.0)
                .together(&[Together::new(Over::One).known(9.0).limit(8.3)]),
            RATIO,
        ],
        figures: &["plan"],
    },
    Study {
        id: "people",
        title: "Somebody stands in the way of an anchor",
        note: "Recordings of cliansang/positioning-algorithms-for-uwb-matlab; anchors calibrated on the runs with nobody in the way. Published: the best other program.",
        recordings: &[
            blocked!("trek_4vba0", "trek_4vnm", "0.5519"),
            blocked!("trek_4vba1", "trek_4vnm", "0.5512"),
            blocked!("trek_4vba2s", "trek_4vnm", "0.5505"),
            blocked!("trek_4vba3s", "trek_4vnm", "0.5519"),
            blocked!("trek_4vba02", "trek_4vnm2", "0.5799"),
            blocked!("trek_4vba12", "trek_4vnm2", "0.5803"),
            blocked!("trek_4vba22", "trek_4vnm2", "0.5819"),
            blocked!("trek_4vba32", "trek_4vnm2", "0.5820"),
        ],
        measures: &[RMSE.together(&[Together::new(Over::Mean).known(9.7)]), RATIO],
        figures: &["plan"],
    },
    Study {
        id: "wall",
        title: "Creeping at 6 cm/s with an anchor behind a wall",
        note: "Recording of ngbui101/bachelorarbeit-uwb-imu-ekf. Published: the best other program.",
        recordings: &[moving!(
            "esp32_wall2",
            [("imu", There("robot/esp32_wall2/imu.csv"))],
            &[("height", "0.015")]
        )],
        measures: &[RMSE.together(&[Together::new(Over::One).known(30.0)]), RATIO],
        figures: &["plan", "error"],
    },
    Study {
        id: "mower",
        title: "A mower's wheels and four radios over 60 m",
        note: "Recorded by Djugash (CMU), by way of GTSAM's examples.",
        recordings: &[moving!(
            "plaza1",
            [("odom", There("robot/plaza1/odom.csv"))],
            &[("height", "0"), ("smooth", "true")]
        )],
        measures: &[
            Measure { quantity: "RMSE as it drives", ..RMSE }.together(&[Together::new(Over::One)]),
            Measure::new("RMSE of the whole run smoothed", "cm", "/smoothed/accuracy/rmse_m")
                .times(100.0)
                .together(&[Together::new(Over::One)]),
            RATIO,
        ],
        figures: &["plan", "error"],
    },
];

const RMSE: Measure = Measure::new("RMSE", "cm", "/accuracy/rmse_m").times(100.0);
const RATIO: Measure =
    Measure::new("error over standard deviation", "", "/accuracy/error_over_sigma");

/// Removes the anchors between the corners.
fn corners(data: &Path, to: &Path) -> Result<(), Error> {
    let path = data.join(POINTS);
    let text = fs::read_to_string(&path).map_err(|source| Error::Read { path, source })?;
    let is_corner = |line: &&str| line.starts_with(['a', '0', '2', '4', '6']);
    let kept = text.lines().filter(is_corner);
    output::write_file(to, |file| kept.into_iter().try_for_each(|line| writeln!(file, "{line}")))
}
