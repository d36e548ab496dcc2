//! Tests of refusals by the replay of a GNSS receiver: always with one sentence, never with a panic.

use std::fs;

use crate::program::{Desk, host_sim, json, refusal};
use crate::station::{self, Fault, satellites};

struct Files {
    desk: Desk,
    obs: String,
    sp3: String,
    antex: String,
}

impl Files {
    fn new() -> Self {
        let desk = Desk::new();
        let obs = desk.file("test.rnx", station::rinex(20, |_, _| Some(Fault::NONE)));
        let sp3 = desk.file("test.sp3", station::sp3(18_000.0, &satellites()));
        let antex = desk.file("test.atx", station::antex(&satellites()));
        Self { desk, obs, sp3, antex }
    }

    fn arguments<'a>(&'a self, more: &[&'a str]) -> Vec<&'a str> {
        let files = ["--obs", &self.obs, "--sp3", &self.sp3, "--antex", &self.antex];
        [&["replay", "gnss"], &files[..], more].concat()
    }

    fn refused(&self, more: &[&str]) -> String {
        refusal(&self.arguments(more))
    }
}

#[test]
fn options_that_do_not_fit() {
    let files = Files::new();
    let track = files.desk.named("track.csv");
    for (more, word) in [
        (&["--scalar", "f32"][..], "f64"),
        (&["--scalar", "fixed"], "f64"),
        (&["--printed"], "rkf"),
        (&["--printed", "--filter", "gkf"], "rkf"),
        (&["--process-noise", "1e-4"], "kinematic"),
        (&["--mode", "kinematic", "--process-noise", "0"], "m²/s"),
        (&["--filter", "all", "--track", &track], "--filter all"),
        (&["--filter", "all", "--residuals", &track], "--filter all"),
        (&["--filter", "all", "--mcap", &track], "--filter all"),
        (&["--track", &track, "--residuals", &track], "same file"),
        (&["--residuals", &track, "--mcap", &track], "--residuals and --mcap name the same file"),
        (&["--filter", "ukf"], "ukf"),
        (&["--mode", "flying"], "flying"),
        (&["--without", "gravity"], "gravity"),
        (&["--truth", "55.5,8.5,60"], "X,Y,Z"),
        (&["--truth", "3582104,532590"], "X,Y,Z"),
        (&["--mask", "90"], "60"),
        (&["--until", "noon"], "seconds"),
        (&["--track", &files.obs], "overwrite"),
        (&["--residuals", &files.sp3], "overwrite"),
        (&["--mcap", &files.obs], "overwrite"),
        (&["--track", &files.desk.named("absent/track.csv")], "absent"),
        (&["--track", &files.desk.named("")], "cannot be written"),
    ] {
        let sentence = files.refused(more);
        assert!(sentence.contains(word), "{more:?}: {sentence}");
    }
    for missing in [0, 2, 4] {
        let mut arguments = files.arguments(&[]);
        arguments.drain(missing + 2..missing + 4);
        refusal(&arguments);
    }
    assert_eq!(fs::read_dir(files.desk.path(".")).expect("the folder").count(), 3);
    // f64 may be requested.
    json(&host_sim(&files.arguments(&["--scalar", "f64", "--json"])));
}

#[test]
fn files_that_are_none() {
    let files = Files::new();
    let absent = files.desk.named("absent.clk");
    let empty = files.desk.file("empty.blq", "");
    for (more, words) in [
        (&["--clk", &absent][..], ["absent.clk", "cannot be read"]),
        (&["--blq", &empty], ["empty.blq", "expected ocean loading (BLQ), found an empty file"]),
        (&["--clk", &files.sp3], ["test.sp3", "expected satellite clocks (RINEX), found orbits"]),
        (&["--sp3", &files.obs], ["test.rnx", "expected orbits (SP3), found observations"]),
        (&["--blq", &files.antex], ["test.atx", "expected ocean loading (BLQ), found antenna"]),
    ] {
        let sentence = files.refused(more);
        assert!(words.iter().all(|word| sentence.contains(word)), "{sentence}");
    }
    let folder = files.desk.named("");
    let swapped = ["replay", "gnss", "--obs", &files.sp3, "--sp3", &files.sp3, "--antex"];
    assert!(refusal(&[&swapped[..], &[&files.antex]].concat()).contains("expected observations"));
    let antex = ["replay", "gnss", "--obs", &files.obs, "--sp3", &files.sp3, "--antex", &folder];
    refusal(&antex);
}

#[test]
fn a_wrong_line_is_named() {
    let files = Files::new();
    let good = [&files.obs, &files.sp3, &files.antex].map(|it| fs::read_to_string(it).unwrap());
    for (file, text, from, to) in [
        (&files.obs, &good[0], "> 2020 06 25 02 03", "> 2020 13 25 02 03"),
        (&files.obs, &good[0], "SYS / # / OBS TYPES", "SYS / # / OBS TIPES"),
        (&files.sp3, &good[1], "*  2020  6 25  1 15", "*  2020  6 25  1 7x"),
        (&files.sp3, &good[1], "PG07", "PG07x"),
        (&files.antex, &good[2], "NOAZI    0.00", "NOAZI    0.0x"),
    ] {
        assert!(text.contains(from));
        fs::write(file, text.replacen(from, to, 1)).expect("the folder can be written");
        let sentence = files.refused(&[]);
        let name = file.rsplit('/').next().expect("a name");
        assert!(sentence.contains(name) && sentence.contains("expected"), "{sentence}");
        fs::write(file, text).expect("the folder can be written");
    }
}

/// A file cut off anywhere, or with any byte changed, never causes a panic.
#[test]
fn damaged_files_never_panic() {
    let files = Files::new();
    for file in [&files.obs, &files.sp3, &files.antex] {
        let good = fs::read(file).expect("a file");
        let step = good.len() / 12 + 1;
        for place in (0..good.len()).step_by(step) {
            let mut damaged = good.clone();
            damaged[place] = b'7';
            for contents in [&good[..place], &damaged] {
                fs::write(file, contents).expect("the folder can be written");
                let output = host_sim(&files.arguments(&["--json"]));
                let status = output.status.code();
                assert!(matches!(status, Some(0 | 2)), "{file} at {place}: {status:?}");
            }
        }
        fs::write(file, good).expect("the folder can be written");
    }
}

#[test]
fn short_recordings_never_panic() {
    let desk = Desk::new();
    let sp3 = desk.file("test.sp3", station::sp3(18_000.0, &satellites()));
    let antex = desk.file("test.atx", station::antex(&satellites()));
    for epochs in [0, 1, 2, 3] {
        let obs = desk.file("test.rnx", station::rinex(epochs, |_, _| Some(Fault::NONE)));
        let files = ["replay", "gnss", "--obs", &obs, "--sp3", &sp3, "--antex", &antex, "--json"];
        let status = host_sim(&files).status.code();
        assert_eq!(status, Some(if epochs == 0 { 2 } else { 0 }), "{epochs} epochs");
    }
}
