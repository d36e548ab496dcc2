//! `host-sim check`: examines a log before it is used.

use clap::{ArgMatches, Command};
use kestirim_replay::Finding;
use serde_json::json;

use super::arguments::chosen;
use super::replay::{opened, recorded};
use crate::systems::ALL;
use crate::{Error, output};

pub(super) fn command() -> Command {
    let about =
        "Look at a log before it is used: rates, gaps, clipping, rest, geometry, and what to do";
    Command::new("check")
        .about(about)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(ALL.iter().map(|system| recorded(*system)))
}

/// Reads the log, examines it and prints the findings; finding a fault is not an error.
pub(super) fn run(matches: &ArgMatches) -> Result<(), Error> {
    let (system, matches) = chosen(matches)?;
    let (opened, settings) = opened(system, matches)?;
    let findings = opened.check(&settings)?;
    if matches.get_flag("json") {
        let faults = findings.iter().filter(|finding| finding.is_fault()).count();
        let report = json!({ "system": system.name(), "faults": faults, "findings": findings });
        return output::print(&report.to_string());
    }
    let mut table = output::table();
    let is_sound = !findings.iter().any(Finding::is_fault);
    for finding in findings {
        let mark = if finding.is_fault() { "!" } else { "" };
        let text = finding.sentence();
        table.add_row([mark, finding.about, &text]);
    }
    if is_sound {
        table.add_row(["", "verdict", "nothing wrong was found"]);
    }
    output::print(&table.to_string())
}
