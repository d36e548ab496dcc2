//! Chromium over its `DevTools` protocol: a `WebSocket` and a few of its methods.
//!
//! Alternatives considered: `headless_chrome` is built by a program under the GPL, `chromiumoxide` includes the whole
//! protocol as code.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::Duration;

use serde_json::{Value, json};
use tempfile::TempDir;
use tungstenite::{Message, WebSocket};

/// The timeout for an answer of the browser.
const PATIENCE: Duration = Duration::from_secs(60);

/// A running browser, which ends when its last page is closed.
struct Program {
    child: Child,
    /// Address of the `WebSocket` on which it listens.
    address: String,
    _profile: TempDir,
}

impl Program {
    /// The browser of all pages that are open at the moment: starting one takes as long as drawing a page.
    fn shared(program: &Path) -> Arc<Self> {
        static RUNNING: Mutex<Weak<Program>> = Mutex::new(Weak::new());
        // A browser that did not start fails the test that started it, and not all others.
        let mut running = RUNNING.lock().unwrap_or_else(PoisonError::into_inner);
        running.upgrade().unwrap_or_else(|| {
            let started = Arc::new(Self::start(program));
            *running = Arc::downgrade(&started);
            started
        })
    }

    fn start(program: &Path) -> Self {
        let profile = tempfile::tempdir().expect("a folder for the browser");
        let mut folder = OsStr::new("--user-data-dir=").to_owned();
        folder.push(profile.path());
        let mut child = Command::new(program)
            .args(["--headless=new", "--remote-debugging-port=0", "--disable-gpu"])
            // The tests run as root where there are no user namespaces.
            .args(["--no-sandbox", "--hide-scrollbars", "--no-first-run", "--mute-audio"])
            .arg(folder)
            .arg("about:blank")
            // Its temporary files are deleted with its profile.
            .env("TMPDIR", profile.path())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the browser starts");
        let mut lines = BufReader::new(child.stderr.take().expect("a pipe")).lines();
        let address = lines
            .by_ref()
            .map_while(Result::ok)
            .find_map(|line| Some(line.split_once("DevTools listening on ")?.1.to_owned()))
            .expect("it says where it listens");
        // The pipe must be drained so that later output does not block the browser.
        std::thread::spawn(move || lines.for_each(drop));
        Self { child, address, _profile: profile }
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // The browser may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// One page of a headless browser, with cookies and storage of its own, which is closed when this is dropped.
pub(super) struct Browser {
    socket: WebSocket<TcpStream>,
    session: Option<String>,
    calls: u64,
    /// Events that have not been looked at yet: method and parameters.
    pub(super) events: Vec<(String, Value)>,
    _program: Arc<Program>,
}

impl Browser {
    /// Opens a page with a window of this width.
    pub(super) fn start(program: &Path, width: u32) -> Self {
        let program = Program::shared(program);
        let place = program.address.strip_prefix("ws://").and_then(|rest| rest.split('/').next());
        let stream = TcpStream::connect(place.expect("an address")).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a limit");
        let (socket, _) = tungstenite::client(&program.address, stream).expect("a WebSocket");
        let mut browser =
            Self { socket, session: None, calls: 0, events: Vec::new(), _program: program };
        // Ends with its connection.
        let context =
            browser.call("Target.createBrowserContext", &json!({ "disposeOnDetach": true }));
        let page = json!({
            "url": "about:blank", "width": width, "height": 900,
            "browserContextId": context["browserContextId"],
        });
        let page = browser.call("Target.createTarget", &page);
        let attach = json!({ "targetId": page["targetId"], "flatten": true });
        let session = browser.call("Target.attachToTarget", &attach)["sessionId"].clone();
        browser.session = session.as_str().map(str::to_owned);
        browser
    }

    /// The result of a method.
    pub(super) fn call(&mut self, method: &str, parameters: &Value) -> Value {
        self.try_call(method, parameters).unwrap_or_else(|error| panic!("{method}: {error}"))
    }

    /// The result of a method, or its error.
    pub(super) fn try_call(&mut self, method: &str, parameters: &Value) -> Result<Value, Value> {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(session) = &self.session {
            call["sessionId"] = session.as_str().into();
        }
        self.socket.send(Message::text(call.to_string())).expect("the browser takes a call");
        loop {
            let message = self.socket.read().expect("the browser answers");
            let Message::Text(text) = message else { continue };
            let mut said: Value = serde_json::from_str(&text).expect("JSON");
            if said["id"] == self.calls {
                let error = said["error"].take();
                return if error.is_null() { Ok(said["result"].take()) } else { Err(error) };
            }
            if let Some(method) = said["method"].as_str().map(str::to_owned) {
                self.events.push((method, said["params"].take()));
            }
        }
    }
}
