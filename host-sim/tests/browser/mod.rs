//! A browser that notes down what goes wrong on a page.

use std::ffi::OsStr;
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

use headless_chrome::protocol::cdp::Page::CaptureScreenshotFormatOption;
use headless_chrome::protocol::cdp::types::Event;
use headless_chrome::protocol::cdp::{Emulation, Log, Network, Runtime};
use headless_chrome::{Browser, LaunchOptions, Tab};
use serde_json::Value;

/// A page is given up if it does not get there within this time.
const PATIENCE: Duration = Duration::from_secs(60);

/// A page in a browser without a window.
pub(crate) struct Page {
    tab: Arc<Tab>,
    noted: Arc<Mutex<Noted>>,
    width: u32,
    _browser: Browser,
}

#[derive(Default)]
struct Noted {
    complaints: Vec<String>,
    requests: Vec<String>,
}

impl Page {
    /// Opens an address; none if this machine has no browser and need not have one.
    pub(crate) fn open(address: &str, width: u32) -> Option<Self> {
        let Some(program) = chromium() else {
            assert!(
                std::env::var_os("KESTIRIM_REQUIRE_BROWSER").is_none(),
                "a browser is required, but there is no chromium"
            );
            eprintln!("SKIPPED: no chromium on this machine");
            return None;
        };
        let options = LaunchOptions {
            path: Some(program),
            // The tests run as root where there are no user namespaces.
            sandbox: false,
            window_size: Some((width, 900)),
            idle_browser_timeout: 10 * PATIENCE,
            args: [OsStr::new("--disable-gpu"), OsStr::new("--hide-scrollbars")].to_vec(),
            ..LaunchOptions::default()
        };
        let browser = Browser::new(options).expect("the browser starts");
        let tab = browser.new_tab().expect("a tab");
        tab.set_default_timeout(PATIENCE);
        let noted = Arc::new(Mutex::new(Noted::default()));
        let notes = Arc::clone(&noted);
        tab.call_method(Runtime::Enable(None)).expect("the console is watched");
        tab.call_method(Log::Enable(None)).expect("the log is watched");
        let network = Network::Enable {
            max_total_buffer_size: None,
            max_resource_buffer_size: None,
            max_post_data_size: None,
            report_direct_socket_traffic: None,
            enable_durable_messages: None,
        };
        tab.call_method(network).expect("requests are watched");
        tab.add_event_listener(Arc::new(move |event: &Event| {
            notes.lock().expect("the notes").take(event);
        }))
        .expect("a listener");
        let page = Self { tab, noted, width, _browser: browser };
        page.size(900);
        page.tab.navigate_to(address).expect("an address");
        // The tab's own waiting misses a page that is there at once.
        let place = place(address);
        page.wait_for(&format!(
            "location.href.startsWith('{place}') && document.readyState === 'complete'"
        ));
        Some(page)
    }

    /// Makes the page this high, and as narrow as no window can be.
    fn size(&self, height: u32) {
        let metrics = Emulation::SetDeviceMetricsOverride {
            width: self.width,
            height,
            device_scale_factor: 1.0,
            mobile: self.width < 500,
            scale: None,
            screen_width: None,
            screen_height: None,
            position_x: None,
            position_y: None,
            dont_set_visible_size: None,
            screen_orientation: None,
            viewport: None,
            display_feature: None,
            device_posture: None,
        };
        self.tab.call_method(metrics).expect("a size");
    }

    /// What a piece of JavaScript says; promises are awaited.
    pub(crate) fn evaluate(&self, script: &str) -> Value {
        let result = self.tab.evaluate(script, true).expect("the script runs");
        result.value.unwrap_or(Value::Null)
    }

    /// Waits until a piece of JavaScript is true.
    pub(crate) fn wait_for(&self, script: &str) {
        let begun = Instant::now();
        // There is nobody to ask while one page gives way to the next.
        let came_true = || {
            let result = self.tab.evaluate(script, true);
            result.is_ok_and(|result| result.value == Some(Value::Bool(true)))
        };
        while !came_true() {
            let complaints = self.complaints();
            assert!(begun.elapsed() < PATIENCE, "{script} never came true: {complaints:?}");
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Puts a file into a field of a form.
    pub(crate) fn choose_file(&self, field: &str, path: &str) {
        let field = self.tab.find_element(field).expect("the field");
        field.set_input_files(&[path]).expect("the file is taken");
    }

    /// Presses a key where the focus is.
    pub(crate) fn press(&self, key: &str) {
        self.tab.press_key(key).expect("a key");
    }

    /// What the console and the log hold of errors and warnings.
    pub(crate) fn complaints(&self) -> Vec<String> {
        self.noted.lock().expect("the notes").complaints.clone()
    }

    /// Every address that the page asked for.
    pub(crate) fn requests(&self) -> Vec<String> {
        self.noted.lock().expect("the notes").requests.clone()
    }

    /// Keeps what the whole page looks like.
    pub(crate) fn screenshot(&self, name: &str) -> PathBuf {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("screenshots");
        fs::create_dir_all(&folder).expect("a folder for screenshots");
        let height = self.evaluate("document.documentElement.scrollHeight").as_f64();
        self.size(height.map_or(900, |height| height as u32));
        // Figures that come into view are drawn now.
        std::thread::sleep(Duration::from_millis(500));
        let png = CaptureScreenshotFormatOption::Png;
        let image = self.tab.capture_screenshot(png, None, None, true).expect("a screenshot");
        let path = folder.join(name);
        fs::write(&path, image).expect("the folder can be written");
        path
    }
}

impl Noted {
    fn take(&mut self, event: &Event) {
        match event {
            Event::RuntimeExceptionThrown(thrown) => {
                self.complaints.push(format!("{:?}", thrown.params.exception_details));
            }
            Event::RuntimeConsoleAPICalled(call) => {
                self.complaints.push(format!("{:?}", call.params.args));
            }
            Event::LogEntryAdded(entry) => {
                self.complaints.push(entry.params.entry.text.clone());
            }
            Event::NetworkRequestWillBeSent(request) => {
                self.requests.push(request.params.request.url.clone());
            }
            _ => {}
        }
    }
}

fn chromium() -> Option<PathBuf> {
    let folders = std::env::var_os("PATH")?;
    let names = ["chromium", "chromium-browser", "google-chrome"];
    std::env::split_paths(&folders)
        .flat_map(|folder| names.map(|name| folder.join(name)))
        .find(|program| program.is_file())
}

/// The program with a page of its own; it ends with this.
pub(crate) struct Server {
    program: Child,
    page: String,
    datagrams: Option<SocketAddr>,
}

impl Server {
    /// Starts `host-sim` with arguments that make it serve a page, and reads where.
    pub(crate) fn start(arguments: &[&str]) -> Self {
        let mut program = Command::new(env!("CARGO_BIN_EXE_host-sim"))
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        // `live` keeps its standard output for its report.
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

    /// Where the page is, with the key to it.
    pub(crate) fn address(&self) -> &str {
        &self.page
    }

    /// Where the page is once the key was handed over.
    pub(crate) fn place(&self) -> &str {
        place(&self.page)
    }

    /// Where it listens.
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
        // It may have ended by itself.
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}
