//! Tests of the tables beside the figures.

use crate::browser::{Page, Server};
use crate::{DRAWN, SETTLED, WIDTHS, assert_quiet, explore, text_of, turn};

const ROWS: &str = "[...document.querySelectorAll('#table-strides tr[data-time]')]";
const MARKED: &str = "document.querySelectorAll('#table-strides tr[aria-current]')";

fn number(page: &Page, script: &str) -> f64 {
    page.evaluate(&format!("Number({script})")).as_f64().expect("a number")
}

#[test]
fn the_row_at_the_cursor_is_marked_and_a_row_moves_the_cursor() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        let Some(page) = explore(&server, "pedestrian", width) else { return };
        let rows = format!("{ROWS}.length");
        assert_eq!(page.evaluate(&rows), 0, "nobody looks yet");
        page.evaluate("document.querySelector('#table-strides summary').click()");
        page.wait_for(&format!("{rows} > 5"));
        let slider = "document.querySelector('.clock input')";
        let time = |row: u32| number(&page, &format!("{ROWS}[{row}].dataset.time"));
        let assert_at = |row: u32| {
            // The bar has a thousand steps.
            let step = number(&page, &format!("{slider}.step"));
            let off = number(&page, &format!("{slider}.value")) - time(row);
            assert!(off.abs() <= step, "row {row}: {off} s off");
            assert_eq!(page.evaluate(&format!("{MARKED}.length")), 1);
            assert_eq!(page.evaluate(&format!("{ROWS}.indexOf({MARKED}[0])")), row);
        };
        page.evaluate(&format!(
            "{{ {slider}.value = {}; {slider}.dispatchEvent(new Event('input')); }}",
            time(3)
        ));
        assert_at(3);
        page.evaluate(&format!("{ROWS}[5].cells[2].click()"));
        assert_at(5);
        page.evaluate(&format!("{ROWS}[0].focus()"));
        page.press("ArrowDown");
        page.press("Enter");
        assert_at(1);
        // A comparison shows the rows of B; other settings give other rows.
        page.evaluate("document.getElementById('keep').click()");
        let title = "document.querySelector('#table-strides summary').textContent";
        page.wait_for(&format!("{SETTLED} && {title} === 'Strides, of B'"));
        let content = format!("{ROWS}.map(r => r.textContent).join()");
        let (before, command) = (page.evaluate(&content), text_of(&page, "command"));
        page.evaluate(&turn("tracker", "lite"));
        page.wait_for(&format!(
            "{SETTLED} && {DRAWN} && document.getElementById('command').textContent !== {}",
            serde_json::json!(command)
        ));
        assert_ne!(page.evaluate(&content), before);
        assert_quiet(&page, server.place());
        page.screenshot(&format!("tables-{width}.png"));
    }
}
