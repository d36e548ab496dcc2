//! The options of `host-sim live`.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::builder::PossibleValuesParser;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Arg, ArgMatches, Args, Command};

use crate::commands::arguments::{self, find};
use crate::commands::serve;
use crate::system::{AnySystem, Files, Panel, Plan, Setting, SettingValue, Settings};
use crate::systems::ALL;
use crate::{Error, output};

/// The name for no system: only the sender's own estimates are shown.
const NONE: &str = "none";

/// The option that follows a calibration while it is recorded.
const CALIBRATE: &str = "calibrate";

/// The default address on which senders reach this program: on the same machine.
const DEFAULT_ADDRESS: &str = "127.0.0.1:5775";

/// The option, and the page's control, that selects a device.
const DEVICE: &str = "device";
const DEVICE_HELP: &str = "number of the device that is shown in detail";

fn is_number(text: &str) -> Result<(), String> {
    text.parse::<u32>().map(|_| ()).map_err(|_| "expected a device's number".to_owned())
}

/// Options of a stream that have nothing to do with who sends it.
#[derive(Debug, Clone, Args)]
pub struct Stream {
    /// Listen to datagrams for this address [default: 127.0.0.1:5775, which only this machine reaches]
    #[arg(long, value_name = "ADDR:PORT", conflicts_with_all = ["serial", "file"])]
    pub udp: Option<String>,
    /// Listen to a serial port
    #[arg(long, value_name = "DEV", conflicts_with = "file")]
    pub serial: Option<PathBuf>,
    /// Speed of the serial port
    #[arg(long, value_name = "BAUD", default_value_t = 115_200, requires = "serial")]
    pub baud: u32,
    /// Play a recording back, as fast as it goes
    #[arg(long, value_name = "RECORDING", conflicts_with_all = ["record", "seconds"])]
    pub file: Option<PathBuf>,
    /// Write everything that arrives to this new file, before it is looked at
    /// [default: target/live/DATE-TIME.frames]
    #[arg(long, value_name = "NEW.frames")]
    pub record: Option<PathBuf>,
    /// Which device is shown in detail, of several that say who they are [default: the first that is heard]
    #[arg(long, value_name = "NUMBER")]
    pub device: Option<u32>,
    /// End after this many seconds
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..))]
    pub seconds: Option<u64>,
    /// End after this many good frames
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: Option<u32>,
    /// Port of the page on this machine that shows the stream; 0 takes a free one
    #[arg(long, value_name = "P", default_value_t = serve::PORT)]
    pub port: u16,
    /// Show no page
    #[arg(long, conflicts_with = "port")]
    pub headless: bool,
    /// At the end print one JSON object instead of a table
    #[arg(long)]
    pub json: bool,
}

impl Stream {
    /// The address to which datagrams are to be sent.
    pub(super) fn address(&self) -> &str {
        self.udp.as_deref().unwrap_or(DEFAULT_ADDRESS)
    }
}

/// The system whose estimator follows a stream, with its settings.
#[derive(Debug, Clone)]
pub struct Following {
    /// The name of the system, or `none`.
    pub name: &'static str,
    /// The figures of the system.
    pub panels: &'static [Panel],
    /// The plan of the estimator, if there is one.
    pub plan: Option<Arc<dyn Plan>>,
    /// The device that is shown in detail; `None` selects the first one.
    pub device: Option<u32>,
    /// The system, settings and files that the plan was made from.
    origin: Option<Origin>,
}

/// A system with its settings and files.
#[derive(Debug, Clone)]
struct Origin {
    system: &'static dyn AnySystem,
    settings: Settings,
    files: Files,
}

impl Following {
    /// Follows without an estimator.
    pub const NONE: Self =
        Self { name: NONE, panels: &Panel::ALL, plan: None, device: None, origin: None };

    /// Follows with the estimator of a system.
    ///
    /// # Errors
    /// Errors in files and settings; [`Error::Usage`] for a system that cannot follow a stream.
    pub fn of(
        system: &'static dyn AnySystem,
        settings: &Settings,
        files: &Files,
    ) -> Result<Self, Error> {
        let plan = system.online(settings, files)?;
        let name = system.name();
        let plan =
            plan.ok_or_else(|| Error::Usage(format!("{name} follows no stream (--system)")))?;
        let origin = Origin { system, settings: settings.clone(), files: files.clone() };
        Ok(Self {
            name,
            panels: system.panels(),
            plan: Some(plan),
            device: None,
            origin: Some(origin),
        })
    }

    /// Whether the estimator decodes the bytes of the stream itself, which is then not telemetry.
    pub(super) fn hears_bytes(&self) -> bool {
        self.origin.as_ref().is_some_and(|origin| origin.system.hears_bytes())
    }

    /// The settings with their values; if there are several devices, also the one that selects the device shown.
    pub(super) fn settings(&self, has_devices: bool) -> Settings {
        let settings = self.origin.as_ref().map(|origin| origin.settings.clone());
        let mut settings = settings.unwrap_or_else(|| Settings::new([]));
        if has_devices {
            settings = settings.and(Setting::text(DEVICE, DEVICE_HELP, "NUMBER", is_number));
        }
        if let Some(device) = self.device.filter(|_| has_devices) {
            settings.give(vec![(DEVICE, SettingValue::Text(device.to_string()))]);
        }
        settings
    }

    /// The plan for the estimators of devices that are not shown; `None` while a calibration is recorded, as its single
    /// file belongs to the device that is shown.
    pub(super) fn plan_of_others(&self) -> Option<&Arc<dyn Plan>> {
        self.plan.as_ref().filter(|_| self.origin.is_some())
    }

    /// The same system and files with other settings.
    ///
    /// # Errors
    /// Those of [`Self::of`]; [`Error::Usage`] for settings that would have no effect.
    pub(super) fn with(&self, settings: &Settings) -> Result<Self, Error> {
        let device = settings.text(DEVICE).and_then(|number| number.parse().ok()).or(self.device);
        let settings = settings.without(|name| name == DEVICE);
        let following = match &self.origin {
            Some(Origin { system, files, .. }) => {
                system.refuse_idle(&settings)?;
                Self::of(*system, &settings, files)?
            }
            None => self.clone(),
        };
        Ok(Self { device, ..following })
    }
}

/// `host-sim live`, with the options of the system that `arguments` names.
pub(in crate::commands) fn command(arguments: &[OsString]) -> Command {
    let names = followers().map(AnySystem::name);
    let names: Vec<_> = std::iter::once(NONE).chain(names).collect();
    let command = Stream::augment_args(Command::new("live"))
        .about("Listen to a sender's telemetry, record it and follow it with a system's estimator")
        .arg(
            Arg::new("system")
                .long("system")
                .value_name("SYSTEM")
                .help("Whose estimator follows the stream; none shows what the sender itself estimates; options of a \
                       system: --system NAME --help")
                .value_parser(PossibleValuesParser::new(names))
                .default_value(NONE),
        );
    let Some(system) = named(arguments) else { return command.after_help(options_of_systems()) };
    command
        .next_help_heading(format!("Of --system {}", system.name()))
        .args(followed(system))
        .args(watches(system).then(calibrate))
}

/// The arguments of a system's files and settings that apply to a live stream.
pub(in crate::commands) fn followed(system: &dyn AnySystem) -> Vec<Arg> {
    let settings = live_settings(system);
    let files = system.files().iter().filter(|field| field.in_live);
    let is_file = |name: &str| system.files().iter().any(|it| it.in_live && it.name == name);
    let others = settings.iter().filter(|it| !is_file(it.name)).flat_map(Setting::arguments);
    files.map(|field| field.argument(&settings)).chain(others).collect()
}

/// The settings and files that a command line gives.
///
/// # Errors
/// Errors in the command line.
pub(in crate::commands) fn given(
    system: &dyn AnySystem,
    matches: &ArgMatches,
) -> Result<(Settings, Files), Error> {
    let mut settings = Settings::matched(live_settings(system), matches);
    let files = Files::matched(system.files(), matches, &mut settings)?;
    system.refuse_idle(&settings)?;
    Ok((settings, files))
}

/// Whether the system can follow a calibration while it is recorded.
fn watches(system: &dyn AnySystem) -> bool {
    system.calibration().is_some_and(|it| it.watch(Path::new("")).is_some())
}

fn calibrate() -> Arg {
    let help = "Follow nobody, but look at a calibration while it is made: tell what to do next, and write it to this file at \
                the end";
    let argument = Arg::new(CALIBRATE).long(CALIBRATE).value_name("OUT.csv").help(help);
    argument.value_parser(clap::value_parser!(PathBuf))
}

/// A list of the options that each system has beside the common ones.
fn options_of_systems() -> String {
    let lines = followers().map(|system| {
        let files =
            system.files().iter().filter(|field| field.in_live).map(|field| field.name.to_owned());
        let settings = live_settings(system);
        let mut options: Vec<_> = files
            .chain(settings.iter().map(Setting::option))
            .chain(watches(system).then(|| CALIBRATE.to_owned()))
            .map(|name| format!("--{name}"))
            .collect();
        options.dedup();
        format!("  --system {}: {}", system.name(), options.join(" "))
    });
    let lines: Vec<_> = lines.collect();
    format!("Options of a system (--system NAME --help tells what they do):\n{}", lines.join("\n"))
}

/// The stream and the system that the arguments ask for.
pub(super) fn read(matches: &ArgMatches) -> Result<(Stream, Following), Error> {
    let stream = arguments::read::<Stream>(matches)?;
    let system = matches.get_one::<String>("system").and_then(|name| find(name));
    let device = stream.device;
    let Some(system) = system else { return Ok((stream, Following { device, ..Following::NONE })) };
    let (settings, files) = given(system, matches)?;
    if let Ok(Some(to)) = matches.try_get_one::<PathBuf>(CALIBRATE) {
        let has_file = system.files().iter().any(|field| files.one(field.name).is_some());
        if has_file || !settings.arguments().is_empty() {
            let problem = "--calibrate follows nobody: expected no option of the system beside it";
            return Err(Error::Usage(problem.to_owned()));
        }
        output::refuse_overwriting("--calibrate", Some(to), stream.file.as_ref())?;
        let (name, panels) = (system.name(), system.panels());
        let plan = system.calibration().and_then(|it| it.watch(to));
        return Ok((stream, Following { name, panels, plan, device, origin: None }));
    }
    Ok((stream, Following { device, ..Following::of(system, &settings, &files)? }))
}

/// The error message for an option that belongs to another system, which it names.
pub(in crate::commands) fn complaint(error: &clap::Error) -> Option<String> {
    let Some(ContextValue::String(option)) = error.get(ContextKind::InvalidArg) else {
        return None;
    };
    if error.kind() != ErrorKind::UnknownArgument {
        return None;
    }
    let name = option.trim_start_matches('-').split(['=', ' ']).next()?;
    let has = |system: &&dyn AnySystem| {
        let files = system.files().iter().any(|field| field.in_live && field.name == name);
        files || live_settings(*system).iter().any(|setting| setting.option() == name)
    };
    let systems: Vec<_> = followers().filter(has).map(AnySystem::name).collect();
    (!systems.is_empty()).then(|| format!("--{name} is for --system {}", systems.join(" or ")))
}

/// The systems that can follow a stream.
pub(in crate::commands) fn followers() -> impl Iterator<Item = &'static dyn AnySystem> {
    ALL.iter().copied().filter(|system| !system.panels().is_empty())
}

fn live_settings(system: &dyn AnySystem) -> Vec<Setting> {
    system.settings().into_iter().filter(|setting| setting.in_live).collect()
}

/// The system that a command line of `live` names, before it is read.
fn named(arguments: &[OsString]) -> Option<&'static dyn AnySystem> {
    let mut words = arguments.iter().filter_map(|word| word.to_str());
    words.next();
    if words.next() != Some("live") {
        return None;
    }
    while let Some(word) = words.next() {
        if word == "--system" {
            return find(words.next()?);
        }
        if let Some(name) = word.strip_prefix("--system=") {
            return find(name);
        }
    }
    None
}
