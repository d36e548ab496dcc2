//! Tests of the report.

use crate::browser::Page;
use crate::program::{self, Desk, host_sim};
use crate::{WIDTHS, assert_quiet, press_buttons};

#[test]
fn the_report_opens_from_the_disk() {
    let desk = Desk::new();
    let folder = desk.named("report");
    let output = host_sim(&["run", "robot", "--trials", "2", "--report", &folder]);
    assert!(output.status.success(), "{}", program::text(&output.stderr));
    let address = format!("file://{folder}/index.html");
    for width in WIDTHS {
        let Some(page) = Page::open(&address, width) else { return };
        page.screenshot(&format!("report-robot-closed-{width}.png"));
        page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })");
        page.unfold();
        page.wait_for(
            "[...document.querySelectorAll('[data-figure]')].every(f => f.querySelector('.main-svg'))",
        );
        page.screenshot(&format!("report-robot-{width}.png"));
        let theme = "document.documentElement.dataset.theme";
        let before = page.evaluate(theme);
        page.evaluate("document.getElementById('theme').click()");
        assert_ne!(page.evaluate(theme), before);
        page.screenshot(&format!("report-robot-dark-{width}.png"));
        press_buttons(&page);
        assert_quiet(&page, &format!("file://{folder}"));
    }
}
