//! Tests of `host-sim serve`: who is answered, for how long, and what remains when it ends.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Command, Stdio};

use crate::program::Desk;
use crate::sender::wait_for;

/// A running server.
struct Server {
    program: Child,
    /// The host and port: `127.0.0.1:PORT`.
    place: String,
    key: String,
}

impl Server {
    /// Starts the program with this folder for temporary files.
    fn start(desk: &Desk) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .args(["serve", "--port", "0"])
            .env("TMPDIR", desk.named("."))
            .stdout(Stdio::piped())
            .spawn()
            .expect("the program runs");
        let mut line = String::new();
        let mut stdout = BufReader::new(program.stdout.take().expect("a pipe"));
        stdout.read_line(&mut line).expect("it says where it is");
        let address = line.split(' ').next().expect("an address");
        let (place, key) = address.split_once("/?token=").expect("a key");
        let place = place.strip_prefix("http://").expect("an address").to_owned();
        Self { program, place, key: key.to_owned() }
    }

    /// Sends the beginning of a request.
    fn begin(&self, request: &str) -> TcpStream {
        let mut stream = TcpStream::connect(&self.place).expect("it listens");
        stream.write_all(request.as_bytes()).expect("it is sent");
        stream
    }

    /// The response to a request for a path with these headers.
    fn get(&self, path: &str, headers: &[&str]) -> String {
        let place = &self.place;
        let headers = headers.iter().fold(String::new(), |all, header| all + header + "\r\n");
        let request =
            format!("GET {path} HTTP/1.1\r\nHost: {place}\r\n{headers}Connection: close\r\n\r\n");
        read(self.begin(&request))
    }

    fn cookie(&self) -> String {
        let port = self.place.split(':').next_back().expect("a port");
        format!("Cookie: kestirim-{port}={}", self.key)
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        // The program may have ended by itself.
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn read(mut stream: TcpStream) -> String {
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).expect("an answer");
    String::from_utf8_lossy(&answer).into_owned()
}

fn status(answer: &str) -> &str {
    answer.split(' ').nth(1).unwrap_or(answer)
}

#[test]
fn nothing_is_answered_without_the_key_and_the_key_is_handed_over() {
    let server = Server::start(&Desk::new());
    let paths =
        ["/", "/page.css", "/explorer.js", "/api/sources", "/live", "/?token=0", "/nothing"];
    for path in paths {
        assert_eq!(status(&server.get(path, &[])), "403", "{path}");
        assert_eq!(status(&server.get(path, &["Cookie: kestirim-1=2; a"])), "403", "{path}");
    }
    let handed = server.get(&format!("/?token={}", server.key), &[]);
    assert_eq!(status(&handed), "303");
    let handed = handed.to_lowercase();
    // The address after the redirect does not contain the key.
    assert!(handed.contains("\r\nlocation: /\r\n"), "{handed}");
    let cookie = server.cookie().to_lowercase().replace("cookie: ", "set-cookie: ");
    assert!(handed.contains(&format!("{cookie}; httponly")), "{handed}");
    for path in ["/", "/api/sources"] {
        let answer = server.get(path, &[&server.cookie()]);
        assert_eq!(status(&answer), "200", "{path}");
        assert!(!answer.contains(&server.key), "{path}");
    }
    // A foreign page has the cookie as well, but its requests state their origin.
    for foreign in ["Origin: http://example.org", "Origin: http://127.0.0.1:1"] {
        assert_eq!(status(&server.get("/api/sources", &[&server.cookie(), foreign])), "403");
    }
}

#[test]
fn a_request_that_does_not_end_is_given_up() {
    let server = Server::start(&Desk::new());
    let stream = server.begin("GET / HTTP/1.1\r\nHost: a\r\n");
    // Without a timeout this waits for ever.
    assert_ne!(status(&read(stream)), "200");
}

#[test]
fn at_most_two_upload_at_once_and_nothing_of_it_stays() {
    for signal in ["-INT", "-TERM"] {
        let desk = Desk::new();
        let mut server = Server::start(&desk);
        let request = format!(
            "POST /api/open/pedestrian HTTP/1.1\r\nHost: {}\r\n{}\r\nContent-Length: 1000\r\n\
             Content-Type: multipart/form-data; boundary=b\r\n\r\n\
             --b\r\nContent-Disposition: form-data; name=\"log\"; filename=\"a.csv\"\r\n\r\nt,ax",
            server.place,
            server.cookie()
        );
        let uploads: Vec<_> = (0..2).map(|_| server.begin(&request)).collect();
        let folders = || fs::read_dir(desk.path(".")).expect("the folder").flatten();
        let begun = || folders().flat_map(|it| fs::read_dir(it.path())).flatten().count();
        wait_for("two uploads", || begun() == 2);
        let mut third = server.begin(&request);
        let mut answer = [0; 12];
        third.read_exact(&mut answer).expect("an answer");
        assert_eq!(&answer, b"HTTP/1.1 503");
        let killed = Command::new("kill").args([signal, &server.program.id().to_string()]).status();
        assert!(killed.expect("kill runs").success());
        assert!(server.program.wait().expect("it ends").success());
        assert_eq!(folders().count(), 0, "{signal}");
        drop(uploads);
    }
}
