//! Tests of downloads of recordings, from a server on this machine.

use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use sha2::{Digest, Sha256};

use crate::program::{Desk, host_sim, refusal, text};

const GOOD: &[u8] = b"t,anchor,range\n0,1,2.5\n";

/// A server with `/data/good.csv` and `/data/changed.csv`, and its number of requests.
fn server() -> (String, Arc<AtomicUsize>) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = format!("http://{}", listener.local_addr().expect("an address"));
    let asked = Arc::new(AtomicUsize::new(0));
    let count = Arc::clone(&asked);
    thread::spawn(move || {
        for mut stream in listener.incoming().flatten() {
            let mut lines = BufReader::new(stream.try_clone().expect("a stream")).lines();
            let request = lines.next().and_then(Result::ok).unwrap_or_default();
            while lines.next().and_then(Result::ok).is_some_and(|line| !line.is_empty()) {}
            count.fetch_add(1, Ordering::Relaxed);
            let path = request.split_whitespace().nth(1).unwrap_or_default();
            let (status, body) = match path {
                "/data/good.csv" => ("200 OK", GOOD),
                "/data/changed.csv" => ("200 OK", &b"something else"[..]),
                _ => ("404 Not Found", &b""[..]),
            };
            let length = body.len();
            let head = format!(
                "HTTP/1.1 {status}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
            );
            let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(body));
        }
    });
    (address, asked)
}

fn sum(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().fold(String::new(), |mut text, byte| {
        write!(text, "{byte:02x}").expect("memory");
        text
    })
}

/// Whether no download program is installed, in which case a message is printed.
fn is_helpless() -> bool {
    let has = |program: &str| Command::new(program).arg("--version").output().is_ok();
    let is_helpless = !has("curl") && !has("wget");
    if is_helpless {
        println!("SKIPPED: curl and wget are missing");
    }
    is_helpless
}

/// A list of four files: one correct, one with other contents, one missing on the server, and one that is not
/// redistributed.
fn list(desk: &Desk, server: &str) -> String {
    let good = sum(GOOD);
    let text = format!(
        "path,bytes,sha256,how,source,note,licence\n\
         data/changed.csv,23,{good},as published,{server}/data/changed.csv,,MIT\n\
         data/missing.csv,23,{good},as published,{server}/data/missing.csv,,MIT\n\
         data/good.csv,23,{good},as published,{server}/data/good.csv,,MIT; cite somebody\n\
         secret/flight,,,not passed on,https://a.example,no licence file,none\n"
    );
    desk.file("list.csv", text)
}

#[test]
fn each_file_is_checked_before_it_has_its_name() {
    if is_helpless() {
        return;
    }
    let desk = Desk::new();
    let (server, asked) = server();
    let (list, to) = (list(&desk, &server), desk.named("to"));
    let fetch = || host_sim(&["fetch-data", "--sources", &list, "--to", &to]);
    let output = fetch();
    assert_eq!(output.status.code(), Some(2));
    let (told, said) = (text(&output.stdout), text(&output.stderr));
    let [good, other] = [sum(GOOD), sum(b"something else")];
    let wrong = said.lines().find(|line| line.contains("changed.csv")).expect("a sentence");
    assert!(wrong.contains(&format!("expected SHA-256 {good}, found {other}")), "{wrong}");
    assert!(
        said.lines().any(|line| line.contains("missing.csv") && line.contains("404")),
        "{said}"
    );
    assert!(said.contains("MIT; cite somebody"), "{said}");
    assert!(said.contains("2 of 3 files could not be fetched"), "{said}");
    assert!(told.starts_with("1 fetched, 0 there already, 1 left"), "{told}");
    assert!(told.contains("secret/flight: not passed on: no licence file (https://a.example)"));
    let names: Vec<_> = fs::read_dir(desk.path("to/data"))
        .expect("a folder")
        .map(|entry| entry.expect("an entry").file_name())
        .collect();
    assert_eq!(names, ["good.csv"], "nothing else is left");
    assert_eq!(fs::read(desk.path("to/data/good.csv")).expect("the file"), GOOD);

    // Existing files are not fetched again; changed ones are.
    asked.store(0, Ordering::Relaxed);
    assert!(text(&fetch().stdout).starts_with("0 fetched, 1 there already"));
    assert_eq!(asked.load(Ordering::Relaxed), 2, "the two that are missing");
    fs::write(desk.path("to/data/good.csv"), "damaged").expect("a file");
    assert!(text(&fetch().stdout).starts_with("1 fetched, 0 there already"));
    assert_eq!(fs::read(desk.path("to/data/good.csv")).expect("the file"), GOOD);
}

#[test]
fn a_wrong_file_of_the_same_name_is_kept_if_nothing_better_comes() {
    if is_helpless() {
        return;
    }
    let desk = Desk::new();
    let (server, _) = server();
    let (list, to) = (list(&desk, &server), desk.named("to"));
    fs::create_dir_all(desk.path("to/data")).expect("a folder");
    fs::write(desk.path("to/data/changed.csv"), "mine").expect("a file");
    refuse_and_name(&["--sources", &list, "--to", &to, "--only", "data/changed.csv"]);
    assert_eq!(fs::read(desk.path("to/data/changed.csv")).expect("the file"), b"mine");
}

#[test]
fn a_copy_serves_what_was_converted() {
    if is_helpless() {
        return;
    }
    let desk = Desk::new();
    let (server, _) = server();
    let good = sum(GOOD);
    let list = desk.file(
        "list.csv",
        format!(
            "path,bytes,sha256,how,source,note,licence\n\
             data/good.csv,23,{good},converted,a MAT file,degrees to radians,MIT\n"
        ),
    );
    let to = desk.named("to");
    let arguments = ["fetch-data", "--sources", &list, "--to", &to];
    let output = host_sim(&arguments);
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("nothing of what was asked for"), "it is told");
    let told = text(&output.stdout);
    assert!(told.contains("data: converted from a MAT file: degrees to radians"), "{told}");
    assert!(!desk.path("to").exists(), "nobody was asked");
    let output = host_sim(&[&arguments[..], &["--from", &server]].concat());
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_eq!(fs::read(desk.path("to/data/good.csv")).expect("the file"), GOOD);
}

#[test]
fn a_name_that_is_not_in_the_list_is_refused_with_those_that_are() {
    let desk = Desk::new();
    let list = list(&desk, "http://127.0.0.1:9");
    let sentence = refusal(&["fetch-data", "--sources", &list, "--only", "walks"]);
    assert!(refusal(&["fetch-data", "--only", "walks"]).contains("--only walks: expected one of"));
    assert!(sentence.contains("expected one of data, secret, or"), "{sentence}");
}

/// Asserts a refusal that names the file, after the outcome of the others.
fn refuse_and_name(arguments: &[&str]) {
    let output = host_sim(&[&["fetch-data"], arguments].concat());
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("changed.csv"));
}
