//! Other readers of the same files.

use std::path::Path;
use std::process::Command;

use crate::Files;

/// Reads columns of numbers with the `csv` crate and fast-float2; returns the number of rows.
pub(crate) fn csv(bytes: &[u8]) -> anyhow::Result<usize> {
    let mut reader = csv::Reader::from_reader(bytes);
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); reader.byte_headers()?.len()];
    let mut record = csv::ByteRecord::new();
    while reader.read_byte_record(&mut record)? {
        for (column, field) in columns.iter_mut().zip(&record) {
            column.push(fast_float2::parse(field).unwrap_or(f64::NAN));
        }
    }
    Ok(columns.first().map_or(0, Vec::len))
}

/// Scans the digits of a table without storing anything and returns the sum of all fields, ignoring signs and points.
/// No reader that goes from byte to byte can be much faster.
pub(crate) fn digits(bytes: &[u8]) -> u64 {
    let (mut sum, mut number) = (0_u64, 0_u64);
    for byte in bytes {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            number = number.wrapping_mul(10).wrapping_add(u64::from(digit));
        } else if !matches!(byte, b'.' | b'-') {
            sum = sum.wrapping_add(number);
            number = 0;
        }
    }
    sum
}

/// The processor time in which polars reads a table from memory on one thread, s; `None` if it is not installed.
pub(crate) fn polars(path: &Path) -> Option<f64> {
    const PROGRAM: &str = "import sys, time, polars
bytes, best = open(sys.argv[1], 'rb').read(), 9.0
for _ in range(7):
    begin = time.process_time()
    polars.read_csv(bytes)
    best = min(best, time.process_time() - begin)
print(best)";
    let mut python = Command::new("python3");
    python.args(["-c", PROGRAM]).arg(path).env("POLARS_MAX_THREADS", "1");
    let output = python.output().ok()?;
    String::from_utf8(output.stdout).ok()?.trim().parse().ok()
}

/// Options that make RTKLIB compute what we do, as far as it can.
const OPTIONS: &str = "pos1-posmode=ppp-static
pos1-frequency=l1+2
pos1-soltype=forward
pos1-elmask=8
pos1-tidecorr=on
pos1-ionoopt=dual-freq
pos1-tropopt=est-ztd
pos1-sateph=precise
pos1-posopt3=on
pos1-navsys=1
out-solformat=xyz
";

/// The processor times in which RTKLIB reads a day, and reads and solves it, s; `None` if it is not installed, or finds
/// positions for less than nine in ten epochs.
pub(crate) fn rtklib(files: &Files, nav: &Path) -> Option<[f64; 2]> {
    let folder = files.obs.parent()?;
    let (options, out) = (folder.join("rtklib.conf"), folder.join("rtklib.pos"));
    std::fs::write(&options, OPTIONS).ok()?;
    let run = |more: &[&str]| -> Option<f64> {
        let mut shell = Command::new("bash");
        let timed = "TIMEFORMAT='%U %S'; { time rnx2rtkp \"$@\" >/dev/null 2>&1; } 2>&1";
        shell.args(["-c", timed, "bash"]).args(more).arg("-k").arg(&options).arg("-o").arg(&out);
        shell.arg(&files.obs).arg(nav).args(&files.sp3).args(&files.clk);
        let output = shell.output().ok()?;
        let times = String::from_utf8(output.stdout).ok()?;
        times.split_whitespace().map(|time| time.parse::<f64>().ok()).sum()
    };
    let best = |more: &[&str]| -> Option<f64> {
        let times: Option<Vec<_>> = (0..3).map(|_| run(more)).collect();
        times?.into_iter().reduce(f64::min)
    };
    // For a day outside the files nothing is solved.
    let read = best(&["-ts", "2030/01/01", "00:00:00", "-te", "2030/01/02", "00:00:00"])?;
    let total = best(&[])?;
    let positions = std::fs::read_to_string(out).ok()?;
    let found = positions.lines().filter(|line| !line.starts_with('%')).count();
    // There is one epoch every 30 s.
    (found * 10 > 2_880 * 9).then_some([read, total])
}
