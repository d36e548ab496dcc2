//! `host-sim list`: the systems, with their recordings.

use comfy_table::presets::NOTHING;

use crate::output;
use crate::system::AnySystem;
use crate::systems::ALL;

/// A description of all systems.
pub(super) fn list() -> String {
    ALL.iter().map(|system| describe(*system)).collect::<Vec<_>>().join("\n")
}

fn describe(system: &dyn AnySystem) -> String {
    let mut table = output::table();
    table.load_style(NOTHING);
    table.add_row([system.name(), system.title()]);
    for (name, label) in system.synthetic() {
        table.add_row([format!("  synthetic {name}"), (*label).to_owned()]);
    }
    for field in system.files() {
        let optional = if field.required { "" } else { " (optional)" };
        table.add_row([format!("  --{}", field.name), format!("{}{optional}", field.help)]);
    }
    if let Some(names) = table.column_mut(0) {
        names.set_padding((0, 1));
    }
    format!("{}\n", table.trim_fmt())
}
