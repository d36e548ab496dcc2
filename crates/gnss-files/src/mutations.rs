//! Tests with damaged files of each format: no reader panics.

use std::path::Path;

use proptest::prelude::*;
use proptest::sample::Index;

use crate::{
    Antennas, Clocks, EarthRotation, Navigation, Observations, Orbits, StationLoading, Text,
    samples,
};

/// Reads bytes as every format; each error message is one line.
fn read(bytes: Vec<u8>) {
    let complaints = |text: Result<Text, _>| {
        let text = text?;
        let texts = [text.clone(), text.clone()];
        let results = [
            Observations::parse(&text).map(drop),
            Orbits::parse(&texts).map(drop),
            Clocks::parse(&texts).map(drop),
            Navigation::parse(&texts).map(drop),
            Antennas::parse(std::slice::from_ref(&text), "ANT  TYPE       DOME").map(drop),
            crate::Biases::parse(&texts).map(drop),
            StationLoading::parse(&text, "here", Some([4e6, 0.0, 4.9e6])).map(drop),
            EarthRotation::parse(&text).map(drop),
        ];
        Ok(results.into_iter().filter_map(Result::err).collect())
    };
    let complaints = complaints(Text::unpack(Path::new("file"), bytes));
    for complaint in complaints.unwrap_or_else(|error| vec![error]) {
        let sentence = complaint.to_string();
        assert!(sentence.starts_with("file"), "{sentence}");
        assert!(!sentence.contains('\n'), "{sentence}");
    }
}

fn files() -> Vec<Vec<u8>> {
    let files = [
        samples::observations_3(),
        samples::compressed_3(),
        samples::observations_2(),
        samples::compressed_2(),
        samples::orbits(),
        samples::clocks(),
        samples::navigation_2(),
        samples::navigation_3(),
        samples::navigation_4(),
        samples::antennas(),
        samples::loading(),
        samples::earth_rotation(),
    ];
    let files = files.map(String::into_bytes).to_vec();
    #[cfg(any(feature = "rtcm", feature = "ubx"))]
    let files = [files, crate::streams::tests::streams()].concat();
    files
}

#[test]
fn files_cut_off_anywhere_do_no_harm() {
    for file in files() {
        for length in 0..file.len() {
            read(file[..length].to_vec());
        }
    }
}

proptest! {
    #[test]
    fn bytes_of_any_kind_do_no_harm(bytes: Vec<u8>) {
        read(bytes);
    }

    #[test]
    fn changed_bytes_do_no_harm(
        file in prop::sample::select(files()),
        changes: Vec<(Index, u8)>,
        digits: Vec<(Index, u8)>,
    ) {
        let mut file = file;
        let last = file.len() - 1;
        for (place, byte) in changes {
            file[place.index(last)] = byte;
        }
        for (place, digit) in digits {
            let byte = &mut file[place.index(last)];
            if byte.is_ascii_digit() || *byte == b' ' {
                *byte = b"0123456789 &->G\n"[usize::from(digit) % 16];
            }
        }
        read(file);
    }

    #[test]
    fn lines_left_out_and_told_twice_do_no_harm(
        file in prop::sample::select(files()),
        places in prop::collection::vec((any::<Index>(), any::<Index>(), any::<bool>()), 1..5),
    ) {
        let mut lines: Vec<_> = file.split_inclusive(|&byte| byte == b'\n').collect();
        for (from, to, stays) in places {
            if lines.is_empty() { break }
            let line = lines[from.index(lines.len())];
            if !stays {
                lines.remove(from.index(lines.len()));
            }
            lines.insert(to.index(lines.len() + 1), line);
        }
        read(lines.concat());
    }
}
