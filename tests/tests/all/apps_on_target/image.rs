//! Inspects the contents of an image, and decodes its log.

use std::collections::BTreeSet;

use anyhow::{Context, Result, bail};
use defmt_decoder::{DecodeError, Table};
use object::{Object, ObjectSection};
use target_bench::{App, Run};

/// The log lines of a run, `LEVEL text`.
pub(crate) fn log(app: &App, run: &Run) -> Result<Vec<String>> {
    let table = Table::parse(&app.file()?)?.context("the image logs")?;
    let mut decoder = table.new_stream_decoder();
    decoder.received(&run.log);
    let mut lines = Vec::new();
    loop {
        match decoder.decode() {
            Ok(frame) => {
                let level = frame.level().map_or("", |level| level.as_str());
                lines.push(format!("{level} {}", frame.display_message()));
            }
            Err(DecodeError::UnexpectedEof) => return Ok(lines),
            Err(DecodeError::Malformed) => bail!("the log is torn"),
        }
    }
}

/// Checks what is linked into an application's image, and prints its size.
pub(crate) fn check(name: &str, app: &App) -> Result<()> {
    let elf = app.elf()?;
    assert_eq!(elf.double_symbols(), Vec::<String>::new(), "{name} has no double precision");
    check_panics(name, app)
}

/// Checks that none of our code can panic, and prints the size of an application's image.
pub(crate) fn check_panics(name: &str, app: &App) -> Result<()> {
    check_panics_but_in(&[], name, app)
}

/// Checks that none of our code can panic except in these sources of async functions: the compiler makes them panic if
/// they are resumed after their end.
pub(crate) fn check_panics_but_in(resumed: &[&str], name: &str, app: &App) -> Result<()> {
    let elf = app.elf()?;
    let mut places = panicking(&app.file()?)?;
    places.retain(|place| !resumed.contains(&place.as_str()));
    let ours: Vec<&String> = places.iter().filter(|place| place.contains('/')).collect();
    assert_eq!(ours, Vec::<&String>::new(), "only foreign crates can panic");
    println!(
        "{name} on {}: {} bytes of flash, {} of static RAM; can panic: {places:?}",
        app.target().triple,
        elf.flash_bytes,
        elf.ram_bytes
    );
    Ok(())
}

/// The crates and directories in which something can panic: the panic handler names the place, so its file is among the
/// constants of the image.
fn panicking(elf: &[u8]) -> Result<BTreeSet<String>> {
    let file = object::File::parse(elf)?;
    let constants = file.section_by_name(".rodata").context("there are constants")?.data()?;
    let texts = constants.split(|&byte| !(b' '..=b'~').contains(&byte));
    let mut places = BTreeSet::new();
    for text in texts.filter_map(|text| str::from_utf8(text).ok()) {
        // Constants are contiguous: a path begins where the one before ends.
        let mut begin = 0;
        for end in text.match_indices(".rs").map(|(at, found)| at + found.len()) {
            places.insert(origin(&text[begin..end]));
            begin = end;
        }
    }
    Ok(places)
}

/// The crate that a file of a registry or of the standard library belongs to, without its version; the path of any
/// other file.
fn origin(path: &str) -> String {
    if path.contains("/library/core/") {
        return "core".to_owned();
    }
    let Some((_, inside)) = path.split_once("/registry/src/") else { return path.to_owned() };
    let package = inside.split('/').nth(1).unwrap_or(inside);
    package.rsplit_once('-').map_or(package, |(name, _)| name).to_owned()
}
