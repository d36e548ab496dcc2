use super::*;

fn read(text: &str) -> Result<Log, Error> {
    parse(Path::new("walk"), text.as_bytes(), &Options::default())
}

fn complaint(text: &str) -> String {
    let sentence = read(text).expect_err(text).to_string();
    assert!(!sentence.contains('\n'), "{sentence}");
    sentence
}

#[test]
fn csv_carries_truth() {
    let log = read("t,ax,ay,az,gx,gy,gz,gt_x,gt_y,gt_z\n0.5,0,0,9.8,0,0,0,1,2,3\n").unwrap();
    let point = TrackPoint { time_us: 500_000, position: [1.0, 2.0, 3.0] };
    assert_eq!(log.truth, Some(vec![point]));
    assert_eq!(log.import.len(), 1, "{:?}", log.import);
}

#[test]
fn razor_text_is_converted_to_si() {
    let log = read("1490 -0.06 -0.21 -1.00 2.44 2.90 180\n").unwrap();
    assert_eq!(log.samples[0].time_us, 1_490_000);
    assert_eq!(log.samples[0].specific_force[2], -crate::metrics::STANDARD_GRAVITY);
    assert_eq!(log.samples[0].angular_rate[2], std::f64::consts::PI);
}

#[test]
fn truth_columns_come_together_and_lie_on_earth() {
    let header = "t,ax,ay,az,gx,gy,gz,gt_x";
    let found = complaint(&format!("{header}\n0,0,0,9.8,0,0,0,0\n"));
    assert!(found.contains("column gt_y"), "{found}");
    let found = complaint(&format!("{header},gt_y,gt_z\n0,0,0,9.8,0,0,0,0,1e9,0\n"));
    assert_eq!(
        found,
        "walk, line 2: expected a position in metres in column gt_y, found 1000000000"
    );
}

#[test]
fn what_is_refused_names_file_and_line() {
    let header = "t,ax,ay,az,gx,gy,gz\n";
    let found = complaint(&format!("{header}0,0,x,0,0,0,0\n"));
    assert!(found.starts_with("walk, line 2: expected a finite number in column ay"), "{found}");
    assert!(complaint("").starts_with("walk: expected"), "{}", complaint(""));
}
