use std::path::Path;

use super::*;
use crate::observations::Observations;
use crate::samples::{compressed_2, compressed_3, observations_3, sentences, text};

fn unpacked(text: &Text) -> Vec<&[u8]> {
    text.lines().map(|line| line.bytes).collect()
}

/// All observations are restored, except for systems that are not read.
#[test]
fn observations_of_rinex_3_are_restored() {
    let (restored, plain) = (text(compressed_3()), text(observations_3()));
    for (restored, plain) in unpacked(&restored).into_iter().zip(unpacked(&plain)) {
        let kept = if plain.starts_with(b"J07") { &plain[..3] } else { plain };
        assert_eq!(String::from_utf8_lossy(restored), String::from_utf8_lossy(kept));
    }
    assert_eq!(restored.lines().count(), plain.lines().count());
    assert_eq!(Observations::parse(&restored).unwrap(), Observations::parse(&plain).unwrap());
}

/// All observables are restored, except for the sixth, a signal strength.
#[test]
fn observations_of_rinex_2_are_restored() {
    let file = text(compressed_2());
    let lines = unpacked(&file);
    let small = ["0.001", "0.022", "0.333", "4.444", "55.555"].map(|value| format!("{value:>14}"));
    let small = small.join("  ");
    let body = [
        " 99 12 31 23 59 30.0000000  0  1G05",
        " 100000000.250 1        -0.500 2  20000000.000    20000001.000",
        "",
        " 99 12 31 23 59  0.0000000  0  2G05G12",
        " 100000001.250 1        -0.500 2  20000001.500    19999999.000",
        "",
        &small,
        "",
        " 99 12 31 23 59 30.0000000  0  1G05",
        " 100000003.250 1         0.100 2  20000003.100    19999997.000",
        "",
    ];
    let found: Vec<_> = lines[3..].iter().map(|line| String::from_utf8_lossy(line)).collect();
    assert_eq!(found, body);
}

#[test]
fn a_difference_from_nothing_is_refused() {
    let file = compressed_3().replace("100000 3&105101000250", "100000 105101000250")
        + "> 2020 01 01 00 01 30.0000000  0  0\n\n";
    let error = Text::unpack(Path::new("f"), file.into_bytes()).unwrap_err().to_string();
    assert_eq!(
        error,
        "f, line 27: expected a whole observation, found the difference from one that is missing"
    );
}

#[test]
fn a_file_cut_off_keeps_whole_epochs() {
    let file = compressed_3();
    let third = file.rfind("                 1").unwrap_or_default();
    for cut in [third + 20, third + 51, file.len() - 3, file.len() - 1] {
        let observations = Observations::parse(&text(&file[..cut])).expect("two epochs");
        assert_eq!(observations.epochs.len(), 2, "{cut}");
        let [warning] = &sentences(&observations.warnings)[..] else { panic!("one warning") };
        assert!(warning.contains("cut off"), "{warning}");
    }
}

#[test]
fn a_lost_line_of_a_satellite_that_is_not_read_is_missed() {
    let file = compressed_3().replacen("3&19000000000 \n", "", 1);
    let error = Text::unpack(Path::new("f"), file.into_bytes()).unwrap_err().to_string();
    assert!(error.contains("expected a satellite's observations"), "{error}");
}

#[test]
fn other_versions_are_refused() {
    let file = compressed_3().replacen("3.0 ", "2.0 ", 1);
    let error = Text::unpack(Path::new("f"), file.into_bytes()).unwrap_err().to_string();
    assert!(error.contains("version 1.0 or 3.0"), "{error}");
}
