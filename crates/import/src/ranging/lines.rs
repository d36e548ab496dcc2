//! Logs with one line of text for the ranges to all anchors at one epoch.

use super::{Found, USUAL_STEP, keep_one_tag};
use crate::clock::unit_of_range_times;
use crate::counter::Counter;
use crate::damage::{Damage, Fault};
use crate::error::{Error, quoted};
use crate::moment::{self, Days, Moment};
use crate::options::{Options, TimeUnit};
use crate::text::{Text, letters};

/// The number of lines that are looked at to recognise a log.
const SAMPLE: usize = 400;

/// The content of a line.
#[derive(Debug, Clone, PartialEq)]
struct Message {
    /// Time on the radio's own clock, s.
    clock: Option<f64>,
    /// The tag, if the line names it.
    tag: Option<String>,
    /// The anchors, by the names that the radio gives them, with their ranges in m.
    ranges: Vec<(String, f64)>,
    /// The position in the line where the message begins.
    begins: usize,
}

/// The format of the lines of one radio or program.
#[derive(Debug)]
struct Form {
    title: &'static str,
    /// The text that every such line contains.
    mark: &'static str,
    parse: fn(&str) -> Option<Message>,
}

const FORMS: [Form; 5] = [
    Form { title: "TREK1000 mc", mark: "mc ", parse: |line| trek(line, "mc ") },
    Form { title: "TREK1000 mr", mark: "mr ", parse: |line| trek(line, "mr ") },
    Form { title: "MDEK1001 les", mark: "]=", parse: les },
    Form { title: "MDEK1001 lec", mark: "DIST,", parse: lec },
    Form { title: "Makerfabs AT+RANGE", mark: "AT+RANGE=", parse: makerfabs },
];

/// Reads a log of such lines; `None` if it is not one.
pub(super) fn read(
    text: &Text<'_>,
    options: &Options,
) -> Result<Option<(Found, String, Damage)>, Error> {
    let Some(form) = recognised(text) else { return Ok(None) };
    let mut damage = Damage { end_may_be_cut: !text.ends_with_line_break(), ..Damage::default() };
    let mut messages = Vec::new();
    for line in text.lines() {
        let words = letters(line.bytes);
        match (form.parse)(&words) {
            Some(message) => {
                let said = said_time(words.get(..message.begins).unwrap_or_default());
                messages.push((said, message));
            }
            None if words.contains(form.mark) => damage.add(Fault::Torn, line.number, || {
                format!("expected a line of {}, found {}", form.title, quoted(&words))
            }),
            // Other output of a radio: its prompt, its version, ranges between anchors.
            None => {}
        }
    }
    damage.accept(messages.len() + damage.count(), options.strict)?;
    keep_one_tag(
        &mut messages,
        |(_, message)| message.tag.as_deref().unwrap_or_default(),
        options.topic.as_deref(),
    )?;
    let (times, clock) = times(&messages, options)?;
    let mut found = Found::default();
    for ((_, message), time_us) in messages.iter().zip(times) {
        for (label, metres) in &message.ranges {
            found.add(time_us, label, *metres);
        }
    }
    Ok(Some((found, format!("{}, time {clock}", form.title), damage)))
}

fn recognised(text: &Text<'_>) -> Option<&'static Form> {
    let lines: Vec<_> = text.lines().take(SAMPLE).map(|line| letters(line.bytes)).collect();
    FORMS.iter().find(|form| {
        let marked = lines.iter().filter(|line| line.contains(form.mark)).count();
        let read = lines.iter().filter(|line| (form.parse)(line).is_some()).count();
        read > 0 && read * 2 >= marked
    })
}

/// The time that precedes a line's message.
#[derive(Debug, Clone, Copy)]
enum Said {
    Moment(Moment),
    Number(f64),
}

impl Said {
    fn seconds(self, days: &mut Days, counter: &mut Counter) -> f64 {
        match self {
            Self::Moment(moment) => days.seconds(moment),
            Self::Number(number) => counter.continued(number),
        }
    }
}

fn said_time(before: &str) -> Option<Said> {
    let stamp = before.trim_matches(|letter: char| !letter.is_ascii_alphanumeric());
    if let Some(moment) = moment::read(stamp.as_bytes()) {
        return Some(Said::Moment(moment));
    }
    stamp.parse().ok().filter(|time: &f64| time.is_finite()).map(Said::Number)
}

/// The time of each message, µs, and the origin of these times.
fn times(
    messages: &[(Option<Said>, Message)],
    options: &Options,
) -> Result<(Vec<i64>, String), Error> {
    let microseconds = |seconds: f64| (seconds * 1e6).round() as i64;
    if let Some(TimeUnit::Rate(rate)) = options.units.time {
        let times = (0..messages.len()).map(|i| microseconds(i as f64 / rate));
        return Ok((times.collect(), format!("counted at {rate} Hz: option")));
    }
    let said: Option<Vec<Said>> = messages.iter().map(|(said, _)| *said).collect();
    if let Some(said) = said {
        let (mut days, mut counter) = (Days::default(), Counter::default());
        let values: Vec<_> =
            said.iter().map(|said| said.seconds(&mut days, &mut counter)).collect();
        if said.iter().all(|it| matches!(it, Said::Moment(_))) {
            let times = values.into_iter().map(microseconds).collect();
            return Ok((times, "as dates or times of day: from the data".to_owned()));
        }
        let (unit, from) = match &options.units.time {
            Some(TimeUnit::Clock(unit)) => (unit.clone(), "option"),
            _ => (unit_of_range_times(values.iter().copied(), USUAL_STEP)?, "from the data"),
        };
        let times = values.iter().map(|value| microseconds(value * unit.scale)).collect();
        return Ok((times, format!("in {unit}: {from}")));
    }
    let clocks: Option<Vec<_>> = messages.iter().map(|(_, message)| message.clock).collect();
    match clocks {
        Some(clocks) => {
            let times = clocks.into_iter().map(microseconds).collect();
            Ok((times, "of the radio's clock: format".to_owned()))
        }
        None => Err(Error::undecided("expected lines with a time, found none", "--units t=10Hz")),
    }
}

/// Parses `mc 0f 00000663 000005a3 00000512 000004cb 095f c1 00024c24 a0:0`.
fn trek(line: &str, mark: &str) -> Option<Message> {
    let begins = line.find(mark)?;
    let words: Vec<_> = line[begins + mark.len()..].split_whitespace().collect();
    let [mask, ranges @ .., _count, _sequence, clock, link] = &words[..] else { return None };
    let hexadecimal = |word: &str| u32::from_str_radix(word, 16).ok();
    let (mask, clock) = (hexadecimal(mask)?, hexadecimal(clock)?);
    if !(1..=8).contains(&ranges.len()) {
        return None;
    }
    let mut valid = Vec::new();
    for (anchor, word) in ranges.iter().enumerate() {
        let millimetres = hexadecimal(word)?;
        if mask >> anchor & 1 == 1 {
            valid.push((anchor.to_string(), f64::from(millimetres) * 1e-3));
        }
    }
    let clock = (mark == "mc ").then(|| f64::from(clock) * 1e-3);
    // `aT:A`: the tag and the anchor, of which either may have written the line.
    let tag = link.get(1..).and_then(|link| link.split_once(':')).map(|(tag, _)| tag.to_owned());
    Some(Message { clock, tag, ranges: valid, begins })
}

/// Parses `1151[5.00,8.00,2.25]=6.48 0CA8[0.00,8.00,2.25]=6.51 le_us=2576 est[6.97,8.17,-1.37,53]`.
fn les(line: &str) -> Option<Message> {
    let mut ranges = Vec::new();
    let mut begins = line.len();
    for word in line.split_whitespace() {
        let Some((anchor, range)) = word.split_once("]=") else { continue };
        let (name, _) = anchor.split_once('[')?;
        begins = begins.min(line.find(word)?);
        ranges.push((name.to_owned(), metres(range)?));
    }
    (!ranges.is_empty()).then_some(Message { clock: None, tag: None, ranges, begins })
}

/// Parses `DIST,4,AN0,1151,5.00,8.00,2.25,6.44,AN1,…,POS,7.10,8.24,-1.31,97`.
fn lec(line: &str) -> Option<Message> {
    let begins = line.find("DIST,")?;
    let mut fields = line[begins..].split(',').skip(1);
    let count: usize = fields.next()?.trim().parse().ok()?;
    let mut ranges = Vec::new();
    for _ in 0..count.min(64) {
        let (_, name) = (fields.next()?, fields.next()?);
        let range = fields.nth(3)?;
        ranges.push((name.trim().to_owned(), metres(range)?));
    }
    Some(Message { clock: None, tag: None, ranges, begins })
}

/// Parses `AT+RANGE=tid:1,mask:0F,seq:128,range:(997,1321,…),ancid:(0,1,…)`.
fn makerfabs(line: &str) -> Option<Message> {
    let begins = line.find("AT+RANGE=")?;
    let list = |name: &str| {
        let (_, rest) = line[begins..].split_once(name)?;
        let (inside, _) = rest.split_once(')')?;
        inside.trim_start().strip_prefix('(').map(|inside| inside.split(',').map(str::trim))
    };
    let ids: Option<Vec<_>> = list("ancid:").map(Iterator::collect);
    let mut ranges = Vec::new();
    for (i, text) in list("range:")?.enumerate() {
        let centimetres = metres(text)?;
        let id = ids.as_ref().and_then(|ids| ids.get(i).copied());
        if id != Some("-1") {
            let name = id.map_or_else(|| i.to_string(), str::to_owned);
            ranges.push((name, centimetres * 1e-2));
        }
    }
    let (_, behind) = line[begins..].split_once("tid:").unwrap_or_default();
    let tag = behind.split(',').next().filter(|tag| !tag.is_empty()).map(str::to_owned);
    Some(Message { clock: None, tag, ranges, begins })
}

fn metres(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|value: &f64| value.is_finite())
}
