//! The options of `host-sim fleet`.

use std::fmt::Write;
use std::net::SocketAddr;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;
use std::time::{Duration, Instant};

use clap::{Args, Command};

use super::nats::{Names, Nats};
use super::transport::Transport;
use super::udp::Udp;
use crate::Error;
use crate::commands::live::options::{followed, followers};
use crate::system::AnySystem;

/// The help of the option `--nats`.
const NATS: &str = "Follow a stream of NATS JetStream, such as nats://127.0.0.1:4222";

/// Options that have nothing to do with whose estimator it is.
#[derive(Debug, Clone, Args)]
pub(super) struct Options {
    #[arg(long, value_name = "URL", help = NATS, required_unless_present = "udp", conflicts_with = "udp")]
    nats: Option<String>,
    /// Listen to datagrams for this address instead: there is no log, and what is killed is not made again
    #[arg(long, value_name = "ADDR:PORT")]
    udp: Option<String>,
    /// Where datagrams with estimates go
    #[arg(long, value_name = "ADDR:PORT", requires = "udp")]
    to: Option<SocketAddr>,
    /// Stream of the frames; it is made of all subjects NAME.> if it is not there
    #[arg(long, value_name = "NAME", default_value = "frames")]
    stream: String,
    /// Those of the stream that are followed here: one part of several, if there are more such programs [default: all]
    #[arg(long, value_name = "SUBJECT")]
    subject: Option<String>,
    /// Stream of the estimates, made likewise: those of device 7 have the subject NAME.7
    #[arg(long, value_name = "NAME", default_value = "estimates")]
    estimates: String,
    /// What the broker calls whoever follows these subjects [default: kestirim-SYSTEM, with the SUBJECT if there is one]
    #[arg(long, value_name = "NAME")]
    consumer: Option<String>,
    /// Folder with the states of the devices; a program that begins goes on with those that are there
    #[arg(long, value_name = "FOLDER", default_value = "target/fleet")]
    pub(super) state: PathBuf,
    /// Between two times that states are written to the disk, and the log is told
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = interval)]
    every: f64,
    /// Answer with metrics for Prometheus at http://ADDR:PORT/metrics
    #[arg(long, value_name = "ADDR:PORT")]
    pub(super) metrics: Option<SocketAddr>,
    /// End after this many seconds
    #[arg(long, value_name = "S", value_parser = clap::value_parser!(u64).range(1..))]
    pub(super) seconds: Option<u64>,
    /// At the end print one JSON object instead of a table
    #[arg(long)]
    pub(super) json: bool,
}

/// The longest interval between two writes of the states, in seconds: far shorter than the broker remembers the ids of
/// estimates, as those since the last states are produced again.
const LONGEST_S: f64 = 60.0;

fn interval(text: &str) -> Result<f64, String> {
    let seconds = text.parse().ok().filter(|seconds| (0.0..=LONGEST_S).contains(seconds));
    seconds.ok_or_else(|| format!("expected seconds, up to {LONGEST_S}"))
}

impl Options {
    /// The interval between two writes of the states.
    pub(super) fn every(&self) -> Duration {
        Duration::from_secs_f64(self.every)
    }

    /// The selected transport and its name; its waits end at the given signal or time.
    ///
    /// # Errors
    /// [`Error::Usage`] if the transport is not available.
    pub(super) fn transport(
        &self,
        system: &str,
        (stop, until): (&Arc<AtomicBool>, Option<Instant>),
    ) -> Result<(Box<dyn Transport>, String), Error> {
        let Some(url) = &self.nats else {
            let udp = Udp::bind(self.udp.as_deref().unwrap_or_default(), self.to)?;
            let address = udp.address().map_or_else(String::new, |address| address.to_string());
            return Ok((Box::new(udp), format!("UDP {address}")));
        };
        let subject = self.subject.clone().unwrap_or_else(|| format!("{}.>", self.stream));
        let name = format!("{url}, {subject}");
        let (stream, estimates) = (self.stream.clone(), self.estimates.clone());
        let consumer =
            self.consumer.clone().unwrap_or_else(|| consumer(system, self.subject.as_deref()));
        let names = Names { stream, subject, estimates, consumer };
        Ok((Box::new(Nats::connect(url, names, (Arc::clone(stop), until))?), name))
    }
}

/// The default name of a consumer: one per subject, as two consumers of one name would take the stream from each other.
/// Characters that are not allowed in names are replaced by their codes.
fn consumer(system: &str, subject: Option<&str>) -> String {
    let mut name = format!("kestirim-{system}");
    for byte in subject.map(|subject| format!("-{subject}")).unwrap_or_default().bytes() {
        match byte {
            b'-' | b'0'..=b'9' | b'A'..=b'Z' | b'a'..=b'z' => name.push(char::from(byte)),
            // Writing to a string does not fail.
            _ => name.write_fmt(format_args!("_{byte:02x}")).unwrap_or_default(),
        }
    }
    name
}

/// The command, with a subcommand and its options for each system.
pub(in crate::commands) fn command() -> Command {
    let of = |system: &'static dyn AnySystem| {
        let command = Options::augment_args(Command::new(system.name())).about(system.title());
        command.next_help_heading("Estimator").args(followed(system))
    };
    Command::new("fleet")
        .about("Follow any number of devices behind a broker, each with an estimator of its own")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(followers().filter(|system| !system.hears_bytes()).map(of))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn programs_that_follow_other_subjects_have_other_names() {
        assert_eq!(consumer("any", None), "kestirim-any");
        let names = ["frames.0.>", "frames.1.>", "frames.0.*", "frames.0-*", "frames_0.*"]
            .map(|subject| consumer("any", Some(subject)));
        assert_eq!(names[0], "kestirim-any-frames_2e0_2e_3e");
        for (index, name) in names.iter().enumerate() {
            assert!(!name.contains(['.', '*', '>', '/', '\\', ' ']), "{name}");
            assert!(!names[..index].contains(name), "{name} is that of another subject");
        }
    }
}
