//! What a tracker does around its navigator, with one that only keeps what it is told.

use super::*;
use kestirim_scalar::Q12_20;
use nalgebra::Vector3;

/// A navigator that is where it is put.
#[derive(Clone, Copy, Debug)]
struct Put<T: Scalar> {
    position: SVector<T, 3>,
    velocity: SVector<T, 3>,
    restarts: u32,
    missed: Option<crate::MissedTurn<T>>,
}

impl<T: Scalar> Navigator<T> for Put<T> {
    fn start(_: SensorClass, _: Orientation<T>) -> Self {
        let (position, velocity) = (SVector::zeros(), SVector::zeros());
        Self { position, velocity, restarts: 0, missed: None }
    }
    fn propagate(&mut self, _: &Step<T>, _: bool) {}
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
}

impl<T: Scalar> Walk<T> {
    fn new(levels: bool) -> Self {
        let config = Config { levels, ..Config::default() };
        Self { engine: Engine::new(config), time_us: 0 }
    }

    fn sample(&self) -> ImuSample<T> {
        let specific_force = Vector3::new(0.0, 0.0, 9.8).map(T::from_f64);
        ImuSample { time_us: self.time_us, specific_force, angular_rate: SVector::zeros() }
    }

    /// The next sample, in stance with a statistic or not.
    fn on(&mut self, statistic: Option<f64>) {
        self.time_us += 10_000;
        let sample = self.sample();
        let examined = self.engine.examine(&sample).expect("a sample");
        let motion = self.engine.motion(&sample);
        let verdict = Verdict {
            stance: statistic.is_some(),
            statistic: T::from_f64(statistic.unwrap_or(9.0)),
        };
        self.engine.advance(&sample, examined, &motion, verdict);
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

    // To and fro by 20 m a hundred times: the path is as long as the numbers reach, the foot near by.
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
    let (mut clipping, mut health) = (Clipping::new(), Health::new());
    let (interval, gained) = (0.005, Vector3::new(0.3, -0.2, 0.1));
    let before = Vector3::new(1.0, 2.0, 3.0);
    navigator.velocity = before + gained;
    for _ in 0..3 {
        for rate in [0.0, 4.0, 8.0, 10.0, 10.0, 10.0, 10.0, 8.0, 4.0, 0.0] {
            let rate = Vector3::new(rate, 0.0, 0.0);
            bridge(&mut clipping, &mut health, &mut navigator, &rate, interval, &before);
            clipping.remember(&rate);
        }
    }
    assert!(health.warnings().gyroscope_saturated);
    // Half of the plateau's four steps, and the two after it; what gravity took is no push.
    let pushed = (gained + Vector3::new(0.0, 0.0, STANDARD_GRAVITY * interval)) * 4.0;
    let missed = navigator.missed.expect("a plateau");
    assert!((missed.pushed - pushed).norm() < 1e-9, "{missed:?} {pushed}");
}
