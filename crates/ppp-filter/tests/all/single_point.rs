//! Tests of single-epoch positions from codes.

use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{
    Carriers, FREQUENCY, Geodetic, Klobuchar, Pattern, Receiver, SatelliteState, Site,
};
use kestirim_ppp_filter::{
    CodeObservation, Config, Error, Health, Motion, Solution, single_point, states,
};

const NOON: f64 = 0.0;
const IONOSPHERE: Klobuchar = Klobuchar {
    alpha: [4.6566e-9, 1.4901e-8, -5.9605e-8, -1.1921e-7],
    beta: [8.192e4, 9.8304e4, -6.5536e4, -5.2429e5],
};
/// By how much satellite clocks are ahead of that of L1 alone, s.
const GROUP_DELAY: f64 = -1.1e-8;

/// The codes of all satellites; if `alone`, only of L1, with the ionosphere in them.
fn codes(alone: bool) -> Vec<CodeObservation<'static>> {
    let place = Geodetic::from_ecef(&crate::sky::marker());
    let site = Site::new(&Receiver::default(), &crate::sky::marker(), crate::sky::START);
    let of = |it: &kestirim_ppp_filter::SatelliteObservation<'_>| {
        let expected = site.expect(&it.state, it.carriers, None, None)?;
        let delay = IONOSPHERE.delay(&place, &expected.direction, crate::sky::START);
        let [first, second] = it.code;
        let ratio = (FREQUENCY[0] / FREQUENCY[1]).powi(2);
        // The clock is that of the combination, which the group delay does not change.
        let group = SPEED_OF_LIGHT * GROUP_DELAY;
        Some(CodeObservation {
            satellite: it.satellite,
            carriers: it.carriers,
            code: [
                Some(first + delay + group),
                (!alone).then_some(second + ratio * (delay + group)),
            ],
            group_delay: GROUP_DELAY,
            state: it.state,
            antenna: None,
        })
    };
    crate::sky::observe(NOON, &crate::sky::marker()).iter().filter_map(of).collect()
}

fn solve(codes: &[CodeObservation<'_>]) -> Result<Solution<{ states(32) }>, Error> {
    let config = Config::new(Motion::Static);
    single_point(crate::sky::START, &Receiver::default(), codes, Some(&IONOSPHERE), &config)
}

#[test]
fn codes_without_noise_lead_to_the_marker() {
    for alone in [false, true] {
        let solution = solve(&codes(alone)).expect("a position");
        // The wet delay is that of another climate.
        assert!((solution.position - crate::sky::marker()).norm() < 0.5, "{}", solution.position);
        assert_eq!(solution.health, Health::Converging);
        let [east, north, up] = solution.deviations_enu();
        assert!(east > 0.2 && north > 0.2 && up > 0.4 && up < 10.0);
    }
}

#[test]
fn an_outlier_and_a_satellite_told_twice_do_no_harm() {
    let clean = codes(false);
    let expected = solve(&clean).expect("a position");
    let mut spoilt = clean.clone();
    let high = expected.satellites[2].satellite;
    for it in spoilt.iter_mut().filter(|it| it.satellite == high) {
        it.code = it.code.map(|code| Some(code? + 60.0));
    }
    spoilt.push(CodeObservation { code: [Some(2e7); 2], ..clean[0] });
    let solution = solve(&spoilt).expect("a position");
    assert!((solution.position - expected.position).norm() < 1.0);
    assert_eq!(solution.satellites.len(), expected.satellites.len());
    assert!(solution.satellites[2].code.weight < 0.01);
}

#[test]
fn a_worse_accuracy_is_told() {
    let good = solve(&codes(false)).expect("a position");
    let worse: Vec<_> = (codes(false).into_iter())
        .map(|it| CodeObservation { state: SatelliteState { accuracy: 8.0, ..it.state }, ..it })
        .collect();
    let worse = solve(&worse).expect("a position");
    assert!(worse.covariance.trace() > 10.0 * good.covariance.trace());
}

#[test]
fn antennas_of_satellites_count() {
    let without = solve(&codes(false)).expect("a position");
    // The antenna is two metres from the centre of mass towards the Earth.
    let pattern = Pattern {
        offset: [0.0, 0.0, 2.0],
        first: 0.0,
        step: 1.0,
        mean: &[0.0; 2],
        azimuth_step: 0.0,
        by_azimuth: &[],
    };
    let with: Vec<_> = (codes(false).into_iter())
        .map(|it| CodeObservation { antenna: Some([pattern; 2]), ..it })
        .collect();
    let with = solve(&with).expect("a position");
    // All ranges are shorter by nearly as much, which appears in the clock.
    assert!((with.clock - without.clock - 2.0).abs() < 0.5, "{} {}", with.clock, without.clock);
}

#[test]
fn too_few_are_refused() {
    let codes = codes(true);
    assert_eq!(solve(&codes[..3]).err(), Some(Error::TooFewSatellites));
    let nothing: Vec<_> =
        codes.iter().map(|it| CodeObservation { code: [None, it.code[0]], ..*it }).collect();
    assert_eq!(solve(&nothing).err(), Some(Error::TooFewSatellites));
}

/// A third of the satellites are of GLONASS, and a third of BeiDou.
#[test]
fn each_system_has_a_clock_of_its_own() {
    let mut codes = codes(false);
    let mut others = 0;
    for it in &mut codes {
        let (carriers, clock) = match it.satellite % 3 {
            0 => continue,
            1 => (Carriers::G1G2 { channel: 3 }, -400.0),
            _ => (Carriers::B1B3, 700.0),
        };
        others += 1;
        it.carriers = carriers;
        let range = Carriers::L1L2.ionosphere_free(it.code.map(|code| code.expect("both")));
        it.code = [Some(range + clock); 2];
    }
    let solution = solve(&codes).expect("a position");
    assert!(others > 4 && (solution.position - crate::sky::marker()).norm() < 1.5);
    // Three coordinates and three clocks need more than six satellites above the mask for a check.
    codes.retain(|it| solution.satellites.iter().any(|report| report.satellite == it.satellite));
    let few = codes.get(..6).expect("six satellites");
    let few = solve(few).expect("a position");
    assert_eq!(few.health, Health::Unchecked);
    let fewer = codes.get(..5).expect("five satellites");
    assert_eq!(solve(fewer).err(), Some(Error::TooFewSatellites));
}

/// Unexpected noise enlarges σ, and codes that contradict each other cause a contradiction.
#[test]
fn codes_that_do_not_fit_are_told() {
    let clean = solve(&codes(false)).expect("a position");
    let spoilt = |by: f64, is: fn(usize) -> bool| {
        let mut codes = codes(false);
        for (index, it) in codes.iter_mut().enumerate().filter(|(index, _)| is(*index)) {
            let by = if index % 4 < 2 { by } else { -by };
            it.code = it.code.map(|code| Some(code? + by));
        }
        solve(&codes).expect("a position")
    };
    let noisy = spoilt(4.0, |_| true);
    assert!(noisy.covariance.trace() > 2.0 * clean.covariance.trace());
    assert_eq!(noisy.health, Health::Converging);
    let wrong = spoilt(60.0, |index| index % 2 == 0);
    assert!(matches!(wrong.health, Health::Contradicted(_)), "{:?}", wrong.health);
}
