//! Tests of files dropped on the explorer, whose system is recognised.

use std::fmt::Write as _;
use std::io::{Cursor, Write as _};

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use host_sim::systems::pedestrian::simulate::sensor::razor_text;
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use crate::browser::{Page, Server};
use crate::{DRAWN, SETTLED, assert_quiet, explore, text_of, walk};

/// Drops files on the page.
fn drop_files(page: &Page, files: &[(&str, &[u8])]) {
    let files: Vec<_> =
        files.iter().map(|(name, bytes)| (name, BASE64_STANDARD.encode(bytes))).collect();
    let files = serde_json::json!(files);
    page.evaluate(&format!(
        "{{ const t = new DataTransfer(); for (const [n, b] of {files}) \
         t.items.add(new File([Uint8Array.from(atob(b), (c) => c.charCodeAt(0))], n)); \
         dispatchEvent(new DragEvent('drop', {{ dataTransfer: t, cancelable: true }})); }}"
    ));
}

/// Waits until a recording of a system is drawn whose command names the log `file`.
fn wait_for(page: &Page, system: &str, file: &str) {
    page.wait_for(&format!(
        "{DRAWN} && {SETTLED} && document.getElementById('command').textContent.includes('replay {system}') && \
         document.getElementById('command').textContent.includes('{file}')"
    ));
}

/// Anchors, ranges and truth of a stationary tag.
fn room() -> [(&'static str, String); 3] {
    let places = [[0.0, 0.0], [8.0, 0.0], [8.0, 6.0], [0.0, 6.0]];
    let (mut anchors, mut ranges) = ("anchor,x,y,z\n".to_owned(), "t,anchor,range\n".to_owned());
    for (index, [x, y]) in places.into_iter().enumerate() {
        let _ = writeln!(anchors, "A{index},{x},{y},2");
    }
    for epoch in 0..200 {
        for (index, [x, y]) in places.into_iter().enumerate() {
            let range = f64::hypot(f64::hypot(x - 3.0, y - 2.0), 1.0);
            let _ = writeln!(ranges, "{},A{index},{range:.3}", 0.1 * f64::from(epoch));
        }
    }
    let truth = "t,x,y\n0,3,2\n20,3,2\n".to_owned();
    // The file names do not tell the contents.
    [("one.csv", truth), ("three.csv", ranges), ("two.csv", anchors)]
}

#[test]
fn a_zip_file_opens_as_what_is_in_it() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = explore(&server, "pedestrian", 1280) else { return };
    let mut zipped = ZipWriter::new(Cursor::new(Vec::new()));
    let notes = ("notes.md", "# what was done\n".to_owned());
    for (name, text) in room().into_iter().chain([notes, ("__MACOSX/._one.csv", String::new())]) {
        zipped.start_file(format!("day/{name}"), SimpleFileOptions::default()).expect("room");
        zipped.write_all(text.as_bytes()).expect("room");
    }
    let zipped = zipped.finish().expect("room").into_inner();
    drop_files(&page, &[("day.zip", &zipped)]);
    wait_for(&page, "robot", "three.csv");
    let taken = text_of(&page, "taken");
    for told in ["one.csvtruth", "two.csvanchors", "three.csvlog", "not usednotes.md"] {
        assert!(taken.contains(told), "{told}: {taken}");
    }
    assert_eq!(page.evaluate("document.getElementById('system').value"), "robot");
    assert_eq!(page.evaluate("document.getElementById('check').open"), true);
    let command = text_of(&page, "command");
    assert!(
        command.contains("--anchors two.csv") && command.contains("--truth one.csv"),
        "{command}"
    );
    assert_quiet(&page, server.place());
    page.screenshot("dropped-1280.png");
}

#[test]
fn what_is_lacking_is_asked_for_and_what_nobody_reads_is_told() {
    let server = Server::start(&["serve", "--port", "0"]);
    let Some(page) = explore(&server, "robot", 1280) else { return };
    let alert = "document.getElementById('alert').textContent";
    let [truth, ranges, anchors] = room();
    drop_files(&page, &[("picture.png", b"\x89PNG\r\n\x1a\n")]);
    page.wait_for(&format!("{alert}.includes('picture.png')"));
    assert_eq!(page.evaluate("document.getElementById('figures').children.length"), 0);
    drop_files(&page, &[(anchors.0, anchors.1.as_bytes()), (truth.0, truth.1.as_bytes())]);
    page.wait_for(&format!("{alert}.includes('needed as well: --log')"));
    drop_files(&page, &[(ranges.0, ranges.1.as_bytes())]);
    wait_for(&page, "robot", "three.csv");
    assert_eq!(page.evaluate(alert), "");
    // A walk is recognised whatever was open before.
    let walk = razor_text(&walk());
    drop_files(&page, &[("somewhere.txt", walk.as_bytes())]);
    wait_for(&page, "pedestrian", "somewhere.txt");
    let mut flight = "t,delta_e,delta_t,q,V,theta\n".to_owned();
    let mut search = "t,x,y,h,rssi_db\n".to_owned();
    for step in 0..200 {
        let t = 0.1 * f64::from(step);
        let _ =
            writeln!(flight, "{t:.1},0.01,0.5,{:.4},20.1,{:.4}", 0.01 * t.sin(), -0.01 * t.cos());
        let [x, y] = [200.0 * t.sin(), 200.0 * t.cos()];
        let level = -60.0 - 20.0 * f64::hypot(f64::hypot(x - 50.0, y), 40.0).log10();
        let _ = writeln!(search, "{t:.1},{x:.2},{y:.2},40,{level:.2}");
    }
    drop_files(&page, &[("a.csv", flight.as_bytes())]);
    wait_for(&page, "uav", "a.csv");
    drop_files(&page, &[("b.csv", search.as_bytes())]);
    wait_for(&page, "drone", "b.csv");
    // The browser logs each refusal, and nothing else.
    assert!(page.complaints().iter().all(|complaint| complaint.contains("422")));
}
