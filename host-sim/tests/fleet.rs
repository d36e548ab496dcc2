//! Tests of `host-sim fleet` with a real broker, with broker and program killed in the middle: every track is that of
//! the device's own replay, nothing is lost and nothing duplicated.
//!
//! `nats-server` is Debian's, on the loopback interface only. If it is missing the test reports SKIPPED, unless
//! `KESTIRIM_REQUIRE_ENGINES` is set. `KESTIRIM_TAGS` and `KESTIRIM_SECONDS` select a longer form.
#![cfg(all(target_os = "linux", feature = "fleet"))]

use std::collections::BTreeMap;
use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::net::TcpListener;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use async_nats::jetstream::{self, Context, consumer::pull, message::PublishMessage};
use futures_util::StreamExt;
use host_sim::system::{Files, Outcome, Settings};
use host_sim::systems::ALL;
use kestirim_telemetry::{CAPACITY, Message, Origin, Range, Receiver, encode_from};
use serde_json::Value;

/// The anchors in the corners of a hall (m).
const ANCHORS: [[f64; 3]; 4] =
    [[0.0, 0.0, 2.5], [20.0, 0.0, 2.0], [20.0, 15.0, 2.5], [0.0, 15.0, 2.0]];
/// The number of epochs per second.
const RATE: usize = 10;
/// The maximum number of unconfirmed messages of the sender.
const ON_THE_WAY: usize = 2000;
/// The timeout for an answer of the broker.
const PATIENCE: Duration = Duration::from_secs(30);

fn number(name: &str, default: usize) -> usize {
    env::var(name).map_or(default, |text| text.parse().expect("a number"))
}

/// A process that is killed when this is dropped.
struct Running(Child);

impl Running {
    fn kill(&mut self) {
        self.0.kill().expect("SIGKILL");
        self.0.wait().expect("it ends");
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn broker(folder: &Path, port: u16) -> Running {
    let mut command = Command::new("nats-server");
    command
        .args(["-js", "-a", "127.0.0.1", "-p", &port.to_string(), "-sd"])
        .arg(folder.join("broker"));
    let child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    Running(child.expect("nats-server"))
}

/// Starts the program and waits until it follows the stream.
fn program(folder: &Path, port: u16) -> Running {
    let url = format!("nats://127.0.0.1:{port}");
    let begun = Instant::now();
    loop {
        let mut command = Command::new(env!("CARGO_BIN_EXE_host-sim"));
        command.args(["fleet", "robot", "--anchors", "anchors.csv", "--height", "0.5", "--json"]);
        command.args(["--nats", &url, "--state", "states", "--metrics", "127.0.0.1:0"]);
        command.current_dir(folder).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = Running(command.spawn().expect("the program"));
        let said = child.0.stderr.take().expect("piped");
        let mut lines = BufReader::new(said).lines().map_while(Result::ok);
        if lines.any(|line| line.starts_with("metrics:")) {
            std::thread::spawn(move || lines.for_each(drop));
            return child;
        }
        assert!(begun.elapsed() < PATIENCE, "the program does not begin");
        sleep(Duration::from_millis(100));
    }
}

/// The ranges of a tag in an epoch, as one message.
fn message(device: u32, epoch: usize) -> Vec<u8> {
    let angle = epoch as f64 * 0.02 + f64::from(device);
    let place = [10.0 + 4.0 * angle.cos(), 7.0 + 4.0 * angle.sin(), 0.5];
    let frames = ANCHORS.iter().enumerate().flat_map(|(index, anchor)| {
        let square: f64 = anchor.iter().zip(place).map(|(a, b)| (a - b).powi(2)).sum();
        // A deterministic substitute for noise of 5 cm.
        let noise = 0.05 * (1e3 * f64::from(device) + 7.0 * epoch as f64 + index as f64).sin();
        let (time_us, range) = (epoch as u64 * 100_000, (square.sqrt() + noise) as f32);
        let range = Range { time_us, anchor: index as u16, range }.into();
        let sequence = (epoch * ANCHORS.len() + index) as u32;
        let mut buffer = [0; CAPACITY];
        encode_from(Origin { device, boot: 1 }, &range, sequence, &mut buffer)
            .expect("it fits")
            .to_vec()
    });
    frames.collect()
}

/// Sends a message until the broker has confirmed it; its id prevents duplicates.
async fn send(context: Context, device: u32, epoch: usize) {
    let bytes = message(device, epoch);
    loop {
        let publish = PublishMessage::build().message_id(format!("{device}-{epoch}"));
        let subject = format!("frames.{device}");
        if let Ok(confirmed) =
            context.send_publish(subject, publish.payload(bytes.clone().into())).await
            && confirmed.await.is_ok()
        {
            return;
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
}

/// Sends the messages of all tags, an epoch each every tenth of a second; returns the duration.
async fn send_all(context: Context, tags: usize, epochs: usize) -> Duration {
    let begun = Instant::now();
    for epoch in 0..epochs {
        let due = Duration::from_millis((epoch * 1000 / RATE) as u64);
        tokio::time::sleep(due.saturating_sub(begun.elapsed())).await;
        let sent = (1..=tags as u32).map(|device| send(context.clone(), device, epoch));
        futures_util::stream::iter(sent).buffer_unordered(ON_THE_WAY).collect::<()>().await;
    }
    begun.elapsed()
}

/// The track that a separate estimator computes from a tag's messages: time and position after each.
fn replay(folder: &Path, device: u32, epochs: usize) -> Vec<(u64, [f32; 3])> {
    let system = ALL.iter().find(|system| system.name() == "robot").expect("a system");
    let mut settings = Settings::new(system.settings());
    settings.set("height", "0.5").expect("a height");
    let mut files = Files::default();
    files.add("anchors", folder.join("anchors.csv"));
    let plan = system.online(&settings, &files).expect("a plan").expect("a plan");
    let mut online = plan.build().expect("an estimator");
    let mut track = Vec::new();
    for epoch in 0..epochs {
        let mut last = None;
        for frame in Receiver::new().frames(&message(device, epoch)) {
            if online.take(&frame.message) == Outcome::Taken {
                last = frame.message.measured_us();
            }
        }
        track.extend(last.zip(online.position().map(|place| place.map(|axis| axis as f32))));
    }
    track
}

/// All estimates by device: number, time and position, ordered by number.
async fn estimates(context: &Context) -> BTreeMap<u32, Vec<(u32, u64, [f32; 3])>> {
    let stream = context.get_stream("estimates").await.expect("a stream");
    let count = stream.get_info().await.expect("it is told").state.messages;
    let config = pull::OrderedConfig::default();
    let consumer = stream.create_consumer(config).await.expect("a consumer");
    let mut messages = consumer.messages().await.expect("messages").take(count as usize);
    let mut all = BTreeMap::<u32, Vec<_>>::new();
    while let Some(message) = messages.next().await {
        let message = message.expect("a message");
        let frame = Receiver::new().frames(&message.payload).next().expect("a frame");
        let Message::Position(it) = frame.message else { panic!("{frame:?}") };
        let device = frame.origin.expect("a device").device;
        all.entry(device).or_default().push((frame.sequence, it.time_us, it.position));
    }
    for track in all.values_mut() {
        track.sort_by_key(|it| it.0);
    }
    all
}

/// The resident memory of a process in kB.
fn memory_kb(process: &Child) -> usize {
    let status = fs::read_to_string(format!("/proc/{}/status", process.id())).expect("a status");
    let line = status.lines().find(|line| line.starts_with("VmRSS:")).expect("memory");
    line.split_whitespace().nth(1).and_then(|kb| kb.parse().ok()).expect("a number")
}

#[test]
fn a_fleet_with_broker_and_program_killed() {
    if !Command::new("nats-server").arg("--version").output().is_ok_and(|it| it.status.success()) {
        assert!(env::var_os("KESTIRIM_REQUIRE_ENGINES").is_none(), "nats-server is missing");
        return println!("SKIPPED: nats-server is missing");
    }
    let (tags, seconds) = (number("KESTIRIM_TAGS", 50), number("KESTIRIM_SECONDS", 5));
    let epochs = seconds * RATE;
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let rows =
        ANCHORS.iter().zip("ABCD".chars()).map(|([x, y, z], name)| format!("{name},{x},{y},{z}\n"));
    let anchors = ["anchor,x,y,z\n".to_owned()].into_iter().chain(rows).collect::<String>();
    fs::write(folder.join("anchors.csv"), anchors).expect("a file");
    let port =
        TcpListener::bind("127.0.0.1:0").and_then(|it| it.local_addr()).expect("a port").port();
    let mut server = broker(folder, port);
    let mut fleet = program(folder, port);
    let before_kb = memory_kb(&fleet.0);
    let runtime =
        tokio::runtime::Builder::new_multi_thread().worker_threads(1).enable_all().build();
    let runtime = runtime.expect("threads");
    let context = runtime.block_on(async {
        let options = async_nats::ConnectOptions::new();
        let client = options.connect(format!("nats://127.0.0.1:{port}")).await.expect("a broker");
        let mut context = jetstream::new(client);
        context.set_timeout(Duration::from_secs(2));
        context
    });
    let sent = runtime.spawn(send_all(context.clone(), tags, epochs));
    let fifth = Duration::from_millis(seconds as u64 * 200);
    sleep(fifth);
    server.kill();
    server = broker(folder, port);
    sleep(fifth);
    fleet.kill();
    fleet = program(folder, port);
    sleep(fifth);
    fleet.kill();
    server.kill();
    server = broker(folder, port);
    fleet = program(folder, port);
    let sending = runtime.block_on(sent).expect("all is sent");
    let begun = Instant::now();
    let replays: BTreeMap<_, _> =
        (1..=tags as u32).map(|device| (device, replay(folder, device, epochs))).collect();
    // The first ranges of a tag do not determine a position yet.
    let expected: usize = replays.values().map(Vec::len).sum();
    let stored = || {
        runtime.block_on(async {
            let stream = context.get_stream("estimates").await.ok()?;
            Some(stream.get_info().await.ok()?.state.messages as usize)
        })
    };
    let (mut changed, mut last) = (Instant::now(), None);
    while stored().is_none_or(|count| count < expected) {
        // The wait continues while more arrive.
        let now = stored();
        if now != last {
            (changed, last) = (Instant::now(), now);
        }
        assert!(changed.elapsed() < PATIENCE, "{now:?} of {expected} estimates");
        sleep(Duration::from_millis(200));
    }
    let following = begun.elapsed();
    let after_kb = memory_kb(&fleet.0);
    // A further wait, in which any duplicates would arrive.
    sleep(Duration::from_secs(2));
    Command::new("kill").args(["-TERM", &fleet.0.id().to_string()]).status().expect("kill");
    let said = fleet.0.stdout.take().expect("piped");
    let report: Value = serde_json::from_reader(said).expect("a report");
    let counts = &report["counts"];
    assert_eq!(counts["frames"], tags * epochs * ANCHORS.len());
    assert_eq!(["lost", "another", "refused"].map(|it| counts[it].as_u64()), [Some(0); 3]);
    let bytes = report["bytes_a_device"].as_f64().expect("a number");
    assert!(bytes <= 2000.0, "{bytes} bytes a device");
    let all = runtime.block_on(estimates(&context));
    server.kill();
    assert_eq!(all.len(), tags);
    for (device, track) in &all {
        assert!(track.windows(2).all(|pair| pair[0].0 < pair[1].0), "device {device}: twice");
        let track: Vec<_> = track.iter().map(|it| (it.1, it.2)).collect();
        assert!(track == replays[device], "device {device}: another track");
    }
    println!(
        "{tags} tags, {} messages sent in {sending:.1?}, followed {following:.1?} later; {bytes:.0} bytes a device, \
         {} kB of memory more than before",
        tags * epochs,
        after_kb.saturating_sub(before_kb)
    );
}
