//! Damaged and random logs, generated from seeds: nothing panics or hangs, and what is read is in order and finite.

use kestirim_import::Options;
use kestirim_import::{inertial, ranging};
use rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::walk;

/// Logs of several kinds.
fn logs() -> Vec<Vec<u8>> {
    let rows = walk::rows(2);
    let write = |header: &str, separator: &str, comma: bool| {
        let mut text = header.to_owned();
        for row in &rows {
            let fields = row.map(|value| format!("{value:.5}"));
            let line = fields.join(separator);
            text += &if comma { line.replace('.', ",") } else { line };
            text.push('\n');
        }
        text.into_bytes()
    };
    let dates = rows
        .iter()
        .enumerate()
        .map(|(i, _)| format!("2024-05-01T23:59:59.{:03}Z;\"0,1\";0;9,8;0;0;0\n", i % 1000));
    let dates = "Time;AccX;AccY;AccZ;GyrX;GyrY;GyrZ\n".to_owned() + &dates.collect::<String>();
    vec![
        write("t,ax,ay,az,gx,gy,gz\n", ",", false),
        write("# made by hand\nTime (s);AccX [g];AccY;AccZ;GyrX [dps];GyrY;GyrZ\n", ";", true),
        write("", " ", false),
        dates.into_bytes(),
    ]
}

/// Logs of ranges, one epoch a line.
fn logs_of_ranges() -> Vec<Vec<u8>> {
    let log = |line: fn(u32) -> String| (0..80).map(line).collect::<String>().into_bytes();
    let wide = |i| format!("{},{:.3},{:.3},\n", i * 100, f64::from(i) * 0.1, 7.0);
    vec![
        log(|i| format!("mc 03 {:08x} 000005a3 0 0 095f c1 {:08x} a0:0\n", 1000 + i, i * 100)),
        log(|i| {
            format!(
                "12:00:{:02}.5 AT+RANGE=tid:1,mask:03,seq:1,range:(100,{i},0),ancid:(0,1,-1)\n",
                i % 60
            )
        }),
        log(|i| format!("{i}.5 DIST,2,AN0,A0,5,8,2,1.6,AN1,A1,0,8,2,{i}.4,POS,7,8,-1,97\n")),
        log(|i| format!("{i}.5 A0[5,8,2]=1.6 A1[0,8,2]={i}.4 le_us=2576 est[6,8,-1,53]\n")),
        ["time_ms,d0,d1,d2\n".to_owned(), (0..80).map(wide).collect()].concat().into_bytes(),
    ]
}

#[test]
fn damaged_logs_of_ranges_do_no_harm() {
    let (logs, anchors) = (logs_of_ranges(), ["A0", "A1", "A2"].map(str::to_owned));
    let is_short = std::env::var("KESTIRIM_SHORT").is_ok_and(|value| value == "1");
    let (seeds, mut read_on) = (if is_short { 5_000 } else { 20_000 }, 0);
    for seed in 0..seeds {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut log = logs[pick(&mut random, logs.len())].clone();
        for _ in 0..=pick(&mut random, 4) {
            mutate(&mut random, &mut log);
        }
        for strict in [false, true] {
            match ranging::read(&log, &anchors, &Options { strict, ..Options::default() }) {
                Ok(Some(read)) => {
                    assert!(read.ranges.iter().all(|it| it.anchor < 3 && it.metres.is_finite()));
                    read_on += 1;
                }
                Ok(None) => {}
                Err(error) => {
                    assert!(!error.to_string().contains(['\n', '\r']), "seed {seed}: {error}");
                }
            }
        }
    }
    assert!(read_on > seeds / 2, "{read_on}");
}

pub(crate) fn pick(random: &mut Xoshiro256PlusPlus, count: usize) -> usize {
    (random.next_u64() % count.max(1) as u64) as usize
}

pub(crate) fn mutate(random: &mut Xoshiro256PlusPlus, log: &mut Vec<u8>) {
    const PIECES: [&[u8]; 12] = [
        b"\n",
        b",",
        b"nan",
        b"-",
        b"1e999",
        b"\0\0\0",
        b"\xff\xfe",
        b"\"",
        b"12:00:00",
        b";",
        b"9",
        b"\r",
    ];
    let at = pick(random, log.len());
    let length = pick(random, 40);
    match pick(random, 6) {
        0 => log.truncate(at),
        1 => drop(log.drain(at..(at + length).min(log.len()))),
        2 => {
            let part = log[at..(at + length * 4).min(log.len())].to_vec();
            let to = pick(random, log.len());
            log.splice(to..to, part);
        }
        3 => drop(log.splice(at..at, PIECES[pick(random, PIECES.len())].to_vec())),
        4 => log.iter_mut().skip(at).take(1).for_each(|byte| *byte = random.next_u64() as u8),
        _ => log.iter_mut().skip(at).take(length).for_each(|byte| *byte ^= 1),
    }
}

pub(crate) fn read(log: &[u8], seed: u64) {
    for strict in [false, true] {
        match inertial::read(log, &Options { strict, ..Options::default() }) {
            Ok(read) => {
                assert!(!read.samples.is_empty(), "seed {seed}");
                assert!(read.samples.is_sorted_by_key(|sample| sample.time_us), "seed {seed}");
                assert_eq!(read.samples.len(), read.rows.len(), "seed {seed}");
                assert!(read.rows.is_sorted(), "seed {seed}");
                let columns = read.other.iter();
                assert!(columns.into_iter().all(|(_, values)| values.len() == read.rows.len()));
            }
            Err(error) => {
                assert!(!error.to_string().contains(['\n', '\r']), "seed {seed}: {error}");
            }
        }
    }
}

#[test]
fn damaged_logs_do_no_harm() {
    let logs = logs();
    for seed in 0..1500 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut log = logs[pick(&mut random, logs.len())].clone();
        for _ in 0..=pick(&mut random, 6) {
            mutate(&mut random, &mut log);
        }
        read(&log, seed);
    }
}

#[test]
fn bytes_of_any_kind_do_no_harm() {
    const PIECES: [&str; 22] = [
        "t,ax,ay,az,gx,gy,gz",
        ",gt_x",
        "\n",
        "\r\n",
        " ",
        ",",
        ";",
        "\t",
        "1",
        "-2.5e3",
        "nan",
        "\0",
        "é",
        "\"",
        "1 2 3 4 5 6 7\n",
        "0,1,2,3,4,5,6\n",
        "# ",
        "//",
        "10:00:00",
        "2024-01-01 10:00:00",
        "1e308",
        "-",
    ];
    for seed in 0..4000 {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let count = pick(&mut random, 60);
        let mut log = Vec::new();
        for _ in 0..count {
            if seed % 3 == 0 {
                log.push(random.next_u64() as u8);
            } else {
                log.extend_from_slice(PIECES[pick(&mut random, PIECES.len())].as_bytes());
            }
        }
        read(&log, seed);
    }
}
