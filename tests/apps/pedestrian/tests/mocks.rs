//! Tests the application on mocked hardware, which expects every transaction on the bus and nothing else.

use embedded_hal_mock::eh1::delay::NoopDelay;
use embedded_hal_mock::eh1::i2c::{Mock, Transaction};
use embedded_io::{ErrorKind, ErrorType, Write};
use kestirim_pedestrian::Reason;
use kestirim_telemetry::{EstimateHealth, Health, Imu, Message, Receiver};
use pedestrian_app::{App, Error, SensorError};

const MPU: u8 = 0x68;

fn write(register: u8, value: u8) -> Transaction {
    Transaction::write(MPU, vec![register, value])
}

fn read(register: u8, values: &[u8]) -> Transaction {
    Transaction::write_read(MPU, vec![register], values.to_vec())
}

/// The transactions that set the sensor up if it identifies itself as `who`.
fn setup(who: u8) -> Vec<Transaction> {
    let mut transactions = vec![write(0x27, 0), write(0x34, 0)]; // no auxiliary bus
    transactions.extend([write(0x6B, 0x80), write(0x6B, 1), write(0x6C, 0)]); // reset, clock, all on
    transactions.extend([read(0x1B, &[0]), write(0x1B, 0x18)]); // 2000 °/s
    transactions.extend([read(0x1B, &[0x18]), write(0x1B, 0x18), read(0x1A, &[0]), write(0x1A, 3)]);
    transactions.extend([read(0x1C, &[0]), write(0x1C, 0x18), write(0x1D, 0x43)]); // 16 g, 45 Hz
    transactions.extend([write(0x19, 9), write(0x38, 0), read(0x75, &[who])]); // 100 Hz
    transactions
}

/// The transactions that enable the data-ready interrupt.
fn interrupt() -> [Transaction; 2] {
    [read(0x38, &[0]), write(0x38, 1)]
}

/// The transactions that read a sample: 1 g upwards, −125 °/s about x, and one count of 16 g / 32768 along x.
fn sample() -> [Transaction; 2] {
    let counts: [i16; 7] = [1, 0, 2048, 0, -2048, 0, 0];
    [read(0x3A, &[1]), read(0x3B, counts.map(i16::to_be_bytes).as_flattened())]
}

/// A file with `room` free bytes, and the lengths of the writes to it.
#[derive(Default)]
struct File {
    text: Vec<u8>,
    room: usize,
    writes: Vec<usize>,
}

impl ErrorType for File {
    type Error = ErrorKind;
}

impl Write for File {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, ErrorKind> {
        if self.text.len() + bytes.len() > self.room {
            return Err(ErrorKind::OutOfMemory);
        }
        self.text.extend(bytes);
        self.writes.push(bytes.len());
        Ok(bytes.len())
    }

    fn flush(&mut self) -> Result<(), ErrorKind> {
        Ok(())
    }
}

type Tested<'a> = App<f32, Mock, &'a mut File, &'a mut Vec<u8>>;

fn messages(line: &[u8]) -> Vec<Message> {
    Receiver::new().frames(line).map(|frame| frame.message).collect()
}

#[test]
fn samples_are_logged_in_blocks_and_sent() {
    let transactions = setup(0x71).into_iter().chain(interrupt());
    let mut bus =
        Mock::new(&transactions.chain((0..30).flat_map(|_| sample())).collect::<Vec<_>>());
    let (mut file, mut line) = (File { room: 10_000, ..File::default() }, Vec::new());
    let mut app =
        Tested::new(bus.clone(), &mut NoopDelay::new(), &mut file, &mut line).expect("it answers");
    for number in 0..30 {
        app.poll(number * 10_000).expect("all is well");
    }
    let summary = app.finish().expect("all is well");
    assert_eq!((summary.accepted, summary.rejected, summary.failed), (30, 0, 0));
    drop(app);
    bus.done();

    let text = String::from_utf8(file.text).expect("it is text");
    let lines: Vec<&str> = text.split_inclusive("\r\n").collect();
    assert_eq!(lines.len(), 30);
    assert_eq!(lines[0], "0 0.0005 0.0000 1.0000 -125.00 0.00 0.00\r\n");
    assert_eq!(lines[29], "290 0.0005 0.0000 1.0000 -125.00 0.00 0.00\r\n");
    assert_eq!(file.writes, [512, 512, text.len() - 1024]);

    let sent = messages(&line);
    let specific_force = [16.0 / 32768.0 * 9.806_65, 0.0, 9.806_65];
    let angular_rate = [-125.0_f32.to_radians(), 0.0, 0.0];
    assert_eq!(sent[0], Imu { time_us: 0, specific_force, angular_rate }.into());
    let of_positions = sent.iter().filter(|message| matches!(message, Message::Position(_)));
    assert_eq!(of_positions.count(), 3 + 1, "every tenth and the last");
    let reasons = kestirim_pedestrian::Health::from(Reason::NotObservable).bits();
    let doubt = EstimateHealth { time_us: 0, reasons }.into();
    let told = |message: &&Message| matches!(message, Message::EstimateHealth(_));
    assert_eq!(sent.iter().filter(told).collect::<Vec<_>>(), [&doubt], "no standstill yet");
    let health = Health { time_us: 290_000, accepted: 30, rejected: 0, failed: 0 };
    assert_eq!(sent.last(), Some(&health.into()));
}

#[test]
fn nothing_ready_is_nothing_done() {
    let transactions = setup(0x73).into_iter().chain(interrupt()).chain([read(0x3A, &[0])]);
    let mut bus = Mock::new(&transactions.collect::<Vec<_>>());
    let (mut file, mut line) = (File::default(), Vec::new());
    let mut app =
        Tested::new(bus.clone(), &mut NoopDelay::new(), &mut file, &mut line).expect("an MPU-9255");
    assert_eq!(app.poll(0), Ok(None));
    drop(app);
    bus.done();
    assert_eq!((file.text.len(), line.len()), (0, 0));
}

#[test]
fn another_chip_is_refused() {
    let mut bus = Mock::new(&setup(0x12));
    let (mut file, mut line) = (File::default(), Vec::new());
    let refused = Tested::new(bus.clone(), &mut NoopDelay::new(), &mut file, &mut line).err();
    assert_eq!(refused, Some(Error::Sensor(SensorError::WrongChip(0x12))));
    bus.done();
}

#[test]
fn a_reading_that_fails_is_counted_and_the_next_one_goes_on() {
    let broken = embedded_hal::i2c::ErrorKind::Bus;
    let transactions = setup(0x71)
        .into_iter()
        .chain(interrupt())
        .chain([read(0x3A, &[0]).with_error(broken)])
        .chain(sample());
    let mut bus = Mock::new(&transactions.collect::<Vec<_>>());
    let (mut file, mut line) = (File { room: 1_000, ..File::default() }, Vec::new());
    let mut app =
        Tested::new(bus.clone(), &mut NoopDelay::new(), &mut file, &mut line).expect("it answers");
    assert_eq!(app.poll(0), Err(Error::Sensor(SensorError::Bus(broken))));
    assert!(app.poll(10_000).is_ok());
    let summary = app.finish().expect("all is well");
    assert_eq!((summary.accepted, summary.rejected, summary.failed), (1, 0, 1));
    drop(app);
    bus.done();
}

#[test]
fn a_full_card_stops_neither_tracker_nor_telemetry() {
    let transactions = setup(0x71).into_iter().chain(interrupt());
    let mut bus =
        Mock::new(&transactions.chain((0..30).flat_map(|_| sample())).collect::<Vec<_>>());
    let (mut file, mut line) = (File { room: 600, ..File::default() }, Vec::new());
    let mut app =
        Tested::new(bus.clone(), &mut NoopDelay::new(), &mut file, &mut line).expect("it answers");
    let failures = (0..30).filter(|number| app.poll(number * 10_000).is_err()).count();
    assert_eq!(app.finish(), Err(Error::Log(ErrorKind::OutOfMemory)));
    drop(app);
    bus.done();
    assert_eq!((failures, file.text.len()), (1, 512), "of two full blocks one fits");
    let sent = messages(&line);
    assert_eq!(sent.iter().filter(|message| matches!(message, Message::Imu(_))).count(), 30);
    assert!(matches!(sent.last(), Some(Message::Health(Health { accepted: 30, .. }))));
}
