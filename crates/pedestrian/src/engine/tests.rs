//! Tests of a tracker apart from its navigator, with one that only records what it is given.

use super::*;
use kestirim_scalar::Q12_20;
use nalgebra::Vector3;

/// A navigator that stays where it is put.
#[derive(Clone, Copy, Debug)]
struct Put<T: Scalar> {
    position: SVector<T, 3>,
    velocity: SVector<T, 3>,
    restarts: u32,
    missed: Option<crate::MissedTurn<T>>,
    /// The turn of the last step.
    turn: SVector<T, 3>,
}

impl<T: Scalar> Navigator<T> for Put<T> {
    fn start(_: SensorClass, _: Orientation<T>) -> Self {
        let (position, velocity) = (SVector::zeros(), SVector::zeros());
        Self { position, velocity, restarts: 0, missed: None, turn: SVector::zeros() }
    }
    fn propagate(&mut self, step: &Step<T>, _: bool) {
        self.turn = step.turn;
    }
    fn miss(&mut self, missed: &crate::MissedTurn<T>) {
        self.missed = Some(*missed);
    }
    fn zero_velocity(&mut self, _: &ZeroVelocity<T>) {}
    fn restart(&mut self, _: SensorClass, _: Orientation<T>) {
        self.restarts += 1;
    }
    fn position(&self) -> SVector<T, 3> {
        self.position
    }
    fn velocity(&self) -> SVector<T, 3> {
        self.velocity
    }
    fn orientation(&self) -> Orientation<T> {
        Orientation::identity()
    }
}

struct Walk<T: Scalar> {
    engine: Engine<T, Put<T>>,
    time_us: u64,
    angular_rate: SVector<T, 3>,
}

impl<T: Scalar> Walk<T> {
    fn new(levels: bool) -> Self {
        let config = Config { levels, ..Config::default() };
        Self { engine: Engine::new(config), time_us: 0, angular_rate: SVector::zeros() }
    }

    fn sample(&self) -> ImuSample<T> {
        let specific_force = Vector3::new(0.0, 0.0, 9.8).map(T::from_f64);
        ImuSample { time_us: self.time_us, specific_force, angular_rate: self.angular_rate }
    }

    /// Processes the next sample, in stance with a statistic, or not; returns a stride that it ends.
    fn on(&mut self, statistic: Option<f64>) -> Option<Stride<T>> {
        self.time_us += 10_000;
        let sample = self.sample();
        let examined = self.engine.examine(&sample).expect("a sample");
        let motion = self.engine.motion(&sample);
        let verdict = Verdict {
            stance: statistic.is_some(),
            statistic: T::from_f64(statistic.unwrap_or(9.0)),
        };
        self.engine.advance(&sample, examined, &motion, verdict)
    }

    fn navigator(&mut self) -> &mut Put<T> {
        self.engine.navigator.as_mut().expect("a stance has begun it")
    }
}

#[test]
fn a_foot_that_lost_its_tilt_is_levelled_until_a_calm_stance() {
    for levels in [true, false] {
        let mut walk = Walk::<f64>::new(levels);
        walk.on(Some(0.05));
        walk.on(None);
        walk.on(Some(0.05));
        assert_eq!(walk.navigator().restarts, 0, "nothing was lost");
        walk.on(None);
        walk.navigator().velocity = Vector3::new(3.0, 0.0, 0.0);
        for (statistic, restarts) in [(0.2, 1), (0.2, 2), (0.05, 3), (0.05, 3), (0.2, 3)] {
            walk.on(Some(statistic));
            assert_eq!(walk.navigator().restarts, if levels { restarts } else { 0 });
        }
    }
}

#[test]
fn a_foot_beyond_the_numbers_is_told() {
    let mut walk = Walk::<f64>::new(true);
    assert!(!walk.engine.warnings().out_of_range, "before it has begun");
    walk.on(Some(0.05));
    assert!(!walk.engine.warnings().out_of_range);
    walk.navigator().position.x = f64::INFINITY;
    assert!(walk.engine.warnings().out_of_range);
    walk.navigator().position.x = 0.0;
    walk.navigator().velocity.y = f64::NAN;
    assert!(walk.engine.warnings().out_of_range);

    // A swing too fast for the numbers stays told when the foot stands again.
    let mut walk = Walk::<f64>::new(true);
    walk.on(Some(0.05));
    walk.on(None);
    walk.navigator().velocity.y = f64::INFINITY;
    walk.on(Some(0.05));
    walk.navigator().velocity.y = 0.0;
    walk.on(Some(0.05));
    assert!(walk.engine.warnings().out_of_range);

    // Back and forth by 20 m a hundred times: the path reaches the limit of the numbers, the foot stays near.
    let mut walk = Walk::<Q12_20>::new(true);
    walk.on(Some(0.05));
    for stride in 0..105 {
        assert_eq!(walk.engine.warnings().out_of_range, stride > 103, "{stride}");
        walk.on(None);
        walk.navigator().position.x = Q12_20::from_f64(if stride % 2 == 0 { 20.0 } else { 0.0 });
        walk.on(Some(0.05));
    }
}

#[test]
fn a_recording_is_learnt_from_and_a_row_written_twice_only_once() {
    let learnt = |times: u32| {
        let mut walk = Walk::<f64>::new(true);
        for _ in 0..55 {
            walk.time_us += 10_000;
            let mut sample = walk.sample();
            sample.angular_rate.x = 0.05;
            for _ in 0..times {
                let examined = walk.engine.examine(&sample).expect("a sample");
                walk.engine.learn(&sample, examined);
            }
        }
        *walk.engine.alignment.gyro_bias()
    };
    assert!((learnt(1) - Vector3::new(0.05, 0.0, 0.0)).norm() < 1e-4, "{}", learnt(1));
    assert_eq!(learnt(2), learnt(1));
}

#[test]
fn what_was_pushed_since_a_missed_turn_is_without_gravity() {
    let mut navigator = Put::<f64>::start(SensorClass::Industrial, Orientation::identity());
    let (mut clipping, mut health, mut strides) = (Clipping::new(), Health::new(), Strides::new());
    let (interval, gained) = (0.005, Vector3::new(0.3, -0.2, 0.1));
    let before = Vector3::new(1.0, 2.0, 3.0);
    navigator.velocity = before + gained;
    for _ in 0..3 {
        for rate in [0.0, 4.0, 8.0, 10.0, 10.0, 10.0, 10.0, 8.0, 4.0, 0.0] {
            let rate = Vector3::new(rate, 0.0, 0.0);
            let told = (&mut health, &mut strides);
            bridge(&mut clipping, told, &mut navigator, &rate, interval, &before);
            clipping.remember(&rate);
        }
    }
    assert!(health.warnings().gyroscope_saturated);
    for (time_us, metres, stance) in [(0, 0.0, true), (1, 0.0, false), (2, 1.0, true)] {
        strides.update(time_us, Vector3::new(metres, 0.0, 0.0), stance);
    }
    let bridged = strides.finish().expect("a stride").bridged;
    assert!(bridged > 0.01 && bridged < 0.2, "{bridged} rad");
    // Half of the plateau's four steps, and the two after it; the effect of gravity is not part of the push.
    let pushed = (gained + Vector3::new(0.0, 0.0, STANDARD_GRAVITY * interval)) * 4.0;
    let missed = navigator.missed.expect("a plateau");
    assert!((missed.pushed - pushed).norm() < 1e-9, "{missed:?} {pushed}");
}

/// Walks a stance, a swing with missing samples of `missing_us`, and a stance a metre on; returns the stride, and the
/// turn in the gap.
fn over_a_gap(missing_us: u64) -> (Stride<f64>, Vector3<f64>) {
    let mut walk = Walk::<f64>::new(true);
    for _ in 0..20 {
        walk.on(Some(0.0));
    }
    walk.angular_rate = Vector3::new(1.0, 4.0, 0.0);
    for _ in 0..20 {
        walk.on(None);
    }
    walk.angular_rate = Vector3::new(3.0, -1.0, 2.0);
    walk.time_us += missing_us - 10_000;
    walk.on(None);
    let turn = walk.navigator().turn;
    walk.angular_rate = Vector3::zeros();
    walk.navigator().position.x = 1.0;
    walk.on(Some(0.0));
    let stride = walk.on(None).expect("a stride");
    walk.navigator().position.x = 2.0;
    walk.on(Some(0.0));
    let next = walk.on(None).expect("a stride");
    assert_eq!(next.unseen, 0.0, "the next stride was seen");
    (stride, turn)
}

#[test]
fn a_body_turns_in_a_gap_as_its_rates_at_both_ends_say() {
    let (stride, turn) = over_a_gap(150_000);
    // (The biases are being learnt meanwhile.)
    assert!((turn - Vector3::new(2.0, 1.5, 1.0) * 0.15).norm() < 2e-3, "{turn}");
    assert!((stride.unseen - 0.15).abs() < 1e-9, "{stride:?}");
    // No gap, and the axis moves: the coning correction is a twelfth of the turn before × this one.
    let (stride, turn) = over_a_gap(10_000);
    let rate = Vector3::new(3.0, -1.0, 2.0) * 0.01;
    let coning = (Vector3::new(1.0, 4.0, 0.0) * 0.01).cross(&rate) / 12.0;
    assert!((turn - rate - coning).norm() < 2e-4 * coning.norm() + 2e-6, "{turn}");
    assert_eq!(stride.unseen, 0.0);
}

#[test]
fn a_gap_after_a_stance_is_on_the_way_to_the_next() {
    let mut walk = Walk::<f64>::new(true);
    for metres in [0.0, 1.0] {
        walk.on(None);
        walk.on(Some(0.0));
        walk.navigator().position.x = metres;
        walk.on(Some(0.0));
    }
    walk.time_us += 140_000;
    walk.angular_rate = Vector3::new(4.0, 0.0, 0.0);
    assert_eq!(walk.on(None).expect("a stride before the gap").unseen, 0.0);
    walk.navigator().position.x = 2.0;
    walk.on(Some(0.0));
    assert!((walk.on(None).expect("a stride with it").unseen - 0.15).abs() < 1e-9);
}

#[test]
fn a_rate_that_is_repeated_to_the_last_bit_is_no_sample() {
    let mut walk = Walk::<f64>::new(true);
    walk.on(Some(0.0));
    walk.on(None);
    let mut examined = |at_us: u64, rate: [f64; 3]| {
        walk.time_us = 20_000 + at_us;
        walk.angular_rate = rate.into();
        walk.engine.examine(&walk.sample()).expect("a sample").0
    };
    assert_eq!(examined(10_000, [0.0; 3]), Tick::Elapsed { interval: 0.01, missing: None });
    walk.angular_rate = Vector3::new(0.0, 3.0, 0.1);
    walk.time_us = 20_000;
    walk.on(None);
    let tick = |at_us: u64, rate: [f64; 3]| {
        let sample =
            ImuSample { time_us: 30_000 + at_us, angular_rate: rate.into(), ..walk.sample() };
        walk.engine.examine(&sample).expect("a sample").0
    };
    assert_eq!(tick(10_000, [0.0, 3.0, 0.1]), Tick::Duplicate);
    assert_eq!(tick(140_000, [0.0, 3.0, 0.1]), Tick::Duplicate);
    assert!(matches!(tick(160_000, [0.0, 3.0, 0.1]), Tick::Elapsed { missing: Some(_), .. }));
    assert!(matches!(tick(10_000, [0.0, 3.0, 0.1001]), Tick::Elapsed { missing: None, .. }));
}

#[test]
fn a_lost_tilt_counts_as_a_fifth_of_a_second() {
    let mut walk = Walk::<f64>::new(true);
    for (metres, speed, unseen) in [(1.0, 0.1, 0.0), (2.0, 3.0, 0.2), (3.0, 0.1, 0.0)] {
        walk.on(Some(0.0));
        walk.on(None);
        let navigator = walk.navigator();
        navigator.velocity = Vector3::new(speed, 0.0, 0.0);
        navigator.position.x = metres;
        walk.on(Some(0.0));
        assert_eq!(walk.on(None).expect("a stride").unseen, unseen, "{speed} m/s");
        walk.navigator().velocity = Vector3::zeros();
    }
}

#[test]
fn a_foot_that_stands_before_and_after_a_short_gap_has_stood_in_it() {
    for (missing_us, expected) in [(200_000, 0.0), (500_000, 0.5)] {
        let mut walk = Walk::<f64>::new(true);
        for _ in 0..20 {
            walk.on(Some(0.0));
        }
        walk.time_us += missing_us - 10_000;
        walk.on(Some(0.0));
        assert!(walk.engine.warnings().gaps);
        walk.on(None);
        walk.navigator().position.x = 1.0;
        walk.on(Some(0.0));
        assert_eq!(walk.on(None).expect("a stride").unseen, expected);
    }
}
