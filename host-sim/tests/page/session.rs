//! Tests of a session that can be kept: its address, undo, comparison and downloads.

use std::fs;

use host_sim::systems::pedestrian::simulate::sensor::razor_text;

use crate::browser::{Page, Server};
use crate::program::Desk;
use crate::{DRAWN, SETTLED, assert_quiet, explore, own_files, systems, text_of, walk};

/// An expression for the control that a test moves: the first slider that has an effect.
const SLIDER: &str =
    "[...document.querySelectorAll('#controls input[type=range]')].find(r => !r.disabled)";

/// Moves the slider by a number of steps, and waits until everything is drawn.
fn turn_by(page: &Page, steps: i32) {
    let command = text_of(page, "command");
    page.evaluate(&format!(
        "{{ const r = {SLIDER}; const b = r.value; if ({steps} > 0) r.stepUp({steps}); else r.stepDown(-({steps})); if (r.value === b) r.stepUp({steps}); \
         r.dispatchEvent(new Event('input')); }}"
    ));
    page.wait_for(&format!(
        "{SETTLED} && document.getElementById('command').textContent !== {}",
        serde_json::json!(command)
    ));
}

fn press(page: &Page, id: &str) {
    page.evaluate(&format!("document.getElementById('{id}').click()"));
}

/// The visible state of a session: command, window, cursor, facts.
fn picture(page: &Page) -> [String; 4] {
    let window = "[document.querySelector('.clock input').min, document.querySelector('.clock input').max].join()";
    let cursor = "document.querySelector('.clock .told').textContent";
    let [window, cursor] =
        [window, cursor].map(|script| page.evaluate(script).as_str().expect("text").to_owned());
    [text_of(page, "command"), window, cursor, text_of(page, "facts")]
}

/// The address once it has been updated.
fn address(page: &Page) -> String {
    std::thread::sleep(std::time::Duration::from_millis(400));
    page.evaluate("location.hash").as_str().expect("text").to_owned()
}

#[test]
fn an_address_shows_the_same_picture_and_undo_goes_back_for_every_system() {
    let server = Server::start(&["serve", "--port", "0"]);
    for &system in systems() {
        let Some(page) = explore(&server, system, 1280) else { return };
        let first = picture(&page);
        turn_by(&page, 3);
        page.evaluate(
            "{ const c = document.querySelector('.clock input'); const [a, b] = [Number(c.min), Number(c.max)]; \
             c.value = (a + b) / 2; c.dispatchEvent(new Event('input')); \
             const p = [...document.querySelectorAll('.plot')].filter(p => p.parentNode.querySelector('.cursor'))[0]; \
             const s = p._fullLayout.xaxis.range[1] / b; \
             Plotly.relayout(p, { 'xaxis.range': [s * (0.7 * a + 0.3 * b), s * (0.3 * a + 0.7 * b)] }); } 0",
        );
        page.wait_for(SETTLED);
        let (kept, address) = (picture(&page), address(&page));
        assert!(kept[0] != first[0] && kept[1] != first[1], "{system}: {kept:?}");
        assert!(address.starts_with(&format!("#{system}?")), "{address}");
        page.evaluate("location.reload()");
        page.wait_for(&format!("performance.getEntriesByType('navigation')[0].type === 'reload' && {DRAWN} && {SETTLED}"));
        assert_eq!(picture(&page), kept, "{system}: reloaded");
        let pasted =
            Page::open(&format!("{}{address}", server.address()), 1280).expect("a browser");
        pasted.wait_for(&format!("{DRAWN} && {SETTLED}"));
        assert_eq!(picture(&pasted), kept, "{system}: pasted");
        assert_quiet(&pasted, server.place());
        // An opened address has nothing to undo before the first change.
        assert_eq!(page.evaluate("document.getElementById('undo').disabled"), true);
        turn_by(&page, 2);
        let turned = text_of(&page, "command");
        press(&page, "undo");
        page.wait_for(SETTLED);
        assert_eq!(picture(&page), kept, "{system}: undone");
        press(&page, "redo");
        page.wait_for(SETTLED);
        assert_eq!(text_of(&page, "command"), turned, "{system}: done again");
        assert_quiet(&page, server.place());
    }
}

#[test]
fn two_settings_are_compared_over_each_other_and_as_a_difference_for_every_system() {
    let server = Server::start(&["serve", "--port", "0"]);
    for &system in systems() {
        let Some(page) = explore(&server, system, 1280) else { return };
        let alone = page.evaluate("document.querySelectorAll('.legend button').length");
        press(&page, "keep");
        page.wait_for(SETTLED);
        turn_by(&page, -5);
        let names = "[...document.querySelectorAll('.legend button')].map(b => b.firstChild.data)";
        for letter in ["A", "B"] {
            assert_eq!(
                page.evaluate(&format!("{names}.some(n => n.startsWith('{letter}: '))")),
                true,
                "{system}, {}: {}",
                text_of(&page, "command"),
                page.evaluate(&format!("{names}.join()"))
            );
        }
        assert!(page.evaluate(&format!("{names}.length")).as_u64() > alone.as_u64(), "{system}");
        let rows = "[...document.querySelectorAll('#changed tbody tr')].map(r => r.textContent)";
        assert_eq!(page.evaluate(&format!("{rows}.some(r => r.includes('--'))")), true, "{system}");
        page.screenshot(&format!("compare-{system}-1280.png"));
        page.evaluate("{ const h = document.getElementById('how'); h.value = 'difference'; h.dispatchEvent(new Event('input')); }");
        page.wait_for(&format!("{SETTLED} && [...document.querySelectorAll('.plot')].some(p => p._fullLayout?.yaxis.title.text.startsWith('difference'))"));
        page.screenshot(&format!("difference-{system}-1280.png"));
        let pasted = Page::open(&format!("{}{}", server.address(), address(&page)), 1280)
            .expect("a browser");
        pasted.wait_for(&format!("{DRAWN} && {SETTLED}"));
        assert_eq!(pasted.evaluate(rows), page.evaluate(rows), "{system}: pasted");
        // Swapping makes B the new A and sets the settings of the old A.
        let b = text_of(&page, "command");
        press(&page, "swap");
        page.wait_for(SETTLED);
        assert_ne!(text_of(&page, "command"), b, "{system}");
        press(&page, "end");
        page.wait_for(SETTLED);
        assert_eq!(
            page.evaluate("document.querySelectorAll('.legend button').length"),
            alone,
            "{system}"
        );
        assert_quiet(&page, server.place());
    }
}

#[test]
fn every_download_of_every_system_is_what_it_is_called() {
    let desk = Desk::new();
    let server = Server::start(&["serve", "--port", "0"]);
    for &system in systems() {
        let Some(page) = explore(&server, system, 1280) else { return };
        // The contents of downloads are intercepted instead of saved.
        page.evaluate(
            "window.given = {}; let last; URL.createObjectURL = blob => { last = blob; return '#'; }; \
             HTMLAnchorElement.prototype.click = function () { given[this.download] = last.text(); }; \
             document.querySelectorAll('#downloads .give, figcaption .give').forEach(b => b.click())",
        );
        let buttons =
            page.evaluate("document.querySelectorAll('#downloads .give, figcaption .give').length");
        page.wait_for(&format!("Object.keys(given).length === {buttons}"));
        let names = page.evaluate("Object.keys(given).join()");
        let names: Vec<_> = names.as_str().expect("text").split(',').collect();
        for name in ["track.csv", "streams.mcap", "session.html"] {
            assert!(names.iter().any(|known| known.ends_with(&format!("-{name}"))), "{names:?}");
        }
        for name in names {
            let content = page.evaluate(&format!("given['{name}']"));
            let content = content.as_str().expect("text");
            let begins = match name.rsplit_once('.').expect("an ending").1 {
                "csv" if name.contains("-figure-") => "series,x,y,error",
                "csv" if name.ends_with("-strides.csv") => "stride,t,",
                "csv" => "t,",
                "pos" => "%",
                "nmea" => "$G",
                "kml" | "gpx" => "<?xml",
                "mcap" => "\u{fffd}MCAP",
                "html" => "<!DOCTYPE html>",
                "svg" => "<svg",
                other => panic!("{other}"),
            };
            assert!(content.starts_with(begins) && content.len() > 100, "{name}: {content:.100}");
            if name.ends_with("session.html") {
                let path = desk.file(&format!("{system}.html"), content);
                let session = Page::open(&format!("file://{path}"), 1280).expect("a browser");
                session.screenshot(&format!("session-{system}-1280.png"));
                session.wait_for("document.querySelectorAll('figure .main-svg').length > 0");
                assert_eq!(
                    session.evaluate("document.querySelectorAll('.clock:not([hidden])').length"),
                    1
                );
                assert_quiet(&session, &format!("file://{path}"));
            }
        }
    }
}

#[test]
fn uploaded_files_are_found_again_by_their_address_and_a_failed_upload_clears_what_it_replaces() {
    let desk = Desk::new();
    let log = desk.file("walk.txt", razor_text(&walk()));
    let broken = desk.file("broken.txt", "17 what\n".repeat(100));
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = Page::open(server.address(), 1280) else { return };
    page.wait_for(&format!("{DRAWN} && {SETTLED}"));
    let choose = |file: &str| {
        own_files(&page);
        page.choose_file("#file-log", file);
        press(&page, "upload");
    };
    turn_by(&page, 3);
    let setting = page.evaluate(&format!("{SLIDER}.value"));
    choose(&log);
    page.wait_for(&format!(
        "{SETTLED} && document.getElementById('command').textContent.includes('walk.txt')"
    ));
    assert_eq!(
        page.evaluate(&format!("{SLIDER}.value")),
        setting,
        "a recording chosen anew keeps the settings"
    );
    let (kept, here) = (picture(&page), address(&page));
    let hash = here.split(['=', '&']).nth(1).expect("a recording");
    assert!(hash.len() == 32 && !here.contains("walk"), "{here}");
    page.evaluate("location.reload()");
    page.wait_for(&format!(
        "performance.getEntriesByType('navigation')[0].type === 'reload' && {DRAWN} && {SETTLED}"
    ));
    assert_eq!(picture(&page), kept);
    // The same bytes have the same address, whatever was open in between.
    choose(&broken);
    page.wait_for("document.getElementById('alert').textContent !== ''");
    let left = "document.getElementById('facts').children.length + document.querySelectorAll('figure').length";
    assert_eq!(page.evaluate(left), 0, "nothing of the last file stays under the error");
    choose(&log);
    page.wait_for(&format!("{DRAWN} && {SETTLED}"));
    assert_eq!(picture(&page)[0], kept[0]);
    assert!(address(&page).contains(hash));
    // Another instance of the program does not know the upload.
    let other = Server::start(&["serve", "--port", "0"]);
    let pasted = Page::open(&format!("{}{here}", other.address()), 1280).expect("a browser");
    pasted.wait_for("document.getElementById('alert').textContent.includes('open them again')");
    assert_eq!(pasted.evaluate("document.getElementById('files').hidden"), false);
    assert!(fs::exists(&log).expect("a folder"));
}
