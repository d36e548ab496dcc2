//! Tests of the explorer, the report and the page of a stream in a real browser: Debian's `chromium-headless-shell`
//! or `chromium`.
//!
//! Screenshots are kept in `target/tmp/screenshots`. Without a browser the tests report SKIPPED, unless
//! `KESTIRIM_REQUIRE_BROWSER` is set.

#[path = "../browser/mod.rs"]
mod browser;
mod explorer;
mod files;
mod keyboard;
mod live;
#[path = "../program/mod.rs"]
mod program;
mod report;
#[path = "../sender/mod.rs"]
mod sender;
mod session;
mod speed;
mod tables;
mod time;

use browser::{Page, Server};
use host_sim::random::stream;
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::measure;
use serde_json::Value;

/// The widths of a desktop screen and of a phone (px).
const WIDTHS: [u32; 2] = [1280, 390];
/// The condition that everything has been drawn.
const DRAWN: &str = "document.querySelectorAll('figure').length > 0 && \
    [...document.querySelectorAll('figure')].every(f => f.querySelector('.main-svg')) && \
    document.getElementById('facts').children.length > 0";

const SYSTEMS: [&str; 5] = ["pedestrian", "robot", "drone", "uav", "gnss"];

/// The systems whose pages are tested completely: all, and in the short form (`KESTIRIM_SHORT=1`) one with a map and
/// one with figures over time, as the pages share their code.
fn systems() -> &'static [&'static str] {
    if program::is_short() { &["robot", "uav"] } else { &SYSTEMS }
}

/// A script that chooses an option or moves a slider as a user does.
fn turn(control: &str, value: &str) -> String {
    format!(
        "{{ const c = document.getElementById('control-{control}'); c.value = '{value}'; \
         c.dispatchEvent(new Event('input')); }}"
    )
}

/// A walk through the paper's flat, as measured by the Razor.
fn walk() -> Vec<Sample> {
    let mut rng = stream(4, 0);
    let ideal = Scenario::draw(&mut rng).ideal_imu(100.0);
    measure(&mut rng, &ideal, 100.0)
}

/// The points of the tracker's path as drawn.
fn path(page: &Page) -> Value {
    page.evaluate(
        "JSON.stringify(document.querySelector('#figure-path .plot').data.find(s => s.name === 'ours').x)",
    )
}

fn assert_quiet(page: &Page, address: &str) {
    assert_eq!(page.complaints(), [""; 0]);
    for request in page.requests() {
        let inside = request.starts_with(address)
            || request.starts_with("data:")
            || request.starts_with("blob:");
        assert!(inside, "the page asked for {request}");
    }
    let wide = "document.documentElement.scrollWidth <= document.documentElement.clientWidth";
    assert_eq!(page.evaluate(wide), true, "the page is wider than its window");
}

/// Presses every button of every figure, after checking that none offers to send the figure away.
fn press_buttons(page: &Page) {
    let buttons = "[...document.querySelectorAll('.modebar-btn')]";
    let titles = page.evaluate(&format!("{buttons}.map(b => b.dataset.title).join()"));
    let titles = titles.as_str().expect("titles");
    assert!(titles.contains("Zoom") && !titles.contains("Share"), "{titles}");
    page.evaluate(&format!("{buttons}.forEach(b => b.click())"));
}

/// The condition that every request has been answered.
const SETTLED: &str = "document.body.dataset.answers > 0 && !document.body.dataset.asking";
/// An expression for the plots over time.
const OVER_TIME: &str =
    "[...document.querySelectorAll('.plot')].filter(p => p.parentNode.querySelector('.cursor'))";

/// The text of an element.
fn text_of(page: &Page, id: &str) -> String {
    let text = page.evaluate(&format!("document.getElementById('{id}').textContent"));
    text.as_str().expect("text").to_owned()
}

/// Opens the explorer with a system and waits until everything is drawn; `None` without a browser.
fn explore(server: &Server, system: &str, width: u32) -> Option<Page> {
    let page = Page::open(&format!("{}#{system}", server.address()), width)?;
    page.wait_for(&format!("{DRAWN} && {SETTLED}"));
    Some(page)
}

/// Selects the opening of own files.
fn own_files(page: &Page) {
    page.evaluate(
        "{ const b = document.getElementById('bundled'); b.value = ''; b.dispatchEvent(new Event('input')); }",
    );
}
