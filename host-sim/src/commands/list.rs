//! `host-sim list`: the systems, with their recordings.

use std::fmt::Write;

use crate::system::AnySystem;
use crate::systems::ALL;

/// What there is.
pub(super) fn list() -> String {
    ALL.iter().map(|system| describe(*system)).collect::<Vec<_>>().join("\n")
}

fn describe(system: &dyn AnySystem) -> String {
    let mut text = format!("{:<12}{}\n", system.name(), system.title());
    for (name, label) in system.synthetic() {
        // Writing to a string never fails.
        let _ = writeln!(text, "  synthetic {name}: {label}");
    }
    for field in system.files() {
        let optional = if field.required { "" } else { " (optional)" };
        let _ = writeln!(text, "  --{:<9} {}{optional}", field.name, field.help);
    }
    text
}
