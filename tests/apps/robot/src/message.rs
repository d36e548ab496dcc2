//! The messages between tag and anchors: the payloads of IEEE 802.15.4 data frames.
//!
//! The tag polls, the anchor responds, the tag sends a final message, and the anchor reports the three timestamps that
//! only it knows. Anchors may answer at any time.

use kestirim_uwb_ranging::Timestamp;

const POLL: u8 = 0x61;
const RESPONSE: u8 = 0x50;
const FINAL: u8 = 0x69;
const REPORT: u8 = 0x70;

/// A message of the tag.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// The poll, which begins an exchange.
    Poll,
    /// The final message of the tag.
    Final,
}

impl Question {
    /// The payload for the exchange with this number.
    pub const fn encode(self, exchange: u8) -> [u8; 2] {
        match self {
            Self::Poll => [POLL, exchange],
            Self::Final => [FINAL, exchange],
        }
    }

    /// Decodes a payload into the question and the number of its exchange.
    pub const fn decode(payload: &[u8]) -> Option<(Self, u8)> {
        match *payload {
            [POLL, exchange] => Some((Self::Poll, exchange)),
            [FINAL, exchange] => Some((Self::Final, exchange)),
            _ => None,
        }
    }
}

/// A message of an anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The response to a poll.
    Response,
    /// The report, after a final message.
    Report(Report),
}

/// An anchor's timestamps of an exchange, by its own counter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// The arrival of the poll.
    pub poll_received: Timestamp,
    /// The departure of the response.
    pub response_sent: Timestamp,
    /// The arrival of the final message.
    pub final_received: Timestamp,
}

impl Answer {
    /// The length of the longest payload, bytes.
    pub const LONGEST: usize = 17;

    /// Writes the payload for the exchange with this number, and returns its length.
    pub fn encode(&self, exchange: u8, payload: &mut [u8; Self::LONGEST]) -> usize {
        let (head, times) = payload.split_at_mut(2);
        let Self::Report(report) = self else {
            head.copy_from_slice(&[RESPONSE, exchange]);
            return head.len();
        };
        head.copy_from_slice(&[REPORT, exchange]);
        let stamps = [report.poll_received, report.response_sent, report.final_received];
        for (bytes, stamp) in times.as_chunks_mut().0.iter_mut().zip(stamps) {
            *bytes = stamp.to_le_bytes();
        }
        Self::LONGEST
    }

    /// Decodes a payload into the answer and the number of its exchange.
    pub fn decode(payload: &[u8]) -> Option<(Self, u8)> {
        match *payload {
            [RESPONSE, exchange] => Some((Self::Response, exchange)),
            [REPORT, exchange, ref times @ ..] => {
                let (&[poll, response, last], []) = times.as_chunks() else { return None };
                let report = Report {
                    poll_received: Timestamp::from_le_bytes(poll),
                    response_sent: Timestamp::from_le_bytes(response),
                    final_received: Timestamp::from_le_bytes(last),
                };
                Some((Self::Report(report), exchange))
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_encoded_is_decoded() {
        for question in [Question::Poll, Question::Final] {
            assert_eq!(Question::decode(&question.encode(7)), Some((question, 7)));
        }
        let report = Report {
            poll_received: Timestamp::new(0xff_1234_5678),
            response_sent: Timestamp::new(0x00_0000_0001),
            final_received: Timestamp::new(0x12_3456_789a),
        };
        for answer in [Answer::Response, Answer::Report(report)] {
            let mut payload = [0; Answer::LONGEST];
            let length = answer.encode(200, &mut payload);
            assert_eq!(Answer::decode(&payload[..length]), Some((answer, 200)));
            assert_eq!(Answer::decode(&payload[..length - 1]), None);
        }
    }
}
