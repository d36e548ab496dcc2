//! Calls everything of `kestirim-ppp-filter`.

use core::fmt::Debug;

use kestirim_gnss_message::{beidou, galileo, gps, ssr};
use kestirim_gnss_ppp::{
    Carriers, Corrections, GpsTime, Klobuchar, OceanLoading, Pattern, Receiver, SatelliteState,
    SlipLimits,
};
use kestirim_kalman::{Covariance, Gaussian};
use kestirim_ppp_filter::{
    AmbiguityFixer, Broadcast, CodeObservation, Config, Corrected, Deviation, Error, Estimator,
    Health, MessagePart, Motion, PhaseBias, PppFilter, SatelliteObservation, Solution, Timed,
    Weighting, corrected, single_point, states,
};
use kestirim_robust_kalman::{Decision, Measurement};

use super::values::{
    any, call_each, keep, matrix, maybe, number, numbers, one_of, rounds, slice, try_on, whole,
    yes_or_no,
};

fn motion() -> Motion {
    one_of([Motion::Static, Motion::Kinematic { process_noise: number() }])
}

fn estimators() {
    keep(Estimator::plain());
    keep(Estimator::igg3());
    keep(Estimator::t_test());
    keep(Estimator::iterative_igg3());
    keep(Estimator::adaptive());
    keep(Estimator::guarded(motion()));
    keep(Config::broadcast(motion()));
    keep(Estimator::at_rest());
    keep(states(whole()));
    keep::<Error>(From::from(any(kestirim_kalman::Error::NotFinite)));
    keep::<Error>(From::from(any(kestirim_robust_kalman::Error::InvalidBlock)));
}

fn weighting() {
    let mut estimate =
        any(Gaussian::<f64, 9>::new(matrix(), Covariance::from_variances(&numbers())));
    let row = any([(whole(), number()); 4]);
    let measurement = Measurement { row: slice(&row), innovation: number(), variance: number() };
    let measurements = any([measurement; 4]);
    let mut decisions = any([Decision::NONE; 4]);
    let robust = any(Estimator::at_rest().robust);
    keep(Weighting::update(&robust, &mut estimate, slice(&measurements), &mut decisions));
}

/// An arbitrary configuration.
fn config() -> Config {
    let deviation = || any(Deviation { zenith: number(), slant: number() });
    any(Config {
        elevation_mask: number(),
        phase: deviation(),
        code: deviation(),
        clock_walk: number(),
        wet_delay: number(),
        wet_delay_walk: number(),
        gradient: number(),
        slips: any(SlipLimits::default()),
        correlation_time: number(),
        estimator: any(Estimator::guarded(motion())),
        ..Config::new(motion())
    })
}

fn filters<const N: usize, R: Weighting + Debug>(estimator: fn() -> Estimator<R>) {
    let (mean, by_azimuth) = (numbers::<f64, 4>(), numbers::<f64, 4>());
    let (mean, by_azimuth) = (slice(&mean), slice(&by_azimuth));
    let (offset, first, step) = (numbers(), number(), number());
    let pattern = Pattern { offset, first, step, mean, azimuth_step: number(), by_azimuth };
    let antenna = maybe([pattern; 2]);
    let ocean = any(OceanLoading { amplitude: [numbers(); 3], lag: [numbers(); 3] });
    let receiver = any(Receiver {
        antenna,
        galileo_antenna: antenna,
        glonass_antenna: antenna,
        beidou_antenna: antenna,
        eccentricity: numbers(),
        ocean_loading: maybe(&ocean),
        pole: maybe(numbers()),
        ut1_minus_gps: number(),
        corrections: any(Corrections::ALL),
    });
    let state = any(SatelliteState {
        position: matrix(),
        velocity: matrix(),
        clock: number(),
        clock_interval: number(),
        clock_distance: number(),
        accuracy: number(),
    });
    let (satellite, code, phase, lock_lost) = (whole(), numbers(), numbers(), yes_or_no());
    let carriers = one_of([Carriers::L1L2, Carriers::G1G2 { channel: whole() }, Carriers::B1B3]);
    let observation =
        SatelliteObservation { satellite, carriers, code, phase, lock_lost, state, antenna };
    keep(SatelliteObservation::hides_gradients(&observation));
    let observations = any([observation; 4]);
    let code = [maybe(number()), maybe(number())];
    let group_delay = number();
    let code = CodeObservation { satellite, carriers, code, group_delay, state, antenna };
    let ionosphere = Klobuchar { alpha: numbers(), beta: numbers() };
    let (codes, ionosphere) = (any([code; 5]), maybe(&ionosphere));
    let time = any(GpsTime::new(whole(), number()));
    keep(single_point::<N>(time, &receiver, slice(&codes), ionosphere, &config()));
    let config = Config::with_estimator(config(), any(estimator()));
    let mut filter = any(PppFilter::<N, R>::new(config));
    keep(PppFilter::config(&filter));
    keep(<AmbiguityFixer<N> as Default>::default());
    let mut fixer = any(AmbiguityFixer::<N>::new());
    let bias = maybe(any(PhaseBias { wide_lane: number(), ionosphere_free: number() }));
    keep(PhaseBias::absolute(carriers, numbers()));
    for _ in 0..rounds() {
        let time = any(GpsTime::new(whole(), number()));
        try_on(&mut filter, |filter| {
            let solution = any(PppFilter::process(filter, time, &receiver, slice(&observations))?);
            keep(Solution::deviations_enu(&solution));
            keep(AmbiguityFixer::fix(&mut fixer, filter, &solution, slice(&observations), |_| {
                bias
            }));
            let back = PppFilter::process_backwards(filter, time, &receiver, slice(&observations));
            keep(any(back)?.position);
            keep(Health::in_short(solution.health));
            Ok::<_, Error>(())
        });
    }
}

fn broadcast<const N: usize>() {
    keep(<Broadcast<N> as Default>::default());
    let mut broadcast = any(Broadcast::<N>::new());
    keep(<Corrected<N> as Default>::default());
    let mut corrected = any(Corrected::<N>::new());
    for _ in 0..rounds() {
        let [mut words, mut other]: [[u32; 10]; 2] = [[whole(); 10], [whole(); 10]];
        words[0] = 0x8b << 22;
        other[0] = 0b111_0001_0010 << 19;
        let parts = [
            gps::Subframe::from_words(&any(words)).map(MessagePart::Gps),
            beidou::Subframe::from_words(&any(other)).map(MessagePart::BeiDou),
            galileo::Word::from_page(&any([whole(); 8])).map(MessagePart::Galileo),
        ];
        let time = any(GpsTime::new(whole(), number()));
        if let Some(part) = one_of(parts) {
            keep(Broadcast::take(&mut broadcast, one_of([1, 2, 3, 4, 5]), part, time));
        }
        let carriers = one_of([Carriers::L1L2, Carriers::E1E5a, Carriers::B1B3]);
        keep(Broadcast::state(&broadcast, one_of([1, 2, 3, 4, 5]), carriers, time, number()));
        keep(Broadcast::ionosphere(&broadcast));
        take_corrections(&mut corrected, &broadcast, time);
    }
}

fn take_corrections<const N: usize>(
    collected: &mut Corrected<N>,
    broadcast: &Broadcast<N>,
    time: GpsTime,
) {
    let mut bytes: [u8; 64] = any([(); 64].map(|()| whole()));
    // Messages 1060 and 1243.
    [bytes[0], bytes[1]] = one_of([[0x42, 0x40], [0x4d, 0xb0]]);
    let Some(message) = ssr::Message::from_data(slice(&bytes)) else { return };
    Corrected::take(collected, &message, |it| (it < 6).then_some(it), broadcast, time);
    keep(Corrected::state(collected, one_of([1, 2, 3, 4, 5]), broadcast, time, number()));
    let (mut orbits, mut clocks) = (None, None);
    for (_, correction) in message.corrections() {
        match correction {
            ssr::Correction::Orbit(orbit) => orbits = Some(orbit),
            ssr::Correction::Clock(clock) => clocks = Some(clock),
            ssr::Correction::Code { .. } => {}
        }
    }
    if let (Some(orbit), Some(clock)) = (orbits, clocks) {
        let orbit = Timed::new(time, &message.header, orbit);
        let clock = Timed::new(time, &message.header, clock);
        keep(Timed::since(&orbit));
        keep(Timed::serves_at(&clock, time));
        if let Ok(ephemeris) = any(Broadcast::newest(broadcast, one_of([1, 2, 3, 4, 5]))) {
            keep(corrected(&ephemeris, &orbit, &clock, time));
        }
    }
}

/// Calls everything in this module.
pub fn run() {
    call_each([
        estimators,
        weighting,
        broadcast::<3>,
        broadcast::<32>,
        || filters::<{ states(10) }, _>(|| Estimator::guarded(motion())),
        || filters::<9, _>(Estimator::at_rest),
    ]);
}
