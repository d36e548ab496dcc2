//! Checks that track the tag: of wheels, of a height that is said to be constant, and of anchors that are not
//! calibrated.

use kestirim_health::Reason;
use kestirim_replay::Finding;
use kestirim_replay::robot::{Anchors, Event, KnownHeight, Range, Wheels, check};
use nalgebra::Vector3;

fn distance(tag: [f64; 3], anchor: [f64; 3]) -> f64 {
    (Vector3::from(tag) - Vector3::from(anchor)).norm()
}

/// The findings about a tag at a known height, m.
fn findings(
    places: &[[f64; 3]],
    height_m: f64,
    events: &[Event],
    biases: Option<&[f64]>,
) -> Vec<Finding> {
    let names = (0..places.len()).map(|k| k.to_string()).collect();
    let anchors = Anchors { names, positions: places.to_vec() };
    check(&anchors, [events], KnownHeight::Said(height_m), false, biases)
}

/// The finding that is about one subject.
fn about(subject: &str, findings: Vec<Finding>) -> Option<Finding> {
    findings.into_iter().find(|finding| finding.about == subject)
}

/// Whether three anchors with ranges that are 0.3 m too long are reported to contradict each other.
fn contradict(biases: Option<&[f64]>) -> bool {
    let places = [[0.0, 0.0, 2.0], [8.0, 0.0, 2.0], [4.0, 6.0, 2.0]];
    let mut events = Vec::new();
    for epoch in 0..200_i64 {
        let turn = 0.05 * epoch as f64;
        let tag = [4.0 + 2.0 * turn.cos(), 2.5 + 1.5 * turn.sin(), 1.0];
        let time_us = 100_000 * epoch;
        for (anchor, place) in places.iter().enumerate() {
            let metres = distance(tag, *place) + 0.3;
            events.push(Event::Range(Range { time_us, anchor, metres }));
        }
        events.push(Event::EpochEnd { time_us });
    }
    let findings = findings(&places, 1.0, &events, biases);
    findings.iter().any(|finding| finding.reason == Some(Reason::Geometry))
}

#[test]
fn three_anchors_contradict_each_other_until_they_are_calibrated() {
    assert!(contradict(None));
    assert!(!contradict(Some(&[0.3; 3])));
}

const CORNERS: [[f64; 3]; 4] = [[0.0, 0.0, 2.0], [8.0, 0.0, 2.0], [8.0, 6.0, 2.0], [0.0, 6.0, 2.0]];

/// The ranges of an epoch to the corners, and its end.
fn epoch(time_us: i64, step: u32, tag: [f64; 3]) -> impl Iterator<Item = Event> {
    let range = move |(anchor, place): (usize, [f64; 3])| {
        let noise = 0.03 * (1.7 * f64::from(step) + 2.9 * anchor as f64).sin();
        Event::Range(Range { time_us, anchor, metres: distance(tag, place) + noise })
    };
    CORNERS.into_iter().enumerate().map(range).chain([Event::EpochEnd { time_us }])
}

/// The finding about a robot that drives an oval at 0.5 m/s, with wheels that report something else.
fn wheels(say: impl Fn(f64, Wheels) -> Wheels) -> Option<Finding> {
    let mut events = Vec::new();
    let (mut place, mut heading) = ([2.0, 1.5], 0.0_f64);
    for step in 0..1200_u32 {
        let seconds = 0.05 * f64::from(step);
        let time_us = 50_000 * i64::from(step);
        let turn_rate = if seconds % 12.0 < 6.0 { 0.0 } else { std::f64::consts::PI / 6.0 };
        events.push(Event::Wheels(say(seconds, Wheels { time_us, speed: 0.5, turn_rate })));
        events.extend(epoch(time_us, step, [place[0], place[1], 0.3]));
        heading += 0.05 * turn_rate;
        place[0] += 0.025 * heading.cos();
        place[1] += 0.025 * heading.sin();
    }
    about("wheels", findings(&CORNERS, 0.3, &events, None))
}

/// The finding about a robot that stops for two seconds now and then, while its wheels report that `late_us` later.
fn late_wheels(late_us: i64) -> Option<Finding> {
    let mut events = Vec::new();
    let mut place = 0.5_f64;
    for step in 0..1600_u32 {
        let (time_us, seconds) = (50_000 * i64::from(step), 0.05 * f64::from(step));
        let speed = if (0.35 * seconds).sin() * (0.83 * seconds).cos() > 0.1 { 0.0 } else { 0.4 };
        let speed = if seconds % 32.0 < 16.0 { speed } else { -speed };
        events.push(Event::Wheels(Wheels { time_us: time_us + late_us, speed, turn_rate: 0.0 }));
        events.extend(epoch(time_us, step, [place, 3.0, 0.3]));
        place += 0.05 * speed;
    }
    events.sort_by_key(Event::time_us);
    about("wheels", findings(&CORNERS, 0.3, &events, None))
}

#[test]
fn wheels_of_another_clock_are_told() {
    assert_eq!(late_wheels(0), None);
    assert_eq!(late_wheels(200_000), None);
    for (late_us, said) in [(3_000_000, "3.0 s too late"), (-2_000_000, "2.0 s too early")] {
        let told = late_wheels(late_us).expect("a finding");
        assert_eq!(told.reason, Some(Reason::Time));
        assert!(told.found.contains(said), "{}", told.found);
    }
}

#[test]
fn wheels_that_are_dead_are_told_and_scales_are_not() {
    for scale in [0.8, 1.0, 1.2] {
        let scaled = |_, it: Wheels| Wheels { speed: scale * it.speed, ..it };
        assert_eq!(wheels(scaled), None, "{scale}");
    }
    let slipping = |seconds: f64, it: Wheels| {
        let speed = if seconds % 20.0 < 1.0 { 2.0 * it.speed } else { it.speed };
        Wheels { speed, ..it }
    };
    assert_eq!(wheels(slipping), None);
    let dead = |_, it: Wheels| Wheels { speed: 0.0, turn_rate: 0.0, ..it };
    let turning = |seconds: f64, it: Wheels| {
        if seconds < 20.0 { it } else { Wheels { speed: 0.5 * it.speed, turn_rate: 2.0, ..it } }
    };
    for fault in [wheels(dead), wheels(turning)] {
        assert_eq!(fault.unwrap().reason, Some(Reason::Innovations));
    }
}

/// Anchors at several heights.
const HIGH_AND_LOW: [[f64; 3]; 5] =
    [[0.0, 0.0, 0.2], [6.0, 0.0, 2.5], [6.0, 5.0, 0.2], [0.0, 5.0, 2.5], [3.0, 0.0, 1.8]];
/// The biases of these anchors, m.
const BIASES: [f64; 5] = [0.1, -0.05, 0.15, 0.0, -0.1];

/// The finding that the height of a tag changes that is carried around at these heights.
fn height(places: &[[f64; 3]], height: impl Fn(f64) -> f64) -> Option<Finding> {
    let mut events = Vec::new();
    for epoch in 0..600_u32 {
        let seconds = 0.1 * f64::from(epoch);
        let turn = 0.3 * seconds;
        let tag = [3.0 + 2.0 * turn.cos(), 2.5 + 1.5 * turn.sin(), height(seconds)];
        let time_us = 100_000 * i64::from(epoch);
        for (anchor, place) in places.iter().enumerate() {
            let noise = 0.03 * (1.7 * f64::from(epoch) + 2.9 * anchor as f64).sin();
            let metres = distance(tag, *place) + BIASES[anchor] + noise;
            events.push(Event::Range(Range { time_us, anchor, metres }));
        }
        events.push(Event::EpochEnd { time_us });
    }
    let findings = findings(places, 1.0, &events, None);
    findings.into_iter().find(|finding| finding.found.contains("height changes"))
}

#[test]
fn a_tag_that_is_raised_is_told_from_one_that_keeps_its_height() {
    for metres in [0.3, 1.0, 1.6] {
        assert_eq!(height(&HIGH_AND_LOW, |_| metres), None, "{metres} m");
    }
    let raised = height(&HIGH_AND_LOW, |seconds| if seconds < 20.0 { 0.5 } else { 1.7 });
    assert_eq!(raised.unwrap().reason, Some(Reason::Height));
}

#[test]
fn anchors_under_a_ceiling_tell_no_height() {
    let ceiling = HIGH_AND_LOW.map(|[x, y, _]| [x, y, 2.5]);
    assert_eq!(height(&ceiling, |seconds| 0.5 + 0.02 * seconds), None);
}
