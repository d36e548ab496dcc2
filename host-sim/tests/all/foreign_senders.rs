//! Tests of the senders in other languages, in `contrib/senders`: their messages arrive as intended.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use kestirim_telemetry::{Imu, Message, Range};

use crate::live_cli::{address, listening, report};
use crate::program::{Desk, is_missing};
use crate::sender::decoded;

/// The message that both senders send with this number.
fn sent(number: u16) -> Message {
    let time_us = u64::from(number) * 10_000;
    let seconds = f32::from(number) / 100.0;
    if number % 20 == 19 {
        return Range { time_us, anchor: number % 4, range: 3.0 + seconds }.into();
    }
    let (specific_force, angular_rate) = ([0.0, 0.0, 9.81], [0.0, seconds.sin(), 0.0]);
    Imu { time_us, specific_force, angular_rate }.into()
}

/// Whether two messages are equal to the last digits of single precision.
fn agree(a: &Message, b: &Message) -> bool {
    let close = |a: f32, b: f32| (a - b).abs() < 1e-6;
    match (a, b) {
        (Message::Imu(a), Message::Imu(b)) => {
            let rates = a.angular_rate.iter().zip(b.angular_rate).all(|(a, b)| close(*a, b));
            rates && (a.time_us, a.specific_force) == (b.time_us, b.specific_force)
        }
        (Message::Range(a), Message::Range(b)) => {
            (a.time_us, a.anchor) == (b.time_us, b.anchor) && close(a.range, b.range)
        }
        _ => false,
    }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../contrib/senders")
}

/// Runs a sender, which is given address and port, and checks the recording.
fn receive(command: &mut Command) {
    let desk = Desk::new();
    let recording = desk.named("sent.frames");
    let arguments = ["--udp", "127.0.0.1:0", "--record", &recording, "--frames", "200", "--json"];
    let (child, line) = listening(&arguments);
    let to = address(&line);
    let status = command.args([to.ip().to_string(), to.port().to_string()]).status();
    assert!(status.expect("it can be run").success());
    let counts = &report(child)["counts"];
    assert_eq!(
        ["received", "lost", "torn", "corrupt"].map(|it| counts[it].as_u64()),
        [200, 0, 0, 0].map(Some)
    );
    let (messages, _) = decoded(&fs::read(&recording).expect("a recording"));
    assert_eq!(messages.len(), 200);
    for (number, message) in (0..).zip(&messages) {
        assert!(agree(message, &sent(number)), "{message:?}, not {:?}", sent(number));
    }
}

#[test]
fn a_sender_in_python_is_understood() {
    if is_missing("python3", "KESTIRIM_REQUIRE_PYTHON") {
        return;
    }
    receive(Command::new("python3").arg(folder().join("send.py")));
}

#[test]
fn a_sender_in_c_is_understood() {
    if is_missing("cc", "KESTIRIM_REQUIRE_C") {
        return;
    }
    let desk = Desk::new();
    let program = desk.named("send");
    let flags = ["-Wall", "-Wextra", "-Werror", "-O1", "-o", &program];
    let source = folder().join("send.c");
    let built = Command::new("cc").args(flags).arg(source).arg("-lm").status();
    assert!(built.expect("a compiler").success());
    receive(&mut Command::new(&program));
}

#[test]
fn a_sender_is_short() {
    for name in ["send.py", "send.c"] {
        let text = fs::read_to_string(folder().join(name)).expect("a file");
        let lines = text.lines().filter(|line| !line.trim().is_empty()).count();
        assert!(lines <= 50, "{name} has {lines} lines");
    }
}
