//! Messages of two anchors on their own clocks, in exact arithmetic, against the computed difference.

use kestirim_scalar::{Q12_20, Scalar};
use kestirim_uwb_ranging::{
    Broadcast, Difference, Downlink, Error, Heard, METRES_PER_TICK, TICKS_PER_SECOND, Timestamp,
};
use nalgebra::Vector3;
use proptest::prelude::*;

const PLACES: [[f64; 3]; 2] = [[0.0, 0.0, 2.0], [9.0, 3.0, 1.0]];
const TAG: [f64; 3] = [2.0, 4.0, 1.0];

/// Three clocks: the tag's and each anchor's.
#[derive(Clone, Copy, Debug)]
struct Clocks {
    starts: [u64; 3],
    ppm: [f64; 3],
}

impl Clocks {
    fn at(&self, who: usize, seconds: f64, metres: f64) -> Timestamp {
        let ticks = seconds * TICKS_PER_SECOND + metres / METRES_PER_TICK;
        let own = (ticks * (1.0 + self.ppm[who] * 1e-6)).round();
        Timestamp::new(self.starts[who].wrapping_add(own as u64))
    }
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (Vector3::from(a) - Vector3::from(b)).norm()
}

/// Message number `k`, one every 5 ms, sent by the anchors in turn.
struct Sent {
    message: Broadcast<'static>,
    heard: [Heard; 1],
}

fn sent(clocks: &Clocks, k: u64) -> Sent {
    let at = |k: u64| k as f64 * 0.005;
    let own = (k % 2) as usize;
    let [mine, between] = [distance(PLACES[own], TAG), distance(PLACES[0], PLACES[1])];
    let before = k.saturating_sub(1);
    let heard = Heard {
        anchor: 1 - own,
        sequence: before as u8,
        received: clocks.at(1 + own, at(before), between),
    };
    let message = Broadcast {
        time_us: k * 5000,
        anchor: own,
        sequence: k as u8,
        sent: clocks.at(1 + own, at(k), 0.0),
        received: clocks.at(0, at(k), mine),
        heard: &[],
    };
    Sent { message, heard: [heard] }
}

fn engine<T: Scalar>() -> Downlink<T, 2> {
    let places = PLACES.map(|place| Vector3::from(place.map(T::from_f64)));
    Downlink::new(places, T::from_f64(0.1), T::from_f64(0.03)).unwrap()
}

fn take<T: Scalar>(
    engine: &mut Downlink<T, 2>,
    sent: &Sent,
) -> Result<Option<Difference<T>>, Error> {
    engine.take(&Broadcast { heard: &sent.heard, ..sent.message })
}

fn clocks() -> impl Strategy<Value = Clocks> {
    let starts = prop::array::uniform3(0_u64..1 << 40);
    (starts, prop::array::uniform3(-20.0..20.0)).prop_map(|(starts, ppm)| Clocks { starts, ppm })
}

fn check<T: Scalar>(clocks: &Clocks, first: u64) -> Result<(), TestCaseError> {
    let expected = distance(PLACES[1], TAG) - distance(PLACES[0], TAG);
    let mut engine = engine::<T>();
    let mut made = 0;
    for k in first..first + 200 {
        let mut sent = sent(clocks, k);
        if k % 2 == 0 {
            // Crazyflie's third version sends timestamps of 32 bits.
            let low = |stamp: Timestamp| Timestamp::new(stamp.ticks() & 0xffff_ffff);
            sent.message.sent = low(sent.message.sent);
            sent.heard[0].received = low(sent.heard[0].received);
        }
        let Some(found) = take(&mut engine, &sent).unwrap() else { continue };
        made += 1;
        let sign = if found.anchors == [0, 1] { 1.0 } else { -1.0 };
        let error = found.difference.to_f64() - sign * expected;
        // Whole ticks of 4.7 mm: three of them, and at least two more over 50 ms.
        prop_assert!(error.abs() < 0.012, "{error} at {k}");
        prop_assert!((0.019..0.021).contains(&found.variance.to_f64()));
    }
    prop_assert!(made > 180, "{made}");
    Ok(())
}

proptest! {
    #[test]
    fn differences_are_those_of_the_places(clocks in clocks(), first in 0_u64..4000) {
        check::<f64>(&clocks, first)?;
        check::<f32>(&clocks, first)?;
        check::<Q12_20>(&clocks, first)?;
    }

    #[test]
    fn any_message_is_taken_or_refused(
        messages in prop::collection::vec(
            (0_u64..2_000_000, 0_usize..4, any::<u8>(), any::<[u64; 3]>(), 0_usize..4), 0..50,
        ),
    ) {
        let mut engine = engine::<Q12_20>();
        let mut now_us = 0;
        for (step_us, anchor, sequence, [sent, received, heard], other) in messages {
            now_us += step_us;
            let [sent, received, heard] = [sent, received, heard].map(Timestamp::new);
            let heard = [Heard { anchor: other, sequence, received: heard }];
            let message =
                Broadcast { time_us: now_us, anchor, sequence, sent, received, heard: &heard };
            let before = format!("{engine:?}");
            if engine.take(&message).is_err() {
                prop_assert_eq!(before, format!("{engine:?}"));
            }
        }
    }
}

#[test]
fn what_is_wrong_is_refused_and_an_anchor_that_begins_anew_is_heard_again() {
    let mut clocks = Clocks { starts: [5, 1 << 39, 77], ppm: [3.0, -12.0, 20.0] };
    let mut engine = engine::<f32>();
    for k in 0..100 {
        take(&mut engine, &sent(&clocks, k)).unwrap();
    }
    let ppm: f32 = engine.clock_offset(0).expect("it is known").ppm();
    assert!((ppm + 15.0).abs() < 0.1, "{ppm}");
    assert_eq!(take(&mut engine, &sent(&clocks, 99)), Err(Error::Repeated));
    let mut wrong = sent(&clocks, 100);
    wrong.message.anchor = 2;
    assert_eq!(take(&mut engine, &wrong), Err(Error::NoSuchAnchor));
    // The other anchor's message was heard 30 m later than possible.
    let mut wrong = sent(&clocks, 100);
    wrong.heard[0].received = Timestamp::new(wrong.heard[0].received.ticks() + 6400);
    assert_eq!(take(&mut engine, &wrong), Err(Error::ImplausibleDifference));
    // The message that it heard was lost: nothing relates its own message to another's.
    let mut lost = sent(&clocks, 100);
    lost.heard[0].sequence = 90;
    assert_eq!(take(&mut engine, &lost), Ok(None));
    // Anchor 1 restarts.
    clocks.starts[2] = 123_456_789_012;
    let (mut refused, mut made) = (0, 0);
    for k in 101..500 {
        match take(&mut engine, &sent(&clocks, k)) {
            Err(Error::ImplausibleClock) => refused += 1,
            Err(error) => panic!("{error}"),
            Ok(found) => made += usize::from(found.is_some() && k > 450),
        }
    }
    assert!((95..105).contains(&refused) && made > 40, "{refused} {made}");
}

#[test]
fn what_no_engine_can_be_made_of_is_refused() {
    let places = [Vector3::zeros(); 2];
    assert_eq!(Downlink::new(places, 0.0, 0.1).err(), Some(Error::NotPositive));
    assert_eq!(Downlink::new(places, f64::NAN, 0.1).err(), Some(Error::NotFinite));
}
