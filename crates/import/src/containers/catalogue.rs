//! The topics of a file: the wanted ones with their data, and the names of the others.

use std::collections::{BTreeMap, BTreeSet};

use super::chunks::Announced;
use crate::error::listed;

/// The largest number of topics whose names are kept for error messages.
pub(super) const MOST_NAMES: usize = 100;

/// Topics by name and type.
#[derive(Debug)]
pub(super) struct Catalogue<T> {
    pub(super) topics: Vec<T>,
    places: BTreeMap<(String, String), usize>,
    others: BTreeSet<String>,
}

impl<T> Default for Catalogue<T> {
    fn default() -> Self {
        Self { topics: Vec::new(), places: BTreeMap::new(), others: BTreeSet::new() }
    }
}

impl<T> Catalogue<T> {
    /// The index of a topic; one that was not announced before is added if `wanted` returns it.
    pub(super) fn place(
        &mut self,
        announced: &Announced<'_>,
        wanted: impl FnOnce() -> Option<T>,
    ) -> Option<usize> {
        let key = (announced.name.to_owned(), announced.kind.to_owned());
        if let Some(&place) = self.places.get(&key) {
            return Some(place);
        }
        let Some(topic) = wanted() else {
            if self.others.len() < MOST_NAMES {
                self.others.insert(format!("{} ({})", announced.name, announced.kind));
            }
            return None;
        };
        self.places.insert(key, self.topics.len());
        self.topics.push(topic);
        Some(self.topics.len() - 1)
    }

    /// The topics that are not wanted, with their types.
    pub(super) fn others(&self) -> impl ExactSizeIterator<Item = &str> {
        self.others.iter().map(String::as_str)
    }

    /// The topics that are not wanted, as a list for a sentence.
    pub(super) fn listed_others(&self) -> String {
        listed(self.others())
    }
}
