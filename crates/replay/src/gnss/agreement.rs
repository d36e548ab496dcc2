//! Whether orbits and clocks come from one solution: an orbit file has clocks of its own, which then agree with those
//! of the clock files.

use kestirim_gnss_files::{Clocks, OrbitSample, Orbits, System};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;

use crate::metrics::median;

/// The median difference above which clocks are of two solutions, m. Clocks of one solution are within 1 cm of each
/// other (a service of rapid products; others to a tenth of a millimetre), those of two are 5 cm apart.
const APART_M: f64 = 0.02;
/// The largest number of instants that are compared.
const INSTANTS: usize = 24;
/// The fewest satellites that tell a common offset.
const FEWEST: usize = 4;

/// A warning if the clocks of the clock files differ from those of the orbit files by more than an offset common to all
/// satellites of a system.
pub(super) fn doubt(orbits: &Orbits, clocks: &Clocks) -> Option<String> {
    let of = |system| Some(differences(orbits, clocks, system)).filter(|it| !it.is_empty());
    let systems = [System::Gps, System::Galileo].into_iter().filter_map(of);
    let apart = systems.map(|differences| median(&differences)).reduce(f64::max)?;
    (apart > APART_M).then(|| {
        format!(
            "orbits and clocks seem to be of two solutions: clocks in their files are {:.0} cm apart. Take both of one service",
            100.0 * apart
        )
    })
}

/// How far the clocks of the satellites in both kinds of files are apart, relative to the median over all at an
/// instant, m.
fn differences(orbits: &Orbits, clocks: &Clocks, system: System) -> Vec<f64> {
    let numbers: Vec<u8> = orbits.satellites().filter(|it| System::of(*it) == system).collect();
    let longest = numbers.iter().map(|&number| orbits.satellite(number)).max_by_key(|it| it.len());
    let instants = longest.unwrap_or_default();
    let every = instants.len().div_ceil(INSTANTS).max(1);
    let at = |instant: &OrbitSample| {
        let of = |&number: &u8| {
            let samples = orbits.satellite(number);
            let place = samples.partition_point(|sample| sample.time < instant.time);
            let sample = samples.get(place).filter(|sample| sample.time == instant.time)?;
            let [before, after] = clocks.around(number, instant.time)?;
            let is_its_own = !sample.clock_event && !sample.clock_predicted;
            (before.time == instant.time && is_its_own)
                .then_some(SPEED_OF_LIGHT * (sample.clock? - after.bias))
        };
        let all: Vec<f64> = numbers.iter().filter_map(of).collect();
        if all.len() < FEWEST {
            return Vec::new();
        }
        let common = median(&all);
        all.iter().map(|it| (it - common).abs()).collect()
    };
    instants.iter().step_by(every).flat_map(at).collect()
}
