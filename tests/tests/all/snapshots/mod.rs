//! Snapshots of estimators: a stream is cut at twenty random places, where the estimator is stored and loaded; all
//! estimates until the next cut, or until the end, equal those without the interruption, bit for bit, and so does the snapshot then.
//! `cargo test -p kestirim-tests --test all snapshots::`

mod bytes;
mod hostile;
mod layouts;
mod on_target;
mod recorded;
mod shape;
mod streams;
#[allow(unreachable_pub)] // The image's.
#[path = "../../../firmware/snapshots/src/systems.rs"]
mod systems;

use std::error::Error;

use kestirim_snapshot::{Layout, load, size, store};
use rand_core::Rng;

use streams::Kind;
use systems::{Sample, Sleeper};

/// The number of times that a stream is cut.
const CUTS: usize = 20;
/// One in this many cuts is followed to the end of the stream, the others to the next cut.
const FOLLOWED: usize = 5;

/// A test to be run on each estimator.
trait Visit {
    /// Tests an estimator that has not begun, with its stream of samples.
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, samples: &[Sample]);
}

/// A snapshot, exactly as large as needed.
fn stored<E: Sleeper>(estimator: &E) -> Vec<u8> {
    let mut bytes = vec![0; size(estimator).expect("a size")];
    let length = store(estimator, &mut bytes).expect("there is room").len();
    assert_eq!(length, bytes.len(), "{}: the size is what is written", E::NAME);
    bytes
}

/// Random places of a stream, each once, in order.
fn places(seed: u64, length: usize) -> Vec<usize> {
    let mut rng = host_sim::random::stream(seed, 22);
    let mut places = Vec::new();
    while places.len() < CUTS {
        let place = (rng.next_u64() % length as u64) as usize;
        if !places.contains(&place) {
            places.push(place);
        }
    }
    places.sort_unstable();
    places
}

/// The reference: an estimator without interruptions.
struct Awake {
    /// A digest of its estimate after each sample.
    said: Vec<u64>,
    /// The places at which it was stored, with its snapshots.
    snapshots: Vec<(usize, Vec<u8>)>,
    /// Its snapshot at the end.
    end: Vec<u8>,
}

impl Awake {
    fn over<E: Sleeper>(mut estimator: E, samples: &[Sample], places: &[usize]) -> Self {
        let (mut said, mut snapshots) = (Vec::new(), Vec::new());
        for (place, sample) in samples.iter().enumerate() {
            if places.contains(&place) {
                snapshots.push((place, stored(&estimator)));
            }
            said.push(estimator.take(sample));
        }
        Self { said, snapshots, end: stored(&estimator) }
    }
}

/// Checks that an estimator restored at each place goes on as the uninterrupted one; returns the size of its largest
/// snapshot, bytes.
fn sleep<E: Sleeper>(name: &str, estimator: E, samples: &[Sample], seed: u64) -> usize {
    let awake = Awake::over(estimator, samples, &places(seed, samples.len()));
    assert_eq!(awake.snapshots.len(), CUTS);
    let distinct: std::collections::BTreeSet<_> = awake.said.iter().collect();
    assert!(distinct.len() > samples.len() / 100, "{name}: something is estimated");
    for (number, (place, snapshot)) in awake.snapshots.iter().enumerate() {
        let mut woken: E =
            load(snapshot).unwrap_or_else(|error| panic!("{name} at {place}: {error}"));
        let next = awake.snapshots.get(number + 1).filter(|_| number % FOLLOWED != 0);
        let (until, then) =
            next.map_or((samples.len(), &awake.end), |(until, then)| (*until, then));
        for (index, sample) in samples.iter().enumerate().take(until).skip(*place) {
            let said = woken.take(sample);
            assert_eq!(
                said, awake.said[index],
                "{name}: slept before {place}, other after {index}"
            );
        }
        assert_eq!(stored(&woken), *then, "{name}: slept before {place}");
    }
    let sizes = awake.snapshots.iter().map(|(_, bytes)| bytes.len());
    sizes.chain([awake.end.len()]).max().unwrap_or(0)
}

struct Sleeps;

impl Visit for Sleeps {
    fn visit<E: Sleeper>(&mut self, kind: &Kind, estimator: E, samples: &[Sample]) {
        let name = format!("{} in {}", E::NAME, E::number());
        let bytes = sleep(&name, estimator, samples, kind.seed);
        println!("{name}: {bytes} bytes, {} of {} samples", size_of::<E>(), samples.len());
    }
}

#[test]
fn what_slept_goes_on_to_the_bit() {
    streams::visit_all(&mut Sleeps);
}

/// The same estimator with a changed layout.
#[derive(serde::Serialize, serde::Deserialize)]
struct Newer<E>(E);

impl<E: Layout> Layout for Newer<E> {
    const NAME: &'static str = E::NAME;
    const VERSION: u16 = E::VERSION + 1;

    fn number() -> kestirim_snapshot::Number {
        E::number()
    }

    fn sizes() -> [u32; 4] {
        E::sizes()
    }
}

struct Refuses;

impl Visit for Refuses {
    fn visit<E: Sleeper>(&mut self, _: &Kind, estimator: E, _: &[Sample]) {
        let bytes = stored(&estimator);
        let error =
            load::<Newer<E>>(&bytes).err().map(|error| Box::<dyn Error>::from(error).to_string());
        let (name, number, sizes) = (E::NAME, E::number(), E::sizes());
        let of = |version| format!("{name} layout {version} in {number}, sizes {sizes:?}");
        let both = format!("a snapshot of {}, expected {}", of(E::VERSION), of(E::VERSION + 1));
        assert_eq!(error, Some(both));
    }
}

#[test]
fn old_layouts_are_refused_by_name() {
    streams::visit_all(&mut Refuses);
}
