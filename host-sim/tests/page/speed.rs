//! Measurements of the page's speed.

use std::time::Instant;

use host_sim::random::stream;
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::{measure, razor_text};

use crate::browser::{Page, Server};
use crate::program::Desk;
use crate::{DRAWN, own_files, turn};

/// The time from the movement of a slider until everything is drawn, for a log of two minutes at 200 Hz.
#[test]
#[ignore = "a measurement: cargo test --release -p host-sim --test page -- --ignored --nocapture"]
fn a_slider_answers_at_once() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    page.wait_for(DRAWN);
    page.evaluate(
        "{ const b = document.getElementById('bundled'); b.value = 'two-minutes'; b.dispatchEvent(new Event('input')); }",
    );
    page.wait_for("document.body.dataset.answers > 1 && !document.body.dataset.asking");
    page.evaluate(&turn("detector", "magnitude"));
    let mut times = Vec::new();
    for step in 0..20 {
        page.wait_for("!document.body.dataset.asking");
        page.evaluate(&turn("threshold", &format!("{:.2}", 0.1 + 0.01 * f64::from(step))));
        page.wait_for("!document.body.dataset.asking");
        times.push(
            page.evaluate("Number(document.body.dataset.milliseconds)").as_f64().expect("ms"),
        );
    }
    times.sort_by(f64::total_cmp);
    println!("slider to picture: median {} ms, worst {} ms", times[10], times[19]);
    assert!(times[19] < 200.0, "{times:?}");
    let plot = "document.querySelector('#figure-velocity .plot')";
    let zooms =
        repeated(&page, &format!("Plotly.relayout({plot}, {{ 'xaxis.range': [5 + i, 25 + i] }})"));
    page.wait_for("!document.body.dataset.asking");
    println!("finer points of it: {} ms", page.evaluate("document.body.dataset.milliseconds"));
    let bar = "document.querySelector('.clock input')";
    let cursors = repeated(
        &page,
        &format!("{{ {bar}.value = 20 + i; {bar}.dispatchEvent(new Event('input')); }}"),
    );
    println!("zoom to picture: median {} ms, worst {} ms", zooms[10], zooms[19]);
    println!("cursor to picture: median {} ms, worst {} ms", cursors[10], cursors[19]);
}

/// The times (ms), sorted, that twenty repetitions of an action with a number `i` take until they are laid out.
fn repeated(page: &Page, action: &str) -> Vec<f64> {
    let times = page.evaluate(&format!(
        "(async () => {{ const times = []; \
         for (let i = 0; i < 20; i++) {{ await new Promise(r => setTimeout(r, 300)); \
         const began = performance.now(); {action}; document.body.offsetHeight; times.push(performance.now() - began); }} \
         return JSON.stringify(times.sort((a, b) => a - b)); }})()"
    ));
    serde_json::from_str(times.as_str().expect("text")).expect("numbers")
}

/// Two hours at 400 Hz, by repeating one walk.
fn two_hours() -> Vec<Sample> {
    let mut rng = stream(4, 0);
    let ideal = Scenario::draw(&mut rng).ideal_imu(400.0);
    let walk = measure(&mut rng, &ideal, 400.0);
    let length_us = walk.last().map_or(0, |sample| sample.time_us) + 2500;
    let laps = 7_200_000_000 / length_us;
    let again = |lap: u64| {
        walk.iter().map(move |it| Sample { time_us: it.time_us + lap * length_us, ..*it })
    };
    (0..laps).flat_map(again).collect()
}

/// The times of several actions for a log of two hours at 400 Hz.
#[test]
#[ignore = "a measurement: cargo test --release -p host-sim --test page -- --ignored --nocapture"]
fn two_hours_are_looked_at() {
    let desk = Desk::new();
    let samples = two_hours();
    println!("{} samples", samples.len());
    let log = desk.file("hours.txt", razor_text(&samples));
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    page.wait_for(DRAWN);
    own_files(&page);
    page.choose_file("#file-log", &log);
    let begun = Instant::now();
    page.evaluate("document.getElementById('upload').click()");
    page.wait_for("document.getElementById('command').textContent.includes('hours.txt') && !document.body.dataset.asking");
    println!("opened in {:.1} s", begun.elapsed().as_secs_f64());
    let taken =
        || page.evaluate("Number(document.body.dataset.milliseconds)").as_f64().expect("ms");
    let (mut sliders, mut zooms) = (Vec::new(), Vec::new());
    for step in 0..5_u32 {
        // The sliders are moved while the whole time is shown.
        page.evaluate("document.querySelector('.clock .whole').click()");
        page.wait_for("!document.body.dataset.asking");
        page.evaluate(&turn("contact-height", &format!("{:.2}", 0.05 + 0.01 * f64::from(step))));
        page.wait_for("!document.body.dataset.asking");
        sliders.push(taken());
        let from = 1000 * step;
        page.evaluate(&format!(
            "Plotly.relayout(document.querySelector('#figure-velocity .plot'), {{ 'xaxis.range': [{from}, {from} + 60] }}); 0"
        ));
        page.wait_for("!document.body.dataset.asking");
        zooms.push(taken());
    }
    println!("sliders {sliders:?} ms, zooms {zooms:?} ms");
    for times in [&mut sliders, &mut zooms] {
        times.sort_by(f64::total_cmp);
    }
    println!("slider: median {} ms; zoom: median {} ms", sliders[2], zooms[2]);
    assert!(zooms[2] < 0.1 * sliders[2], "{sliders:?} {zooms:?}");
}
