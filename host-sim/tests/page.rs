//! The explorer, the report and the page of a stream in a real browser: Debian's `chromium`, without a window.
//!
//! Screenshots are kept in `target/tmp/screenshots`. Without a browser the tests say SKIPPED, unless
//! `KESTIRIM_REQUIRE_BROWSER` is set.

mod browser;
mod program;
mod sender;

use std::fmt::Write as _;

use browser::{Page, Server};
use host_sim::random::stream;
use host_sim::systems::pedestrian::Sample;
use host_sim::systems::pedestrian::simulate::scenario::Scenario;
use host_sim::systems::pedestrian::simulate::sensor::{measure, razor_text};
use kestirim_telemetry::Imu;
use program::{Desk, host_sim};
use sender::{frames, send};
use serde_json::Value;

/// A desk's screen and a telephone's, px.
const WIDTHS: [u32; 2] = [1280, 390];
/// Everything has been drawn.
const DRAWN: &str = "document.querySelectorAll('figure').length > 0 && \
    [...document.querySelectorAll('figure')].every(f => f.querySelector('.main-svg')) && \
    document.getElementById('facts').children.length > 0";

/// Chooses an option or moves a slider, as a person does.
fn turn(control: &str, value: &str) -> String {
    format!(
        "{{ const c = document.getElementById('control-{control}'); c.value = '{value}'; \
         c.dispatchEvent(new Event('input')); }}"
    )
}

/// A walk through the paper's flat, as the Razor measures it.
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

/// Presses every button of every figure, of which none offers to send the figure away.
fn press_buttons(page: &Page) {
    let buttons = "[...document.querySelectorAll('.modebar-btn')]";
    let titles = page.evaluate(&format!("{buttons}.map(b => b.dataset.title).join()"));
    let titles = titles.as_str().expect("titles");
    assert!(titles.contains("Zoom") && !titles.contains("Share"), "{titles}");
    page.evaluate(&format!("{buttons}.forEach(b => b.click())"));
}

#[test]
fn every_system_is_explored_at_both_widths() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        for system in ["pedestrian", "robot", "drone", "uav", "gnss"] {
            let address = format!("{}#{system}", server.address());
            let Some(page) = Page::open(&address, width) else { return };
            page.wait_for(DRAWN);
            assert_eq!(page.evaluate("document.getElementById('system').value"), system);
            assert_eq!(page.evaluate("document.getElementById('alert').textContent"), "");
            page.screenshot(&format!("explorer-{system}-{width}.png"));
            press_buttons(&page);
            assert_quiet(&page, server.place());
        }
    }
}

#[test]
fn a_slider_moves_and_the_path_changes() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    page.wait_for(DRAWN);
    let adaptive = path(&page);
    page.evaluate(&turn("detector", "magnitude"));
    page.wait_for(&format!("{DRAWN} && document.body.dataset.answers > 1"));
    let tenth = path(&page);
    assert_ne!(adaptive, tenth);
    // With the keyboard alone: an arrow moves the slider that has the focus.
    page.evaluate("document.getElementById('control-threshold').focus()");
    let answers = page.evaluate("Number(document.body.dataset.answers)");
    for _ in 0..5 {
        page.press("ArrowRight");
    }
    page.wait_for(&format!(
        "document.body.dataset.answers > {answers} && !document.body.dataset.asking"
    ));
    assert_ne!(path(&page), tenth);
    // A button of the legend takes its series away, and a key moves into the figure.
    let first = "document.querySelector('#figure-path .legend button')";
    page.evaluate(&format!("{first}.focus()"));
    let before = page.evaluate(&format!("{first}.getAttribute('aria-pressed')"));
    page.press("Enter");
    assert_ne!(page.evaluate(&format!("{first}.getAttribute('aria-pressed')")), before);
    page.evaluate("document.querySelector('#figure-position .plot').focus()");
    let range =
        "JSON.stringify(document.querySelector('#figure-position .plot')._fullLayout.xaxis.range)";
    let before = page.evaluate(range);
    page.press("+");
    page.wait_for(&format!("{range} !== '{}'", before.as_str().expect("a range")));
    page.screenshot("explorer-slider.png");
    assert_quiet(&page, server.place());
}

#[test]
fn a_razors_log_is_opened_damage_told_and_a_broken_one_refused_with_a_sentence() {
    let desk = Desk::new();
    let text = razor_text(&walk());
    let good = desk.file("walk.txt", &text);
    let damaged = desk.file("damaged.txt", format!("{text}17 what\n"));
    let tears = |(index, line)| if index % 50 == 49 { "17 what\n" } else { line };
    let broken: String = text.split_inclusive('\n').enumerate().map(tears).collect();
    let broken = desk.file("broken.txt", broken);
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    let open = |log: &str| {
        page.choose_file("#file-log", log);
        page.evaluate("document.getElementById('upload').click()");
    };
    page.wait_for(DRAWN);
    page.evaluate(
        "{ const b = document.getElementById('bundled'); b.value = ''; b.dispatchEvent(new Event('input')); }",
    );
    open(&good);
    // The log holds no truth: nothing is said of errors.
    page.wait_for(&format!(
        "{DRAWN} && !document.getElementById('facts').textContent.includes('RMSE')"
    ));
    let opened = path(&page);
    open(&damaged);
    let line = text.lines().count() + 1;
    page.wait_for(&format!(
        "document.getElementById('warnings').textContent.includes('line {line}')"
    ));
    assert_eq!(path(&page), opened, "a line that is skipped changes nothing");
    open(&broken);
    page.wait_for("document.getElementById('alert').textContent !== ''");
    let sentence = page.evaluate("document.getElementById('alert').textContent");
    let begin = "broken.txt: expected at most ";
    assert!(sentence.as_str().expect("text").starts_with(begin), "{sentence}");
    // The same sentence as on the command line, but for where the file lies.
    let output = host_sim(&["replay", "pedestrian", "--log", &broken]);
    let told = program::text(&output.stderr);
    let told = told.trim_end();
    let told = &told[told.find("broken.txt").expect("the file's name")..];
    assert_eq!(sentence, told);
    assert_eq!(path(&page), opened, "what was open stays open");
}

/// Three anchors do not tell how high the tag beside them is: the page shows where that is said, and goes on when it is.
#[test]
fn what_a_refusal_asks_for_is_said_on_the_page() {
    let desk = Desk::new();
    let anchors = desk.file("anchors.csv", "anchor,x,y,z\n0,2.8,0,1.3\n1,0.1,0,2\n2,1.9,4.1,2.1\n");
    let mut log = "t,anchor,range\n".to_owned();
    for epoch in 0..50 {
        for (index, [x, y, z]) in
            [[2.8, 0.0, 1.3], [0.1, 0.0, 2.0], [1.9, 4.1, 2.1_f64]].iter().enumerate()
        {
            let range = (x - 3.5_f64).hypot(y - 4.7).hypot(*z);
            let _ = writeln!(log, "{:.1},{index},{range:.3}", 0.1 * f64::from(epoch));
        }
    }
    let log = desk.file("ranges.csv", log);
    let server = Server::start(&["serve", "--port", "0"]);
    let asked = "[...document.querySelectorAll('.asked')].map(p => p.dataset.setting ?? p.dataset.option).join()";
    for width in WIDTHS {
        let address = format!("{}#robot", server.address());
        let Some(page) = Page::open(&address, width) else { return };
        page.wait_for(DRAWN);
        page.evaluate(
            "{ const b = document.getElementById('bundled'); b.value = ''; b.dispatchEvent(new Event('input')); }",
        );
        page.choose_file("#file-anchors", &anchors);
        page.choose_file("#file-log", &log);
        page.evaluate("document.getElementById('upload').click()");
        page.wait_for("document.getElementById('alert').textContent.includes('--height')");
        let marks = page.evaluate(asked);
        assert!(marks.as_str().expect("text").split(',').any(|mark| mark == "height"), "{marks}");
        assert_eq!(page.evaluate("document.getElementById('facts').children.length"), 0);
        page.screenshot(&format!("explorer-asked-{width}.png"));
        // Taken as the slider stands, then as it is moved.
        page.evaluate("document.querySelector('[data-setting=height] .take').click()");
        page.wait_for(DRAWN);
        assert_eq!(page.evaluate("document.getElementById('alert').textContent"), "");
        assert_eq!(page.evaluate(asked), "");
        let command = "document.getElementById('command').textContent";
        let first = page.evaluate(command);
        assert!(first.as_str().expect("text").contains("--height"), "{first}");
        page.evaluate(&turn("height", "0.5"));
        page.wait_for(&format!("{command}.includes('--height 0.5')"));
        // Refusals are no faults of the page, though the browser notes their status.
        let complaints = page.complaints();
        assert!(complaints.iter().all(|it| it.contains("422")), "{complaints:?}");
    }
}

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

/// How long a slider takes from its movement until everything is drawn, on a log of two minutes at 200 Hz.
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
}
