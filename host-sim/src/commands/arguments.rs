//! Parsing of the command line shared by the commands.

use clap::error::{ContextKind, ContextValue};
use clap::{ArgMatches, FromArgMatches};

use crate::Error;
use crate::system::AnySystem;
use crate::systems::ALL;

/// Parses the options of a command that are declared in a struct.
pub(super) fn read<T: FromArgMatches>(matches: &ArgMatches) -> Result<T, Error> {
    T::from_arg_matches(matches).map_err(|error| Error::Usage(sentence(&error)))
}

/// The system that a subcommand names, and its arguments.
pub(super) fn chosen(matches: &ArgMatches) -> Result<(&'static dyn AnySystem, &ArgMatches), Error> {
    let chosen = matches.subcommand().and_then(|(name, matches)| Some((find(name)?, matches)));
    chosen.ok_or_else(|| Error::Usage("expected a system".to_owned()))
}

/// The system with this name.
pub(super) fn find(name: &str) -> Option<&'static dyn AnySystem> {
    ALL.iter().copied().find(|system| system.name() == name)
}

/// The error message of clap for a wrong command line, folded into one plain sentence.
pub(super) fn sentence(error: &clap::Error) -> String {
    let rendered = error.render().to_string();
    let complaint = rendered.lines().take_while(|line| !line.trim().is_empty());
    let joined = complaint.map(str::trim).collect::<Vec<_>>().join(" ");
    let complaint = joined.trim_start_matches("error: ");
    match meant(error) {
        Some(name) => format!("{complaint}: did you mean {name}? (see --help)"),
        // For an invalid value the message already lists the valid ones.
        None if error.get(ContextKind::ValidValue).is_some() => complaint.to_owned(),
        None => format!("{complaint} (see --help)"),
    }
}

/// The command or option that resembles an unknown one.
fn meant(error: &clap::Error) -> Option<&str> {
    let similar = [ContextKind::SuggestedSubcommand, ContextKind::SuggestedArg];
    similar.into_iter().find_map(|kind| match error.get(kind)? {
        ContextValue::String(name) => Some(name.as_str()),
        ContextValue::Strings(names) => names.first().map(String::as_str),
        _ => None,
    })
}
