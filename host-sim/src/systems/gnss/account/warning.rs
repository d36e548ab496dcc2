//! Warnings of several filters.

use kestirim_replay::gnss::{FilterKind, Followed};

/// The warnings of all filters, with the names of the filters unless a warning applies to all.
pub(super) fn of_all(followed: &[(FilterKind, Followed)]) -> Vec<String> {
    let mut sentences: Vec<(String, Vec<&str>)> = Vec::new();
    for (filter, followed) in followed {
        for warning in followed.warnings() {
            match sentences.iter_mut().find(|(sentence, _)| *sentence == warning) {
                Some((_, names)) => names.push(filter.name()),
                None => sentences.push((warning, vec![filter.name()])),
            }
        }
    }
    let named = |(sentence, names): (String, Vec<&str>)| {
        if names.len() == followed.len() {
            sentence
        } else {
            format!("{}: {sentence}", names.join(", "))
        }
    };
    sentences.into_iter().map(named).collect()
}
