//! Two-way ranging: from intervals on two clocks to a distance.

use crate::ticks::light_distance;
use crate::{ClockOffset, Error, Ticks, Timestamp};
use kestirim_scalar::Scalar;

/// A poll and a response: the initiator measures the round trip, the responder its own reply time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct SingleSided {
    /// From the poll's departure to the response's arrival, on the initiator's clock.
    pub round: Ticks,
    /// From the poll's arrival to the response's departure, on the responder's clock.
    pub reply: Ticks,
}

impl SingleSided {
    /// Creates an exchange from its four timestamps: poll sent and received, response sent and received.
    pub const fn new(
        poll_sent: Timestamp,
        poll_received: Timestamp,
        response_sent: Timestamp,
        response_received: Timestamp,
    ) -> Self {
        Self {
            round: response_received.since(poll_sent),
            reply: response_sent.since(poll_received),
        }
    }

    /// The distance (m): c·(R − D·(1 + offset))/2, with the reply time D converted to the initiator's clock.
    ///
    /// Equation (2) of the paper is misprinted; this is what its text describes. Without the offset
    /// ([`ClockOffset::ZERO`]), 20 ppm cause an error of 3 m per millisecond of reply time. Negative distances are
    /// returned unchanged.
    pub fn distance<T: Scalar>(&self, offset: ClockOffset) -> T {
        let (round, reply) = (self.round.signed(), self.reply.signed());
        let difference = i128::from(round.wrapping_sub(reply)) << ClockOffset::FRACTION;
        let correction = i128::from(reply).wrapping_mul(i128::from(offset.to_bits()));
        light_distance(difference.wrapping_sub(correction), 2 << ClockOffset::FRACTION)
    }
}

/// A poll, a response and a final message: each side measures a round trip and a reply time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct DoubleSided {
    /// From the poll's departure to the response's arrival, on the initiator's clock.
    pub round1: Ticks,
    /// From the poll's arrival to the response's departure, on the responder's clock.
    pub reply1: Ticks,
    /// From the response's departure to the final's arrival, on the responder's clock.
    pub round2: Ticks,
    /// From the response's arrival to the final's departure, on the initiator's clock.
    pub reply2: Ticks,
}

impl DoubleSided {
    /// Creates an exchange from its six timestamps: poll, response and final message, each sent and received.
    pub const fn new(
        poll_sent: Timestamp,
        poll_received: Timestamp,
        response_sent: Timestamp,
        response_received: Timestamp,
        final_sent: Timestamp,
        final_received: Timestamp,
    ) -> Self {
        Self {
            round1: response_received.since(poll_sent),
            reply1: response_sent.since(poll_received),
            round2: final_received.since(response_sent),
            reply2: final_sent.since(response_received),
        }
    }

    /// The distance (m): c·(R₁R₂ − D₁D₂)/(R₁ + R₂ + D₁ + D₂), for reply times of any lengths (DW1000 user manual,
    /// 12.3.2; equation (2) of the paper is a misprint of it).
    ///
    /// Clock offsets cancel except for 20 ppm of the distance itself. The numerator is exact, as (R₁ − D₁)·R₂ +
    /// D₁·(R₂ − D₂). Negative distances are returned unchanged.
    ///
    /// # Errors
    /// [`Error::EmptyExchange`] if all intervals are zero.
    pub fn asymmetric<T: Scalar>(&self) -> Result<T, Error> {
        let [round1, reply1, round2, reply2] = self.signed();
        let product = |a: i64, b: i64| i128::from(a).wrapping_mul(i128::from(b));
        let numerator = product(round1.wrapping_sub(reply1), round2)
            .wrapping_add(product(reply1, round2.wrapping_sub(reply2)));
        let sum = round1.wrapping_add(round2).wrapping_add(reply1).wrapping_add(reply2);
        if sum == 0 {
            return Err(Error::EmptyExchange);
        }
        Ok(light_distance(numerator, i128::from(sum)))
    }

    /// The distance (m): c·(R₁ − D₁ + R₂ − D₂)/4, for EQUAL reply times only: 20 ppm of their difference remain,
    /// 1.5 m per millisecond. Negative distances are returned unchanged.
    pub fn symmetric<T: Scalar>(&self) -> T {
        let [round1, reply1, round2, reply2] = self.signed();
        let difference = round1.wrapping_sub(reply1).wrapping_add(round2.wrapping_sub(reply2));
        light_distance(i128::from(difference), 4)
    }

    /// Offset of the initiator's clock from the responder's during this exchange: the times from the first
    /// departure to the last, and from the first arrival to the last, are equal.
    ///
    /// # Errors
    /// [`Error::EmptyExchange`] if the responder's intervals are zero.
    pub fn clock_offset(&self) -> Result<ClockOffset, Error> {
        let [round1, reply1, round2, reply2] = self.signed();
        ClockOffset::between(round1.wrapping_add(reply2), reply1.wrapping_add(round2))
    }

    const fn signed(&self) -> [i64; 4] {
        [self.round1.signed(), self.reply1.signed(), self.round2.signed(), self.reply2.signed()]
    }
}
