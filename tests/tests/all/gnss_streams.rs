//! A day that was recorded as RINEX, re-encoded as RTCM 3 (MSM7) and as UBX (RXM-RAWX), gives the same positions.
//!
//! The recordings are in `../shared/data/gnss`, beside the repository. Where they are absent these tests print SKIPPED
//! and pass; with `KESTIRIM_REQUIRE_DATA=1` they fail instead. With `--nocapture` each is printed.

use std::collections::BTreeMap;
use std::io::Read as _;
use std::path::Path;

use flate2::read::GzDecoder;
use host_sim::system::Settings;
use host_sim::systems::ALL;
use host_sim::systems::gnss::settings::Setup;
use kestirim_gnss_files::{Epoch, Observations};
use kestirim_gnss_ppp::constants::SPEED_OF_LIGHT;
use kestirim_gnss_ppp::{Corrections, FREQUENCY};
use kestirim_ppp_filter::{Config, Motion};
use kestirim_replay::gnss::{Followed, Pass, follow};
use kestirim_tests::gnss::ESBC;
use kestirim_tests::recordings::folder_of;
use nalgebra::Vector3;
use rtcm_rs::Message;
use rtcm_rs::MessageBuilder;
use rtcm_rs::msg::{GpsSigId, Msg1019T, Msg1077Data, Msg1077Sig, Msg1077T, Msm57Sat};

/// The GPS week of the day, and the day on which it began.
const WEEK: u16 = 2_111;
const SUNDAY: i32 = 59_021;
/// The largest lock time of a phase that a UBX message can hold, ms.
const LONGEST_LOCK: u16 = 64_500;

/// The time since when a phase has been tracked, s, and its shift in cycles: a format can only encode phases close to
/// the codes.
#[derive(Default)]
struct Tracked(BTreeMap<(u8, usize), (f64, f64)>);

/// The tracking time after which a phase is sent, s.
const TRACKED_BEFORE: f64 = 1.0;

/// The lock-time indicator of MSM7 (DF407) for a phase tracked for this time, s.
fn indicator(tracked: f64) -> u16 {
    let milliseconds = (1e3 * tracked).round() as u32;
    let step = milliseconds.max(32).ilog2() - 5;
    (32 * step + (milliseconds >> step)).min(704) as u16
}

/// The observations as RINEX, without what streams lack: the antenna and its position.
fn rinex(folder: &Path) -> String {
    let mut text = String::new();
    let file = std::fs::File::open(folder.join(ESBC.observations)).expect("a recording");
    GzDecoder::new(file).read_to_string(&mut text).expect("text");
    let is_told = |line: &&str| !line.contains("ANT # / TYPE") && !line.contains("ANTENNA: DELTA");
    text.lines().filter(is_told).flat_map(|line| [line, "\n"]).collect()
}

fn second_of_week(epoch: &Epoch) -> f64 {
    f64::from(epoch.time.day() - SUNDAY) * 86_400.0 + epoch.time.second()
}

fn rtcm(epochs: &[Epoch]) -> Vec<u8> {
    let mut tracked = Tracked::default();
    let week = Msg1019T {
        gps_satellite_id: 1,
        gps_week_number: WEEK % 1024,
        toe_s: 345_600.0,
        ..Msg1019T::default()
    };
    let mut stream = frame(&Message::Msg1019(week));
    for epoch in epochs {
        let begun = second_of_week(epoch) - TRACKED_BEFORE;
        let mut data = Msg1077Data::default();
        for observed in &epoch.satellites {
            let Some(code) = observed.code[0] else { continue };
            let milliseconds = |metres: f64| 1e3 * metres / SPEED_OF_LIGHT;
            let rough = (1024.0 * milliseconds(code)).round() / 1024.0;
            data.satellite_data.push(Msm57Sat {
                satellite_id: observed.prn,
                gnss_satellite_rough_range_integer_ms: Some(rough.floor() as u8),
                gnss_satellite_rough_range_mod1ms_ms: rough - rough.floor(),
                ..Msm57Sat::default()
            });
            for band in 0..2 {
                let (Some(code), Some(phase)) = (observed.code[band], observed.phase[band]) else {
                    continue;
                };
                let cycles_of = 1e-3 * FREQUENCY[band];
                let place = tracked.0.entry((observed.prn, band)).or_insert((begun, f64::INFINITY));
                let fine = |shift: f64| (phase + shift) / cycles_of - rough;
                if observed.loss_of_lock[band] {
                    place.0 = begun;
                }
                let fits = fine(place.1).abs() < 0.003_5;
                if !fits {
                    *place = (begun, (rough * cycles_of - phase).round());
                }
                data.signal_data.push(Msg1077Sig {
                    satellite_id: observed.prn,
                    signal_id: GpsSigId::new(band as u8 + 1, 'W'),
                    gnss_signal_fine_pseudorange_ext_ms: Some(milliseconds(code) - rough),
                    gnss_signal_fine_phaserange_ext_ms: Some(fine(place.1)),
                    gnss_phaserange_lock_time_ext_ind: indicator(second_of_week(epoch) - place.0),
                    ..Msg1077Sig::default()
                });
            }
        }
        stream.extend(frame(&Message::Msg1077(Msg1077T {
            gps_epoch_time_ms: (1e3 * second_of_week(epoch)).round() as u32,
            data_segment: data,
            ..Msg1077T::default()
        })));
    }
    stream
}

fn frame(message: &Message) -> Vec<u8> {
    MessageBuilder::new().build_message(message).expect("a message").to_vec()
}

/// The messages UBX-RXM-RAWX of epochs.
pub(super) fn ubx(epochs: &[Epoch]) -> Vec<Vec<u8>> {
    let mut tracked = Tracked::default();
    let message = |epoch: &Epoch| {
        let begun = second_of_week(epoch) - TRACKED_BEFORE;
        let mut signals = Vec::new();
        for observed in &epoch.satellites {
            for (band, signal) in [(0, 0), (1, 3)] {
                let (Some(code), Some(phase)) = (observed.code[band], observed.phase[band]) else {
                    continue;
                };
                let (since, _) = tracked.0.entry((observed.prn, band)).or_insert((begun, 0.0));
                if observed.loss_of_lock[band] {
                    *since = begun;
                }
                let tracked = 1e3 * (second_of_week(epoch) - *since);
                let lock = (tracked.round() as u32).min(LONGEST_LOCK.into()) as u16;
                signals.extend(code.to_le_bytes());
                signals.extend(phase.to_le_bytes());
                signals.extend([0, 0, 0, 0, 0, observed.prn, signal, 0]);
                signals.extend(lock.to_le_bytes());
                signals.extend([40, 0, 0, 0, 7, 0]);
            }
        }
        let mut held = second_of_week(epoch).to_le_bytes().to_vec();
        held.extend(WEEK.to_le_bytes());
        held.extend([18, (signals.len() / 32) as u8, 1, 1, 0, 0]);
        held.extend(signals);
        ubx_frame(0x15, &held)
    };
    epochs.iter().map(message).collect()
}

/// A frame of UBX of the class RXM.
pub(super) fn ubx_frame(id: u8, held: &[u8]) -> Vec<u8> {
    let length = (held.len() as u16).to_le_bytes();
    let summed = [&[0x02, id, length[0], length[1]], held].concat();
    let sums = summed.iter().fold([0_u8; 2], |[a, b], byte| {
        let a = a.wrapping_add(*byte);
        [a, b.wrapping_add(a)]
    });
    [&[0xb5, 0x62], &*summed, &sums].concat()
}

fn positions(folder: &Path, observations: &[u8], config: &Config) -> Followed {
    let file = tempfile::NamedTempFile::new().expect("a temporary file");
    std::fs::write(file.path(), observations).expect("a file can be written");
    let path = file.path().display().to_string();
    let recording = ESBC.observed_in(path.leak()).read(folder);
    let receiver = recording.receiver(Corrections::ALL);
    follow(
        &recording,
        recording.epochs(Some(ESBC.until)),
        &receiver,
        *config,
        Pass::default(),
        &mut || (),
    )
}

#[test]
fn streams_give_what_rinex_gives() {
    let Some(folder) = folder_of("gnss") else { return };
    let text = rinex(&folder);
    let read = kestirim_gnss_files::Text::unpack("day.rnx", text.clone().into_bytes());
    let observations = read.and_then(|text| Observations::parse(&text)).expect("observations");
    let config = Config::new(Motion::Static);
    let told = positions(&folder, text.as_bytes(), &config);
    for (format, stream) in
        [("RTCM", rtcm(&observations.epochs)), ("UBX", ubx(&observations.epochs).concat())]
    {
        let found = positions(&folder, &stream, &config);
        assert_eq!(found.fixes.len(), told.fixes.len());
        let away = |(a, b): (&kestirim_replay::gnss::Fix, &kestirim_replay::gnss::Fix)| {
            assert_eq!(a.t, b.t);
            (a.position - b.position).norm()
        };
        let away: Vec<_> = found.fixes.iter().zip(&told.fixes).map(away).collect();
        let (settled, last) = (&away[120..], away.last().expect("a position"));
        let most = settled.iter().copied().fold(0.0, f64::max);
        println!("{format}: last {:.4} mm, most after an hour {:.4} mm", 1e3 * last, 1e3 * most);
        assert!(*last < 1e-4 && most < 2.5e-4);
    }
}

/// The size of the pieces of a stream as a line delivers them, bytes, and the number of pieces after which there is a
/// pause.
const PIECE: usize = 700;
const PIECES: usize = 9;

#[test]
fn a_stream_that_comes_gives_what_it_gives_as_a_recording() {
    let Some(folder) = folder_of("gnss") else { return };
    let text = kestirim_gnss_files::Text::unpack("day.rnx", rinex(&folder).into_bytes());
    let observations = text.and_then(|text| Observations::parse(&text)).expect("observations");
    // Twice the part of a stream that is kept.
    let epochs = &observations.epochs[..720];
    let gnss = ALL.iter().find(|system| system.name() == "gnss").expect("the system");
    let settings = Settings::new(gnss.settings());
    let setup = Setup::of(&settings);
    for (format, stream) in [("RTCM", rtcm(epochs)), ("UBX", ubx(epochs).concat())] {
        let told = positions(&folder, &stream, &setup.config(setup.main()));
        let plan = gnss.online(&settings, &ESBC.products(&folder)).expect("a plan");
        let mut online = plan.expect("a follower").build().expect("an estimator");
        for (index, piece) in stream.chunks(PIECE).enumerate() {
            online.hear(piece);
            if index % PIECES == 0 {
                online.settle();
                let solved = online.heard()[1] as usize;
                let then = solved.checked_sub(1).map(|last| told.fixes[last].position);
                let apart = online.position().zip(then).map(|(a, b)| (Vector3::from(a) - b).norm());
                assert!(apart.is_none_or(|apart| apart < 1e-6), "{apart:?}");
            }
        }
        online.settle();
        let [heard, solved] = online.heard().map(|count| count as usize);
        // The last epoch may have another message until it is known that none follows.
        assert_eq!((heard, solved + 1), (epochs.len() - 1, told.fixes.len()));
        online.finish().expect("nothing is written");
        assert_eq!(online.heard()[1] as usize, told.fixes.len());
        let (found, last) =
            (online.position().expect("a position"), told.fixes.last().expect("one"));
        let away = (Vector3::from(found) - last.position).norm();
        println!("{format}: {:.6} mm from the recording's", 1e3 * away);
        assert!(away < 1e-6);
        assert!(online.sigma_m().is_some_and(|sigma| sigma < 0.05));
        assert!(online.place().is_some_and(|[x, y]| x.hypot(y) < 20.0));
    }
}
