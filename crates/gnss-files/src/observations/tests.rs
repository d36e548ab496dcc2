use super::*;
use crate::samples::{
    header, lines, observations_2, observations_3, observations_3_header, sentences, text,
};

fn complaint(file: &str) -> String {
    let sentence = Observations::parse(&text(file)).expect_err(file).to_string();
    assert!(!sentence.contains('\n'), "{sentence}");
    sentence
}

const NOT_READ: &str = "file: satellites of QZSS (1) are in the file, but are not read";

#[test]
fn rinex_3_is_read() -> Result<(), Error> {
    let observations = Observations::parse(&text(observations_3()))?;
    assert_eq!(observations.marker, "HERE00XXX");
    assert_eq!(observations.receiver, "RECEIVER");
    assert_eq!(observations.antenna, "ANT  TYPE       DOME");
    assert_eq!(observations.approximate_position, Some([4_000_000.1, 2e5, 4.9e6]));
    assert_eq!(observations.antenna_delta_hen, [1.5, 0.2, -0.1]);
    assert_eq!(sentences(&observations.warnings), [""; 0]);
    let unserved = observations.unserved.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(unserved, [NOT_READ]);
    let epochs = &observations.epochs;
    let seconds: Vec<_> = epochs.iter().map(|epoch| epoch.time.second()).collect();
    assert_eq!(seconds, [0.0, 30.0, 60.0]);
    assert_eq!(epochs[0].time.day(), 58_849);
    assert_eq!(
        epochs.iter().map(|epoch| epoch.power_failure).collect::<Vec<_>>(),
        [false, true, false]
    );
    let first = Observed {
        prn: 5,
        carriers: Carriers::L1L2,
        code: [Some(20_000_000.625), Some(20_000_001.5)],
        phase: [Some(105_100_000.25), Some(81_900_000.5)],
        loss_of_lock: [true, false],
    };
    assert_eq!(epochs[0].satellites, [first]);
    let [twelve, five] = epochs[1].satellites[..] else { panic!("two satellites") };
    assert_eq!((twelve.prn, five.prn), (12, 5));
    assert_eq!((five.phase[0], five.loss_of_lock), (None, [false, true]));
    let signals = observations.signals[&5];
    let names = signals.code.iter().chain(&signals.phase).flatten().map(Signal::to_string);
    assert_eq!(names.collect::<Vec<_>>(), ["C1W", "C2W", "L1C", "L2W"]);
    Ok(())
}

#[test]
fn rinex_2_is_read() -> Result<(), Error> {
    let observations = Observations::parse(&text(observations_2()))?;
    let [first, second] = &observations.epochs[..] else { panic!("two epochs") };
    assert_eq!(second.time.since(first.time), 30.0);
    assert_eq!(second.time.day(), 51_544);
    let numbers: Vec<_> = first.satellites.iter().map(|satellite| satellite.prn).collect();
    assert_eq!(numbers, [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 13]);
    assert_eq!(first.satellites[11].phase[0], Some(1_000_000_012.25));
    assert_eq!(first.satellites[2].code, [Some(20_000_000.5), Some(20_000_001.0)]);
    // P1 is missing once; C1 does not replace it.
    assert_eq!(second.satellites[0].code, [None, Some(20_000_101.0)]);
    assert_eq!(sentences(&observations.warnings), [""; 0]);
    let unserved = observations.unserved.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert_eq!(unserved, [NOT_READ.replace("QZSS", "GLONASS")]);
    Ok(())
}

#[test]
fn codes_without_reference_are_taken_with_a_warning() -> Result<(), Error> {
    let file = observations_3().replace("       C1W", "       S1C");
    let observations = Observations::parse(&text(file))?;
    assert_eq!(observations.epochs[0].satellites[0].code[0], Some(20_000_000.125));
    let [warning] = &sentences(&observations.warnings)[..] else { panic!("one warning") };
    assert!(warning.starts_with("file: C1C is taken instead of C1W"), "{warning}");
    assert!(warning.contains("G05 G12"), "{warning}");
    Ok(())
}

#[test]
fn scale_factors_are_divided_out() -> Result<(), Error> {
    let end = header("", "END OF HEADER");
    let file =
        observations_3().replace(&end, &(header("G  100  1 L1C", "SYS / SCALE FACTOR") + &end));
    let observations = Observations::parse(&text(file))?;
    assert_eq!(observations.epochs[0].satellites[0].phase[0], Some(1_051_000.002_5));
    Ok(())
}

#[test]
fn an_event_may_change_the_observables() -> Result<(), Error> {
    let file = observations_3_header()
        + &lines(&["> 2020 01 01 00 00  0.0000000  4  2"])
        + &header("G    2 L2W C1W", "SYS / # / OBS TYPES")
        + &header("", "COMMENT")
        + &lines(&["> 2020 01 01 00 00  0.0000000  0  1", "G05  81900000.500    20000000.625"]);
    let observations = Observations::parse(&text(file))?;
    let observed = observations.epochs[0].satellites[0];
    assert_eq!(observed.code, [Some(20_000_000.625), None]);
    assert_eq!(observed.phase, [None, Some(81_900_000.5)]);
    Ok(())
}

#[test]
fn another_antenna_in_an_event_is_told() -> Result<(), Error> {
    let begin = observations_3_header() + &lines(&["> 2020 01 01 00 00  0.0000000  4  1"]);
    let end = lines(&["> 2020 01 01 00 00  0.0000000  0  1", "G05  81900000.500    20000000.625"]);
    let whole = observations_3();
    let line = |label| whole.lines().find(|line: &&str| line.contains(label)).expect("the line");
    let told = |changed: &str| {
        let observations = Observations::parse(&text(begin.clone() + changed + "\n" + &end))?;
        Ok::<_, Error>(sentences(&observations.warnings))
    };
    let height = line("DELTA H/E/N");
    assert!(told(height)?.is_empty(), "the same again");
    assert!(told(&height.replacen("1.5000", "1.5x00", 1))?.is_empty(), "no number");
    let [warning] = &told(&height.replacen("1.5000", "2.5000", 1))?[..] else { panic!("one") };
    assert!(warning.contains("antenna is 2.5 m above its marker, 0.2 m east"), "{warning}");
    assert!(warning.contains("before 1.5 m above its marker, 0.2 m east"), "{warning}");
    let antenna = header("1234                OTHER           NONE", "ANT # / TYPE");
    let [warning] = &told(antenna.trim_end_matches('\n'))?[..] else { panic!("one") };
    assert!(warning.contains("antenna is another, OTHER           NONE"), "{warning}");
    Ok(())
}

#[test]
fn a_file_cut_off_loses_its_last_epoch() -> Result<(), Error> {
    let whole = observations_3();
    let cut = &whole[..whole.len() - 3];
    let line = whole.lines().count() - 1;
    for file in [cut, &whole[..whole.len() - 60]] {
        let observations = Observations::parse(&text(file))?;
        assert_eq!(observations.epochs.len(), 2);
        let warning =
            format!("file, line {line}: the file was cut off in this epoch, which is left out");
        assert_eq!(sentences(&observations.warnings), [warning]);
    }
    Ok(())
}

#[test]
fn an_antenna_without_a_height_or_with_an_absurd_one_is_told() -> Result<(), Error> {
    let whole = observations_3();
    let line = whole.lines().find(|line| line.contains("DELTA H/E/N")).expect("the line");
    let told = |file: String| Ok(sentences(&Observations::parse(&text(file))?.warnings));
    for (changed, expected) in [
        (String::new(), Some("no height of the antenna is told")),
        (line.replacen("1.5000", "1500.0", 1) + "\n", Some("1500 m above its marker")),
        (line.replacen("1.5000", "0.0000", 1) + "\n", Some("0 m above its marker, 0.2 m east")),
        (line.replacen("1.5000", "2.5000", 1) + "\n", None),
    ] {
        let warnings: Vec<String> = told(whole.replacen(&format!("{line}\n"), &changed, 1))?;
        assert_eq!(warnings.len(), usize::from(expected.is_some()), "{changed}: {warnings:?}");
        assert!(expected.is_none_or(|expected| warnings[0].contains(expected)), "{warnings:?}");
    }
    Ok(())
}

#[test]
fn garbage_in_the_middle_is_located() {
    let file = observations_3().replace("22000001.000", "2200x001.000");
    assert_eq!(complaint(&file), "file, line 18: expected an observation, found \"2200x001.000\"");
    let file = observations_3().replace("> 2020 01 01 00 00 30", "> 2020 01 41 00 00 30");
    assert!(complaint(&file).starts_with("file, line 17: expected a date and time"));
    let file = observations_3().replacen("  0  2\n", "  0  3\n", 1);
    assert!(complaint(&file).starts_with("file, line 15: expected a satellite's observations"));
}

#[test]
fn a_damaged_epoch_among_hundreds_is_left_out() -> Result<(), Error> {
    let header = observations_3_header();
    let body = observations_3()[header.len()..].to_owned();
    let whole = header + &body.repeat(100);
    let count = |file: &str| -> Result<_, Error> {
        let found = Observations::parse(&text(file))?;
        let told = sentences(&found.warnings);
        Ok((told.len(), told.into_iter().find(|told| told.contains("damaged"))))
    };
    let (clean, _) = count(&whole)?;
    // The second epoch, on line 17, is damaged, or something stands before it. (The first one tells whether the file is what it
    // should be.)
    for (damaged, line) in [
        (whole.replacen("22000001.000", "************", 1), 18),
        (whole.replacen("22000001.000", "         nan", 1), 18),
        (whole.replacen("> 2020 01 01 00 00 30", "# a remark\n> 2020 01 01 00 00 30", 1), 17),
        (whole.replacen("> 2020 01 01 00 00 30", "\0\0\0\n> 2020 01 01 00 00 30", 1), 17),
    ] {
        let (told, sentence) = count(&damaged)?;
        let sentence = sentence.expect("it is told");
        let expected = format!("file, line {line}: damaged epochs, left out: 1");
        assert!(sentence.starts_with(&expected), "{sentence}");
        assert_eq!(told, clean + 1);
    }
    // Too many.
    let damaged = whole.replace("22000001.000", "************");
    assert!(complaint(&damaged).contains("line 18: expected an observation"));
    Ok(())
}

#[test]
fn epochs_told_twice_are_taken_once() -> Result<(), Error> {
    let whole = observations_3();
    let body = &whole[observations_3_header().len()..];
    let observations = Observations::parse(&text(whole.clone() + body))?;
    assert_eq!(observations.epochs.len(), 3);
    let warning = "file: 3 epochs stand out of the order of time and are left out";
    assert_eq!(sentences(&observations.warnings), [warning]);
    Ok(())
}

#[test]
fn files_that_were_joined_are_named() {
    let joined = observations_3() + &observations_3();
    let told =
        "expected an epoch, found the header of a second file: separate files that were joined";
    assert!(complaint(&joined).ends_with(told), "{}", complaint(&joined));
}

#[test]
fn what_cannot_be_used_is_refused() {
    let file = observations_3().replace("     GPS", "     GLO");
    assert!(complaint(&file).ends_with("expected times of GPS, found the time system \"GLO\""));
    let file = observations_3().replace("3.04 ", "1.04 ");
    assert!(complaint(&file).contains("expected RINEX 2, 3 or 4, found version 1.04"));
    let file = observations_3().replace("G    5", "C    5");
    assert!(
        complaint(&file)
            .contains("expected observations of GPS, Galileo, GLONASS or BeiDou in the header")
    );
    let file = header("     3.04           N", "RINEX VERSION / TYPE");
    let sentence = "file: expected observations (RINEX), found a navigation file (RINEX)";
    assert_eq!(complaint(&file), sentence);
    assert!(complaint("<!DOCTYPE html>\n").contains("found a web page"));
    assert!(complaint("").ends_with("found an empty file"));
    assert!(complaint(&observations_3_header()).contains("found none"));
}

#[test]
fn rinex_4_and_a_time_system_beside_its_columns() -> Result<(), Error> {
    let file = observations_3().replace("     3.04 ", "     4.02 ");
    let more = [
        header("https://doi.org/10.57677/anything", "DOI"),
        header("https://creativecommons.org/licenses/by/4.0", "LICENSE OF USE"),
        header("https://stations.example/HERE00XXX", "STATION INFORMATION"),
        header("", "END OF HEADER"),
    ];
    let file = file.replace(&more[3], &more.concat());
    let whole = Observations::parse(&text(observations_3()))?;
    assert_eq!(Observations::parse(&text(&file))?, whole);
    for beside in ["    GPS ", "      GPS", " GPS"] {
        let file = observations_3().replace("     GPS", beside);
        assert_eq!(Observations::parse(&text(file))?.epochs, whole.epochs, "{beside:?}");
    }
    Ok(())
}

#[test]
fn galileo_is_read_beside_gps() -> Result<(), Error> {
    let file = |bands: &str| {
        lines(&[
            "     3.04           OBSERVATION DATA    M                   RINEX VERSION / TYPE",
            "G    2 C1W L1W                                              SYS / # / OBS TYPES",
            &format!("E    6 {bands:<53}SYS / # / OBS TYPES"),
            "                                                            END OF HEADER",
            "> 2020 01 01 00 00  0.0000000  0  2",
            "G05  20000000.125   105100000.250",
            "E11  24000000.000   126100000.000    24000001.000    94200000.50011  24000002.000    96600000.000",
        ])
    };
    let both = Observations::parse(&text(file("C1C L1C C5Q L5Q C7Q L7Q")))?;
    let [five, eleven] = &both.epochs[0].satellites[..] else { panic!("two satellites") };
    assert_eq!((five.prn, five.carriers), (5, Carriers::L1L2));
    assert_eq!((eleven.prn, eleven.carriers), (111, Carriers::E1E5a));
    assert_eq!(eleven.phase, [Some(126_100_000.0), Some(94_200_000.5)]);
    assert_eq!(eleven.loss_of_lock, [false, true]);
    let e5b = Observations::parse(&text(file("C1C L1C C6C L6C C7Q L7Q")))?;
    let eleven = e5b.epochs[0].satellites[1];
    assert_eq!((eleven.carriers, eleven.code[1]), (Carriers::E1E5b, Some(24_000_002.0)));
    Ok(())
}

#[test]
fn glonass_needs_channels_and_beidou_its_most_frequent_carriers() -> Result<(), Error> {
    let file = |channels: &str, bands: &str| {
        lines(&[
            "     3.04           OBSERVATION DATA    M                   RINEX VERSION / TYPE",
            "        0.0000        0.0000        0.0000                  ANTENNA: DELTA H/E/N",
            &format!("{channels:60}GLONASS SLOT / FRQ #"),
            "R    5 C1C L1C C2P L2P S1C                                  SYS / # / OBS TYPES",
            &format!("C    6 {bands:<53}SYS / # / OBS TYPES"),
            "                                                            END OF HEADER",
            "> 2020 01 01 00 00  0.0000000  0  3",
            "R07  20000000.125   105100000.250    20000001.000    81000000.000          45.000",
            "R22  20000000.125   105100000.250    20000001.000    81000000.00011        45.000",
            "C19  24000000.000   126100000.000    24000001.000    94200000.500    24000002.000    96600000.000",
        ])
    };
    let told = "  2 R07  5 R22 -3";
    let both = Observations::parse(&text(file(told, "C2I L2I C7I L7I C6I L6I")))?;
    assert_eq!(sentences(&both.warnings), [""; 0]);
    let [seven, other, nineteen] = &both.epochs[0].satellites[..] else { panic!("three") };
    assert_eq!((seven.prn, seven.carriers), (157, Carriers::G1G2 { channel: 5 }));
    assert_eq!((other.prn, other.carriers), (172, Carriers::G1G2 { channel: -3 }));
    assert_eq!((other.code[1], other.phase[1]), (Some(20_000_001.0), Some(81_000_000.0)));
    assert_eq!(other.loss_of_lock, [false, true]);
    assert_eq!((nineteen.prn, nineteen.carriers), (199, Carriers::B1B3));
    assert_eq!(nineteen.code, [Some(24_000_000.0), Some(24_000_002.0)]);
    let of_beidou = |bands: &str| {
        let observations = Observations::parse(&text(file(told, bands)))?;
        let last = observations.epochs[0].satellites.last().copied();
        Ok::<_, Error>(last.map(|it| (it.carriers, it.code[1])))
    };
    let third = Some(24_000_002.0);
    assert_eq!(of_beidou("C6X L6D C2I L2I C7I L7I")?, Some((Carriers::B1B2, third)));
    assert_eq!(of_beidou("C2X L2X C1P L1P C5P L5P")?, Some((Carriers::B1cB2a, third)));

    let unknown = Observations::parse(&text(file("  1 R22 -3", "C2I L2I C7I L7I C6I L6I")))?;
    assert_eq!(unknown.epochs[0].satellites.len(), 2);
    let warning = "file: tells no channel of R07: they are left out";
    assert_eq!(sentences(&unknown.warnings), [warning]);
    // There is no such channel.
    let wrong = Observations::parse(&text(file("  1 R22 -8", "C2I L2I C7I L7I C6I L6I")))?;
    assert_eq!(wrong.epochs[0].satellites.len(), 1);
    Ok(())
}
