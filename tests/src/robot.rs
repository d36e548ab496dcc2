//! Recorded ranges with ground truth, from `../shared/data/robot` beside the repository.

use std::path::Path;

use host_sim::systems::robot::account::accuracy::Accuracy;
use host_sim::systems::robot::recording::anchors;
use host_sim::systems::robot::recording::calibration::Residuals;
use host_sim::systems::robot::recording::motion;
use host_sim::systems::robot::recording::points;
use host_sim::systems::robot::recording::ranges;
use kestirim_import::Options;
use kestirim_replay::ScalarKind;
use kestirim_replay::robot::{
    Anchors, Course, Follow, RangeRow, Sensors, Setup, Trace, TrackerKind, build, build_changed,
    follow,
};
use kestirim_uwb_tracker::Config;

/// A change to the default tracker's configuration.
pub type Change = fn(&mut Config<f64>);

/// A way of tracking ranges, the same for every recording.
#[derive(Clone, Copy, Debug)]
pub struct Method {
    /// The tracker.
    pub tracker: TrackerKind,
    /// The number type.
    pub scalar: ScalarKind,
    /// A change to the configuration, if any: only for the default tracker in `f64`.
    pub change: Option<Change>,
}

impl Method {
    /// The defaults of host-sim.
    pub const DEFAULT: Self =
        Self { tracker: TrackerKind::Default, scalar: ScalarKind::F32, change: None };

    fn setup(self, anchors: &Anchors, height_m: f64, biases: Option<Vec<f64>>) -> Setup {
        Setup {
            tracker: self.tracker,
            scalar: self.scalar,
            biases,
            ..Setup::new(&anchors.positions, height_m)
        }
    }

    fn build(self, setup: &Setup) -> Box<dyn Follow> {
        match self.change {
            Some(change) => build_changed(setup, change),
            None => build(setup),
        }
        .expect("a tracker")
    }
}

/// A recording of a moving or stationary tag.
#[derive(Clone, Debug)]
pub struct Recording {
    anchors: Anchors,
    sensors: Sensors,
    truth: Course<3>,
    height_m: f64,
}

impl Recording {
    /// Reads a folder of the recordings, including IMU or wheels if it has them. The tag's height is the mean of the
    /// true height.
    ///
    /// # Panics
    /// It cannot be read: those beside the repository can.
    pub fn read(folder: &Path, name: &str) -> Self {
        let folder = folder.join(name);
        let anchors = anchors::read(&folder.join("anchors.csv")).expect("anchors");
        let rows = ranges::read_moving(&folder.join("ranges.csv"), &anchors, &Options::default())
            .expect("ranges")
            .0
            .rows;
        let truth =
            points::read_course(&folder.join("truth.csv"), ["x", "y", "z"]).expect("a truth");
        let imu = folder.join("imu.csv");
        let inertial = if imu.exists() {
            motion::read_inertial(&imu, &Options::default()).expect("an IMU").0
        } else {
            vec![]
        };
        let heights: Vec<f64> =
            rows.iter().filter_map(|row| Some(truth.held(row.time_us)?[2])).collect();
        let height_m = host_sim::metrics::mean(&heights);
        let sensors = Sensors { inertial, ..Sensors::ranges(rows) };
        Self { anchors, sensors, truth, height_m }
    }

    /// The measured bias of each anchor, m, from the first `seconds` of the recording.
    pub fn biases(&self, seconds: f64) -> Vec<f64> {
        let mut residuals = Residuals::new(&self.anchors);
        let start_us = self.sensors.ranges.first().map_or(0, |row| row.time_us);
        let end_us = start_us.saturating_add((seconds * 1e6) as i64);
        for row in self.sensors.ranges.iter().take_while(|row| row.time_us <= end_us) {
            if let (Some(range), Some(place)) = (row.range, self.truth.within(row.time_us)) {
                residuals.add(&self.anchors, row.anchor, range, place);
            }
        }
        residuals.calibrations(&self.anchors).iter().map(|anchor| anchor.bias_m).collect()
    }

    /// The recording with every twentieth range replaced by outliers that radios have been observed to report.
    #[must_use]
    pub fn spoiled(&self) -> Self {
        let wild = [337.0, -143.0, 60.0, 100.0, 12.0, 0.2].iter().cycle();
        let mut spoiled = self.clone();
        for (row, &wild) in spoiled.sensors.ranges.iter_mut().step_by(20).zip(wild) {
            row.range = Some(wild);
        }
        spoiled
    }

    /// Tracks the recording.
    ///
    /// # Panics
    /// The tracker cannot be built, or finds no position at all.
    pub fn track(&self, method: Method, biases: Option<Vec<f64>>) -> (Accuracy, Trace) {
        let setup = method.setup(&self.anchors, self.height_m, biases);
        let mut tracker = method.build(&setup);
        let trace = follow(tracker.as_mut(), &self.sensors.events());
        let pairs: Vec<_> = trace
            .epochs
            .iter()
            .filter_map(|epoch| {
                let [x, y, _] = self.truth.within(epoch.time_us)?;
                Some((epoch.position, [x, y]))
            })
            .collect();
        (Accuracy::of(&pairs).expect("positions"), trace)
    }
}

/// The 90 points of `lias_static_814`, with 50 epochs each.
#[derive(Clone, Debug)]
pub struct Points {
    anchors: Anchors,
    points: Vec<(String, [f64; 3], Vec<RangeRow>)>,
}

impl Points {
    /// The duration of the epochs that are used, µs; an epoch takes 0.1 s.
    const EPOCHS_US: i64 = 50 * 100_000;

    /// Reads the points, with either the four anchors in the corners or all eight.
    ///
    /// # Panics
    /// They cannot be read.
    pub fn read(folder: &Path, corners_only: bool) -> Self {
        let folder = folder.join("lias_static_814");
        let mut anchors = anchors::read(&folder.join("anchors.csv")).expect("anchors");
        if corners_only {
            let corner = |index: &usize| index.is_multiple_of(2);
            let kept: Vec<usize> = (0..anchors.names.len()).filter(corner).collect();
            anchors = Anchors {
                names: kept.iter().map(|&index| anchors.names[index].clone()).collect(),
                positions: kept.iter().map(|&index| anchors.positions[index]).collect(),
            };
        }
        let (mut logs, _) =
            ranges::read_static(&folder.join("ranges.csv"), &anchors, &Options::default())
                .expect("ranges");
        let read = points::read_points(&folder.join("points.csv")).expect("points");
        let points = read.into_iter().map(|point| {
            let ([x, y], z) = (point.plane.expect("x and y"), point.height.expect("z"));
            let mut rows = logs.remove(&point.name).expect("ranges of the point").rows;
            rows.retain(|row| row.time_us < Self::EPOCHS_US);
            (point.name, [x, y, z], rows)
        });
        Self { points: points.collect(), anchors }
    }

    /// The points whose names start with `prefix`, or all others if not `inside`.
    #[must_use]
    pub fn group(&self, prefix: &str, inside: bool) -> Self {
        let kept = self.points.iter().filter(|(name, ..)| name.starts_with(prefix) == inside);
        Self { anchors: self.anchors.clone(), points: kept.cloned().collect() }
    }

    /// The measured bias of each anchor, m.
    pub fn biases(&self) -> Vec<f64> {
        let mut residuals = Residuals::new(&self.anchors);
        for (_, place, rows) in &self.points {
            for row in rows {
                if let Some(range) = row.range {
                    residuals.add(&self.anchors, row.anchor, range, *place);
                }
            }
        }
        residuals.calibrations(&self.anchors).iter().map(|anchor| anchor.bias_m).collect()
    }

    /// The errors of the last position at each point.
    ///
    /// # Panics
    /// The tracker cannot be built, or finds no position at all.
    pub fn track(&self, method: Method, biases: Option<&[f64]>) -> Accuracy {
        let found = self.points.iter().map(|(_, [x, y, z], rows)| {
            let setup = method.setup(&self.anchors, *z, biases.map(<[f64]>::to_vec));
            let mut tracker = method.build(&setup);
            let trace = follow(tracker.as_mut(), &Sensors::ranges(rows.clone()).events());
            (trace.last(), [*x, *y])
        });
        Accuracy::of(&found.collect::<Vec<_>>()).expect("positions")
    }
}

/// The runs in which a person blocks an anchor, each with the unobstructed run at the same spot.
pub const BLOCKED: [(&str, &str); 8] = [
    ("trek_4vba0", "trek_4vnm"),
    ("trek_4vba1", "trek_4vnm"),
    ("trek_4vba2s", "trek_4vnm"),
    ("trek_4vba3s", "trek_4vnm"),
    ("trek_4vba02", "trek_4vnm2"),
    ("trek_4vba12", "trek_4vnm2"),
    ("trek_4vba22", "trek_4vnm2"),
    ("trek_4vba32", "trek_4vnm2"),
];

/// The root mean square errors of [`BLOCKED`], m, with biases from the unobstructed runs or without calibration.
pub fn blocked(folder: &Path, method: Method, calibrated: bool) -> Vec<f64> {
    BLOCKED
        .iter()
        .map(|(name, free)| {
            let biases = calibrated.then(|| Recording::read(folder, free).biases(f64::INFINITY));
            Recording::read(folder, name).track(method, biases).0.rmse_m
        })
        .collect()
}
