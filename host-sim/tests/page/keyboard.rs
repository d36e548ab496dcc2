//! Tests of the explorer without a mouse.

use std::collections::BTreeSet;

use crate::browser::{Page, Server};
use crate::{DRAWN, SETTLED, WIDTHS, assert_quiet, explore, systems, text_of};

/// A script that numbers all focusable elements.
const NUMBERED: &str = "(() => { const all = [...document.querySelectorAll('button, input, select, summary, a[href], [tabindex=\"0\"]')] \
    .filter(it => !it.disabled && it.checkVisibility()); all.forEach((it, k) => { it.dataset.stop = k; }); \
    return all.map(it => `${it.tagName} ${it.id} ${it.ariaLabel ?? it.textContent.slice(0, 40)}`).join('\\n'); })()";

/// A script that returns the number of the focused element, and its outline. Between the last element and the first the
/// browser itself has the focus for a moment, in which nothing is outlined yet.
const FOCUSED: &str = "(async () => { \
    const now = () => { const it = document.activeElement; return [it.dataset.stop ?? -1, getComputedStyle(it).outlineStyle]; }; \
    for (let k = 0; k < 100 && now()[1] === 'none' && now()[0] >= 0; k++) await new Promise(it => setTimeout(it, 20)); \
    return now().join(); })()";

/// Presses Tab until an element has the focus.
fn tab_to(page: &Page, selector: &str) {
    let is_there = format!("document.activeElement.matches('{selector}')");
    for _ in 0..500 {
        page.press("Tab");
        if page.evaluate(&is_there) == true {
            return;
        }
    }
    panic!("Tab never leads to {selector}");
}

/// Presses a key and waits until its effect is shown.
fn press_for(page: &Page, key: &str, changed: &str) {
    let before = page.evaluate(changed);
    page.press(key);
    page.wait_for(&format!("{SETTLED} && {changed} !== {before}"));
}

#[test]
fn everything_is_reached_by_tab_and_shows_that_it_is() {
    let server = Server::start(&["serve", "--port", "0"]);
    let wide = systems().iter().map(|system| (*system, 1280));
    for (system, width) in wide.chain([("robot", WIDTHS[1])]) {
        let Some(page) = explore(&server, system, width) else { return };
        page.evaluate("document.querySelectorAll('details').forEach(it => { it.open = true; })");
        let all = page.evaluate(NUMBERED);
        let all: Vec<_> = all.as_str().expect("text").lines().collect();
        assert!(all.len() > 30, "{system}: {all:?}");
        let mut reached = BTreeSet::new();
        // More than two rounds would be a keyboard trap.
        for _ in 0..2 * all.len() {
            page.press("Tab");
            let stop = page.evaluate(FOCUSED);
            let stop = stop.as_str().expect("text").to_owned();
            let Some((stop, outline)) = stop.split_once(',') else { panic!("{stop}") };
            if let Ok(stop) = stop.parse::<usize>() {
                assert_ne!(outline, "none", "{system}: {}", all[stop]);
                if !reached.insert(stop) {
                    break;
                }
            }
        }
        let missed: Vec<_> =
            (0..all.len()).filter(|stop| !reached.contains(stop)).map(|stop| all[stop]).collect();
        assert!(missed.is_empty(), "{system}: Tab never leads to {missed:?}");
    }
}

#[test]
fn a_session_needs_no_mouse() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = explore(&server, "pedestrian", 1280) else { return };
    let facts = "document.getElementById('facts').textContent";
    tab_to(&page, "#bundled");
    press_for(&page, "ArrowDown", facts);
    tab_to(&page, "#control-detector");
    let before = text_of(&page, "facts");
    press_for(&page, "ArrowDown", facts);
    page.press_with_control('z');
    page.wait_for(&format!("{SETTLED} && {facts} === {}", serde_json::json!(before)));
    // A window and a cursor.
    tab_to(&page, "#figure-accelerometer .plot");
    press_for(&page, "+", "location.hash");
    press_for(&page, ".", "location.hash");
    let hash = page.evaluate("location.hash");
    let hash = hash.as_str().expect("text");
    assert!(hash.contains("window=") && hash.contains("cursor="), "{hash}");
    // A series, and a figure as a picture.
    tab_to(&page, ".legend button[aria-pressed=true]");
    press_for(&page, "Enter", "document.querySelectorAll('.legend [aria-pressed=false]').length");
    page.evaluate(
        "Plotly.downloadImage = (figure, how) => Plotly.toImage(figure, how).then(url => { window.given = url; }); 0",
    );
    tab_to(&page, ".legend .give");
    page.press("Enter");
    page.wait_for("window.given?.startsWith('data:image/png;base64,')");
    // A comparison.
    tab_to(&page, "#compare summary");
    page.press("Enter");
    tab_to(&page, "#keep");
    press_for(&page, "Enter", "document.getElementById('kept').textContent");
    tab_to(&page, "#how");
    press_for(&page, "ArrowDown", "location.hash");
    tab_to(&page, "#end");
    press_for(&page, "Enter", "document.getElementById('kept').textContent");
    // A table, its rows and the cursor.
    tab_to(&page, "#table-strides summary");
    page.press("Enter");
    tab_to(&page, "#table-strides tr");
    page.press("ArrowDown");
    press_for(&page, "Enter", "document.querySelector('.clock .told').textContent");
    // Tab returns to the row that it left.
    tab_to(&page, ".clock .play");
    tab_to(&page, "#table-strides tr:nth-child(2)");
    // Own files, and another system.
    tab_to(&page, "#bundled");
    page.press("End");
    for field in ["#any-files", "#any-folder", "#file-log", "#upload"] {
        tab_to(&page, field);
    }
    tab_to(&page, "#system");
    press_for(&page, "ArrowDown", facts);
    page.wait_for(DRAWN);
    assert_quiet(&page, server.place());
}
