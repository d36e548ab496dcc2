//! Comparison of a filter whose choices are types with one that has them at run time.

use crate::sky::{START, marker, observe, spoil};
use kestirim_gnss_ppp::Receiver;
use kestirim_ppp_filter::{Config, Estimator, Lean, Motion, PppFilter, states};

const N: usize = states(20);

#[test]
fn a_lean_filter_is_the_one_at_rest_to_the_bit() {
    let config = Config::new(Motion::Static);
    let mut chosen = PppFilter::<N>::new(config);
    let mut lean = PppFilter::<N, Lean>::new(config.with_estimator(Estimator::at_rest()));
    assert!(size_of_val(&lean) < size_of_val(&chosen));
    let mut treated = 0;
    for epoch in 0..40 {
        let seconds = 30.0 * f64::from(epoch);
        let mut observations = observe(seconds, &marker());
        if epoch % 4 == 3 {
            let satellite = observations[epoch as usize % observations.len()].satellite;
            spoil(&mut observations, satellite, 12.0, 0.3);
        }
        let time = START.plus(seconds);
        let receiver = Receiver::default();
        let expected = chosen.process(time, &receiver, &observations).expect("a solution");
        assert_eq!(lean.process(time, &receiver, &observations).as_ref(), Ok(&expected));
        treated += expected.satellites.iter().filter(|it| it.code.was_treated()).count();
    }
    assert!(treated > 5, "{treated} codes that were wrong were found");
}
