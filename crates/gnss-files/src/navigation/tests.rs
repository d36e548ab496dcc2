use super::*;
use crate::samples::{header, navigation_2, navigation_3, navigation_4, sentences, text};
use crate::time::GpsTime;

fn complaint(file: &str) -> String {
    Navigation::parse(&[text(file)]).expect_err(file).to_string()
}

#[test]
fn satellites_of_gps_and_galileo_are_read() -> Result<(), Error> {
    let navigation = Navigation::parse(&[text(navigation_3())])?;
    assert_eq!(navigation.satellites().collect::<Vec<_>>(), [1, 101]);
    assert_eq!(navigation.skipped, 1);
    let [unserved] = &navigation.unserved[..] else { panic!("GLONASS is told of") };
    assert!(unserved.to_string().ends_with("of GLONASS (1) are in the file, but are not read"));
    let [gps] = navigation.satellite(1, Message::Lnav) else { panic!("one ephemeris") };
    assert_eq!(gps.time, GpsTime::new(59_025, 14_400.0));
    assert_eq!((gps.clock_time, gps.issue), (gps.time, 58));
    assert_eq!(gps.clock, [1.604_342_833_161e-5, 7.048_583_938_740e-12, 0.0]);
    assert_eq!((gps.eccentricity, gps.root_of_axis), (1.000_394_229_777e-2, 5_153.707_128_525));
    assert_eq!((gps.mean_anomaly, gps.perigee), (0.634_209_450_786_4, 0.794_170_301_500_8));
    assert_eq!(gps.radius_terms, [353.968_75, -39.687_5]);
    assert_eq!(gps.latitude_terms, [-2.177_432_179_451e-6, 1.937_150_955_200e-6]);
    assert_eq!(gps.inclination_terms, [-1.508_742_570_877e-7, 1.359_730_958_939e-7]);
    assert_eq!((gps.node, gps.node_rate), (2.572_838_528_869, -8.384_634_967_987e-9));
    assert_eq!(
        (gps.inclination, gps.inclination_rate),
        (0.980_651_860_109_1, -5.714_523_747_137e-11)
    );
    assert_eq!(gps.mean_motion_correction, 4.304_822_170_265e-9);
    assert_eq!((gps.accuracy, gps.is_healthy, gps.fit), (Some(2.0), true, Some(14_400.0)));
    assert_eq!(gps.group_delays, [5.122_274_160_385e-9, 0.0]);
    let [galileo] = navigation.satellite(101, Message::Fnav) else { panic!("one ephemeris") };
    assert_eq!(galileo.time, GpsTime::new(59_024, 84_600.0));
    assert_eq!((galileo.accuracy, galileo.fit), (Some(3.12), None));
    assert_eq!(galileo.group_delays, [-1.862_645_149_231e-9, 0.0]);
    assert!(navigation.satellite(101, Message::Inav).is_empty());
    let [alpha, beta] = navigation.ionosphere.expect("both lines are there");
    assert_eq!((alpha[0], beta[3]), (4.6566e-9, -5.2429e5));
    Ok(())
}

#[test]
fn version_4_tells_the_same() -> Result<(), Error> {
    let [third, fourth] = [navigation_3(), navigation_4()]
        .map(|file| Navigation::parse(&[text(file)]).expect("a whole file"));
    assert_eq!((&fourth.messages, &fourth.unserved), (&third.messages, &third.unserved));
    assert_eq!((fourth.ionosphere, fourth.skipped), (third.ionosphere, 2));
    // Other messages of the same satellite are ignored.
    let other = navigation_4().replace("EPH E01 FNAV", "EPH E01 CNAV");
    let other = Navigation::parse(&[text(other)])?;
    assert_eq!(other.satellites().collect::<Vec<_>>(), [1]);
    assert_eq!(other.unserved, third.unserved, "no other system is passed over");
    Ok(())
}

#[test]
fn version_2_needs_no_letters() -> Result<(), Error> {
    let navigation = Navigation::parse(&[text(navigation_2())])?;
    let [gps] = navigation.satellite(1, Message::Lnav) else { panic!("one ephemeris") };
    assert_eq!(gps.time, GpsTime::new(53_462, 7_200.0));
    assert_eq!((gps.issue, gps.fit, gps.accuracy), (140, None, Some(1.0)));
    assert_eq!(gps.root_of_axis, 5_153.636_478_42);
    assert_eq!(navigation.ionosphere.map(|[alpha, _]| alpha[2]), Some(-5.96e-8));
    let glonass = navigation_2().replace("N: GPS", "G: GLO");
    assert!(
        complaint(&glonass)
            .ends_with("expected ephemerides of satellites of GPS, Galileo or BeiDou, found none")
    );
    Ok(())
}

#[test]
fn files_are_put_together_and_the_same_ephemeris_counts_once() -> Result<(), Error> {
    let texts = [text(navigation_4()), text(navigation_3()), text(navigation_2())];
    let navigation = Navigation::parse(&texts)?;
    let times: Vec<_> =
        navigation.satellite(1, Message::Lnav).iter().map(|it| it.time.day()).collect();
    assert_eq!(times, [53_462, 59_025]);
    let ephemerides = navigation.satellite(1, Message::Lnav).iter().map(|it| (1, *it));
    assert_eq!(Navigation::of(ephemerides).satellite(1, Message::Lnav).len(), 2);
    Ok(())
}

#[test]
fn what_a_satellite_says_of_itself() -> Result<(), Error> {
    let first = |file: String, number, message| {
        Navigation::parse(&[text(file)]).map(|read| read.satellite(number, message)[0])
    };
    let gps = |from: &str, to: &str| first(navigation_3().replace(from, to), 1, Message::Lnav);
    let unhealthy = " 2.000000000000e+00 6.300000000000e+01 5.122";
    assert!(!gps(" 2.000000000000e+00 0.000000000000e+00 5.122", unhealthy)?.is_healthy);
    let accuracy = " 6.144000000000e+03 0.000000000000e+00 5.122";
    assert_eq!(gps(" 2.000000000000e+00 0.000000000000e+00 5.122", accuracy)?.accuracy, None);
    let galileo =
        |from: &str, to: &str, message| first(navigation_3().replace(from, to), 101, message);
    // No accuracy prediction available.
    let accuracy = galileo(" 3.120000000000e+00", "-1.000000000000e+00", Message::Fnav)?;
    assert_eq!(accuracy.accuracy, None);
    // E5a being out of service does not affect E1 and E5b.
    let [from, to] =
        ["3.120000000000e+00 0.000000000000e+00", "3.120000000000e+00 1.600000000000e+01"];
    assert!(!galileo(from, to, Message::Fnav)?.is_healthy);
    let inav =
        navigation_3().replace(from, to).replace(" 2.580000000000e+02", " 5.130000000000e+02");
    assert!(first(inav, 101, Message::Inav)?.is_healthy);
    Ok(())
}

#[test]
fn what_cannot_be_used_is_refused() {
    let file = navigation_3();
    let damaged = file.replace("1.000394229777e-02", "1.0003942x9777e-02");
    assert_eq!(
        complaint(&damaged),
        "file, line 7: expected a number of a navigation message, found \"1.0003942x9777e-02\""
    );
    let blank = file.replace("1.000394229777e-02", "                  ");
    assert!(complaint(&blank).starts_with("file, line 5: expected a whole navigation message"));
    let observations = header("     3.04           O", "RINEX VERSION / TYPE");
    assert_eq!(
        complaint(&observations),
        "file: expected a navigation file (RINEX), found observations (RINEX)"
    );
    assert!(complaint(&file.replace("     3.05", "     5.00")).contains("found version 5"));
    let clocks = header("     3.00           C", "RINEX VERSION / TYPE");
    assert!(complaint(&clocks).contains("found satellite clocks (RINEX)"));
}

#[test]
fn a_record_cut_off_is_left_out() -> Result<(), Error> {
    let file = navigation_3();
    let cut = Navigation::parse(&[text(&file[..file.len() - 110])])?;
    assert_eq!(cut.satellites().collect::<Vec<_>>(), [1]);
    assert_eq!(
        sentences(&cut.warnings),
        ["file, line 17: the file ends within this record, which is left out"]
    );
    Ok(())
}

#[test]
fn an_orbit_that_is_none_is_left_out() -> Result<(), Error> {
    for (from, to) in [
        ("1.000394229777e-02", "1.000394229777e+00"),
        ("1.000394229777e-02", "            -0.1  "),
        (" 5.153707128525e+03", " 0.000000000000e+00"),
        (" 5.153707128525e+03", "-5.153707128525e+03"),
    ] {
        let file = navigation_3().replace(from, to);
        assert_ne!(file, navigation_3(), "{from}");
        let read = Navigation::parse(&[text(file)])?;
        assert_eq!((read.satellites().collect::<Vec<_>>(), read.skipped), (vec![101], 2));
        assert!(sentences(&read.warnings)[0].ends_with("it is left out"));
    }
    Ok(())
}

/// The record of a Galileo satellite under another name: BeiDou's have the same order.
#[test]
fn times_of_beidou_are_14_s_behind() -> Result<(), Error> {
    let renamed = |name: &str| navigation_3().replace("E01 2020", name);
    let navigation = Navigation::parse(&[text(renamed("C19 2020"))])?;
    let [one] = navigation.satellite(199, Message::D1) else { panic!("one ephemeris") };
    assert_eq!(one.time, GpsTime::new(59_024, 84_614.0));
    assert_eq!(one.clock_time, GpsTime::new(59_024, 84_614.0));
    assert_eq!(one.group_delays, [-1.862_645_149_231e-9, 0.0]);
    assert_eq!((one.accuracy, one.is_healthy, one.fit), (Some(3.12), true, None));
    let fourth =
        navigation_4().replace("EPH E01 FNAV", "EPH C19 D1").replace("E01 2020", "C19 2020");
    let fourth = Navigation::parse(&[text(fourth)])?;
    assert_eq!(fourth.satellite(199, Message::D1), [*one]);
    let geostationary = Navigation::parse(&[text(renamed("C03 2020"))])?;
    assert_eq!(geostationary.satellites().collect::<Vec<_>>(), [1]);
    let told = "ephemerides of GLONASS (1), BeiDou (1) are in the file, but are not read";
    assert!(geostationary.unserved[0].to_string().ends_with(told));
    Ok(())
}
