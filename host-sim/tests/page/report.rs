//! The report, and the page of a stream.

use kestirim_telemetry::Imu;

use crate::browser::{Page, Server};
use crate::program::{self, Desk, host_sim};
use crate::sender::{self, frames, send};
use crate::{DRAWN, WIDTHS, assert_quiet, press_buttons, walk};

#[test]
fn the_report_opens_from_the_disk() {
    let desk = Desk::new();
    let folder = desk.named("report");
    let output = host_sim(&["run", "robot", "--trials", "2", "--report", &folder]);
    assert!(output.status.success(), "{}", program::text(&output.stderr));
    let address = format!("file://{folder}/index.html");
    for width in WIDTHS {
        let Some(page) = Page::open(&address, width) else { return };
        // On a page as high as its contents every figure comes into view.
        let picture = format!("report-robot-{width}.png");
        page.screenshot(&format!("report-robot-closed-{width}.png"));
        page.evaluate("document.querySelectorAll('details').forEach(d => { d.open = true; })");
        page.screenshot(&picture);
        page.wait_for(
            "[...document.querySelectorAll('[data-figure]')].every(f => f.querySelector('.main-svg'))",
        );
        page.screenshot(&picture);
        let theme = "document.documentElement.dataset.theme";
        let before = page.evaluate(theme);
        page.evaluate("document.getElementById('theme').click()");
        assert_ne!(page.evaluate(theme), before);
        page.screenshot(&format!("report-robot-dark-{width}.png"));
        press_buttons(&page);
        assert_quiet(&page, &format!("file://{folder}"));
    }
}

#[test]
fn a_stream_is_shown_while_it_comes() {
    let desk = Desk::new();
    let record = desk.named("walk.frames");
    let server = Server::start(&[
        "live",
        "--udp",
        "127.0.0.1:0",
        "--system",
        "pedestrian",
        "--record",
        &record,
        "--port",
        "0",
    ]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    let walk = walk();
    let imu = walk.iter().map(|sample| Imu {
        time_us: sample.time_us,
        specific_force: sample.specific_force.map(|axis| axis as f32),
        angular_rate: sample.angular_rate.map(|axis| axis as f32),
    });
    let bytes = frames(imu);
    let recorded = || sender::length(desk.path("walk.frames").as_path());
    send(server.datagrams(), bytes.chunks(1200), recorded);
    page.wait_for(&format!(
        "document.getElementById('facts').textContent.includes('{}')",
        walk.len()
    ));
    page.wait_for(DRAWN);
    page.screenshot("live-1280.png");
    assert_quiet(&page, server.place());
}
