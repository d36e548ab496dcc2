//! The human-readable table.

use comfy_table::CellAlignment;
use host_sim::output::table;

use crate::row::Row;

/// Formats the rows, workload by workload.
pub fn of(rows: &[Row]) -> String {
    let mut table = table();
    table.set_header([
        "workload",
        "scalar",
        "target",
        "opt",
        "instructions",
        "min",
        "max",
        "flash B",
        "RAM B",
        "object B",
        "stack B",
        "panics",
        "doubles",
    ]);
    let mut rows: Vec<_> = rows.iter().collect();
    rows.sort_by_key(|row| row.key());
    for row in rows {
        let mut cells: Vec<String> = row.key().iter().map(ToString::to_string).collect();
        cells.push(format!("{:.0}", row.instructions_mean));
        cells.extend([row.instructions_min, row.instructions_max].map(|count| count.to_string()));
        cells.push(row.flash_bytes.to_string());
        cells.extend(
            [row.ram_bytes, row.object_bytes, row.stack_bytes].map(|bytes| bytes.to_string()),
        );
        cells.extend([row.panic_symbols, row.double_symbols].map(|count| count.to_string()));
        table.add_row(cells);
    }
    for column in table.column_iter_mut().skip(4) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table.to_string()
}
