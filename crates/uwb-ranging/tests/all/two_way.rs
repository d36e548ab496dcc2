//! Exchanges computed from a known distance and two clocks, in exact arithmetic, against the measured distance.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{
    AntennaDelay, Channel, ClockOffset, DataRate, DoubleSided, Error, METRES_PER_TICK, SingleSided,
    Ticks, Timestamp,
};
use proptest::prelude::*;

/// A clock with any start value that runs `ppm` fast.
#[derive(Clone, Copy, Debug)]
struct Clock {
    start: u64,
    ppm: f64,
}

impl Clock {
    /// The reading after a duration given in true ticks.
    fn at(self, time: f64) -> Timestamp {
        Timestamp::new(self.start + (time * (1.0 + self.ppm * 1e-6)).round() as u64)
    }
}

/// The exchange over a distance (m) with two reply times (ticks), timestamped in whole ticks.
fn exchange(a: Clock, b: Clock, distance: f64, reply1: f64, reply2: f64) -> DoubleSided {
    let flight = distance / METRES_PER_TICK;
    let arrived = 1e6 + flight;
    let answered = arrived + reply1;
    let returned = answered + flight;
    let closed = returned + reply2;
    DoubleSided::new(
        a.at(1e6),
        b.at(arrived),
        b.at(answered),
        a.at(returned),
        a.at(closed),
        b.at(closed + flight),
    )
}

fn exact_asymmetric(e: &DoubleSided) -> f64 {
    let [r1, d1, r2, d2] = [e.round1, e.reply1, e.round2, e.reply2].map(|t| i128::from(t.get()));
    (r1 * r2 - d1 * d2) as f64 / (r1 + r2 + d1 + d2) as f64 * METRES_PER_TICK
}

fn clock() -> impl Strategy<Value = Clock> {
    (0_u64..1 << 40, -20.0..20.0).prop_map(|(start, ppm)| Clock { start, ppm })
}

fn reply() -> impl Strategy<Value = f64> {
    (-3.7..-0.7).prop_map(|exponent: f64| 10_f64.powf(exponent) * 63.8976e9)
}

fn check<T: Scalar>(ours: T, exact: f64, bound: f64) -> Result<(), TestCaseError> {
    let error = (ours.to_f64() - exact).abs();
    prop_assert!(error < bound, "{ours:?} is not {exact}");
    Ok(())
}

proptest! {
    #[test]
    fn distances_are_those_of_exact_arithmetic(
        a in clock(), b in clock(), distance in -1.0..100.0, reply1 in reply(), reply2 in reply(),
    ) {
        let e = exchange(a, b, distance, reply1, reply2);
        let exact = exact_asymmetric(&e);
        // Whole ticks of 4.7 mm; each of the four has a weight of at most one half.
        prop_assert!((exact - distance).abs() < 0.012, "{exact} is not {distance}");
        check(e.asymmetric::<f64>().unwrap(), exact, 2e-7)?;
        check(e.asymmetric::<f32>().unwrap(), exact, 2e-5)?;
        check(e.asymmetric::<Q12_20>().unwrap(), exact, 3e-6)?;

        let single = SingleSided { round: e.round1, reply: e.reply1 };
        let offset = e.clock_offset().unwrap();
        let expected = ((1.0 + a.ppm * 1e-6) / (1.0 + b.ppm * 1e-6) - 1.0) * 1e6;
        // Two ticks over the length of the exchange.
        let resolution = 2e6 / (reply1 + reply2) + 1e-3;
        prop_assert!((offset.ppm::<f64>() - expected).abs() < resolution);
        let [round, reply] = [single.round, single.reply].map(|t| i128::from(t.get()));
        let exact = (((round - reply) << 40) - reply * i128::from(offset.to_bits())) as f64
            / 2_f64.powi(41) * METRES_PER_TICK;
        check(single.distance::<f64>(offset), exact, 2e-7)?;
        check(single.distance::<f32>(offset), exact, 2e-5)?;
        check(single.distance::<Q12_20>(offset), exact, 3e-6)?;
        // The offset is known to one tick over the length of the exchange.
        prop_assert!((exact - distance).abs() < 0.02, "{exact} is not {distance}");
    }

    #[test]
    fn equal_replies_suffice_for_the_symmetric_form(
        a in clock(), b in clock(), distance in -1.0..100.0, reply in 200e-6..2e-3,
    ) {
        let reply = reply * 63.8976e9;
        let e = exchange(a, b, distance, reply, reply);
        let [r1, d1, r2, d2] = [e.round1, e.reply1, e.round2, e.reply2].map(|t| t.get() as f64);
        let exact = (r1 - d1 + r2 - d2) / 4.0 * METRES_PER_TICK;
        check(e.symmetric::<f64>(), exact, 2e-7)?;
        check(e.symmetric::<f32>(), exact, 2e-5)?;
        check(e.symmetric::<Q12_20>(), exact, 3e-6)?;
        prop_assert!((exact - distance).abs() < 0.02);
    }

    #[test]
    fn any_intervals_give_a_number(r1: u64, d1: u64, r2: u64, d2: u64, offset: i32) {
        let e = DoubleSided {
            round1: Ticks::new(r1), reply1: Ticks::new(d1),
            round2: Ticks::new(r2), reply2: Ticks::new(d2),
        };
        let exact = exact_asymmetric(&e);
        let ours = e.asymmetric::<f64>().unwrap();
        prop_assert!((ours - exact).abs() <= 1e-9 * exact.abs() + 1e-6, "{ours} is not {exact}");
        prop_assert!(e.symmetric::<f32>().is_finite());
        let single = SingleSided { round: e.round1, reply: e.reply1 };
        prop_assert!(single.distance::<f32>(ClockOffset::from_bits(offset)).is_finite());
        let _ = single.distance::<Q12_20>(ClockOffset::from_bits(offset));
    }

    #[test]
    fn bytes_and_intervals_survive_the_wrap(ticks in 0_u64..1 << 40, interval in 0_u64..1 << 40) {
        let stamp = Timestamp::new(ticks);
        prop_assert_eq!(Timestamp::from_le_bytes(stamp.to_le_bytes()), stamp);
        let later = stamp.after(Ticks::new(interval));
        prop_assert_eq!(later.since(stamp).get(), interval);
    }
}

#[test]
fn nothing_measured_is_an_error() {
    let zero = Ticks::new(0);
    let empty = DoubleSided { round1: zero, reply1: zero, round2: zero, reply2: zero };
    assert_eq!(empty.asymmetric::<f32>(), Err(Error::EmptyExchange));
    assert_eq!(empty.clock_offset(), Err(Error::EmptyExchange));
    assert_eq!(ClockOffset::from_intervals(zero, zero), Err(Error::EmptyExchange));
}

#[test]
fn the_carrier_integrator_reads_as_decawaves_code_does() {
    for (channel, carrier) in [
        (Channel::One, 3494.4e6),
        (Channel::Two, 3993.6e6),
        (Channel::Three, 4492.8e6),
        (Channel::Four, 3993.6e6),
        (Channel::Five, 6489.6e6),
        (Channel::Seven, 6489.6e6),
    ] {
        for (rate, window) in [(DataRate::Kbps110, 8192.0), (DataRate::Kbps850OrMore, 1024.0)] {
            for count in [-(1 << 20), -17_000, -1, 0, 1, 12_345, (1 << 20) - 1] {
                let hertz = f64::from(count) * (998.4e6 / 2.0 / window / 131_072.0);
                let ratio = hertz * (-1.0 / carrier);
                let expected = 1.0 / (1.0 + ratio) - 1.0;
                let raw = count & 0x1F_FFFF;
                for register in [count, raw] {
                    let ours = ClockOffset::from_carrier_integrator(register, channel, rate);
                    let error = ours.ppm::<f64>() - 1e6 * expected;
                    assert!(error.abs() < 1e-4, "{channel:?} {count}: {error} ppm");
                }
            }
        }
    }
}

#[test]
fn parts_per_million_survive_the_round_trip() {
    for ppm in [-40.0, -3.25, 0.0, 1e-3, 19.5] {
        assert!((ClockOffset::from_ppm(ppm).ppm::<f64>() - ppm).abs() < 1e-5);
        assert!((ClockOffset::from_ppm(ppm as f32).ppm::<f32>() - ppm as f32).abs() < 1e-5);
    }
    assert_eq!(ClockOffset::from_ppm(f32::NAN), ClockOffset::ZERO);
    assert_eq!(ClockOffset::from_ppm(Q12_20::MIN), ClockOffset::ZERO);
    assert_eq!(ClockOffset::from_ppm(1e9_f32).to_bits(), i32::MAX);
}

#[test]
fn antenna_delays_come_back_from_the_excess_they_cause() {
    let [a, b, c] = [32_900, 32_950, 33_001].map(AntennaDelay::new);
    let found =
        AntennaDelay::of_three(a.excess::<f32>(b), a.excess::<f32>(c), b.excess::<f32>(c)).unwrap();
    assert_eq!(found, [a, b, c]);
    let found =
        AntennaDelay::of_three(a.excess::<Q12_20>(b), a.excess::<Q12_20>(c), b.excess::<Q12_20>(c));
    assert_eq!(found.unwrap(), [a, b, c]);
    assert_eq!(AntennaDelay::of_each(b.excess::<f64>(b)), Ok(b));
    assert_eq!(AntennaDelay::of_each(f32::NAN), Err(Error::NotFinite));
    assert_eq!(AntennaDelay::of_each(1e30_f64), Err(Error::NotFinite));
}
