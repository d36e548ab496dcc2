//! The recorded days whose results are reported.

use crate::system::DataFile::{self, There};
use crate::system::{Measure, Over, Recorded, Study, Together};

/// The position of the station ESBC (ECEF, m), and the last epoch that the orbits cover.
const TRUTH: (&str, &str) = ("truth", "3582104.7657,532590.1785,5232755.1390");
const UNTIL: (&str, &str) = ("until", "85500");
const MOVING: (&str, &str) = ("mode", "kinematic");

/// A day of the station ESBC with the given observations of GPS.
macro_rules! gps {
    ($observations:literal) => {
        &[
            ("obs", There($observations)),
            ("sp3", There("gnss/esbc2020177/grg176_gps.sp3.gz")),
            ("sp3", There("gnss/esbc2020177/grg177_gps.sp3.gz")),
            ("clk", There("gnss/esbc2020177/grg177_gps.clk.gz")),
            ("antex", There("gnss/esbc2020177/esbc.atx.gz")),
        ]
    };
}

const CLEAN: &[(&str, DataFile)] = gps!("gnss/esbc2020177/esbc_gps.rnx.gz");
const FAULTY: &[(&str, DataFile)] = gps!("gnss/esbc2020177_injected/esbc_gps_CPSB0.rnx.gz");
const WITH_GALILEO: &[(&str, DataFile)] = &[
    ("obs", There("gnss/esbc2020177_multi/ESBC00DNK_R_20201770000_01D_30S_MO.crx.gz")),
    ("sp3", There("gnss/esbc2020177_multi/GRG0MGXFIN_20201760000_01D_15M_ORB.SP3.gz")),
    ("sp3", There("gnss/esbc2020177_multi/GRG0MGXFIN_20201770000_01D_15M_ORB.SP3.gz")),
    ("clk", There("gnss/esbc2020177_multi/GRG0MGXFIN_20201770000_01D_30S_CLK.CLK.gz")),
    ("antex", There("gnss/wettzell2020177_multi/igs20_wettzell_trim.atx.gz")),
    ("antex", There("gnss/esbc2020177/esbc.atx.gz")),
    ("antex", There("gnss/esbc2020177_multi/galileo_igs20.atx.gz")),
];

const FINAL: Measure = Measure::new("final 3-D error", "mm", "/accuracy/final_3d_m").times(1e3);
const RMS: Measure = Measure::new("RMS after an hour", "mm", "/accuracy/rms_3d_m").times(1e3);
const CONVERGENCE: Measure = Measure::new("time to 10 cm", "min", "/accuracy/convergence_min");
const RATIO: Measure =
    Measure::new("error over standard deviation", "", "/accuracy/error_over_sigma");

const NOTE: &str = "Observations of EPN and IGS, orbits and clocks of CNES/CLS. Published: RTKLIB demo5 on the same files; limit: what was asked for.";
const FIGURES: &[&str] = &["plan", "components"];

/// The studies of a stationary day, also treated as kinematic, without faults and with them.
pub(super) const STUDIES: &[Study] = &[
    Study {
        id: "static",
        title: "A day of a station at rest, GPS",
        note: NOTE,
        recordings: &[Recorded::new("ESBC", CLEAN, &[UNTIL, TRUTH])],
        measures: &[
            FINAL.together(&[Together::new(Over::One).known(5.5).limit(8.0)]),
            RMS.together(&[Together::new(Over::One).known(8.8).limit(12.5)]),
            CONVERGENCE.together(&[Together::new(Over::One).known(30.5).limit(34.0)]),
            RATIO,
        ],
        figures: FIGURES,
    },
    Study {
        id: "smoothed",
        title: "The same as if it moved, GPS and Galileo, smoothed, from the first epoch on",
        note: NOTE,
        recordings: &[Recorded::new(
            "ESBC, GPS and Galileo",
            WITH_GALILEO,
            &[UNTIL, TRUTH, MOVING, ("smooth", "true")],
        )],
        measures: &[
            Measure::new("RMS of all epochs", "mm", "/smoothed/rms_3d_m")
                .times(1e3)
                .together(&[Together::new(Over::One).limit(25.0)]),
            Measure::new("error over standard deviation", "", "/smoothed/error_over_sigma"),
        ],
        figures: FIGURES,
    },
    Study {
        id: "faults",
        title: "The day at rest with outliers, biases and small slips",
        note: NOTE,
        recordings: &[Recorded::new("ESBC with faults", FAULTY, &[UNTIL, TRUTH])],
        measures: &[
            FINAL.together(&[Together::new(Over::One).known(16.0).limit(10.0)]),
            RMS.together(&[Together::new(Over::One).known(26.0).limit(14.0)]),
            CONVERGENCE.together(&[Together::new(Over::One).known(52.0).limit(35.0)]),
            RATIO,
        ],
        figures: FIGURES,
    },
    Study {
        id: "faults-kinematic",
        title: "The same as if it moved",
        note: NOTE,
        recordings: &[Recorded::new("ESBC with faults", FAULTY, &[UNTIL, TRUTH, MOVING])],
        measures: &[RMS.together(&[Together::new(Over::One).known(699.0).limit(55.0)]), RATIO],
        figures: FIGURES,
    },
];
