use std::sync::Arc;

use kestirim_replay::pedestrian::{Options, Trace, trace, walk, without_updates};
use serde_json::{Value, json};

use super::*;
use crate::figure::Figure;
use crate::system::{AnySystem, Opened, Source};

fn open(name: &str) -> Box<dyn Opened> {
    let settings = Settings::new(settings::table(None));
    Pedestrian.open(Source::Synthetic(name.to_owned()), &settings).unwrap()
}

fn answer(opened: &dyn Opened, sent: &Value) -> Arc<Answer> {
    let sent = sent.as_object().cloned().unwrap_or_default();
    opened.answer(&Settings::sent(opened.settings(), &sent).unwrap()).unwrap()
}

fn figure<'a>(answer: &'a Answer, id: &str) -> &'a Figure {
    answer.figures.iter().find(|figure| figure.id == id).unwrap()
}

fn fact<'a>(answer: &'a Answer, name: &str) -> &'a str {
    &answer.facts.iter().find(|(found, _)| found == name).unwrap().1
}

#[test]
fn every_synthetic_walk_opens_with_the_same_figures_and_is_walked_well() {
    for (name, _) in Pedestrian::SYNTHETIC {
        let answer = answer(&*open(name), &json!({}));
        let ids: Vec<_> = answer.figures.iter().map(|figure| figure.id.as_str()).collect();
        let expected = [
            "path",
            "space",
            "attitude",
            "uncertainty",
            "height",
            "accelerometer",
            "gyroscope",
            "magnitude",
            "velocity",
            "position",
        ];
        assert_eq!(ids, expected, "{name}");
        let [strides] = answer.tables.as_slice() else { panic!("{name}: {:?}", answer.tables) };
        assert_eq!(strides.rows.len().to_string(), fact(&answer, "strides"), "{name}");
        assert_eq!(strides.times_s.as_ref().map(Vec::len), Some(strides.rows.len()), "{name}");
        let rmse: f64 = fact(&answer, "RMSE").trim_end_matches(" m").parse().unwrap();
        assert!(rmse < 1.0, "{name}: {rmse} m");
        assert!(answer.warnings.is_empty(), "{name}: {:?}", answer.warnings);
    }
}

#[test]
fn the_threshold_moves_its_lines_and_the_path() {
    let opened = open("route-50");
    let at =
        |threshold| answer(&*opened, &json!({ "detector": "magnitude", "threshold": threshold }));
    let (low, high) = (at(0.1), at(0.4));
    for id in ["path", "space", "attitude", "height", "magnitude", "velocity", "position"] {
        assert_ne!(figure(&low, id), figure(&high, id), "{id}");
    }
    for id in ["accelerometer", "gyroscope"] {
        assert_eq!(figure(&low, id), figure(&high, id), "{id}");
    }
    assert_ne!(fact(&low, "path length"), fact(&high, "path length"));
}

#[test]
fn what_cannot_be_walked_is_refused_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.txt");
    let mut files = Files::default();
    files.add("log", &path);
    let settings = Settings::new(settings::table(None));
    let refusal = |files: &Files| {
        let opened = Pedestrian.open(Source::Files(files.clone()), &settings);
        opened.and_then(|opened| opened.answer(&settings)).err().map(|error| error.to_string())
    };
    for (text, expected) in [
        ("", "empty"),
        ("t,ax,ay,az,gx,gy,gz\n0,0,up,9.8,0,0,0\n", "line 2: expected a finite number"),
        ("0 0 0 1 0 0 0\n", "expected a log of at least 2 samples, found 1"),
    ] {
        std::fs::write(&path, text).unwrap();
        let refusal = refusal(&files).unwrap();
        assert!(refusal.contains(expected) && !refusal.contains('\n'), "{refusal}");
    }
    assert!(refusal(&Files::default()).is_some());
    assert!(Pedestrian.open(Source::Synthetic("the moon".to_owned()), &settings).is_err());
}

#[test]
fn a_trace_is_the_walk_and_more() {
    let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
    let options = Options::default();
    let trace = trace(&log.samples, &options).unwrap();
    assert_eq!(trace.walk, walk(&log.samples, &options).unwrap());
    assert_eq!(trace.moments.len(), log.samples.len());
    let standing = trace.moments.iter().filter(|moment| moment.stance).count();
    assert!((0.3..0.8).contains(&(standing as f64 / log.samples.len() as f64)));
}

#[test]
fn without_updates_the_foot_never_stands_again_and_the_velocity_drifts() {
    let Recording { log, .. } = Recording::synthetic(Walked::Route, 100.0, 1, 0).unwrap();
    let options = Options::default();
    let drifting = without_updates(&log.samples, &options).unwrap();
    let left = drifting.moments.iter().position(|moment| !moment.stance).unwrap();
    assert!(left > 150 && drifting.moments[left..].iter().all(|moment| !moment.stance));
    let last_speed = |trace: &Trace| {
        let [x, y, z] = trace.moments.last().unwrap().velocity;
        x.hypot(y).hypot(z)
    };
    assert!(last_speed(&drifting) > 0.2, "{}", last_speed(&drifting));
    assert!(last_speed(&trace(&log.samples, &options).unwrap()) < 0.05);
}

/// A walk on the paper's route, with strides of 1.26 m on average: east, north, east, north and west.
fn route() -> (Recording, Trace) {
    let recording = Recording::synthetic(Walked::Route, 100.0, 3, 0).unwrap();
    let trace = trace(&recording.log.samples, &Options::default()).unwrap();
    (recording, trace)
}

#[test]
fn strides_are_as_long_and_lead_where_the_foot_went() {
    let (recording, trace) = route();
    let lines = strides::lines(&trace.walk);
    assert_eq!(lines.len() + 1, recording.footprints.len());
    let headings = [0, 0, 0, 90, 0, 0, 90, 180, 180, 180].map(f64::from);
    for ((line, pair), heading) in lines.iter().zip(recording.footprints.windows(2)).zip(headings) {
        let true_length = crate::metrics::distance(pair[0].position, pair[1].position);
        let length = line.stride.length_m;
        assert!((length - true_length).abs() < 0.05, "{length} m instead of {true_length} m");
        assert!(line.height_change_m().abs() < 0.05, "{line:?}");
        // The last stance extends to the end of the log.
        let usual = if line.stride == *trace.walk.strides.last().unwrap() { 0.3 } else { 0.7 };
        assert!((usual..1.5).contains(&line.speed_m_s().unwrap()), "{line:?}");
        // The sensor is mounted at an angle on the foot: headings are relative to the first.
        let turned = line.heading_rad() - lines[0].heading_rad() - heading.to_radians();
        assert!(turned.sin().abs() < 0.06 && turned.cos() > 0.0, "{turned} rad from {heading}°");
    }
    let table = strides::table(&trace.walk);
    assert_eq!((table.rows.len(), table.header.len()), (10, 7));
    assert!(table.rows.iter().all(|row| row.len() == 7), "{table:?}");
}

#[test]
fn right_angles_are_turns_and_what_is_straight_is_none() {
    let (recording, trace) = route();
    let turns = strides::turns(&trace.walk);
    let angles: Vec<_> = turns.iter().map(|turn| turn.angle_rad.to_degrees()).collect();
    // The last two corners are one stride apart, to the same side.
    assert_eq!(angles.len(), 3, "{angles:?}");
    for (angle, expected) in angles.into_iter().zip([90.0, -90.0, 180.0]) {
        assert!((angle - expected).abs() < 8.0, "{angle}° instead of {expected}°");
    }
    let [x, y, _] = turns[0].position;
    let placement = figures::placement::Placement::of(&trace.walk.track, &recording.truth());
    let corner =
        crate::metrics::distance(placement.onto_plan([x, y]), recording.footprints[3].position);
    assert!(corner < 0.1, "{corner} m from the corner");
    assert_eq!(strides::stops(&trace), []);
}

#[test]
fn standing_for_long_on_the_way_is_a_stop() {
    let (recording, before) = route();
    let mut samples = recording.log.samples.clone();
    // Two seconds of the standstill before the walk, inserted in the middle of the fifth stance.
    let [from, to] = strides::stances(&before)[5];
    let place = usize::midpoint(from, to);
    let still: Vec<_> = samples[..200].to_vec();
    samples.splice(place..place, still);
    for (number, sample) in (1_u64..).zip(&mut samples) {
        sample.time_us = 10_000 * number;
    }
    let after = trace(&samples, &Options::default()).unwrap();
    let stops = strides::stops(&after);
    let [stop] = stops.as_slice() else { panic!("{stops:?}") };
    let expected = 2.0 + 0.01 * (to - from) as f64;
    assert!((stop.duration_s - expected).abs() < 0.2, "{stop:?} instead of {expected} s");
    let there = before.walk.strides[4].position;
    assert!((stop.position[0] - there[0]).hypot(stop.position[1] - there[1]) < 0.15, "{stop:?}");
}

#[test]
fn the_foot_is_level_where_it_stands_and_turned_as_it_walks() {
    let answer = answer(&*open("route-100"), &json!({}));
    let attitude = figure(&answer, "attitude");
    let angles = |name: &str| {
        let found = attitude.series.iter().find(|series| series.name == name).unwrap();
        (found.y.first().copied().unwrap(), found.y.last().copied().unwrap(), found)
    };
    let (_, roll, _) = angles("roll");
    let (_, pitch, pitches) = angles("pitch");
    let (begin, yaw, _) = angles("yaw");
    // The sensor is mounted with a tilt of 25°, which must not show in the foot's attitude.
    assert!(roll.abs() < 5.0 && pitch.abs() < 5.0, "roll {roll}°, pitch {pitch}°");
    let turned = yaw.to_radians();
    assert!(begin.abs() < 2.0 && turned.cos() < -0.98, "yaw from {begin}° to {yaw}°");
    // Toes down at toe-off, up at heel strike: simulated with −60° and 25°.
    let [low, high] = [f64::min, f64::max].map(|of| pitches.y.iter().copied().fold(0.0, of));
    assert!((-75.0..-45.0).contains(&low) && (15.0..40.0).contains(&high), "{low}° to {high}°");
}

#[test]
fn the_uncertainty_grows_and_stands_beside_the_error() {
    let answer = answer(&*open("two-minutes"), &json!({}));
    let of = |name: &str| {
        let figure = figure(&answer, "uncertainty");
        &figure.series.iter().find(|series| series.name == name).unwrap().y
    };
    let (sigma, error) = (of("horizontal"), of("error, horizontal"));
    assert!(sigma.last() > sigma.first(), "{sigma:?}");
    let final_error = format!("{:.3} m", error.last().unwrap());
    assert_eq!(fact(&answer, "error at the end"), final_error);
}

#[test]
fn why_another_log_is_not_used_is_told() {
    let synthetic = |rate_hz, index| Recording::synthetic(Walked::Rounds(2), rate_hz, 0, index);
    let mut recording = synthetic(200.0, 0).unwrap();
    let other = synthetic(100.0, 1).unwrap();
    recording.other_foot = Some(Box::new(other.clone()));
    let warnings = |sent: Value| {
        let table = <Pedestrian as System>::settings(Some(&recording));
        let settings = Settings::sent(table, sent.as_object().unwrap()).unwrap();
        Track::of(&recording, &settings, Detail::Result).unwrap().trace.walk.warnings.join("; ")
    };
    let of_another_walk = warnings(json!({}));
    assert!(of_another_walk.contains("the other foot is not used: "), "{of_another_walk}");
    assert!(warnings(json!({ "causal": true })).contains("without --causal"));
    // The slower log stays as it is.
    assert!(recording.at_rate(150.0).unwrap().other_foot.unwrap().log == other.log);
    let at_50_hz = recording.at_rate(50.0).unwrap().other_foot.unwrap();
    assert!(at_50_hz.log.samples.len().abs_diff(other.log.samples.len() / 2) <= 1);
}
