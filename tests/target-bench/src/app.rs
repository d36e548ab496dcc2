//! Builds and runs an application of `tests/firmware/apps` or `contrib`.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::thread::{self, JoinHandle};

use anyhow::{Context, Result, anyhow, bail};

use crate::elf::Elf;
use crate::form::is_short;
use crate::images::{Images, Packages, Profile, build_apart, left_out};
use crate::qemu::{ERRORS, OUTPUT, STREAM, emulate};
use crate::target::{CORTEX_M0, CORTEX_M4F, RV32IMC, Target};
use crate::toolchain::Apart;

/// The names of the files that application and host share in the emulator's working directory.
const CARD: &str = "card.img";
const LOG: &str = "log.bin";
const TELEMETRY: &str = "telemetry.bin";
const LINE: &str = "line.sock";

/// The applications of each target, in groups that are built together: those of one board. The first group is the short
/// form.
const APPLICATIONS: [(&Target, Packages); 4] = [
    (&CORTEX_M0, &["pedestrian-firmware", "uav-firmware"]),
    (&CORTEX_M4F, &["drone-firmware", "pedestrian-firmware", "uav-firmware"]),
    (&CORTEX_M4F, &["gnss-firmware", "foot-embassy", "foot-rtic"]),
    (&RV32IMC, &["robot-firmware"]),
];

/// An application, built for one target.
#[derive(Clone, Debug)]
pub struct App {
    target: &'static Target,
    board: &'static [&'static str],
    image: PathBuf,
}

/// The results of a run of an application.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Run {
    /// Whether it ended successfully.
    pub success: bool,
    /// Its output besides the log: the reason why it could not go on.
    pub console: String,
    /// The bytes that it sent over the first serial port.
    pub telemetry: Vec<u8>,
    /// Its log, in `defmt`'s encoding.
    pub log: Vec<u8>,
    /// The contents of the SD card, if it had one.
    pub card: Option<Vec<u8>>,
}

impl App {
    /// Builds an application together with the others of its board.
    ///
    /// Prints a notice and returns `None` on a machine without the tools, and for what the short form leaves out.
    ///
    /// # Errors
    /// It is no application of this target, it does not build, or a tool is missing and
    /// `KESTIRIM_REQUIRE_TARGETS` is 1.
    pub fn of(target: &'static Target, package: &'static str) -> Result<Option<Self>> {
        let (_, packages) = APPLICATIONS
            .into_iter()
            .find(|(of, packages)| of.triple == target.triple && packages.contains(&package))
            .with_context(|| format!("{package} is not for {}", target.triple))?;
        if is_short() && packages != APPLICATIONS[0].1 {
            return left_out(package);
        }
        let images = Images::of_packages(packages, target, Profile::Speed)?;
        Ok(images.map(|images| Self { target, board: target.board, image: images.file(package) }))
    }

    /// Builds an application that runs on the machine of the images, which has more memory.
    ///
    /// # Errors
    /// As [`App::of`].
    pub fn of_machine(target: &'static Target, package: &'static str) -> Result<Option<Self>> {
        Ok(Self::of(target, package)?.map(|app| Self { board: target.machine, ..app }))
    }

    /// Builds an application with its own workspace, for a board that has no emulator.
    ///
    /// # Errors
    /// As [`App::of`].
    pub fn apart(target: &'static Target, package: Apart) -> Result<Option<Self>> {
        let directory = build_apart(target, package, Profile::Speed)?;
        let image = directory.map(|directory| directory.join(package.name));
        Ok(image.map(|image| Self { target, board: target.board, image }))
    }

    /// The target that it was built for.
    pub fn target(&self) -> &'static Target {
        self.target
    }

    /// The contents of the image's file.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn file(&self) -> Result<Vec<u8>> {
        fs::read(&self.image).with_context(|| format!("cannot read {}", self.image.display()))
    }

    /// Opens the file of the image.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn elf(&self) -> Result<Elf> {
        Elf::read(&self.image)
    }

    /// Runs the application until it ends, with a recording for its sensors to play and a card in its slot.
    ///
    /// # Errors
    /// It does not end, or leaves no files.
    pub fn run(&self, stream: &[u8], card: Option<&[u8]>) -> Result<Run> {
        let directory = tempfile::tempdir()?;
        let file = |name| directory.path().join(name);
        fs::write(file(STREAM), stream)?;
        if let Some(card) = card {
            fs::write(file(CARD), card)?;
        }
        let run = self.run_in(directory.path(), |qemu| {
            qemu.args(["-serial", &format!("file:{TELEMETRY}")]);
            if card.is_some() {
                qemu.args(["-drive", &format!("if=sd,format=raw,file={CARD}")]);
            }
        })?;
        Ok(Run {
            telemetry: fs::read(file(TELEMETRY))?,
            card: card.map(|_| fs::read(file(CARD))).transpose()?,
            ..run
        })
    }

    /// Runs the application with these bytes arriving at its first serial port, until it ends.
    ///
    /// # Errors
    /// It does not end, or leaves no files.
    pub fn run_on_line(&self, bytes: &[u8]) -> Result<Run> {
        let directory = tempfile::tempdir()?;
        let line = Line::new(directory.path().join(LINE), bytes)?;
        let run = self.run_in(directory.path(), |qemu| {
            qemu.args([
                "-chardev",
                &format!("socket,id=line,path={LINE}"),
                "-serial",
                "chardev:line",
            ]);
        })?;
        Ok(Run { telemetry: line.received()?, ..run })
    }

    /// Runs the application in a directory, on a board extended by `configure`; its telemetry and card are not
    /// collected.
    fn run_in(&self, directory: &Path, configure: impl FnOnce(&mut Command)) -> Result<Run> {
        let file = |name| directory.join(name);
        // The emulator forwards what the application writes to the semihosting host's standard output. Output without a
        // file handle, with which a panicking application ends, goes to the emulator's own console.
        let log = File::create(file(LOG))?;
        let status = emulate(self.target, &self.image, directory, |qemu| {
            qemu.args(self.board).args(["-icount", "shift=0,sleep=off"]).stdout(log);
            configure(qemu);
        })?;
        let Some(status) = status else {
            bail!("{} was still running", self.image.display());
        };
        Ok(Run {
            success: status.success(),
            console: fs::read_to_string(file(OUTPUT))? + &fs::read_to_string(file(ERRORS))?,
            log: fs::read(file(LOG))?,
            telemetry: Vec::new(),
            card: None,
        })
    }
}

/// The host's end of an application's serial port.
struct Line {
    socket: PathBuf,
    reader: JoinHandle<io::Result<Vec<u8>>>,
}

impl Line {
    /// Waits at a socket for the emulator, sends these bytes to it and collects what it sends back.
    fn new(socket: PathBuf, bytes: &[u8]) -> Result<Self> {
        let (listener, bytes) = (UnixListener::bind(&socket)?, bytes.to_vec());
        let reader = thread::spawn(move || {
            let (mut stream, _) = listener.accept()?;
            let mut sender = stream.try_clone()?;
            // An emulator that has ended takes no more bytes; its output shows why.
            let sender = thread::spawn(move || sender.write_all(&bytes).is_ok());
            let mut received = Vec::new();
            // An emulator that ends with unread bytes breaks the connection; the bytes received before count.
            let _ = stream.read_to_end(&mut received);
            let _ = sender.join();
            Ok(received)
        });
        Ok(Self { socket, reader })
    }

    /// The bytes received until the emulator ended.
    fn received(self) -> Result<Vec<u8>> {
        // Releases the reader if the emulator never connected.
        let _ = UnixStream::connect(&self.socket);
        let received = self.reader.join().map_err(|_| anyhow!("the line's reader panicked"))?;
        received.context("the serial line")
    }
}
