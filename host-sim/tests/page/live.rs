//! Tests of the page of a stream: live, at an earlier moment, and with other settings.

use kestirim_telemetry::Imu;

use crate::browser::{Page, Server};
use crate::program::Desk;
use crate::sender::{self, frames, send};
use crate::{DRAWN, assert_quiet, walk};

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
    let fact = |name: &str| {
        let fact = format!(
            "[...document.querySelectorAll('#facts div')].find(d => d.firstChild.textContent === '{name}')"
        );
        page.evaluate(&format!("{fact}.lastChild.textContent"))
    };
    let pressed = |is: &str| format!("document.getElementById('pause').textContent === '{is}'");
    let received = || fact("frames received").as_str().and_then(|it| it.parse::<usize>().ok());
    let all = received();
    assert_eq!(all, Some(walk.len()));
    // Half of the stream gives the state halfway.
    page.evaluate("{ const a = document.getElementById('after'); a.value = a.max / 2; a.dispatchEvent(new Event('input')); }");
    page.wait_for(&pressed("go on"));
    page.wait_for("document.getElementById('of').textContent === '50 %'");
    let half = received().expect("a number");
    assert!(half.abs_diff(walk.len() / 2) < walk.len() / 50, "{half} of {}", walk.len());
    page.screenshot("live-back-1280.png");
    let before = fact("position");
    page.evaluate("document.getElementById('pause').click()");
    page.wait_for(&pressed("pause"));
    page.wait_for("document.getElementById('of').textContent === '100 %'");
    assert_eq!(received(), all);
    assert_ne!(fact("position"), before);
    // Other settings are applied from the beginning of the stream.
    let now = fact("position");
    page.evaluate(
        "{ const e = document.getElementById('control-tracker'); \
         e.value = [...e.options].find(o => !o.selected).value; e.dispatchEvent(new Event('input')); }",
    );
    page.wait_for(&format!(
        "[...document.querySelectorAll('#facts dd')].every(d => d.textContent !== {now})"
    ));
    assert_eq!(received(), all);
    // A stream has no undo.
    assert_eq!(page.evaluate("document.getElementById('undo').checkVisibility()"), false);
    assert_quiet(&page, server.place());
}
