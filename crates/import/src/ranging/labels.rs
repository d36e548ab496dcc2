//! Matches the anchors of a list with the names that a log uses.

use std::collections::BTreeMap;

use crate::error::{Error, listed, quoted};

/// The distinct labels of a log, numbered in order of appearance.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Labels(BTreeMap<String, usize>);

impl Labels {
    /// The number of a label, which is added if it is new.
    pub fn index(&mut self, label: &str) -> usize {
        let next = self.0.len();
        match self.0.get(label) {
            Some(&known) => known,
            None => *self.0.entry(label.to_owned()).or_insert(next),
        }
    }

    /// The index of the anchor that each label refers to.
    ///
    /// A label refers to the anchor of that name; if no label is a name in the list, to the only anchor whose name ends
    /// with the same number.
    ///
    /// # Errors
    /// No label refers to any anchor, or list and log start counting at different numbers.
    pub fn places(&self, anchors: &[String]) -> Result<Vec<Option<usize>>, Error> {
        let mut labels: Vec<_> = self.0.iter().collect();
        labels.sort_by_key(|(_, index)| **index);
        let labels: Vec<_> = labels.into_iter().map(|(label, _)| label.as_str()).collect();
        places(&labels, anchors)
    }
}

fn places(labels: &[&str], anchors: &[String]) -> Result<Vec<Option<usize>>, Error> {
    let named: Vec<_> = labels.iter().map(|label| by_name(label, anchors)).collect();
    // A log that uses names of the list means the same anchors by them, and nothing by a number alone.
    let places = if named.iter().any(Option::is_some) {
        named
    } else {
        labels.iter().map(|label| by_number(label, anchors)).collect()
    };
    if !labels.is_empty() && places.iter().all(Option::is_none) {
        let [known, heard]: [Vec<_>; 2] = [
            anchors.iter().map(|name| quoted(name)).collect(),
            labels.iter().map(|label| quoted(label)).collect(),
        ];
        let [known, heard] = [known, heard].map(|all| listed(all.iter().map(String::as_str)));
        return Err(Error::log(format!("expected ranges to anchors {known}, found {heard}")));
    }
    if let Some([listed, heard]) = counted_apart(labels, anchors) {
        let problem = format!(
            "expected anchors counted from {listed}, as the list has them, found them counted from {heard}: name them in the list as the log does, and none that is not heard"
        );
        return Err(Error::log(problem));
    }
    Ok(places)
}

/// The index of the anchor that a single label refers to.
pub(super) fn place(label: &str, anchors: &[String]) -> Option<usize> {
    by_name(label, anchors).or_else(|| by_number(label, anchors))
}

fn by_name(label: &str, anchors: &[String]) -> Option<usize> {
    let exact = anchors.iter().position(|name| name == label);
    exact.or_else(|| anchors.iter().position(|name| name.eq_ignore_ascii_case(label)))
}

fn by_number(label: &str, anchors: &[String]) -> Option<usize> {
    let number = number(label)?;
    let mut numbered = (0..anchors.len()).filter(|&i| self::number(&anchors[i]) == Some(number));
    numbered.next().filter(|_| numbered.next().is_none())
}

/// The first numbers of list and log, if both number equally many anchors consecutively but from different starts: most
/// labels then match the list, each for the wrong anchor.
fn counted_apart(labels: &[&str], anchors: &[String]) -> Option<[u32; 2]> {
    if labels.len() != anchors.len() || anchors.len() < 3 {
        return None;
    }
    let begin = |mut numbers: Vec<u32>| {
        numbers.sort_unstable();
        let begin = *numbers.first()?;
        let follow = numbers.windows(2).all(|pair| pair[0].checked_add(1) == Some(pair[1]));
        follow.then_some(begin)
    };
    let listed = begin(anchors.iter().map(|name| number(name)).collect::<Option<_>>()?)?;
    let heard = begin(labels.iter().map(|name| number(name)).collect::<Option<_>>()?)?;
    (listed != heard).then_some([listed, heard])
}

/// The number at the end of a name that otherwise starts with letters alone.
fn number(name: &str) -> Option<u32> {
    let digits = name.trim_start_matches(|letter: char| !letter.is_ascii_digit());
    digits.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_alone_means_an_anchor_only_where_no_name_does() {
        let anchors = ["A0", "A1", "A2"].map(str::to_owned);
        let found = |labels: &[&str]| places(labels, &anchors).ok();
        assert_eq!(found(&["A1", "B1", "a0"]), Some(vec![Some(1), None, Some(0)]));
        assert_eq!(found(&["1", "2"]), Some(vec![Some(1), Some(2)]));
        assert_eq!(found(&["1", "2", "3"]), None, "counted from another number");
        assert_eq!(found(&["B7"]), None);
        assert_eq!(found(&[]), Some(Vec::new()));
    }

    #[test]
    fn labels_are_numbered_as_they_come() {
        let mut labels = Labels::default();
        let numbers = ["b", "a", "b", "c"].map(|label| labels.index(label));
        assert_eq!(numbers, [0, 1, 0, 2]);
        let anchors = ["c", "b"].map(str::to_owned);
        assert_eq!(labels.places(&anchors).ok(), Some(vec![Some(1), None, Some(0)]));
    }
}
