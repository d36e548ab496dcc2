//! Tests of `host-sim live`: killed, on a serial port, playing back, refusing.

use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::program::{Desk, host_sim, json, refusal, text};
use crate::sender::{decoded, frames, length, send, wait_for};
use kestirim_telemetry::{Health, Imu, Message};
use serde_json::Value;

/// Starts the program, and returns it with the line that announces its source.
pub(crate) fn listening(arguments: &[&str]) -> (Child, String) {
    let mut child = Command::new(env!("CARGO_BIN_EXE_host-sim"))
        .args(["live", "--headless"])
        .args(arguments)
        // The limit ends it if a test does not.
        .args(["--seconds", "300"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    let mut line = String::new();
    let mut stderr = BufReader::new(child.stderr.take().expect("a pipe"));
    stderr.read_line(&mut line).expect("it says where it listens");
    // The pipe must be drained so that later output does not block the program.
    std::thread::spawn(move || stderr.read_to_end(&mut Vec::new()));
    (child, line)
}

pub(crate) fn address(line: &str) -> std::net::SocketAddr {
    let found = line.split([' ', ',']).find_map(|word| word.parse().ok());
    found.unwrap_or_else(|| panic!("no address in {line}"))
}

pub(crate) fn report(mut child: Child) -> Value {
    let mut text = String::new();
    child.stdout.take().expect("a pipe").read_to_string(&mut text).expect("UTF-8");
    assert!(child.wait().expect("it ends").success());
    serde_json::from_str(&text).expect("one JSON object")
}

fn healths(count: usize) -> Vec<Message> {
    let health = |n| Health { time_us: n as u64, accepted: n as u32, rejected: 0, failed: 0 };
    (0..count).map(|number| health(number).into()).collect()
}

#[test]
fn a_killed_program_has_written_down_all_that_came() {
    let desk = Desk::new();
    let recording = desk.path("killed.frames");
    let named = desk.named("killed.frames");
    let (mut child, line) = listening(&["--udp", "127.0.0.1:0", "--record", &named]);
    let sent = healths(20_000);
    let bytes = frames(sent.iter().copied());
    send(address(&line), bytes[..100_000].chunks(777), || length(&recording));
    // The kill comes in the middle of a frame, without any prior request to end.
    child.kill().expect("it can be killed");
    child.wait().expect("it is dead");
    let recorded = fs::read(&recording).expect("the recording");
    assert_eq!(recorded, bytes[..100_000]);
    let (found, counts) = decoded(&recorded);
    assert_eq!((found.as_slice(), counts.lost), (&sent[..found.len()], 0));
    let replayed = json(&host_sim(&["live", "--headless", "--file", &named, "--json"]));
    assert_eq!(replayed["counts"]["received"], found.len());
    assert_eq!(replayed["counts"]["torn"], 1);
}

#[test]
fn a_stream_ends_after_as_many_frames_as_are_enough() {
    let desk = Desk::new();
    let named = desk.named("few.frames");
    let arguments = ["--udp", "localhost:0", "--record", &named, "--frames", "100", "--json"];
    let (child, line) = listening(&arguments);
    let bytes = frames(healths(150));
    send(address(&line), bytes.chunks(500), || length(Path::new(&named)));
    let report = report(child);
    assert_eq!(report["counts"]["received"], 100);
    assert_eq!(report["recording"], Value::from(named));
    assert_eq!(report["system"], "none");
}

#[test]
fn a_torn_last_frame_is_counted() {
    let desk = Desk::new();
    let bytes = frames(healths(10));
    let counts = |cut: usize| {
        let recording = desk.file("cut.frames", &bytes[..bytes.len() - cut]);
        json(&host_sim(&["live", "--headless", "--file", &recording, "--json"]))["counts"].clone()
    };
    assert_eq!((&counts(0)["received"], &counts(0)["torn"]), (&10.into(), &0.into()));
    // A frame that only lacks its delimiter is complete.
    assert_eq!((&counts(1)["received"], &counts(1)["torn"]), (&10.into(), &0.into()));
    assert_eq!((&counts(4)["received"], &counts(4)["torn"]), (&9.into(), &1.into()));
    let table = host_sim(&["live", "--headless", "--file", &desk.named("cut.frames")]);
    assert!(text(&table.stdout).contains("frames received"), "{}", text(&table.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn a_serial_port_is_read_until_it_is_unplugged() {
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::io::Write;

    let desk = Desk::new();
    let recording = desk.path("serial.frames");
    let named = desk.named("serial.frames");
    // The program, which is to notice the hang-up, must not inherit the cable.
    let flags = OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC;
    let cable = openpt(flags).expect("a pseudo-terminal");
    grantpt(&cable).and_then(|()| unlockpt(&cable)).expect("it can be used");
    let device = ptsname(&cable, Vec::new()).expect("it has a name");
    let device = device.to_str().expect("a plain name");
    let (child, line) =
        listening(&["--serial", device, "--baud", "921600", "--record", &named, "--json"]);
    assert!(line.contains(device), "{line}");
    let imu = |n: usize| Imu {
        time_us: n as u64,
        specific_force: [f32::from_bits((n % 256) as u32 * 0x0101_0101); 3],
        angular_rate: [n as f32; 3],
    };
    // The bytes include all those that a terminal would translate.
    let bytes = frames((0..500).map(imu));
    let mut cable = fs::File::from(cable);
    for piece in bytes.chunks(1000) {
        let before = length(&recording);
        cable.write_all(piece).expect("the cable is in");
        wait_for("the serial port", || length(&recording) == before + piece.len() as u64);
    }
    drop(cable);
    let report = report(child);
    assert_eq!(
        (&report["counts"]["received"], &report["counts"]["lost"]),
        (&500.into(), &0.into())
    );
    assert!(fs::read(&recording).expect("the recording") == bytes);
}

#[test]
fn a_file_without_a_frame_is_refused() {
    let desk = Desk::new();
    let walk = desk.file("walk.csv", "t,x\n0,1\n");
    let output = host_sim(&["live", "--headless", "--json", "--file", &walk]);
    assert!(output.status.code() == Some(2) && output.stdout.is_empty());
    let sentence = text(&output.stderr).trim_end();
    assert!(sentence.ends_with("expected a recorded stream, found no frame"), "{sentence}");
}

#[test]
fn what_is_wrong_is_one_sentence() {
    let desk = Desk::new();
    let new = desk.named("new.frames");
    let old = desk.file("old.frames", "precious");
    let wrong: [(&[&str], &str); 12] = [
        (&["--udp", "127.0.0.1", "--record", &new], "--udp"),
        (&["--udp", "192.0.2.1:5775", "--record", &new], "--udp"),
        (&["--serial", "/no/such/device", "--record", &new], "/no/such/device"),
        (&["--baud", "9600"], "--serial"),
        (&["--file", "/no/such/file"], "/no/such/file"),
        (&["--file", &old, "--record", &new], "--record"),
        (&["--file", &old, "--udp", "127.0.0.1:0"], "--udp"),
        (&["--record", &old, "--udp", "127.0.0.1:0"], "overwritten"),
        (&["--record", "/no/such/folder/a", "--udp", "127.0.0.1:0"], "/no/such/folder/a"),
        (&["--system", "gnss", "--filter", "all"], "--filter"),
        (&["--system", "gnss", "--sp3", "/no/such/orbits"], "--antex"),
        (&["--system", "gnss", "--nav", "/no/such/messages"], "/no/such/messages"),
    ];
    for (arguments, said) in wrong {
        let sentence = refusal(&[&["live"], arguments].concat());
        assert!(sentence.contains(said), "{arguments:?}: {sentence}");
        assert!(!Path::new(&new).exists(), "{arguments:?}: nothing was to be recorded");
    }
    assert_eq!(fs::read_to_string(&old).expect("it is still there"), "precious");
}
