use super::*;
use proptest::prelude::*;

fn read(text: &str) -> Result<Log, Error> {
    parse(&TextFile::from_bytes(Path::new("walk"), text.as_bytes().to_vec())?)
}

fn complaint(text: &str) -> String {
    let sentence = read(text).expect_err(text).to_string();
    assert!(!sentence.contains('\n'), "{sentence}");
    sentence
}

#[test]
fn csv_columns_stand_in_any_order() {
    let log = read("\u{feff}gz, gy,gx,note,az,ay,ax,t\r\n6,5,4,#,3,2,1,0.0000014\r\n\r\n").unwrap();
    let sample =
        Sample { time_us: 1, specific_force: [1.0, 2.0, 3.0], angular_rate: [4.0, 5.0, 6.0] };
    assert_eq!(log, Log { samples: vec![sample], ..Log::default() });
}

#[test]
fn csv_carries_truth() {
    let log = read("t,ax,ay,az,gx,gy,gz,gt_x,gt_y,gt_z\n0.5,0,0,9.8,0,0,0,1,2,3\n").unwrap();
    let point = TrackPoint { time_us: 500_000, position: [1.0, 2.0, 3.0] };
    assert_eq!(log.truth, Some(vec![point]));
}

#[test]
fn razor_text_is_converted_to_si() {
    let line = "1490 -0.06 -0.21 -1.00 2.44 2.90 180\n";
    let bare = read(line).unwrap();
    assert_eq!(bare.samples[0].time_us, 1_490_000);
    assert_eq!(bare.samples[0].specific_force[2], -STANDARD_GRAVITY);
    assert_eq!(bare.samples[0].angular_rate[2], std::f64::consts::PI);
    let with_header = format!("Zaman [ms], AccX, AccY [g]\n{line}");
    assert_eq!(read(&with_header).unwrap(), bare);
}

#[test]
fn razor_columns_beyond_the_seventh_are_ignored() {
    assert_eq!(read("0 0 0 1 0 0 0 mag 5\n1 0 0 1 0 0 0 mag 6\n").unwrap().samples.len(), 2);
}

#[test]
fn repeated_times_and_gaps_are_read() {
    let log = read("0 0 0 1 0 0 0\n0 0 0 1 0 0 0\n900 0 0 1 0 0 0\n").unwrap();
    assert_eq!(log.samples.len(), 3);
    assert_eq!(log.duration_s(), 0.9);
}

#[test]
fn a_missing_line_break_at_the_end_is_only_suspicious() {
    assert_eq!(read("0 0 0 1 0 0 0").unwrap().warnings.len(), 1);
}

#[test]
fn broken_csv_is_located() {
    let header = "t,ax,ay,az,gx,gy,gz\n";
    for (text, expected) in [
        (
            "t,ax,ay,az,gx,gy\n0,0,0,0,0,0\n".to_owned(),
            "line 1: expected a header with a column gz",
        ),
        ("0,0,0,0,0,0,0\n".to_owned(), "line 1: expected a header with a column t"),
        (
            format!("{header}0,0,x,0,0,0,0\n"),
            "line 2: expected a finite number in column ay, found \"x\"",
        ),
        (format!("{header}0,0,,0,0,0,0\n"), "column ay, found nothing"),
        (format!("{header}\n0,0,NaN,0,0,0,0\n"), "line 3: expected a finite number in column ay"),
        (format!("{header}0,0,1e999,0,0,0,0\n"), "line 2: expected a finite number"),
        (
            format!("{header}0,0,9807,0,0,0,0\n"),
            "line 2: expected at most 9807 m/s² (1000 g) in column ay",
        ),
        (format!("{header}0,0,0,0,0,0,-1746\n"), "in column gz"),
        (format!("{header}-1,0,0,0,0,0,0\n"), "line 2: expected a time between 0"),
        (format!("{header}1,0,0,0,0,0,0\n0.5,0,0,0,0,0,0\n"), "line 3: expected a time not before"),
        (
            format!("{header}0,0,0,0,0,0,0\n1,0,0,0,0"),
            "line 3: expected 7 fields as in the header, found 5",
        ),
        (format!("{header}# made by hand\n"), "line 2: expected 7 fields"),
        (header.to_owned(), "expected samples after the header"),
        (String::new(), "found an empty file"),
        ("\n \n".to_owned(), "found an empty file"),
    ] {
        let complaint = complaint(&text);
        assert!(complaint.contains(expected), "{complaint} / {expected}");
    }
}

#[test]
fn truth_columns_come_together() {
    let complaint = complaint("t,ax,ay,az,gx,gy,gz,gt_x\n0,0,0,0,0,0,0,0\n");
    assert!(complaint.contains("column gt_y"), "{complaint}");
}

#[test]
fn broken_razor_text_is_located() {
    for (text, expected) in [
        ("0 0 0 1 0 0\n", "line 1: expected 7 blank-separated fields, found 6"),
        (
            "ms g\n0 0 0 1 0 0 0\n1 0 0 one 0 0 0\n",
            "line 3: expected a finite number in column accZ",
        ),
        ("0 0 0 1 0 0 0\n1 0 0 1 0 0 0 0\n", "line 2: expected 7 blank-separated fields, found 8"),
        ("0 0 0 1001 0 0 0\n", "(1000 g) in column az"),
        ("5 0 0 1 0 0 0\n4 0 0 1 0 0 0\n", "line 2: expected a time not before"),
        ("ms g g g dps dps dps\n", "expected samples after the header"),
        ("\0\u{1}\n\0 0\n", "line 2"),
    ] {
        let complaint = complaint(text);
        assert!(complaint.contains(expected), "{complaint} / {expected}");
    }
}

/// Bytes that are nearly a log: the likeliest to reach the far corners of a reader.
fn nearly_a_log() -> impl Strategy<Value = Vec<u8>> {
    const PIECES: [&str; 13] = [
        "t,ax,ay,az,gx,gy,gz",
        ",gt_x",
        "\n",
        "\r\n",
        " ",
        ",",
        "1",
        "-2.5e3",
        "nan",
        "\0",
        "é",
        "1 2 3 4 5 6 7\n",
        "0,1,2,3,4,5,6\n",
    ];
    let piece = proptest::sample::select(&PIECES[..]);
    proptest::collection::vec(piece, 0..40).prop_map(|pieces| pieces.concat().into_bytes())
}

proptest! {
    #[test]
    fn no_bytes_panic(bytes in prop_oneof![proptest::collection::vec(any::<u8>(), 0..400), nearly_a_log()]) {
        let file = TextFile::from_bytes(Path::new("walk"), bytes);
        if let Ok(log) = file.and_then(|file| parse(&file)) {
            prop_assert!(!log.samples.is_empty());
            prop_assert!(log.samples.is_sorted_by_key(|sample| sample.time_us));
        }
    }
}
