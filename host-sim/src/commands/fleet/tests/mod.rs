//! Kills and restarts at any moment, with a log in memory.

mod broker;
mod streams;

use std::sync::{Arc, Mutex};
use std::time::Duration;

use kestirim_telemetry::{CAPACITY, Health, Message, Origin, Receiver, encode_from};

use self::broker::{Broker, Memory};
use self::streams::{Maker, plans};
use super::engine::Engine;
use super::keyed::Fleet;
use super::store::Store;
use super::transport::{Delivery, Estimate, Log};
use crate::system::{Outcome, Plan};

const DEVICES: u32 = 7;
const MESSAGES: u64 = 60;
const FRAMES: u64 = 8;

fn log_of(name: &str, created: Option<&str>) -> Log {
    Log { name: name.to_owned(), created: created.map(str::to_owned) }
}

fn frame(device: u32, boot: u32, sequence: u64, message: &Message) -> Vec<u8> {
    let origin = Origin { device, boot };
    let mut buffer = [0; CAPACITY];
    encode_from(origin, message, sequence as u32, &mut buffer).unwrap().to_vec()
}

/// Messages of all devices, in turn. The last device is switched on again halfway, the one before shares its messages with
/// the first, and some messages come twice.
fn log(plan: &dyn Plan, message: Maker) -> Vec<Vec<u8>> {
    let mut log: Vec<Vec<u8>> = Vec::new();
    for number in 0..MESSAGES {
        for device in 0..DEVICES {
            let restarts = device == DEVICES - 1 && number >= MESSAGES / 2;
            let (boot, first) = if restarts { (1, MESSAGES / 2) } else { (0, 0) };
            let frames = (0..FRAMES).flat_map(|it| {
                let step = (number - first) * FRAMES + it;
                frame(device, boot, step, &message(plan, device, step))
            });
            let frames: Vec<u8> = frames.collect();
            if device == DEVICES - 2 {
                log.last_mut().expect("a message").extend(frames);
            } else {
                log.push(frames);
            }
        }
        if number % 5 == 0 {
            log.push(log[log.len() - 3].clone());
        }
    }
    log
}

/// The track that a separate estimator computes from a file of a device's messages: time and position after each
/// message.
fn replay(plan: &dyn Plan, log: &[Vec<u8>], device: u32) -> Vec<(u64, [f32; 3])> {
    let (mut online, mut boot, mut next) = (plan.build().unwrap(), 0, 0);
    let mut track = Vec::new();
    for bytes in log {
        let mut last = None;
        for frame in Receiver::new().frames(bytes) {
            let origin = frame.origin.expect("a device");
            if origin.device != device || (origin.boot, frame.sequence) < (boot, next) {
                continue;
            }
            if origin.boot > boot {
                online = plan.build().unwrap();
            }
            (boot, next) = (origin.boot, frame.sequence + 1);
            if online.take(&frame.message) == Outcome::Taken {
                last = frame.message.measured_us();
            }
        }
        let position = online.position().map(|position| position.map(|axis| axis as f32));
        track.extend(last.zip(position));
    }
    track
}

fn track(estimates: &[Estimate]) -> Vec<(u64, [f32; 3])> {
    let of = |estimate: &Estimate| match Receiver::new().frames(&estimate.frame).next() {
        Some(frame) => match frame.message {
            Message::Position(it) => (it.time_us, it.position),
            other => panic!("{other:?}"),
        },
        None => panic!("no frame"),
    };
    estimates.iter().map(of).collect()
}

#[test]
fn killed_at_any_moment_every_track_is_that_of_the_devices_own_replay() {
    let plans = plans();
    assert!(plans.len() >= 2, "{plans:?}");
    for (name, plan, message) in plans {
        let broker = Arc::new(Mutex::new(Broker::default()));
        broker.lock().unwrap().log = log(plan.as_ref(), message);
        let count = broker.lock().unwrap().log.len();
        let folder = tempfile::tempdir().unwrap();
        let mut kills = 0_usize;
        let counts = loop {
            let mut fleet = Fleet::new(name, &plan).unwrap();
            let store = Store::open(folder.path(), name, Vec::new(), log_of("a", None), &mut fleet);
            let store = store.unwrap();
            // Each kill comes a little later, and messages are received in other batches.
            let (batch, calls_left) = (1 + kills % 4, 1 + kills % 11);
            let memory = Memory { broker: Arc::clone(&broker), next: 0, batch, calls_left };
            let every =
                if kills.is_multiple_of(3) { Duration::ZERO } else { Duration::from_micros(300) };
            let begun = Engine::begin(fleet, store, Box::new(memory), every);
            let mut engine = begun.unwrap();
            let ended = loop {
                match engine.step() {
                    Ok(0) if engine.fleet.keyed.position == count as u64 => break engine.settle(),
                    Ok(_) => {}
                    Err(error) => break Err(error),
                }
            };
            if ended.is_ok() {
                break engine.fleet.counts();
            }
            kills += 1;
            assert!(kills < 10_000);
        };
        let broker = broker.lock().unwrap();
        assert!(kills > 30, "{kills}");
        assert!(broker.again > 30, "{name}: {} of {kills}", broker.again);
        assert_eq!(broker.acknowledged, count as u64);
        for device in 0..DEVICES {
            let own = replay(plan.as_ref(), &broker.log, device);
            assert!(own.len() > MESSAGES as usize / 2, "{name}: {}", own.len());
            assert!(
                own.first().map(|it| it.1) != own.last().map(|it| it.1),
                "{name} does not move"
            );
            assert_eq!(track(&broker.stored[&device]), own, "{name}, device {device}");
        }
        let frames = u64::from(DEVICES) * MESSAGES * FRAMES;
        assert_eq!((counts.frames, counts.lost, counts.another), (frames, 0, 0));
        assert_eq!((counts.restarts, counts.dropped >= 12 * FRAMES), (1, true));
    }
}

#[test]
fn states_of_another_estimator_and_torn_ones_are_refused() {
    let plans = plans();
    let [(first, plan, message), (second, other, _)] = [&plans[0], &plans[1]];
    let folder = tempfile::tempdir().unwrap();
    let open = |name: &str, plan: &Arc<dyn Plan>| {
        let mut fleet = Fleet::new(name, plan).unwrap();
        let log = log_of("a", None);
        Store::open(folder.path(), name, Vec::new(), log, &mut fleet).map(|store| (store, fleet))
    };
    {
        let (store, mut fleet) = open(first, plan).unwrap();
        let taken = open(first, plan).unwrap_err().to_string();
        assert!(taken.contains("another program"), "{taken}");
        let bytes = frame(3, 1, 0, &message(plan.as_ref(), 3, 0));
        fleet.take(&[Delivery { position: 9, bytes }]).unwrap();
        store.write(&fleet.keyed).unwrap();
    }
    assert_eq!(open(first, plan).unwrap().1.keyed.position, 9);
    let refused = open(second, other).unwrap_err().to_string();
    assert!(refused.contains("expected another folder"), "{refused}");
    let path = folder.path().join("fleet.states");
    let whole = std::fs::read(&path).unwrap();
    for length in [0, 5, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(open(first, plan).is_err(), "{length} bytes");
    }
}

#[test]
fn a_position_is_of_one_log_and_one_that_was_made_anew_is_followed_from_its_start() {
    let plans = plans();
    let (name, plan, message) = &plans[0];
    let folder = tempfile::tempdir().unwrap();
    let open = |log: Log| {
        let mut fleet = Fleet::new(name, plan).unwrap();
        Store::open(folder.path(), name, Vec::new(), log, &mut fleet).map(|store| (store, fleet))
    };
    {
        let (store, mut fleet) = open(log_of("a", Some("noon"))).unwrap();
        let bytes = frame(3, 1, 0, &message(plan.as_ref(), 3, 0));
        fleet.take(&[Delivery { position: 9, bytes }]).unwrap();
        store.write(&fleet.keyed).unwrap();
    }
    let refused = open(log_of("b", Some("noon"))).unwrap_err().to_string();
    assert!(refused.contains("came from a; expected those from b"), "{refused}");
    assert_eq!(open(log_of("a", Some("noon"))).unwrap().1.keyed.position, 9);
    let (_, anew) = open(log_of("a", Some("one"))).unwrap();
    assert_eq!((anew.keyed.position, anew.keyed.devices.len()), (0, 1));
}

#[test]
fn holes_are_counted_and_another_sender_is_told() {
    let plans = plans();
    let (name, plan, message) = &plans[0];
    let mut fleet = Fleet::new(name, plan).unwrap();
    let mut take = |frames: &[(u32, u64, u32)]| {
        let bytes = frames.iter().flat_map(|&(boot, sequence, seed)| {
            frame(5, boot, sequence, &message(plan.as_ref(), seed, sequence + 60))
        });
        let bytes: Vec<u8> = bytes.collect();
        let position = fleet.keyed.position + 1;
        fleet.take(&[Delivery { position, bytes }]).unwrap();
        fleet.counts()
    };
    let counts = take(&[(0, 0, 0), (0, 3, 0), (0, 4, 0), (0, 3, 0)]);
    assert_eq!((counts.frames, counts.lost, counts.dropped, counts.another), (3, 2, 1, 0));
    let counts = take(&[(0, 4, 1), (1, 2, 0), (0, 5, 0)]);
    assert_eq!((counts.frames, counts.lost, counts.another, counts.restarts), (4, 4, 2, 1));
    let mut fleet = Fleet::new(name, plan).unwrap();
    fleet.take(&[Delivery { position: 1, bytes: b"noise".to_vec() }]).unwrap();
    assert_eq!((fleet.keyed.unreadable, fleet.keyed.devices.len()), (1, 0));
    // Messages that no estimator uses do not register a device; the first that is used does.
    let health = Health { time_us: 0, accepted: 0, rejected: 0, failed: 0 }.into();
    let bytes = frame(8, 0, 0, &health);
    fleet.take(&[Delivery { position: 2, bytes }]).unwrap();
    assert_eq!((fleet.keyed.devices.len(), fleet.counts().frames), (0, 0));
    let bytes = [frame(8, 0, 1, &health), frame(8, 0, 5, &message(plan.as_ref(), 8, 0))].concat();
    fleet.take(&[Delivery { position: 3, bytes }]).unwrap();
    assert_eq!((fleet.keyed.devices.len(), fleet.counts().frames), (1, 1));
    assert_eq!((fleet.counts().lost, fleet.counts().taken), (0, 1));
}
