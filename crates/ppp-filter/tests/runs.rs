//! Runs of broken epochs among good ones: whatever comes, every solution is finite, and ten good epochs later the
//! place is known again as well as the filter says. `PROPTEST_CASES` sets the number of sequences.

mod sky;

use kestirim_gnss_ppp::Receiver;
use kestirim_ppp_filter::{
    Config, Estimator, Motion, PppFilter, SatelliteObservation, Solution, states,
};
use proptest::prelude::*;
use sky::{START, marker, observe, spoil};
use std::sync::LazyLock;

const N: usize = states(20);
const COUNT: usize = 130;

/// What is wrong with a run of epochs.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Zero,
    /// All codes and phases repeat themselves, or those of one satellite.
    Stuck,
    StuckSatellite(u8),
    StuckCodes,
    /// Every code is this (m), and every phase.
    Constant(f64),
    Alternating(f64),
    /// Each satellite's own, anew each time (m).
    Noise(f64),
    CodeNoise(f64),
    /// Steps of one satellite (m).
    Step(u8, f64, f64),
    /// All phases slip by amounts of their own.
    Slips,
    /// A receiver's clock off by this (m).
    ReceiverClock(f64),
    Swapped,
    NotFinite,
    Missing,
    /// Fewer than four satellites.
    Few,
    Repeated,
    Reordered(usize),
    /// Time stamps that are off (s), throughout or in the first epoch only.
    Clock(f64),
    WrongTime(f64),
    LockLost,
}

#[derive(Clone, Copy, Debug)]
struct Run {
    fault: Fault,
    begin: usize,
    length: usize,
}

fn any_run(begin: std::ops::Range<usize>, length: usize) -> impl Strategy<Value = Run> {
    let fault = prop_oneof![
        Just(Fault::Zero),
        Just(Fault::Stuck),
        (1_u8..33).prop_map(Fault::StuckSatellite),
        Just(Fault::StuckCodes),
        prop_oneof![1e6..4e7, Just(-1e9), Just(1e12)].prop_map(Fault::Constant),
        (1.0..1e6).prop_map(Fault::Alternating),
        prop_oneof![0.1..100.0, 100.0..1e7].prop_map(Fault::Noise),
        prop_oneof![0.1..100.0, 100.0..1e7].prop_map(Fault::CodeNoise),
        (1_u8..33, -1e4..1e4, -1e3..1e3).prop_map(|(s, code, phase)| Fault::Step(s, code, phase)),
        Just(Fault::Slips),
        (-1e7..1e7).prop_map(Fault::ReceiverClock),
        Just(Fault::Swapped),
        Just(Fault::NotFinite),
        Just(Fault::Missing),
        Just(Fault::Few),
        Just(Fault::Repeated),
        (2_usize..6).prop_map(Fault::Reordered),
        prop_oneof![-100.0..100.0, -1e4..1e4].prop_map(Fault::Clock),
        prop_oneof![-100.0..100.0, -1e4..1e4].prop_map(Fault::WrongTime),
        Just(Fault::LockLost),
    ];
    (fault, begin, 1..=length).prop_map(|(fault, begin, length)| Run { fault, begin, length })
}

type Epoch = (f64, Vec<SatelliteObservation<'static>>);

/// An hour and five minutes, and its epochs half a minute apart.
static SKY: LazyLock<Vec<Epoch>> = LazyLock::new(|| {
    (0..COUNT).map(|k| 30.0 * k as f64).map(|at| (at, observe(at, &marker()))).collect()
});

/// From −1 to 1.
fn noisy(index: usize) -> f64 {
    (index as f64 * 12.9898).sin()
}

fn broken(epochs: &mut [Epoch], run: &Run) {
    let end = (run.begin + run.length).min(epochs.len());
    let part = &mut epochs[run.begin..end];
    let Some(first) = part.first().cloned() else { return };
    let before = |satellite: u8| first.1.iter().find(|it| it.satellite == satellite);
    for (k, (time, observations)) in part.iter_mut().enumerate() {
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        let satellites: Vec<u8> = observations.iter().map(|it| it.satellite).collect();
        match run.fault {
            Fault::Repeated => *time = first.0,
            Fault::Clock(by) => *time += by,
            Fault::WrongTime(by) if k == 0 => *time += by,
            Fault::Missing => observations.clear(),
            Fault::Few => observations.truncate(k % 4),
            Fault::Step(satellite, code, phase) => spoil(observations, satellite, code, phase),
            Fault::Noise(size) => {
                for (index, satellite) in satellites.into_iter().enumerate() {
                    let at = 97 * k + 3 * index;
                    spoil(observations, satellite, size * noisy(at), size * noisy(at + 1));
                }
            }
            Fault::CodeNoise(size) => {
                for (index, satellite) in satellites.into_iter().enumerate() {
                    spoil(observations, satellite, size * noisy(97 * k + 3 * index), 0.0);
                }
            }
            Fault::Slips => {
                for (index, satellite) in satellites.into_iter().enumerate() {
                    spoil(observations, satellite, 0.0, 100.0 * noisy(97 * k + 3 * index));
                }
            }
            Fault::ReceiverClock(by) => {
                for satellite in satellites {
                    spoil(observations, satellite, by, by);
                }
            }
            _ => {}
        }
        for it in observations {
            let known = before(it.satellite);
            match run.fault {
                Fault::Zero => (it.code, it.phase) = ([0.0; 2], [0.0; 2]),
                Fault::StuckCodes => it.code = known.map_or(it.code, |known| known.code),
                Fault::StuckSatellite(satellite) if it.satellite != satellite => {}
                Fault::Stuck | Fault::StuckSatellite(_) => {
                    let same = known.map(|known| (known.code, known.phase));
                    (it.code, it.phase) = same.unwrap_or((it.code, it.phase));
                }
                Fault::Constant(value) => (it.code, it.phase) = ([value; 2], [value; 2]),
                Fault::Alternating(by) => it.code = it.code.map(|code| code + by * sign),
                Fault::Swapped => {
                    it.code.swap(0, 1);
                    it.phase.swap(0, 1);
                }
                Fault::NotFinite => it.phase[k % 2] = f64::NAN,
                Fault::LockLost => it.lock_lost = true,
                _ => {}
            }
        }
    }
    if let Fault::Reordered(block) = run.fault {
        part.chunks_mut(block).for_each(<[_]>::reverse);
    }
}

fn step(filter: &mut PppFilter<N>, epoch: &Epoch) -> Option<Solution<N>> {
    let solution = filter.process(START.plus(epoch.0), &Receiver::default(), &epoch.1).ok()?;
    let finite = solution.position.iter().chain(solution.covariance.iter()).all(|x| x.is_finite())
        && solution.deviations_enu().iter().all(|x| x.is_finite() && *x > 0.0)
        && solution.clock.is_finite()
        && solution.wet_delay.is_finite();
    assert!(finite, "{} s: {solution:?}", epoch.0);
    Some(solution)
}

fn take_all(filter: &mut PppFilter<N>, epochs: &[Epoch]) {
    for epoch in epochs {
        let _ = step(filter, epoch);
    }
}

fn filters() -> [(&'static str, PppFilter<N>); 4] {
    let moving = |process_noise| Motion::Kinematic { process_noise };
    let plain = |motion| Config { estimator: Estimator::plain(), ..Config::new(motion) };
    [
        ("static", Config::new(Motion::Static)),
        ("kinematic", Config::new(moving(1.0))),
        ("plain static", plain(Motion::Static)),
        ("plain kinematic", plain(moving(1.0))),
    ]
    .map(|(name, config)| (name, PppFilter::new(config)))
}

fn recovers(run: &Run) {
    let mut epochs = SKY[..run.begin + run.length + 14].to_vec();
    broken(&mut epochs, run);
    for (name, mut filter) in filters() {
        if name.starts_with("plain") {
            // They take everything in, and what they make of it is what they are compared for.
            take_all(&mut filter, &epochs);
            continue;
        }
        for (k, epoch) in epochs.iter().enumerate() {
            let solution = step(&mut filter, epoch);
            if k >= run.begin + run.length + 10 {
                let solution = solution.unwrap_or_else(|| panic!("{name}: none at {k}"));
                let error = (solution.position - marker()).norm();
                let sigma = solution.covariance.trace().sqrt();
                assert!(error < 6.0 * sigma + 0.05, "{name}: {error} m off, {sigma} at {k}");
            }
        }
    }
}

fn cases(short: u32) -> ProptestConfig {
    let mut config = ProptestConfig { failure_persistence: None, ..ProptestConfig::default() };
    if std::env::var_os("PROPTEST_CASES").is_none() {
        config.cases = short;
    }
    config
}

proptest! {
    #![proptest_config(cases(16))]

    #[test]
    fn every_solution_is_finite(
        runs in proptest::collection::vec(any_run(0..100, 100), 1..5)
    ) {
        let mut epochs = SKY.clone();
        for run in &runs {
            broken(&mut epochs, run);
        }
        for (_, mut filter) in filters() {
            take_all(&mut filter, &epochs);
        }
    }

    #[test]
    fn the_place_is_known_again(run in any_run(0..80, 20)) {
        recovers(&run);
    }
}
