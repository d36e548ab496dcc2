//! Tests of the explorer: opening, changing and refusing.

use std::fmt::Write as _;

use host_sim::systems::pedestrian::simulate::sensor::razor_text;

use crate::browser::{Page, Server};
use crate::program::{self, Desk, host_sim};
use crate::{
    DRAWN, SYSTEMS, WIDTHS, assert_quiet, explore, own_files, path, press_buttons, systems, turn,
    walk,
};

#[test]
fn every_system_is_explored_at_both_widths() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        let narrow = width == WIDTHS[1];
        for &system in if narrow { systems() } else { &SYSTEMS } {
            let Some(page) = explore(&server, system, width) else { return };
            assert_eq!(page.evaluate("document.getElementById('system').value"), system);
            assert_eq!(page.evaluate("document.getElementById('alert').textContent"), "");
            let top = page
                .evaluate("document.querySelector('figure').getBoundingClientRect().top + scrollY");
            let top = top.as_f64().expect("a number");
            assert!(top < 844.0, "{system}: the first figure begins at {top} px");
            page.screenshot(&format!("explorer-{system}-{width}.png"));
            if systems().contains(&system) {
                press_buttons(&page);
                page.evaluate("document.getElementById('theme').click()");
                page.screenshot(&format!("explorer-{system}-dark-{width}.png"));
            }
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
    // By keyboard alone: an arrow key moves the focused slider.
    page.evaluate("document.getElementById('control-threshold').focus()");
    let answers = page.evaluate("Number(document.body.dataset.answers)");
    for _ in 0..5 {
        page.press("ArrowRight");
    }
    page.wait_for(&format!(
        "document.body.dataset.answers > {answers} && !document.body.dataset.asking"
    ));
    assert_ne!(path(&page), tenth);
    // A button of the legend hides its series, and a key moves into the figure.
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
    own_files(&page);
    open(&good);
    // The log contains no truth, so no errors are reported.
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
    // The same sentence as on the command line, except for the path of the file.
    let output = host_sim(&["replay", "pedestrian", "--log", &broken]);
    let told = program::text(&output.stderr);
    let told = told.trim_end();
    let told = &told[told.find("broken.txt").expect("the file's name")..];
    assert_eq!(sentence, told);
}

/// Three anchors do not determine the height of the tag beside them: the page points to the control for it, and
/// continues when it is set.
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
        own_files(&page);
        page.choose_file("#file-anchors", &anchors);
        page.choose_file("#file-log", &log);
        page.evaluate("document.getElementById('upload').click()");
        page.wait_for("document.getElementById('alert').textContent.includes('--height')");
        let marks = page.evaluate(asked);
        assert!(marks.as_str().expect("text").split(',').any(|mark| mark == "height"), "{marks}");
        assert_eq!(page.evaluate("document.getElementById('facts').children.length"), 0);
        page.screenshot(&format!("explorer-asked-{width}.png"));
        // First with the slider's initial value, then after moving it.
        page.evaluate("document.querySelector('[data-setting=height] .take').click()");
        page.wait_for(DRAWN);
        assert_eq!(page.evaluate("document.getElementById('alert').textContent"), "");
        assert_eq!(page.evaluate(asked), "");
        let command = "document.getElementById('command').textContent";
        let first = page.evaluate(command);
        assert!(first.as_str().expect("text").contains("--height"), "{first}");
        page.evaluate(&turn("height", "0.5"));
        page.wait_for(&format!("{command}.includes('--height 0.5')"));
        // Refusals are not errors of the page, although the browser logs their status.
        let complaints = page.complaints();
        assert!(complaints.iter().all(|it| it.contains("422")), "{complaints:?}");
    }
}

/// A path is never a thread in an empty field, whatever its shape.
#[test]
fn a_path_fills_its_place_at_any_shape() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        let Some(page) = Page::open(server.address(), width) else { return };
        page.wait_for(DRAWN);
        for [wide, high] in [[21, 3], [3, 21], [1, 1], [16, 9], [100, 1], [1, 100]] {
            let fill = page.evaluate(&format!(
                "(async () => {{ const place = document.createElement('figure'); \
                 document.getElementById('figures').append(place); \
                 const line = {{ type: 'scatter', mode: 'lines', name: 'path', line: {{ color: '#000' }}, \
                 x: [0, {wide}, {wide}, 0, 0], y: [0, 0, {high}, {high}, 0] }}; \
                 await Figures.draw(place, {{ id: 'shape', title: '', caption: '', equal: true, seconds: null, \
                 data: [line], layout: {{ xaxis: {{}}, yaxis: {{ scaleanchor: 'x' }} }} }}); \
                 const plot = place.querySelector('.plot'); const {{ xaxis, yaxis }} = plot._fullLayout; \
                 const [x, y] = [Math.abs(xaxis.l2p({wide}) - xaxis.l2p(0)), Math.abs(yaxis.l2p({high}) - yaxis.l2p(0))]; \
                 const said = [x / (plot.clientWidth - 70), y / (plot.clientHeight - 54), x / {wide} - y / {high}]; \
                 Figures.forget(place); place.remove(); return JSON.stringify(said); }})()"
            ));
            let [x, y, skew]: [f64; 3] =
                serde_json::from_str(fill.as_str().expect("text")).expect("numbers");
            assert!(x.max(y) >= 0.8, "{wide} × {high} m fills {x:.2} × {y:.2} at {width} px");
            assert!(skew.abs() < 0.1, "a metre is as long along both axes");
        }
    }
}
