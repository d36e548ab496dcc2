//! RTCM 3, as produced by the decoder's own encoder.

use std::f64::consts::PI;

use rtcm_rs::msg::{
    BdsSigId, GloSigId, GpsSigId, Msg1019T, Msg1042T, Msg1045T, Msg1077Data, Msg1077Sig, Msg1077T,
    Msg1087Data, Msg1087Sig, Msg1087T, Msg1127Data, Msg1127Sig, Msg1127T, Msm57GloSat, Msm57Sat,
    message,
};
use rtcm_rs::prelude::MessageBuilder;
use rtcm_rs::util::DataVec;

use super::*;
use crate::Carriers;
use kestirim_gnss_message::crc_24q;

fn frame(message: &message::Message) -> Vec<u8> {
    MessageBuilder::new().build_message(message).expect("a message").to_vec()
}

/// Fills in the fields that both messages have in common.
macro_rules! told {
    ($type:ident { $($own:tt)* }, $it:ident) => {
        $type {
            toe_s: second_of_week($it.time),
            toc_s: second_of_week($it.clock_time),
            af0_s: $it.clock[0],
            crs_m: $it.radius_terms[1] as f32,
            crc_m: $it.radius_terms[0] as f32,
            delta_n_sc_s: ($it.mean_motion_correction / PI) as f32,
            m0_sc: $it.mean_anomaly / PI,
            cuc_rad: $it.latitude_terms[0] as f32,
            cus_rad: $it.latitude_terms[1] as f32,
            cic_rad: $it.inclination_terms[0] as f32,
            cis_rad: $it.inclination_terms[1] as f32,
            eccentricity: $it.eccentricity,
            sqrt_a_sqrt_m: $it.root_of_axis,
            omega0_sc: $it.node / PI,
            i0_sc: $it.inclination / PI,
            omega_sc: $it.perigee / PI,
            $($own)*
            ..$type::default()
        }
    };
}

fn second_of_week(time: crate::GpsTime) -> f32 {
    (f64::from((time.day() - 44_244).rem_euclid(7)) * 86_400.0 + time.second()) as f32
}

pub(super) fn ephemerides(told: &[(u8, Ephemeris); 2]) -> Vec<u8> {
    ephemerides_of_week(told, 2111)
}

fn ephemerides_of_week([(_, gps), (_, galileo)]: &[(u8, Ephemeris); 2], week: u16) -> Vec<u8> {
    let gps = told!(
        Msg1019T {
            gps_satellite_id: 1,
            gps_week_number: week % 1024,
            ura_index: 0,
            iode: 58,
            iodc: 58,
            af1_s_s: gps.clock[1] as _,
            omegadot_sc_s: (gps.node_rate / PI) as _,
            idot_sc_s: gps.inclination_rate / PI,
            tgd_s: gps.group_delays[0] as f32,
        },
        gps
    );
    let galileo = told!(
        Msg1045T {
            gal_satellite_id: 1,
            gal_week_number: week - 1024,
            sisa_e1_e5a_index: 107,
            iodnav: 61,
            af1_s_s: galileo.clock[1],
            omegadot_sc_s: (galileo.node_rate / PI) as _,
            idot_sc_s: (galileo.inclination_rate / PI) as f32,
            bgd_e1_e5a_s: galileo.group_delays[0] as f32,
        },
        galileo
    );
    [frame(&message::Message::Msg1019(gps)), frame(&message::Message::Msg1045(galileo))].concat()
}

pub(super) fn observed(milliseconds: u32, lock: u16) -> Vec<u8> {
    let mut data = Msg1077Data::default();
    data.satellite_data.push(Msm57Sat {
        satellite_id: 5,
        gnss_satellite_rough_range_integer_ms: Some(70),
        gnss_satellite_rough_range_mod1ms_ms: 0.5,
        ..Msm57Sat::default()
    });
    let mut signals = DataVec::new();
    for (band, code, phase) in [(1, 0.000_1, 0.000_2), (2, 0.000_3, 0.000_4)] {
        signals.push(Msg1077Sig {
            satellite_id: 5,
            signal_id: GpsSigId::new(band, 'W'),
            gnss_signal_fine_pseudorange_ext_ms: Some(code),
            gnss_signal_fine_phaserange_ext_ms: Some(phase),
            gnss_phaserange_lock_time_ext_ind: lock,
            ..Msg1077Sig::default()
        });
    }
    data.signal_data = signals;
    frame(&message::Message::Msg1077(Msg1077T {
        gps_epoch_time_ms: milliseconds,
        data_segment: data,
        ..Msg1077T::default()
    }))
}

/// A message with two signals of a GLONASS satellite, on Thursday in Moscow time.
fn of_glonass(milliseconds: u32, number: u8, channel: Option<i8>) -> Vec<u8> {
    let mut data = Msg1087Data::default();
    data.satellite_data.push(Msm57GloSat {
        satellite_id: number,
        gnss_satellite_rough_range_integer_ms: Some(65),
        gnss_satellite_rough_range_mod1ms_ms: 0.25,
        glonass_satellite_frequency_channel_number: channel,
        ..Msm57GloSat::default()
    });
    let mut signals = DataVec::new();
    for (band, fine) in [(1, 0.000_1), (2, 0.000_3)] {
        signals.push(Msg1087Sig {
            satellite_id: number,
            signal_id: GloSigId::new(band, 'C'),
            gnss_signal_fine_pseudorange_ext_ms: Some(fine),
            gnss_signal_fine_phaserange_ext_ms: Some(fine),
            gnss_phaserange_lock_time_ext_ind: 7,
            ..Msg1087Sig::default()
        });
    }
    data.signal_data = signals;
    frame(&message::Message::Msg1087(Msg1087T {
        glo_day_of_week: Some(4),
        glo_epoch_time_ms: milliseconds,
        data_segment: data,
        ..Msg1087T::default()
    }))
}

/// A message with two signals of a BeiDou satellite.
fn of_beidou(milliseconds: u32) -> Vec<u8> {
    let mut data = Msg1127Data::default();
    data.satellite_data.push(Msm57Sat {
        satellite_id: 19,
        gnss_satellite_rough_range_integer_ms: Some(80),
        ..Msm57Sat::default()
    });
    let mut signals = DataVec::new();
    for band in [2, 6] {
        signals.push(Msg1127Sig {
            satellite_id: 19,
            signal_id: BdsSigId::new(band, 'I'),
            gnss_signal_fine_pseudorange_ext_ms: Some(0.0),
            gnss_signal_fine_phaserange_ext_ms: Some(0.0),
            gnss_phaserange_lock_time_ext_ind: 7,
            ..Msg1127Sig::default()
        });
    }
    data.signal_data = signals;
    frame(&message::Message::Msg1127(Msg1127T {
        bds_epoch_time_ms: milliseconds,
        data_segment: data,
        ..Msg1127T::default()
    }))
}

/// An epoch on Thursday at 4 o'clock, with GLONASS before or after the others, and one without GPS, to which GLONASS
/// belongs.
#[test]
fn glonass_and_beidou_are_put_to_the_epochs_of_gps() -> Result<(), Error> {
    const AT: u32 = 4 * 86_400_000 + 14_400_000;
    const OF_DAY: u32 = 14_400_000 + 10_800_000 - 18_000;
    let dated = ephemerides(&broadcast()?);
    let [gps, beidou] = [observed(AT, 7), of_beidou(AT - 14_000)];
    let glonass = [of_glonass(OF_DAY, 7, Some(5)), of_glonass(OF_DAY, 22, None)].concat();
    // GLONASS without an epoch of other systems.
    let alone = of_glonass(OF_DAY + 500, 7, Some(5));
    for stream in [
        [&dated, &gps, &beidou, &glonass, &alone].map(Vec::as_slice).concat(),
        [&glonass, &dated, &beidou, &gps, &alone].map(Vec::as_slice).concat(),
    ] {
        let observations = Observations::parse(&text(stream))?;
        let [epoch] = &observations.epochs[..] else { panic!("one epoch") };
        assert_eq!(epoch.time, crate::GpsTime::new(59_025, 14_400.0));
        let of = |number| *epoch.satellites.iter().find(|it| it.prn == number).expect("observed");
        assert_eq!(epoch.satellites.len(), 3, "R22 has no channel");
        let (glonass, beidou) = (of(157), of(199));
        assert_eq!(glonass.carriers, Carriers::G1G2 { channel: 5 });
        let c = 299_792_458.0;
        let first = c / (1_602e6 + 5.0 * 562_500.0) * glonass.phase[0].expect("a phase");
        assert!((first - c * 1e-3 * 65.250_1).abs() < 1e-4, "{first}");
        let second = c / (1_246e6 + 5.0 * 437_500.0) * glonass.phase[1].expect("a phase");
        assert!((second - c * 1e-3 * 65.250_3).abs() < 1e-4, "{second}");
        assert_eq!((beidou.carriers, beidou.code), (Carriers::B1B3, [Some(c * 0.08); 2]));
        let phase = c / 1_561.098e6 * beidou.phase[0].expect("a phase");
        assert!((phase - c * 0.08).abs() < 1e-4, "{phase}");
        let [warning] = &observations.warnings[..] else { panic!("one warning") };
        assert!(warning.to_string().contains("tells no channel of R22"), "{warning}");
    }
    Ok(())
}

#[test]
fn weeks_of_beidou_are_its_own() -> Result<(), Error> {
    let [(_, gps), _] = broadcast()?;
    let of = |satellite| {
        let told = Msg1042T {
            bds_satellite_id: satellite,
            bds_week_number: 2111 - 1356,
            toe_s: second_of_week(gps.time) - 14.0,
            toc_s: second_of_week(gps.time) - 14.0,
            sqrt_a_sqrt_m: gps.root_of_axis,
            eccentricity: gps.eccentricity,
            tgd1_s: 1e-8,
            ura_index: 1,
            ..Msg1042T::default()
        };
        frame(&message::Message::Msg1042(told))
    };
    let read = Navigation::parse(&[text([of(19), of(3)].concat())])?;
    let [one] = read.satellite(199, Message::D1) else { panic!("one ephemeris") };
    assert!(one.time.since(gps.time).abs() < 8.0, "{:?}", one.time);
    assert!((one.group_delays[0] - 1e-8).abs() < 1e-10 && one.is_healthy);
    assert_eq!(read.satellites().collect::<Vec<_>>(), [199], "C03 is geostationary");
    Ok(())
}

#[test]
fn ephemerides_are_what_the_file_has() -> Result<(), Error> {
    let told = broadcast()?;
    let stream = text(ephemerides(&told));
    assert_eq!(Kind::of(stream.bytes()), Some(Kind::Rtcm));
    let read = Navigation::parse(&[stream])?;
    let [gps] = read.satellite(1, Message::Lnav) else { panic!("one ephemeris") };
    are_alike(gps, &told[0].1);
    let [galileo] = read.satellite(101, Message::Fnav) else { panic!("one ephemeris") };
    are_alike(galileo, &told[1].1);
    Ok(())
}

#[test]
fn observations_are_read_to_the_resolution_of_the_format() -> Result<(), Error> {
    // Noise around, Saturday's last second and Sunday's first.
    let stream = [
        b"$GNGGA,\xd3\x00\x13noise\r\n".to_vec(),
        ephemerides(&broadcast()?),
        observed(604_799_000, 7),
        observed(0, 3),
    ]
    .concat();
    let observations = Observations::parse(&text(stream))?;
    let times: Vec<_> = observations.epochs.iter().map(|it| it.time).collect();
    assert_eq!(times[1].since(times[0]), 1.0);
    assert_eq!((times[0].day() - 44_244) % 7, 6);
    let [first, second] = [0, 1].map(|epoch: usize| observations.epochs[epoch].satellites[0]);
    let c = 299_792.458;
    for (band, [fine, phase]) in [[0.000_1, 0.000_2], [0.000_3, 0.000_4]].into_iter().enumerate() {
        let code = first.code[band].expect("a code");
        assert!((code - c * (70.5 + fine)).abs() < 3e-4);
        let wavelength = c * 1e3 / [1_575.42e6, 1_227.60e6][band];
        let range = wavelength * first.phase[band].expect("a phase");
        assert!((range - c * (70.5 + phase)).abs() < 7.1e-5);
    }
    // Tracked for a shorter time than before.
    assert_eq!((first.loss_of_lock, second.loss_of_lock), ([false; 2], [true; 2]));
    Ok(())
}

/// The message under another number: the observation messages of all systems have the same structure.
fn renumbered(frame: &[u8], number: u16) -> Vec<u8> {
    let mut frame = frame[..frame.len() - 3].to_vec();
    frame[3] = (number >> 4) as u8;
    frame[4] = frame[4] & 0xf | (number << 4) as u8;
    let sum = crc_24q(&frame).to_be_bytes();
    [&frame, &sum[1..]].concat()
}

#[test]
fn what_is_passed_over_is_named() -> Result<(), Error> {
    let read = [ephemerides(&broadcast()?), observed(345_600_000, 7)].concat();
    let [gps, of_gps] = [observed(345_600_000, 7), ephemerides(&broadcast()?)];
    // SBAS, NavIC and a number that no message has; GPS and GLONASS as MSM5, and GPS in the old form; ephemerides of
    // GLONASS and QZSS.
    let others = [1107, 1137, 1138, 1075, 1085].map(|number| renumbered(&gps, number)).concat();
    let end = 6 + usize::from(of_gps[2]);
    let broadcast = [1020, 1044].map(|number| renumbered(&of_gps[..end], number)).concat();
    let old = renumbered(&of_gps[..end], 1004);
    let stream = text([read.clone(), others, broadcast, old].concat());

    let observations = Observations::parse(&stream)?;
    let told = observations.unserved.map(|it| it.to_string());
    let expected = "file: satellites of NavIC (1), SBAS (1) are in the file, but are not read";
    assert_eq!(told.as_deref(), Some(expected));
    let [warning] = &observations.warnings[..] else { panic!("one warning") };
    let expected =
        "file: observations in messages 1004, 1075, 1085 are not read, only those in MSM4 and MSM7";
    assert_eq!(warning.to_string(), expected);
    let navigation = Navigation::parse(&[stream])?;
    let [unserved] = &navigation.unserved[..] else { panic!("one warning") };
    let expected = "file: ephemerides of GLONASS (1), QZSS (1) are in the file, but are not read";
    assert_eq!(unserved.to_string(), expected);

    let stream = text(read);
    let observations = Observations::parse(&stream)?;
    assert_eq!((observations.unserved, observations.warnings), (None, Vec::new()));
    assert_eq!(Navigation::parse(&[stream])?.unserved, []);
    Ok(())
}

#[test]
fn a_stream_without_a_date_is_refused() {
    let complaint = Observations::parse(&text(observed(0, 0))).expect_err("no date");
    assert!(complaint.to_string().contains("tells the week"), "{complaint}");
}

#[test]
fn an_ephemeris_for_the_next_week_is_not_a_week_early() -> Result<(), Error> {
    // Transmitted on Saturday evening for Sunday, 0 h; some senders give the week of Sunday.
    let sunday = crate::GpsTime::new(59_028, 0.0);
    let plain = broadcast()?;
    let next = plain
        .map(|(satellite, it)| (satellite, Ephemeris { time: sunday, clock_time: sunday, ..it }));
    let saturday = observed(603_000_000, 7);
    let later = [plain[0], plain[1]].map(|(satellite, it)| {
        let time = crate::GpsTime::new(59_027, 72_000.0);
        (satellite, Ephemeris { time, clock_time: time, ..it })
    });
    for stream in [
        [saturday.clone(), ephemerides_of_week(&next, 2111)].concat(),
        [ephemerides_of_week(&next, 2111), saturday.clone()].concat(),
        [saturday.clone(), ephemerides_of_week(&next, 2112), ephemerides(&later)].concat(),
    ] {
        let read = Navigation::parse(&[text(stream.clone())])?;
        for (satellite, message) in [(1, Message::Lnav), (101, Message::Fnav)] {
            let last = read.satellite(satellite, message).last().expect("an ephemeris");
            assert_eq!((last.time, last.clock_time), (sunday, sunday));
        }
        let epoch = Observations::parse(&text(stream))?.epochs[0].time;
        assert_eq!(epoch, crate::GpsTime::new(59_027, 84_600.0));
    }
    Ok(())
}
