//! A synthetic sky: the observations of a receiver at a known position over a day, and the products of that day.
//!
//! `constellation` has the orbits, `clocks` the clocks of the satellites and of the receiver, `products` what a service
//! publishes of both at the `times` of a day, `atmosphere` the signal delays, `noise` and `faults` the disturbances;
//! `receiver` assembles the observations.
//!
//! The observations come from an independent forward model: Keplerian orbits, the light path in the inertial frame,
//! relativity by the eccentric anomaly. It shares with the filter's model the formulas of the solid tide, the wind-up
//! with nominal yaw, Shapiro's delay, and the hydrostatic zenith delay and mapping of a standard atmosphere: a mistake
//! in those would not show here, only on recorded data. The filter does not model the weather, horizontal gradients,
//! the errors of the products, or multipath. Antennas are points, and there is no ocean loading.

mod atmosphere;
mod clocks;
mod constellation;
mod faults;
mod noise;
mod products;
mod receiver;
mod times;
pub mod trial;

use kestirim_replay::gnss::{Epoch, Products};
use nalgebra::Vector3;

pub use self::faults::Rates;
use self::products::Services;
use self::receiver::Station;
pub use self::times::{EPOCHS, INTERVAL_S, MIDNIGHT, UTC_MINUS_GPS};
use crate::random::stream;

/// The number of random streams of a day: faults have their own, so that the same day exists without them.
const STREAMS: u64 = 2;

/// The simulated day of a station.
#[derive(Debug)]
pub struct Day {
    /// The true position of the marker, ECEF, m.
    pub marker: Vector3<f64>,
    /// The observations of the receiver.
    pub epochs: Vec<Epoch>,
    /// The products of the satellites.
    pub products: Products,
}

impl Day {
    /// Draws station-day number `index` of an experiment, with its own position, sky and weather.
    pub fn new(seed: u64, index: u64, faults: &Rates) -> Self {
        let mut rng = stream(seed, STREAMS * index);
        let services = Services::draw(&mut rng);
        let mut station = Station::draw(&mut rng);
        let mut epochs: Vec<_> =
            (0..EPOCHS).map(|epoch| station.observe(&services, epoch, &mut rng)).collect();
        faults::disturb(&mut epochs, faults, &mut stream(seed, STREAMS * index + 1));
        Self { marker: station.marker(), epochs, products: services.products() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kestirim_gnss_ppp::{Arc, Carriers, SlipLimits};

    #[test]
    fn the_same_day_again_and_faults_beside_it() {
        let day = Day::new(1, 2, &Rates::RECORDING);
        assert_eq!(day.epochs, Day::new(1, 2, &Rates::RECORDING).epochs);
        assert_ne!(day.epochs, Day::new(1, 3, &Rates::RECORDING).epochs);
        let clean = Day::new(1, 2, &Rates::NONE);
        let pairs = || {
            day.epochs
                .iter()
                .zip(&clean.epochs)
                .flat_map(|(a, b)| a.satellites.iter().zip(&b.satellites))
        };
        let share =
            pairs().filter(|(a, b)| a.code != b.code).count() as f64 / pairs().count() as f64;
        assert!((0.018..0.035).contains(&share), "{share}");
        assert!(pairs().all(|(a, b)| a.prn == b.prn));
    }

    /// Eight satellites or more, at most as many as a filter has room for; codes of the two carriers differ by the
    /// ionosphere.
    #[test]
    fn a_sky_as_gps_has_it() {
        for index in 0..4 {
            let day = Day::new(5, index, &Rates::NONE);
            let counts = || day.epochs.iter().map(|epoch| epoch.satellites.len());
            assert_eq!(day.epochs.len(), EPOCHS as usize);
            assert!(counts().min() > Some(4) && counts().max() < Some(16));
            let mean = counts().sum::<usize>() as f64 / f64::from(EPOCHS);
            assert!((8.0..12.0).contains(&mean), "{mean}");
            for observed in day.epochs.iter().flat_map(|epoch| &epoch.satellites) {
                let [Some(first), Some(second)] = observed.code else { panic!("{observed:?}") };
                assert!((-5.0..40.0).contains(&(second - first)), "{observed:?}");
            }
        }
    }

    /// A calm ionosphere would be too kind to the detectors, a wild one would make every epoch a slip.
    #[test]
    fn the_ionosphere_is_not_taken_for_slips() {
        let day = Day::new(7, 0, &Rates::NONE);
        let mut arcs: [Option<Arc>; 33] = [None; 33];
        let (mut slips, mut largest, mut count) = (0, 0.0_f64, 0);
        let mut last = [0.0; 33];
        for epoch in &day.epochs {
            for observed in &epoch.satellites {
                let [Some(p1), Some(p2)] = observed.code else { continue };
                let [Some(l1), Some(l2)] = observed.phase else { continue };
                let place = usize::from(observed.prn);
                let (phase, code) = ([l1, l2], [p1, p2]);
                match &mut arcs[place] {
                    None => arcs[place] = Some(Arc::begin(epoch.time, Carriers::L1L2, phase, code)),
                    Some(arc) => {
                        let slip =
                            arc.observe(epoch.time, phase, code, false, &SlipLimits::default());
                        slips += usize::from(slip.is_some());
                        if slip.is_none() {
                            largest = largest
                                .max((Carriers::L1L2.geometry_free(phase) - last[place]).abs());
                        }
                        count += 1;
                    }
                }
                last[place] = Carriers::L1L2.geometry_free(phase);
            }
        }
        // Each satellite rises once or twice a day; low elevation may split an arc.
        assert!(slips < count / 100, "{slips} of {count}");
        // Above 5 cm only where a satellite's own jumps were as large.
        assert!((0.005..0.1).contains(&largest), "{largest}");
    }
}
