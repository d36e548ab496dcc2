//! Benchmarks our readers on this machine against others of the same files, and a station's day from files to
//! positions:
//!
//! ```text
//! cargo bench -p kestirim-tests --bench readers
//! ```
//!
//! The benchmark makes its own files; recorded days are also read where they are available. Peers are the `csv` crate
//! with fast-float2, and, where installed, polars (`python3 -c 'import polars'`) and RTKLIB (`rnx2rtkp`). A number is
//! the processor time, of all threads, of the fastest of several rounds.

mod peers;
mod synthetic;

use std::hint::black_box;
use std::path::{Path, PathBuf};
use std::time::Duration;

use anyhow::ensure;
use kestirim_gnss_files::{Clocks, Observations, Orbits, Text};
use kestirim_gnss_ppp::Corrections;
use kestirim_import::{NamedTable, Options, Table, inertial};
use kestirim_ppp_filter::{Config, Motion};
use kestirim_replay::gnss::{Pass, Paths, Recording, Shelf, follow};
use kestirim_tests::recordings;
use rustix::time::{ClockId, clock_gettime};

/// The number of rounds, of which the fastest counts.
const ROUNDS: usize = 7;

fn main() -> anyhow::Result<()> {
    let folder = tempfile::tempdir()?;
    println!("{:34} {:>6} {:>10}   of others", "MB/s", "MB", "ours");
    tables(folder.path())?;
    let day = synthetic::day(folder.path())?;
    gnss_files("synthetic", &day)?;
    station_day("synthetic", &day)?;
    let recorded = recordings::folder().map(|folder| folder.join("gnss"));
    for name in ["esbc2020177", "esbc2020177_multi"] {
        if let Some(files) = recorded.as_ref().and_then(|folder| Files::of(&folder.join(name))) {
            gnss_files(name, &files)?;
            station_day(name, &files)?;
        } else {
            println!("{name}: SKIPPED, it is not there");
        }
    }
    Ok(())
}

/// The files of a station's day.
struct Files {
    obs: PathBuf,
    sp3: Vec<PathBuf>,
    clk: Vec<PathBuf>,
    antex: Vec<PathBuf>,
    /// The navigation file that RTKLIB additionally needs; if there is one, all files are uncompressed and only of GPS.
    nav: Option<PathBuf>,
}

impl Files {
    /// The files in a folder; `None` if it does not exist.
    fn of(folder: &Path) -> Option<Self> {
        let mut all: Vec<_> = folder.read_dir().ok()?.flatten().map(|it| it.path()).collect();
        all.sort();
        let named = |words: &[&str]| {
            let has = |path: &&PathBuf| {
                let name = path.to_string_lossy().to_lowercase();
                words.iter().any(|word| name.contains(word))
            };
            all.iter().filter(has).cloned().collect::<Vec<_>>()
        };
        let obs = named(&[".rnx", ".crx"]).into_iter().next()?;
        let [sp3, clk, antex] = [".sp3", ".clk", ".atx"].map(|word| named(&[word]));
        Some(Self { obs, sp3, clk, antex, nav: None })
    }

    fn paths(&self) -> Paths<'_> {
        let Self { obs, sp3, clk, antex, .. } = self;
        Paths { obs, sp3, nav: &[], antex, clk, bias: &[], blq: None, erp: None }
    }
}

/// Benchmarks reading of tables of numbers.
fn tables(folder: &Path) -> anyhow::Result<()> {
    let walk = synthetic::walk();
    let path = folder.join("walk.csv");
    std::fs::write(&path, &walk)?;
    let peers = [
        ("csv + fast-float2", Some(fastest(|| peers::csv(&walk)))),
        ("polars", peers::polars(&path)),
        ("digits alone", Some(fastest(|| peers::digits(&walk)))),
    ];
    let rows = || Table::read(&kestirim_import::Text::new(&walk)?).map(|table| table.lines.len());
    let samples = || inertial::read(&walk, &Options::default()).map(|it| it.samples.len());
    // A failing reader would be the fastest of all.
    let (found, taken) = (rows()?, samples()?);
    ensure!(found == 200_000 && taken > 0, "{found} rows, {taken} samples");
    let table = fastest(rows);
    row("CSV, 200 000 rows of 7 numbers", walk.len(), table, &peers);
    let read = fastest(samples);
    row("the same, units and axes found", walk.len(), read, &peers);
    let ranges = synthetic::ranges();
    let path = folder.join("ranges.csv");
    std::fs::write(&path, &ranges)?;
    let peers = [
        ("csv + fast-float2", Some(fastest(|| peers::csv(&ranges)))),
        ("polars", peers::polars(&path)),
    ];
    let options = Options::default();
    let by_name = || {
        let text = kestirim_import::Text::new(&ranges)?;
        let found = NamedTable::find(&text, &options, |it| it.require(["t", "range"]));
        let (table, [t, range]) = found.ok_or_else(|| anyhow::anyhow!("no table"))??;
        let number = |field: Option<&std::borrow::Cow<'_, [u8]>>| table.number(field?);
        let rows = table.rows().filter_map(|(_, row)| {
            Some(number(row.get(t.column))? + number(row.get(range.column))?)
        });
        anyhow::Ok(rows.sum::<f64>())
    };
    ensure!(by_name()?.is_finite(), "no ranges");
    let named = fastest(by_name);
    row("CSV, 500 000 ranges, by name", ranges.len(), named, &peers);
    Ok(())
}

/// Benchmarks each file of a day separately: first unpacking, then reading.
fn gnss_files(day: &str, files: &Files) -> anyhow::Result<()> {
    let read = |what: &str, paths: &[PathBuf], parse: &dyn Fn(&[Text])| -> anyhow::Result<()> {
        let packed: Vec<_> = paths.iter().map(std::fs::read).collect::<Result<_, _>>()?;
        let unpack = || -> Result<Vec<Text>, _> {
            paths.iter().zip(&packed).map(|(path, it)| Text::unpack(path, it.clone())).collect()
        };
        let texts = unpack()?;
        let bytes = packed.iter().map(Vec::len).sum();
        let is_packed = paths.iter().any(|path| path.extension().is_some_and(|it| it == "gz"));
        if is_packed {
            row(&format!("{day}: {what}, unpacking"), bytes, fastest(unpack), &[]);
        }
        let time = fastest(|| parse(&texts));
        let what = format!("{day}: {what}");
        // For compressed files only the time is comparable.
        if is_packed {
            println!("{what:34} {:>6} {:>7.1} ms", "", time * 1e3);
        } else {
            row(&what, bytes, time, &[]);
        }
        Ok(())
    };
    read("observations", std::slice::from_ref(&files.obs), &|texts| {
        for text in texts {
            drop(black_box(Observations::parse(text)));
        }
    })?;
    read("orbits", &files.sp3, &|texts| drop(black_box(Orbits::parse(texts))))?;
    read("clocks", &files.clk, &|texts| drop(black_box(Clocks::parse(texts))))
}

/// Benchmarks a day from files to positions.
fn station_day(day: &str, files: &Files) -> anyhow::Result<()> {
    let recording = Recording::read(&files.paths())?;
    let config = Config::new(Motion::Static);
    let receiver = recording.receiver(Corrections::default());
    let epochs = recording.epochs(None);
    let solve = || follow(&recording, epochs, &receiver, config, Pass::default(), &mut || ());
    ensure!(solve().fixes.len() * 10 > epochs.len() * 9, "{day}: too few positions");
    let shelf = Shelf::default();
    Recording::read_beside(&files.paths(), &shelf)?;
    let all = fastest(|| Recording::read(&files.paths()));
    let beside = fastest(|| Recording::read_beside(&files.paths(), &shelf));
    let solved = fastest(solve);
    println!(
        "{day}, a station's day: read {:.1} ms (products already read {:.1} ms), solved {:.1} ms, together {:.1} ms",
        all * 1e3,
        beside * 1e3,
        solved * 1e3,
        (all + solved) * 1e3
    );
    let rtklib = files.nav.as_ref().map(|nav| peers::rtklib(files, nav));
    match rtklib {
        Some(Some([read, total])) => println!(
            "    RTKLIB: read {:.1} ms = {:.1} x, together {:.1} ms = {:.1} x",
            read * 1e3,
            read / all,
            total * 1e3,
            total / (all + solved)
        ),
        Some(None) => {
            println!("    RTKLIB: SKIPPED, rnx2rtkp is not installed or finds no positions");
        }
        None => {}
    }
    Ok(())
}

/// Prints a line of the table; `peers` are given by their times in s.
fn row(what: &str, bytes: usize, ours: f64, peers: &[(&str, Option<f64>)]) {
    let megabytes = bytes as f64 / 1e6;
    let speed = |seconds: f64| megabytes / seconds;
    let others = peers.iter().map(|(name, seconds)| match seconds {
        Some(seconds) => format!("{name} {:.0} ({:.2} x)", speed(*seconds), seconds / ours),
        None => format!("{name} SKIPPED, not installed"),
    });
    let others = others.collect::<Vec<_>>().join(", ");
    println!("{what:34} {megabytes:>6.1} {:>10.0}   {others}", speed(ours));
}

/// The processor time of the fastest round, s.
fn fastest<T>(mut work: impl FnMut() -> T) -> f64 {
    let now = || Duration::try_from(clock_gettime(ClockId::ProcessCPUTime)).unwrap_or_default();
    let round = |_| {
        let begin = now();
        black_box(work());
        now().saturating_sub(begin).as_secs_f64()
    };
    (0..ROUNDS).map(round).fold(f64::INFINITY, f64::min)
}
