//! A browser that records errors on a page.

mod devtools;

use std::cell::RefCell;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};

use crate::program;
use devtools::Browser;

/// The timeout of waiting for a condition on a page.
const PATIENCE: Duration = Duration::from_secs(60);

/// A page in a headless browser.
pub(crate) struct Page {
    browser: RefCell<Browser>,
    width: u32,
}

impl Page {
    /// Opens an address; `None` if this machine has no browser and none is required.
    pub(crate) fn open(address: &str, width: u32) -> Option<Self> {
        let Some(program) = chromium() else {
            assert!(
                std::env::var_os("KESTIRIM_REQUIRE_BROWSER").is_none(),
                "a browser is required, but there is no chromium"
            );
            eprintln!("SKIPPED: no chromium on this machine");
            return None;
        };
        let page = Self { browser: RefCell::new(Browser::start(&program, width)), width };
        for domain in ["Page", "Runtime", "Log", "Network", "DOM"] {
            page.call(&format!("{domain}.enable"), &json!({}));
        }
        // As if its window had the focus.
        page.call("Emulation.setFocusEmulationEnabled", &json!({ "enabled": true }));
        page.size(900);
        page.call("Page.navigate", &json!({ "url": address }));
        let place = place(address);
        page.wait_for(&format!(
            "location.href.startsWith('{place}') && document.readyState === 'complete'"
        ));
        Some(page)
    }

    fn call(&self, method: &str, parameters: &Value) -> Value {
        self.browser.borrow_mut().call(method, parameters)
    }

    /// Sets the height of the page, and its width, which may be narrower than any window.
    fn size(&self, height: u32) {
        let (width, mobile) = (self.width, self.width < 500);
        let size =
            json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": mobile });
        self.call("Emulation.setDeviceMetricsOverride", &size);
    }

    /// The value of a JavaScript expression; promises are awaited.
    pub(crate) fn evaluate(&self, script: &str) -> Value {
        let said = self.try_evaluate(script).expect("there is a page");
        assert!(said["exceptionDetails"].is_null(), "{script}: {}", said["exceptionDetails"]);
        said["result"]["value"].clone()
    }

    fn try_evaluate(&self, script: &str) -> Result<Value, Value> {
        let script = json!({ "expression": script, "awaitPromise": true, "returnByValue": true });
        self.browser.borrow_mut().try_call("Runtime.evaluate", &script)
    }

    /// Waits until a JavaScript expression is true.
    pub(crate) fn wait_for(&self, script: &str) {
        let begun = Instant::now();
        // Evaluation fails while one page is replaced by the next.
        while !self.try_evaluate(script).is_ok_and(|said| said["result"]["value"] == true) {
            assert!(
                begun.elapsed() < PATIENCE,
                "{script} never came true: {:?}",
                self.complaints()
            );
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Chooses a file in an input field.
    pub(crate) fn choose_file(&self, field: &str, path: &str) {
        let root = self.call("DOM.getDocument", &json!({}))["root"]["nodeId"].clone();
        let field = self.call("DOM.querySelector", &json!({ "nodeId": root, "selector": field }));
        let files = json!({ "nodeId": field["nodeId"], "files": [path] });
        self.call("DOM.setFileInputFiles", &files);
    }

    /// Presses a key in the focused element.
    pub(crate) fn press(&self, key: &str) {
        let (code, text) = match key {
            "Tab" => (9, ""),
            "End" => (35, ""),
            "ArrowRight" => (39, ""),
            "ArrowDown" => (40, ""),
            "Enter" => (13, "\r"),
            "+" => (187, "+"),
            "." => (190, "."),
            _ => panic!("no test presses {key}"),
        };
        self.strike(&json!({ "key": key, "windowsVirtualKeyCode": code, "text": text }));
    }

    /// Presses a letter with the control key.
    pub(crate) fn press_with_control(&self, letter: char) {
        let code = u32::from(letter.to_ascii_uppercase());
        self.strike(
            &json!({ "key": letter, "windowsVirtualKeyCode": code, "modifiers": 2, "text": "" }),
        );
    }

    fn strike(&self, key: &Value) {
        let down = if key["text"] == "" { "rawKeyDown" } else { "keyDown" };
        for kind in [down, "keyUp"] {
            let mut event = key.clone();
            event["type"] = kind.into();
            if kind == "keyUp" {
                event["text"] = "".into();
            }
            self.call("Input.dispatchKeyEvent", &event);
        }
    }

    /// The results of `of` for the events so far.
    fn noted(&self, of: impl Fn(&str, &Value) -> Option<String>) -> Vec<String> {
        // Earlier events arrive before the answer to this.
        let _ = self.try_evaluate("0");
        let browser = self.browser.borrow();
        browser.events.iter().filter_map(|(method, said)| of(method, said)).collect()
    }

    /// The errors and warnings in the console and the log.
    pub(crate) fn complaints(&self) -> Vec<String> {
        self.noted(|method, said| match method {
            "Runtime.exceptionThrown" => Some(said["exceptionDetails"].to_string()),
            "Runtime.consoleAPICalled" => Some(said["args"].to_string()),
            "Log.entryAdded" => Some(said["entry"]["text"].to_string()),
            _ => None,
        })
    }

    /// Every address that the page requested.
    pub(crate) fn requests(&self) -> Vec<String> {
        self.noted(|method, said| {
            let asked = (method == "Network.requestWillBeSent").then_some(said)?;
            asked["request"]["url"].as_str().map(str::to_owned)
        })
    }

    /// Makes the page as high as its contents, so that every figure comes into view and is drawn.
    pub(crate) fn unfold(&self) {
        let height = self.evaluate("document.documentElement.scrollHeight").as_f64();
        self.size(height.map_or(900, |height| height as u32));
        std::thread::sleep(Duration::from_millis(500));
    }

    /// Saves a screenshot of the whole page; in the short form (`KESTIRIM_SHORT=1`) only of wide and light ones.
    pub(crate) fn screenshot(&self, name: &str) {
        self.unfold();
        if program::is_short() && (self.width < 500 || name.contains("dark")) {
            return;
        }
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("screenshots");
        fs::create_dir_all(&folder).expect("a folder for screenshots");
        let image = self.call("Page.captureScreenshot", &json!({ "format": "png" }));
        let image = STANDARD.decode(image["data"].as_str().expect("an image")).expect("base64");
        fs::write(folder.join(name), image).expect("the folder can be written");
    }
}

fn chromium() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    // Without the parts around a page it takes two thirds of the time.
    let names = ["chromium-headless-shell", "chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// The program with its own page, which ends when this is dropped.
pub(crate) struct Server {
    program: Child,
    page: String,
    datagrams: Option<SocketAddr>,
}

impl Server {
    /// Starts `host-sim` with arguments that make it serve a page, and reads the address.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        // `live` reserves its standard output for its report.
        let output: Box<dyn Read> = match arguments[0] {
            "live" => Box::new(program.stderr.take().expect("a pipe")),
            _ => Box::new(program.stdout.take().expect("a pipe")),
        };
        let (mut page, mut datagrams) = (None, None);
        let mut lines = BufReader::new(output).lines();
        while page.is_none() {
            let line = lines.next().expect("it says where its page is").expect("text");
            let words = || line.split([' ', ',']);
            page = words().find(|word| word.starts_with("http://")).map(str::to_owned);
            datagrams = datagrams.or(words().find_map(|word| word.parse().ok()));
        }
        Self { program, page: page.expect("it was found"), datagrams }
    }

    /// The address of the page, including its key.
    pub(crate) fn address(&self) -> &str {
        &self.page
    }

    /// The address of the page after the key has been handed over.
    pub(crate) fn place(&self) -> &str {
        place(&self.page)
    }

    /// The address on which it receives datagrams.
    pub(crate) fn datagrams(&self) -> SocketAddr {
        self.datagrams.expect("it listens")
    }
}

/// An address without the key and the name of a system.
fn place(address: &str) -> &str {
    address.split(['?', '#']).next().unwrap_or(address)
}

impl Drop for Server {
    fn drop(&mut self) {
        // The program may have ended by itself.
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}
