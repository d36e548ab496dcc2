//! Tests the robot's driver with the simulated radio, on the host.

use embedded_io::{ErrorType, Write};
use kestirim_telemetry::{Message, Receiver};
use robot_app::{Imu, Radio, Robot, TAG};
use robot_world::{ChipSelect, I2cBus, Sample, Spi, World};

#[derive(Default)]
struct Told(Vec<u8>);

impl ErrorType for &mut Told {
    type Error = core::convert::Infallible;
}
impl Write for &mut Told {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Self::Error> {
        self.0.extend(bytes);
        Ok(bytes.len())
    }
    fn flush(&mut self) -> Result<(), Self::Error> {
        Ok(())
    }
}

/// The resolution of a range, m: a tick of the counters is 4.7 mm.
const TICK: f32 = 0.005;
const STEPS: u64 = 7 * 4 * 40;

#[test]
fn ranges_come_out_as_they_went_in() {
    let world = World::new();
    let radio = Radio::new(Spi(&world), ChipSelect(&world), &world, &TAG).expect("a radio");
    let imu = Imu::new(I2cBus(&world), &mut &world).expect("an IMU");
    let mut told = Told::default();
    let mut robot = Robot::new(radio, imu, &mut told).expect("a room");
    let range = |index: u64| if index % 7 == 5 { f32::NAN } else { 3.0 + 0.01 * index as f32 };
    for index in 0..STEPS {
        let sample =
            Sample { time_us: index * 25_000, range: range(index), acceleration: [0, 0, 981] };
        world.advance(&sample);
        robot.step(sample.time_us).expect("nothing is lost");
    }
    drop(robot);
    let mut receiver = Receiver::new();
    let (mut next, mut failed, mut healths) = (0, 0, 0);
    for frame in receiver.frames(&told.0) {
        match frame.message {
            Message::Range(told) => {
                while range(next).is_nan() {
                    next += 1;
                }
                assert_eq!(told.time_us, next * 25_000);
                let error = told.range - range(next);
                assert!(error.abs() < TICK, "{error} m of {}", range(next));
                next += 1;
            }
            Message::Health(health) => failed = health.failed,
            Message::EstimateHealth(_) => healths += 1,
            _ => {}
        }
    }
    assert_eq!(next, STEPS);
    assert_eq!(failed, STEPS as u32 / 7);
    assert_eq!(healths, STEPS / 4, "one after each round of the anchors");
}
