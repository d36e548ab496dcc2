//! Calls everything of `kestirim-health`.

use kestirim_health::{Health, Reason, State};

use super::values::{any, call_each, keep, one_of, whole, yes_or_no};

fn reason() -> Reason {
    one_of(Reason::ALL)
}

fn words() {
    keep(State::word(one_of([State::Good, State::Degraded, State::Bad])));
    keep(Reason::state(reason()));
    keep(Reason::words(reason()));
}

fn healths() {
    let mut health = any(Health::from(reason()));
    Health::add(&mut health, reason());
    let health = any(Health::with(health, reason(), yes_or_no()));
    let both = any(Health::and(health, Health::from_iter([reason(), reason()])));
    keep(Health::has(both, reason()));
    keep(Health::state(both));
    Health::reasons(both).for_each(keep);
    keep(Health::bits(both));
    keep(Health::from_bits(whole()));
}

/// Calls everything in this module.
pub fn run() {
    call_each([words, healths]);
}
