//! Bytes that are not a snapshot, and snapshots that were forged to do harm: refused, or a bad estimate, never a panic.

use std::panic::{AssertUnwindSafe, catch_unwind};

use kestirim_snapshot::{Error, load};
use rand_core::Rng;
use target_bench::is_short;

use super::streams::{Kind, visit_all};
use super::systems::{Sample, Sleeper};
use super::{Awake, Visit};

/// The number of bytes before the state, and of those after it.
const HEADER: usize = 42;
const CHECKSUM: usize = 4;
/// The number of times that each estimator's snapshot is damaged; a quarter of that in the short form.
const ROUNDS: usize = 100;
/// The number of samples that an estimator takes after that.
const SAMPLES: usize = 60;

/// Gives a snapshot with a changed state the checksum that it should have.
fn forged(bytes: &mut [u8]) {
    let end = bytes.len() - CHECKSUM;
    let checksum = crc32fast::hash(&bytes[..end]);
    bytes[end..].copy_from_slice(&checksum.to_le_bytes());
}

struct Spoils;

impl Visit for Spoils {
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, samples: &[Sample]) {
        let middle = samples.len() / 2;
        let awake = Awake::over(estimator, &samples[..=middle], &[middle]);
        let [(place, snapshot)] = &awake.snapshots[..] else { panic!("a snapshot") };
        let mut rng = host_sim::random::stream(kind.seed, 23);
        let mut refused = 0;
        let rounds = if is_short() { ROUNDS / 4 } else { ROUNDS };
        for round in 0..rounds {
            let mut bytes = snapshot.clone();
            for _ in 0..=round % 4 {
                let room = (bytes.len() - HEADER - CHECKSUM) as u64;
                let at = HEADER + (rng.next_u64() % room) as usize;
                // Random bytes, and the limits of their range.
                bytes[at] =
                    [rng.next_u32() as u8, 0, 0x7f, 0x80, 0xff][(rng.next_u32() % 5) as usize];
            }
            forged(&mut bytes);
            let Ok(mut woken) = load::<E>(&bytes) else {
                refused += 1;
                continue;
            };
            let taken = catch_unwind(AssertUnwindSafe(|| {
                for sample in samples.iter().skip(*place).take(SAMPLES) {
                    woken.take(sample);
                }
            }));
            assert!(taken.is_ok(), "{} in {}: round {round}", E::NAME, E::number());
        }
        println!("{} in {}: {refused} of {rounds} refused", E::NAME, E::number());
    }
}

#[test]
fn a_forged_snapshot_makes_no_estimator_panic() {
    visit_all(&mut Spoils);
}

struct Tears;

impl Visit for Tears {
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, _: &[Sample]) {
        let whole = super::stored(&estimator);
        let error = |bytes: &[u8]| load::<E>(bytes).err();
        assert_eq!(error(&whole), None);
        for erased in [0x00, 0xff] {
            assert_eq!(error(&vec![erased; whole.len()]), Some(Error::NoSnapshot));
        }
        let mut rng = host_sim::random::stream(kind.seed, 24);
        for _ in 0..50 {
            let at = (rng.next_u64() % whole.len() as u64) as usize;
            assert!(matches!(error(&whole[..at]), Some(Error::TooShort)), "cut at {at}");
            // A page that was written up to this position.
            let mut torn = whole.clone();
            torn[at..].fill(0xff);
            assert!(error(&torn).is_some() || torn == whole, "torn at {at}");
            let mut flipped = whole.clone();
            flipped[at] ^= 1 << (rng.next_u32() % 8);
            assert!(error(&flipped).is_some(), "a bit of byte {at}");
        }
    }
}

#[test]
fn what_was_not_written_whole_is_refused() {
    visit_all(&mut Tears);
}
