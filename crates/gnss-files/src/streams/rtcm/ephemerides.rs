//! Ephemerides: messages 1019, 1042, 1045 and 1046.

use std::f64::consts::PI as SEMICIRCLE;

use kestirim_gnss_message::accuracy::{sisa, ura};
use rtcm_rs::msg::{Msg1019T, Msg1042T, Msg1045T, Msg1046T};

use crate::navigation::{Ephemeris, Message as Of, time_of_week};
use crate::time::GpsTime;

/// The length of a week, days.
pub(super) const WEEK: i32 = 7;
/// GPS weeks are transmitted modulo this: those from April 2019 on are assumed, unless Galileo, whose first week was
/// GPS week 1024, tells others.
pub(super) const ROLLOVER: i32 = 1_024;
/// The number of weeks to add to a GPS week.
const ROLLED_OVER: i32 = 2 * ROLLOVER;
/// The GPS week in which Galileo time began.
const GALILEO_WEEK: i32 = ROLLOVER;
/// The GPS week in which BeiDou time began.
const BEIDOU_WEEK: i32 = 1_356;

/// The instant of a second of a week, where the week is counted from `behind` weeks after the first week of GPS.
fn instant(week: u16, behind: i32, second: f32) -> GpsTime {
    GpsTime::new(GpsTime::EPOCH.day() + WEEK * (i32::from(week) + behind), f64::from(second))
}

/// Converts the orbit in a message.
macro_rules! orbit {
    ($message:ident, $rest:expr) => {{
        let it = $message;
        let single = |number: f32| f64::from(number);
        Ephemeris {
            root_of_axis: it.sqrt_a_sqrt_m,
            eccentricity: it.eccentricity,
            mean_anomaly: SEMICIRCLE * it.m0_sc,
            mean_motion_correction: SEMICIRCLE * single(it.delta_n_sc_s),
            perigee: SEMICIRCLE * it.omega_sc,
            node: SEMICIRCLE * it.omega0_sc,
            node_rate: SEMICIRCLE * f64::from(it.omegadot_sc_s),
            inclination: SEMICIRCLE * it.i0_sc,
            inclination_rate: SEMICIRCLE * f64::from(it.idot_sc_s),
            latitude_terms: [single(it.cuc_rad), single(it.cus_rad)],
            radius_terms: [single(it.crc_m), single(it.crs_m)],
            inclination_terms: [single(it.cic_rad), single(it.cis_rad)],
            ..$rest
        }
    }};
}

/// Converts a message of GPS or Galileo, given the names of the fields that differ.
macro_rules! ephemeris {
    ($message:ident, $of:expr, $week:ident, $behind:ident, $issue:ident, $rest:expr) => {{
        let it = $message;
        let time = instant(it.$week, $behind, it.toe_s);
        let told = Ephemeris {
            message: $of,
            time,
            clock_time: time_of_week(time, f64::from(it.toc_s)),
            clock: [it.af0_s, f64::from(it.af1_s_s), f64::from(it.af2_s_s2)],
            issue: u16::from(it.$issue),
            ..$rest
        };
        orbit!(it, told)
    }};
}

pub(super) fn gps(it: &Msg1019T) -> Ephemeris {
    ephemeris!(
        it,
        Of::Lnav,
        gps_week_number,
        ROLLED_OVER,
        iode,
        Ephemeris {
            group_delays: [f64::from(it.tgd_s), 0.0],
            accuracy: ura(it.ura_index),
            is_healthy: it.sv_health_ind == 0,
            ..Ephemeris::NOTHING
        }
    )
}

pub(super) fn fnav(it: &Msg1045T) -> Ephemeris {
    ephemeris!(
        it,
        Of::Fnav,
        gal_week_number,
        GALILEO_WEEK,
        iodnav,
        Ephemeris {
            group_delays: [f64::from(it.bgd_e1_e5a_s), 0.0],
            accuracy: sisa(it.sisa_e1_e5a_index),
            is_healthy: it.e5a_sig_health_ind == 0 && it.e5a_data_validity_flag == 0,
            ..Ephemeris::NOTHING
        }
    )
}

pub(super) fn inav(it: &Msg1046T) -> Ephemeris {
    let signals = [it.e1_b_sig_health_ind, it.e5b_sig_health_ind];
    let data = [it.e1_b_data_validity_flag, it.e5b_data_validity_flag];
    ephemeris!(
        it,
        Of::Inav,
        gal_week_number,
        GALILEO_WEEK,
        iodnav,
        Ephemeris {
            group_delays: [f64::from(it.bgd_e1_e5a_s), f64::from(it.bgd_e1_e5b_s)],
            accuracy: sisa(it.sisa_e1_e5b_index),
            is_healthy: signals == [0; 2] && data == [0; 2],
            ..Ephemeris::NOTHING
        }
    )
}

pub(super) fn beidou(it: &Msg1042T) -> Ephemeris {
    let by_gps = |second| instant(it.bds_week_number, BEIDOU_WEEK, second).beidou_to_gps();
    let told = Ephemeris {
        message: Of::D1,
        time: by_gps(it.toe_s),
        clock_time: by_gps(it.toc_s),
        clock: [it.a0_s, it.a1_s_s, f64::from(it.a2_s_s2)],
        issue: u16::from(it.aode),
        group_delays: [it.tgd1_s, it.tgd2_s].map(f64::from),
        accuracy: ura(it.ura_index),
        is_healthy: it.sv_health_flag == 0,
        ..Ephemeris::NOTHING
    };
    orbit!(it, told)
}
