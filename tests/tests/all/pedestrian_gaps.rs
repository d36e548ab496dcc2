//! Recorded walks with samples removed or replaced by repeated ones: how far the path deviates, and whether its
//! standard deviation covers that.

use host_sim::metrics::median;
use host_sim::systems::pedestrian::recording::log;
use kestirim_replay::pedestrian::{Options, Sample, SensorClass, Walk, walk};
use kestirim_tests::recordings::{self, GCP, gcp};

/// The number of places in a walk at which samples are removed.
const PLACES: u64 = 6;

/// Tracks a walk causally without the samples of a stretch of time, µs.
fn without(samples: &[Sample], from_us: u64, length_us: u64) -> Walk {
    let is_kept = |time_us: u64| time_us <= from_us || time_us >= from_us + length_us;
    let kept: Vec<_> = samples.iter().filter(|it| is_kept(it.time_us)).copied().collect();
    walk(&kept, &industrial()).expect("a walk")
}

/// Tracks a walk causally with one sample repeated over a stretch of time, as of a sensor that is not read anew.
fn stalled(samples: &[Sample], from_us: u64, length_us: u64) -> Walk {
    let last = samples.partition_point(|it| it.time_us <= from_us).saturating_sub(1);
    let is_stalled = |time_us: u64| time_us > from_us && time_us < from_us + length_us;
    let read = |it: &Sample| {
        let measured = if is_stalled(it.time_us) { samples[last] } else { *it };
        Sample { time_us: it.time_us, ..measured }
    };
    let read: Vec<_> = samples.iter().map(read).collect();
    walk(&read, &industrial()).expect("a walk")
}

fn industrial() -> Options {
    Options { sensor: SensorClass::Industrial, causal: true, ..Options::default() }
}

/// The distance of the footprints after a time from those of the whole walk, m, and that over their standard
/// deviations; root mean squares.
fn astray(whole: &Walk, walk: &Walk, after_us: u64) -> Option<[f64; 2]> {
    let (mut squares, mut ratios, mut count) = (0.0, 0.0, 0.0);
    for stride in walk.strides.iter().filter(|it| it.time_us > after_us) {
        let nearest = whole.strides.iter().min_by_key(|it| it.time_us.abs_diff(stride.time_us))?;
        let by = |axis: usize| stride.position[axis] - nearest.position[axis];
        let square = by(0).powi(2) + by(1).powi(2);
        squares += square;
        ratios += square / (stride.sigma_m[0].powi(2) + stride.sigma_m[1].powi(2));
        count += 1.0;
    }
    (count > 0.0).then(|| [squares, ratios].map(|sum: f64| (sum / count).sqrt()))
}

/// Applies a fault of each length, µs, at some places of eight walks; returns the errors, m, and the errors over σ.
fn spoilt(
    spoil: impl Fn(&[Sample], u64, u64) -> Walk,
    lengths_us: &[u64],
    mut judge: impl FnMut(u64, &Walk),
) -> Option<Vec<Vec<[f64; 2]>>> {
    let walks = gcp(&recordings::folder()?, &GCP).into_iter().map(|(file, _)| {
        let samples = log::read(&file, &log::Options::default()).expect("a log").samples;
        (walk(&samples, &industrial()).expect("a walk"), samples)
    });
    let walks: Vec<_> = walks.collect();
    println!("| for, s | off, m: median | worst | over σ: median | beyond 3 σ |");
    let of_length = |&length_us: &u64| {
        let mut all = Vec::new();
        for (whole, samples) in &walks {
            let [begin, end] = [0, samples.len() - 1].map(|at| samples[at].time_us);
            for place in 0..PLACES {
                let from_us = begin + (end - begin) * (3 + place) / (4 + PLACES) + 137_000 * place;
                let walk = spoil(samples, from_us, length_us);
                judge(length_us, &walk);
                all.extend(astray(whole, &walk, from_us + length_us));
            }
        }
        let [off, ratios] = [0, 1].map(|of| all.iter().map(|it| it[of]).collect::<Vec<_>>());
        println!(
            "| {:.2} | {:.2} | {:.1} | {:.2} | {} of {} |",
            1e-6 * length_us as f64,
            median(&off),
            off.iter().copied().fold(0.0, f64::max),
            median(&ratios),
            beyond(&all),
            ratios.len()
        );
        all
    };
    Some(lengths_us.iter().map(of_length).collect())
}

/// The number of results beyond three standard deviations.
fn beyond(all: &[[f64; 2]]) -> usize {
    all.iter().filter(|[_, ratio]| *ratio > 3.0).count()
}

#[test]
fn where_samples_are_missing_standard_deviations_have_what_was_not_seen() {
    let lengths_us = [50_000, 100_000, 200_000, 500_000, 1_000_000];
    let judge = |length_us: u64, walk: &Walk| {
        let is_told = walk.warnings.iter().any(|it| it.contains("samples are missing"));
        assert!(is_told, "{length_us} µs: {:?}", walk.warnings);
    };
    let Some(spoilt) = spoilt(without, &lengths_us, judge) else { return };
    assert!(spoilt.iter().all(|all| beyond(all) <= 1));
}

#[test]
fn where_a_sensor_is_not_read_anew_standard_deviations_have_it_too() {
    let Some(spoilt) = spoilt(stalled, &[50_000, 100_000, 150_000, 200_000], |_, _| ()) else {
        return;
    };
    assert!(spoilt.iter().all(|all| beyond(all) <= 1));
}
