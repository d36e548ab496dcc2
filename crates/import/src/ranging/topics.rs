//! Ranges in ROS topics: which anchor each one is to.

use std::collections::BTreeSet;

use super::labels::place;
use super::tags::is_named;
use super::{Found, keep_one_tag};
use crate::containers::{self, Label, RangeEntry, RangeTopics};
use crate::damage::Damage;
use crate::error::{Error, listed};
use crate::options::Options;
use crate::part::Part;

/// Reads a bag of ROS 1 or an MCAP file; `None` if it is neither.
pub(super) fn read(
    bytes: &[u8],
    anchors: &[String],
    options: &Options,
) -> Result<Option<(Found, String, Damage)>, Error> {
    let Some((format, topics)) = containers::ranges(bytes, options)? else { return Ok(None) };
    options.refuse_beside(&["range", "anchor"])?;
    // An option may name a tag in place of a topic.
    let said = options.topic.as_deref();
    let is_chosen = |it: &&RangeEntry| {
        it.heard.tag.as_ref().zip(said).is_some_and(|(tag, said)| is_named(tag, said))
    };
    let of_tag: BTreeSet<usize> =
        topics.entries.iter().filter(is_chosen).map(|it| it.topic).collect();
    let said = said.filter(|_| !of_tag.is_empty());
    let wanted = if said.is_some() { of_tag.into_iter().collect() } else { topics.wanted()? };
    let scales = wanted.iter().map(|&it| topics.scale(it)).collect::<Result<Vec<_>, _>>()?;
    let mut told: Vec<_> = scales.iter().map(|(_, told)| told.clone()).collect();
    told.dedup();
    let is_wanted = |topic: &usize| wanted.iter().position(|it| it == topic);
    let entries = topics.entries.iter().filter_map(|it| Some((is_wanted(&it.topic)?, it)));
    let mut entries: Vec<_> = entries.collect();
    keep_one_tag(&mut entries, |(_, it)| it.heard.tag.as_deref().unwrap_or_default(), said)?;
    let has_stamps = entries.iter().any(|(_, it)| it.stamp.is_some_and(|stamp| stamp != 0.0));
    let by_topic = names_by_topic(&topics, &wanted, anchors)?;
    let mut found = Found::default();
    for &(own, entry) in &entries {
        let time = if has_stamps { entry.stamp.unwrap_or(entry.receipt) } else { entry.receipt };
        let metres = entry.heard.range * scales[own].0;
        let label = match (&entry.heard.label, &by_topic) {
            (Label::Said(label), _) => label,
            (Label::Frame(_), Some(names)) => &names[own],
            (Label::Frame(frame), None) => frame,
        };
        if metres.is_finite() {
            found.add(time.round() as i64, label, metres);
        }
    }
    let names = listed(wanted.iter().map(|&it| topics.name(it)));
    let noun = if wanted.len() == 1 { "topic" } else { "topics" };
    let times = if has_stamps { "" } else { ", times of receipt, as there are no stamps" };
    let conclusion = format!("{}: {noun} {names}{times}: {format}", told.join(", "));
    let damage = topics.losses.damage(Part::Record, entries.len());
    damage.accept(entries.len() + damage.count(), options.strict)?;
    Ok(Some((found, conclusion, damage)))
}

/// The anchor's name in the name of each topic, if that distinguishes more anchors than the frames of the messages do;
/// `None` if the frames do, or if messages name the anchors.
///
/// # Errors
/// If both distinguish equally many anchors, but different ones.
fn names_by_topic(
    topics: &RangeTopics<'_>,
    wanted: &[usize],
    anchors: &[String],
) -> Result<Option<Vec<String>>, Error> {
    let mut frames: Vec<BTreeSet<&str>> = vec![BTreeSet::new(); wanted.len()];
    for entry in &topics.entries {
        if let (Label::Frame(frame), Some(own)) =
            (&entry.heard.label, wanted.iter().position(|&it| it == entry.topic))
        {
            frames[own].insert(frame);
        }
    }
    if frames.iter().all(BTreeSet::is_empty) {
        return Ok(None);
    }
    let segment = |&topic: &usize| {
        let name = topics.name(topic);
        let parts = name.rsplit('/');
        let own = parts.clone().find(|part| place(part, anchors).is_some());
        own.unwrap_or(name).to_owned()
    };
    let names: Vec<_> = wanted.iter().map(segment).collect();
    let anchor_of = |name: &str| place(name, anchors);
    let of_topics: BTreeSet<_> = names.iter().filter_map(|name| anchor_of(name)).collect();
    let of_frames: BTreeSet<_> =
        frames.iter().flatten().filter_map(|frame| anchor_of(frame)).collect();
    let is_same = frames
        .iter()
        .zip(&names)
        .all(|(frames, name)| frames.iter().all(|frame| anchor_of(frame) == anchor_of(name)));
    if of_topics.len() == of_frames.len() && !is_same {
        return Err(Error::log(format!(
            "expected anchors by the names of topics or of frames, found topics {} with frames {}",
            listed(names.iter().map(String::as_str)),
            listed(frames.iter().flatten().copied()),
        )));
    }
    Ok((of_topics.len() >= of_frames.len()).then_some(names))
}
