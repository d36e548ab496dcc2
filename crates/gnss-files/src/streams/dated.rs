//! Dating of ephemerides from navigation messages, which give only the second of the week.

use kestirim_gnss_message as message;

use crate::navigation::{Ephemeris, Message, time_of_week};
use crate::time::GpsTime;

/// The ephemeris of a message whose last part was received `near` an instant.
pub(super) fn dated(of: Message, it: &message::Ephemeris, near: GpsTime) -> Ephemeris {
    let time = time_of_week(near, it.second);
    let clock_time = time_of_week(time, it.clock_second);
    let by_gps = |time: GpsTime| if of == Message::D1 { time.beidou_to_gps() } else { time };
    Ephemeris {
        message: of,
        time: by_gps(time),
        clock_time: by_gps(clock_time),
        clock: it.clock,
        issue: it.issue,
        root_of_axis: it.root_of_axis,
        eccentricity: it.eccentricity,
        mean_anomaly: it.mean_anomaly,
        mean_motion_correction: it.mean_motion_correction,
        perigee: it.perigee,
        node: it.node,
        node_rate: it.node_rate,
        inclination: it.inclination,
        inclination_rate: it.inclination_rate,
        latitude_terms: it.latitude_terms,
        radius_terms: it.radius_terms,
        inclination_terms: it.inclination_terms,
        group_delays: it.group_delays,
        accuracy: it.accuracy,
        is_healthy: it.is_healthy,
        fit: None,
    }
}
