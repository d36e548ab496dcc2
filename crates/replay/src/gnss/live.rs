//! Live positions of a receiver, from its own stream.

use kestirim_gnss_files::{Carriers, Error, Kind};
use kestirim_gnss_ppp::{Corrections, GpsTime};
use kestirim_ppp_filter::{Config, Health};

use super::choices::{Method, STATES_OF_ALL};
use super::feed::Feed;
use super::followed::{Fix, Followed, Pass};
use super::model::Epoch;
use super::recording::{Paths, Recording};
use super::shelf::Shelf;
use super::single::single;

/// The span of the stream that is kept, s: satellites repeat their ephemerides, which serve for two hours. If the newer
/// half of a stream cannot be read alone, because it tells its week only once, twice the span is kept, and so on.
const KEPT_S: f64 = 10_800.0;
/// The largest number of bytes that are kept.
const MOST: usize = 1 << 25;
/// In a stream without pauses, new data are processed once they exceed one part in this many of what is kept.
const NEW: usize = 8;

/// An epoch that is further ahead than this of all later ones has a wrong time, s.
const AHEAD_S: f64 = 1.0;
/// The beginning of a stream is searched in steps of this many bytes; no message is longer than `LONGEST`.
const STEP: usize = 2048;
const LONGEST: usize = 8192;
/// The message shown while nothing else has come.
const NO_STREAM: &str = "no message of UBX or RTCM 3 has come yet: let the receiver send RXM-RAWX and RXM-SFRBX, or MSM4 or MSM7";

/// Live positions of a receiver, from its own stream of UBX or RTCM 3.
///
/// The stream is kept, three hours at most, and read again, so that the quality of signals, the week and the health of
/// satellites are known as well as in a recording. Each epoch is given to the filter once, when the next one has begun,
/// as an epoch may come in several messages.
#[derive(Debug)]
pub struct Live {
    config: Config,
    pass: Pass,
    corrections: Corrections,
    kept: Vec<u8>,
    /// The span of the stream that is kept, s.
    kept_s: f64,
    /// The number of bytes that have not been processed.
    fresh: usize,
    /// The size that data must reach before they are read again after they could not be read, in bytes.
    enough: usize,
    /// The carriers with which the filter has been fed, one pair for each system: with others of a system it begins anew.
    carriers: Vec<Carriers>,
    feed: Option<Box<Feed<STATES_OF_ALL>>>,
    /// The last epoch that was fed.
    until: Option<GpsTime>,
    /// The number of epochs, and of those with a solution.
    counts: [usize; 2],
    now: Option<Now>,
    /// The result of the last processing of the stream: the warnings, or why there is no position yet.
    told: Vec<String>,
    /// The reason why the last epoch has no solution.
    outage: Option<String>,
}

/// The current position of a receiver.
#[derive(Debug, Clone, PartialEq)]
pub struct Now {
    /// The time in UTC.
    pub utc: String,
    /// The position; its time counts from the midnight before the first epoch that is kept.
    pub fix: Fix,
    /// Standard deviations to the east, north and up, m.
    pub sd_enu: [f64; 3],
    /// How far the position is to be trusted.
    pub health: Health,
    /// The number of satellites used.
    pub satellites: usize,
}

impl Live {
    /// A receiver of which nothing has come yet.
    pub fn new(config: Config, pass: Pass, corrections: Corrections) -> Self {
        Self {
            config,
            pass,
            corrections,
            kept: Vec::new(),
            kept_s: KEPT_S,
            fresh: 0,
            enough: 0,
            carriers: Vec::new(),
            feed: None,
            until: None,
            counts: [0; 2],
            now: None,
            told: Vec::new(),
            outage: None,
        }
    }

    /// Takes new bytes; returns whether there are so many that they should be processed before more are taken.
    pub fn hear(&mut self, bytes: &[u8]) -> bool {
        self.kept.extend_from_slice(bytes);
        self.fresh += bytes.len();
        self.fresh > self.kept.len() / NEW
    }

    /// Processes what came since the last call. The products are those of `paths`, in which `obs` names the stream;
    /// `is_end` says that no more will come.
    pub fn look(&mut self, paths: &Paths<'_>, shelf: &Shelf, is_end: bool) {
        let is_news = self.fresh > 0 && self.kept.len() >= self.enough;
        if !is_news && !is_end {
            return;
        }
        (self.fresh, self.enough) = (0, 0);
        if !self.find_beginning() {
            self.told = vec![NO_STREAM.to_owned()];
            return;
        }
        match Recording::of_stream(self.kept.clone(), paths, shelf) {
            Ok(recording) => {
                self.follow(&recording, is_end);
                let [first, last] = recording.span();
                if last - first > self.kept_s {
                    self.forget(paths, shelf);
                }
            }
            // Not enough of the stream has come, or nothing that can be read.
            Err(error) => {
                self.enough = self.kept.len() + self.kept.len() / NEW;
                self.told = vec![format!("no position yet: {}", problem(error, paths))];
            }
        }
        if self.kept.len() > MOST {
            self.kept.drain(..self.kept.len() / 2);
            self.enough = 0;
        }
    }

    /// Drops what precedes the stream, such as the lines of a receiver that has not yet been told to send one; returns
    /// whether the stream has begun.
    fn find_beginning(&mut self) -> bool {
        let is_stream = |bytes: &[u8]| Kind::of(bytes).is_some_and(Kind::is_stream);
        let begins = (0..self.kept.len()).step_by(STEP).find(|&at| is_stream(&self.kept[at..]));
        // A message may have begun in the last bytes.
        let last = self.kept.len().saturating_sub(LONGEST);
        self.kept.drain(..begins.unwrap_or(last));
        begins.is_some()
    }

    /// Notes the observed carriers; returns whether they are those of before, as far as their systems were observed. The filter
    /// knows of systems that come and go.
    fn take_carriers(&mut self, observed: &[Carriers]) -> bool {
        // Each satellite of GLONASS has a channel of its own.
        let pair = |of: &Carriers| match of {
            Carriers::G1G2 { .. } => Carriers::G1G2 { channel: 0 },
            other => *other,
        };
        for carriers in observed.iter().map(pair) {
            match self.carriers.iter().find(|known| known.system() == carriers.system()) {
                Some(known) if *known != carriers => {
                    self.carriers = observed.iter().map(pair).collect();
                    return false;
                }
                Some(_) => {}
                None => self.carriers.push(carriers),
            }
        }
        true
    }

    fn follow(&mut self, recording: &Recording, is_end: bool) {
        let epochs = recording.epochs(None);
        if !self.take_carriers(recording.carriers()) {
            self.feed = None;
        }
        // Without this, the filter would wait for a time that was ahead by mistake.
        let last = epochs.last().map(|epoch| epoch.time);
        if let (Some(until), Some(last)) = (self.until, last)
            && until.since(last) > AHEAD_S
        {
            (self.until, self.feed) = (Some(last), None);
        }
        let begin = self
            .until
            .map_or(0, |until| epochs.partition_point(|epoch| epoch.time.since(until) <= 0.0));
        let end = if is_end { epochs.len() } else { epochs.len().saturating_sub(1) };
        let new = epochs.get(begin..end).unwrap_or_default();
        let receiver = recording.receiver(self.corrections);
        let config = recording.settled(self.config);
        let mut followed = Followed::default();
        if self.pass.method == Method::Single {
            followed = single(recording, new, &receiver, &config, self.pass, &mut || ());
        } else {
            let fresh = || Box::new(Feed::new(&config, recording, self.pass));
            let feed = self.feed.get_or_insert_with(fresh);
            for epoch in new {
                feed.take(recording, &receiver, epoch, None, &mut followed);
            }
        }
        self.until = new.last().map(|epoch| epoch.time).or(self.until);
        self.counts[0] += new.len();
        self.counts[1] += followed.fixes.len();
        let last = followed.fixes.last().zip(followed.last).zip(followed.heard.last());
        if let Some(((fix, last), satellites)) = last {
            self.now = Some(Now {
                utc: recording.utc(fix.t),
                fix: *fix,
                sd_enu: last.sd_enu,
                health: last.health,
                satellites: *satellites,
            });
        }
        let is_solved = |epoch: &Epoch| {
            followed.fixes.last().is_some_and(|fix| fix.t >= recording.seconds(epoch))
        };
        if let Some(epoch) = new.last() {
            let outage = followed.outages.first().filter(|_| !is_solved(epoch));
            self.outage = outage.map(|outage| format!("no solution any more: {outage}"));
        }
        self.told = recording.warnings(self.corrections).collect();
        self.told.extend(self.outage.clone());
    }

    /// Drops the older half of what is kept.
    fn forget(&mut self, paths: &Paths<'_>, shelf: &Shelf) {
        let newer = self.kept.len() / 2;
        match Recording::of_stream(self.kept[newer..].to_vec(), paths, shelf) {
            Ok(_) => drop(self.kept.drain(..newer)),
            // The only message with the week is in the older half.
            Err(_) => self.kept_s *= 2.0,
        }
    }

    /// The current or last known position; `None` before the first solution.
    pub const fn now(&self) -> Option<&Now> {
        self.now.as_ref()
    }

    /// Whether the last epoch had a solution.
    pub const fn is_solved(&self) -> bool {
        self.now.is_some() && self.outage.is_none()
    }

    /// The number of epochs, and of those with a solution.
    pub const fn counts(&self) -> [usize; 2] {
        self.counts
    }

    /// The warnings about the stream, or why there is no position yet: a sentence each.
    pub fn warnings(&self) -> &[String] {
        &self.told
    }
}

/// The reason why there is no position yet, without the name of the stream, which is not a file.
fn problem(error: Error, paths: &Paths<'_>) -> String {
    match error {
        Error::File { path, problem } | Error::Line { path, problem, .. } if path == paths.obs => {
            problem
        }
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use kestirim_ppp_filter::Motion;

    use super::*;

    /// The warnings after these bytes, and the number of bytes kept.
    fn told(bytes: &[u8]) -> (String, usize) {
        let paths = Paths {
            obs: Path::new("stream"),
            sp3: &[],
            nav: &[],
            antex: &[],
            clk: &[],
            bias: &[],
            blq: None,
            erp: None,
        };
        let mut live = Live::new(Config::new(Motion::Static), Pass::default(), Corrections::ALL);
        for piece in bytes.chunks(1000) {
            live.hear(piece);
            live.look(&paths, &Shelf::default(), false);
            assert!(live.now().is_none() && live.counts() == [0; 2]);
        }
        (live.warnings().join("; "), live.kept.len())
    }

    #[test]
    fn a_system_may_come_and_go_and_only_other_carriers_of_one_begin_anew() {
        use Carriers::{E1E5a, E1E5b, G1G2, L1L2};
        let mut live = Live::new(Config::new(Motion::Static), Pass::default(), Corrections::ALL);
        assert!(live.take_carriers(&[L1L2, G1G2 { channel: 1 }]));
        assert!(live.take_carriers(&[L1L2, G1G2 { channel: -4 }, E1E5a]));
        assert!(live.take_carriers(&[L1L2]));
        assert!(!live.take_carriers(&[L1L2, E1E5b]));
        assert!(live.take_carriers(&[E1E5b]));
    }

    #[test]
    fn what_is_no_stream_is_told_and_not_kept() {
        let lines = "$GNGGA,120000.00,,,,,0,00,99.99,,,,,,*71\r\n".repeat(1000);
        let (said, kept) = told(lines.as_bytes());
        assert!(said.contains("RXM-RAWX"), "{said}");
        assert!(kept <= LONGEST);
        // A message without observations, UBX-ACK-ACK, behind them: the stream has begun.
        let acknowledged = [0xb5, 0x62, 0x05, 0x01, 0x02, 0x00, 0x06, 0x01, 0x0f, 0x38];
        let (said, kept) = told(&[lines.as_bytes(), &acknowledged].concat());
        assert!(said.contains("no position yet"), "{said}");
        assert!(kept > 0);
        assert_eq!(told(&[]).1, 0);
    }
}
