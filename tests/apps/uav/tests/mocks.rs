//! Tests the application on mocked hardware, which expects every transaction on the buses and nothing else.

use embedded_hal::i2c::ErrorKind;
use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use kestirim_telemetry::{EstimateHealth, Flight, Health, Message, Receiver, State};
use ms4525do::Ms4525doError;
use uav_app::{App, Error, Event, SensorError, Sensors};

const BNO: u8 = 0x29;
const MS: u8 = 0x28;

fn write(register: u8, value: u8) -> Transaction {
    Transaction::write(BNO, vec![register, value])
}

/// Reads a register of the first page, which the driver selects every time.
fn read(register: u8, values: &[u8]) -> [Transaction; 2] {
    [write(0x07, 0), Transaction::write_read(BNO, vec![register], values.to_vec())]
}

/// The transactions that set the inertial sensor up if it identifies itself as `who`.
fn setup(who: u8) -> Vec<Transaction> {
    let mut transactions = vec![write(0x07, 0)];
    transactions.extend(read(0x00, &[who]));
    if who == 0xA0 {
        transactions.extend([write(0x07, 0), write(0x3F, 0x20)]); // reset
        transactions.extend([write(0x07, 0), write(0x3E, 0), write(0x3F, 0)]); // normal power
        transactions.extend([write(0x07, 0), write(0x3D, 0x0C)]); // fusion
    }
    transactions
}

/// The transactions that read −32 °/s and 8 ° of pitch.
fn inertial() -> [Transaction; 4] {
    let rate: [i16; 3] = [0, -32 * 16, 0];
    let euler: [i16; 3] = [0, 0, 8 * 16];
    let [a, b] = read(0x14, rate.map(i16::to_le_bytes).as_flattened());
    let [c, d] = read(0x1A, euler.map(i16::to_le_bytes).as_flattened());
    [a, b, c, d]
}

/// The transactions that read 1000 Pa at 15 °C: 7241 and 665 counts.
fn airspeed() -> [Transaction; 3] {
    let said = |status: u8| {
        let [high, low] = 7241_u16.to_be_bytes();
        let [warm, er] = (665_u16 << 5).to_be_bytes();
        Transaction::read(MS, vec![status << 6 | high, low, warm, er])
    };
    [Transaction::write(MS, vec![0]), said(0), said(2)]
}

/// The transactions of a step in which the Pitot tube's sensor reports a fault.
fn fault() -> [Transaction; 3] {
    let said = || Transaction::read(MS, vec![0xC0, 0, 0, 0]);
    [Transaction::write(MS, vec![0]), said(), said()]
}

type Tested<'a> = App<f32, Mock, Mock, NoopDelay, &'a mut Vec<u8>>;

/// Runs steps with these transactions; returns the result of each, and what was sent.
#[expect(clippy::type_complexity, reason = "it is the application's own")]
fn run(
    inertial: &[Transaction],
    airspeed: &[Transaction],
    inputs: &[[f32; 2]],
) -> (Vec<Result<Option<Event>, Error<ErrorKind, std::io::Error>>>, Vec<Message>, [f32; 4]) {
    let inertial: Vec<_> = setup(0xA0).into_iter().chain(inertial.iter().cloned()).collect();
    let mut buses = [Mock::new(&inertial), Mock::new(airspeed)];
    let [imu, tube] = buses.clone();
    let sensors = Sensors::new(imu, tube, NoopDelay::new()).expect("it answers");
    let mut line = Vec::new();
    let mut app = Tested::new(sensors, &mut line).expect("the gains fit");
    let outcomes = inputs
        .iter()
        .enumerate()
        .map(|(number, &inputs)| {
            app.step(number as u64 * 10_000, inputs).map_err(|error| match error {
                Error::Sensor(error) => Error::Sensor(error),
                other => panic!("{other}"),
            })
        })
        .collect();
    let estimate = app.estimate();
    drop(app);
    buses.iter_mut().for_each(Mock::done);
    (outcomes, Receiver::new().frames(&line).map(|frame| frame.message).collect(), estimate)
}

const TRIM: [f32; 2] = [0.025, 0.155];

#[test]
fn what_was_measured_is_sent_in_si_units() {
    let (outcomes, sent, state) = run(&inertial(), &airspeed(), &[TRIM]);
    assert!(matches!(outcomes[..], [Ok(None)]));
    let [Message::Flight(Flight { time_us: 0, inputs, outputs: [rate, airspeed, pitch] }), last] =
        sent[..]
    else {
        panic!("{sent:?}")
    };
    assert_eq!(inputs, TRIM);
    assert!((rate + 32.0_f32.to_radians()).abs() < 1e-6, "{rate} rad/s");
    assert!((pitch - 8.0_f32.to_radians()).abs() < 1e-6, "{pitch} rad");
    // √(2 · 1000 Pa / 1.225 kg/m³); the sensor resolves 1 Pa.
    assert!((airspeed - 40.41).abs() < 0.05, "{airspeed} m/s");
    assert_eq!(last, State { time_us: 10_000, state }.into());
}

#[test]
fn without_a_sensor_the_observer_moves_on() {
    let readings = [inertial(), inertial(), inertial()].concat();
    let tube = [airspeed(), fault(), airspeed()].concat();
    let (outcomes, sent, _) = run(&readings, &tube, &[TRIM; 3]);
    assert!(matches!(
        outcomes[..],
        [
            Ok(None),
            Err(Error::Sensor(SensorError::Airspeed(Ms4525doError::FaultDetected))),
            Ok(Some(Event::Recovered(1)))
        ]
    ));
    let states: Vec<State> = sent
        .iter()
        .filter_map(|message| if let Message::State(state) = message { Some(*state) } else { None })
        .collect();
    assert_eq!(states.len(), 3, "a state every step");
    assert_ne!(states[0].state, states[1].state);
    assert_eq!(sent.len(), 3 + 2, "but no measurement that was not made");
}

#[test]
fn an_input_that_is_no_number_is_refused() {
    let readings = [inertial(), inertial()].concat();
    let tube = [airspeed(), airspeed()].concat();
    let (outcomes, _, state) = run(&readings, &tube, &[TRIM, [f32::NAN, 0.0]]);
    assert!(matches!(outcomes[1], Ok(Some(Event::Refused(_)))), "{outcomes:?}");
    assert!(state.iter().all(|value| value.is_finite()));
}

#[test]
fn a_second_of_steps_ends_with_the_health() {
    let readings = vec![inertial(); 100].concat();
    let tube = vec![airspeed(); 100].concat();
    let (_, sent, _) = run(&readings, &tube, &[TRIM; 100]);
    let health = Health { time_us: 990_000, accepted: 100, rejected: 0, failed: 0 };
    let doubts = EstimateHealth { time_us: 990_000, reasons: 0 };
    assert!(sent.ends_with(&[health.into(), doubts.into()]), "{sent:?}");
}

#[test]
fn another_chip_is_refused() {
    let mut bus = Mock::new(&setup(0x33));
    let mut none = Mock::new(&[]);
    let refused = Sensors::new(bus.clone(), none.clone(), NoopDelay::new()).err();
    assert_eq!(refused, Some(SensorError::WrongChip(0x33)));
    bus.done();
    none.done();
}
