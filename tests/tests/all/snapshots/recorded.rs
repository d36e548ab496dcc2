//! Snapshots in the middle of recorded streams, from `../shared/data` beside the repository.

use host_sim::systems::pedestrian::recording::log;
use host_sim::systems::robot::recording::{anchors, ranges};
use kestirim_import::Options;
use kestirim_pedestrian::{Config as WalkConfig, Ekf, Lite, Tracker as Walk};
use kestirim_replay::robot::RangeRow;
use kestirim_scalar::{Q12_20, Scalar};
use kestirim_tests::recordings::{folder, folder_of, gcp};
use kestirim_uwb_tracker::{Anchor, Config, Tracker as Robot};
use nalgebra::SVector;

use super::sleep;
use super::systems::Sample;

#[test]
fn a_recorded_walk() {
    let Some(folder) = folder() else { return };
    let [(file, _)] = &gcp(&folder, &[31])[..] else { panic!("a walk") };
    let walk = log::read(file, &log::Options::default()).expect("a recording can be read");
    let sample = |sample: &host_sim::systems::pedestrian::Sample| {
        let [force, rate] =
            [sample.specific_force, sample.angular_rate].map(|it| it.map(|number| number as f32));
        Sample::Inertial(sample.time_us, force, rate)
    };
    let samples: Vec<_> = walk.samples.iter().map(sample).collect();
    sleep("EKF", Walk::<f32, Ekf<f32>>::new(WalkConfig::default()), &samples, 1);
    sleep("lite", Walk::<f32, Lite<f32>>::new(WalkConfig::default()), &samples, 2);
    sleep("fixed", Walk::<Q12_20, Ekf<Q12_20>>::new(WalkConfig::default()), &samples, 3);
}

fn tracker<T: Scalar>(places: &[[f64; 3]]) -> Robot<T, 2, 4, 8> {
    let anchor = |place: &[f64; 3]| Anchor {
        position: SVector::from(place.map(T::from_f64)),
        bias: T::ZERO,
    };
    let anchors: Vec<_> = places.iter().map(anchor).collect();
    Robot::new(Config::calibrated(T::ONE), &anchors).expect("they fit")
}

#[test]
fn a_recorded_drive() {
    let Some(folder) = folder_of("robot") else { return };
    let folder = folder.join("plaza1");
    let places = anchors::read(&folder.join("anchors.csv")).expect("anchors");
    let options = Options::default();
    let (log, _) =
        ranges::read_moving(&folder.join("ranges.csv"), &places, &options).expect("ranges");
    let sample = |row: &RangeRow| {
        Some(Sample::Range(row.time_us as u64, row.anchor as u32, row.range? as f32))
    };
    let samples: Vec<_> = log.rows.iter().filter_map(sample).collect();
    sleep("robot", tracker::<f32>(&places.positions), &samples, 4);
    sleep("robot in fixed point", tracker::<Q12_20>(&places.positions), &samples, 5);
}
