//! Tests of the common time of a page's figures: a window and a cursor.

use crate::browser::{Page, Server};
use crate::{DRAWN, OVER_TIME, SETTLED, WIDTHS, assert_quiet, explore, systems};

/// The ranges of the axes of all plots over time, in seconds of the bar.
fn ranges(page: &Page) -> Vec<[f64; 2]> {
    let script = format!(
        "JSON.stringify({OVER_TIME}.map(p => p._fullLayout.xaxis.range.map(v => \
         p._fullLayout.xaxis.title.text.endsWith(', h') ? 3600 * v : v)))"
    );
    let text = page.evaluate(&script);
    serde_json::from_str(text.as_str().expect("text")).expect("ranges")
}

/// The number of visible marks of a kind.
fn seen(page: &Page, class: &str) -> Option<u64> {
    page.evaluate(&format!("document.querySelectorAll('.{class}:not([hidden])').length")).as_u64()
}

#[test]
fn one_window_and_one_cursor_hold_for_all_figures_of_every_system() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        for &system in systems() {
            let Some(page) = explore(&server, system, width) else { return };
            let slider = "document.querySelector('.clock input')";
            // The bar by keyboard alone.
            page.evaluate(&format!("{slider}.focus()"));
            page.press("ArrowRight");
            let told = "document.querySelector('.clock .told').textContent";
            page.wait_for(&format!("{told} !== ''"));
            let number = |script: &str| page.evaluate(&format!("Number({script})")).as_f64();
            let [low, high] =
                ["min", "max"].map(|end| number(&format!("{slider}.{end}")).expect("a number"));
            assert!(high > low, "{system}: {low} to {high}");
            let middle = f64::midpoint(low, high);
            let to = |time: f64| {
                format!(
                    "{{ {slider}.value = {time}; {slider}.dispatchEvent(new Event('input')); }}"
                )
            };
            page.evaluate(&to(middle));
            let lines = seen(&page, "cursor").expect("a number");
            assert!(lines >= 2, "{system}: {lines} figures have a cursor");
            let map = page.evaluate("document.querySelectorAll('.plot.map').length > 0");
            if map == true && system != "uav" {
                assert!(
                    seen(&page, "here").expect("a number") > 0,
                    "{system}: no place on the map"
                );
            }
            let values = "[...document.querySelectorAll('.legend .value')].filter(o => o.textContent).length";
            assert!(page.evaluate(values).as_u64() > Some(lines), "{system}: values at the cursor");
            // The window of one figure is that of all, and points are requested once.
            let before = ranges(&page);
            assert!(before.iter().all(|range| *range == before[0]), "{system}: {before:?}");
            let [from, until] = [low + 0.4 * (high - low), low + 0.6 * (high - low)];
            page.evaluate(&format!(
                "{{ const p = {OVER_TIME}.at(-1); const s = p._fullLayout.xaxis.title.text.endsWith(', h') ? 3600 : 1; \
                 Plotly.relayout(p, {{ 'xaxis.range': [{from} / s, {until} / s] }}); }} 0"
            ));
            page.wait_for(SETTLED);
            let after = ranges(&page);
            let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * (high - low);
            for [a, b] in &after {
                assert!(
                    close(*a, from) && close(*b, until),
                    "{system}: {after:?}, not {from} to {until}"
                );
            }
            page.screenshot(&format!("time-{system}-{width}.png"));
            page.evaluate("document.querySelector('.clock .whole').click()");
            page.wait_for(SETTLED);
            assert_eq!(ranges(&page), before, "{system}");
            // Played to the end.
            page.evaluate(&to(low + 0.998 * (high - low)));
            page.evaluate("{ const s = document.querySelector('.clock .speed'); s.value = '100'; document.querySelector('.clock .play').click(); }");
            page.wait_for("document.querySelector('.clock .play').textContent === 'play'");
            let end = number(&format!("{slider}.value")).expect("a number");
            assert!(close(end, high), "{system}: ended at {end}, not {high}");
            assert_quiet(&page, server.place());
        }
    }
}

#[test]
fn mouse_and_keys_move_the_cursor_in_a_figure() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    page.wait_for(&format!("{DRAWN} && {SETTLED}"));
    let told = || page.evaluate("document.querySelector('.clock .told').textContent");
    let point = |kind: &str, event: &str, share: f64| {
        page.evaluate(&format!(
            "{{ const p = document.querySelector('#figure-accelerometer .plot'); const a = p._fullLayout.xaxis; \
             p.dispatchEvent(new PointerEvent('{event}', {{ pointerType: '{kind}', bubbles: true, \
             clientX: p.getBoundingClientRect().left + a._offset + {share} * a._length }})); }}"
        ));
        told()
    };
    let places = [
        point("mouse", "pointermove", 0.25),
        point("touch", "pointerdown", 0.5),
        // A moving finger zooms.
        point("touch", "pointermove", 0.75),
    ];
    assert!(places[0] != "" && places[0] != places[1], "{places:?}");
    assert_eq!(places[1], places[2]);
    page.evaluate("document.querySelector('#figure-accelerometer .plot').focus()");
    page.press(".");
    assert_ne!(told(), places[2]);
}

#[test]
fn the_ellipse_of_a_place_follows_the_cursor() {
    let server = Server::start(&["serve", "--port", "0"]);
    for width in WIDTHS {
        let Some(page) = explore(&server, "robot", width) else { return };
        for id in ["plan", "dilution"] {
            // The distance of its centre from the dot, and its size (px).
            let at = |share: f64| {
                let script = format!(
                    "{{ const s = document.querySelector('.clock input'); \
                     s.value = Number(s.min) + {share} * (s.max - s.min); s.dispatchEvent(new Event('input')); \
                     const box = '#figure-{id} .box '; \
                     const [a, b] = ['.here:not([hidden])', '.ellipses circle'].map(it => \
                     [...document.querySelectorAll(box + it)].at(-1).getBoundingClientRect()); \
                     JSON.stringify([b.x + b.width / 2 - a.x - a.width / 2, b.y + b.height / 2 - a.y - a.height / 2, \
                     b.width, b.height, b.x]) }}"
                );
                let text = page.evaluate(&script);
                let numbers: [f64; 5] =
                    serde_json::from_str(text.as_str().expect("text")).expect("numbers");
                assert!(numbers[..2].iter().all(|off| off.abs() < 1.0), "{id}: {numbers:?}");
                assert!(
                    numbers[2..4].iter().all(|size| (2.0..200.0).contains(size)),
                    "{id}: {numbers:?}"
                );
                numbers
            };
            assert_ne!(at(0.3)[4], at(0.7)[4], "{id}");
        }
        page.screenshot(&format!("time-ellipse-{width}.png"));
        assert_quiet(&page, server.place());
    }
}
