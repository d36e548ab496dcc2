//! The anchors' side of two-way ranging: four anchors, each with its own clock and antenna.

use robot_app::message::{Answer, Question, Report};
use robot_app::{SITES, TAG};

use kestirim_uwb_ranging::{METRES_PER_TICK, Timestamp};

use crate::world::ticks;

/// The relative drift of each anchor's clock against the tag's, 10⁻⁹.
const DRIFT: [i64; SITES.len()] = [18_300, -11_700, 400, -20_000];
/// The time from the arrival of a question to the departure of its answer, µs; it differs between anchors.
const REPLY_US: [u64; SITES.len()] = [3_000, 2_700, 4_100, 3_300];
/// The number of bytes before the payload (frame control, number, network and address of both sides), and that of the
/// checksum.
const HEADER: usize = 11;
const CHECKSUM: usize = 2;
/// The frame control of an IEEE 802.15.4-2006 data frame with short addresses, each with its network.
const CONTROL: [u8; 2] = [0x01, 0x98];

/// A frame on the air.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub(crate) bytes: [u8; 127],
    /// The length, including the checksum.
    pub(crate) length: usize,
}

/// The anchors, and their part of the current exchange.
#[derive(Debug)]
pub(crate) struct Anchors {
    /// The range to the polled anchor, m.
    pub(crate) range: f32,
    poll_received: Timestamp,
    response_sent: Timestamp,
}

impl Anchors {
    pub(crate) const fn new() -> Self {
        let never = Timestamp::new(0);
        Self { range: f32::NAN, poll_received: never, response_sent: never }
    }

    /// The reaction to a frame that left the tag's antenna at `departure`: an answer and the time of its arrival at the
    /// antenna, or silence.
    pub(crate) fn hear(&mut self, frame: &Frame, departure: u64) -> Option<(Frame, u64)> {
        let content = frame.bytes.get(..frame.length.checked_sub(CHECKSUM)?)?;
        let (header, payload) = content.split_first_chunk::<HEADER>()?;
        let anchor = SITES
            .iter()
            .position(|site| *header == heading(header[2], site.address, TAG.address))?;
        let (question, exchange) = Question::decode(payload)?;
        if !self.range.is_finite() {
            return None;
        }
        let flight = (self.range * const { (1.0 / METRES_PER_TICK) as f32 } + 0.5) as u64;
        let site = SITES.get(anchor)?;
        // A third of the delay that neither side corrects is on the way in.
        let late_in = i64::from(site.antenna.ticks()) / 3;
        let late_out = i64::from(site.antenna.ticks()) - late_in;

        let arrival = departure + flight;
        let received = clock(anchor, arrival.wrapping_add_signed(late_in));
        let reply = arrival + ticks(*REPLY_US.get(anchor)?);
        let sent = clock(anchor, reply.wrapping_add_signed(-late_out));
        let answer = match question {
            Question::Poll => {
                self.poll_received = received;
                self.response_sent = sent;
                Answer::Response
            }
            Question::Final => Answer::Report(Report {
                poll_received: self.poll_received,
                response_sent: self.response_sent,
                final_received: received,
            }),
        };
        let mut payload = [0; Answer::LONGEST];
        let length = answer.encode(exchange, &mut payload);
        let mut bytes = [0; 127];
        let (head, rest) = bytes.split_first_chunk_mut::<HEADER>()?;
        *head = heading(exchange, TAG.address, site.address);
        rest.get_mut(..length)?.copy_from_slice(payload.get(..length)?);
        Some((Frame { bytes, length: HEADER + length + CHECKSUM }, reply + flight))
    }
}

/// The reading of an anchor's counter.
fn clock(anchor: usize, now: u64) -> Timestamp {
    let drift = DRIFT.get(anchor).copied().unwrap_or_default();
    let gained = i128::from(now) * i128::from(drift) / 1_000_000_000;
    // The anchors were turned on at different times.
    Timestamp::new(
        now.wrapping_add_signed(gained as i64).wrapping_add(anchor as u64 * 0x31_4159_2653),
    )
}

fn heading(number: u8, to: u16, from: u16) -> [u8; HEADER] {
    let [control, version] = CONTROL;
    let [network_low, network] = TAG.network.to_le_bytes();
    let ([to_low, to], [from_low, from]) = (to.to_le_bytes(), from.to_le_bytes());
    [
        control,
        version,
        number,
        network_low,
        network,
        to_low,
        to,
        network_low,
        network,
        from_low,
        from,
    ]
}
