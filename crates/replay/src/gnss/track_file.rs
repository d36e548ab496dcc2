//! Tracks in the formats of other programs, by the file extension: RTKLIB's positions, NMEA, KML and GPX.

use std::fmt::Write;

use kestirim_gnss_ppp::{Corrections, Geodetic};
use kestirim_ppp_filter::Health;

use super::calendar::{Calendar, calendar};
use super::{Followed, Recording};

/// One position of the marker.
struct Row {
    /// The calendar date and time of GPS time.
    gps: Calendar,
    /// The calendar date and time of UTC.
    utc: Calendar,
    latitude: f64,
    longitude: f64,
    height: f64,
    /// Standard deviations to the east, north and up, m.
    deviations: [f64; 3],
    satellites: usize,
    /// Whether the position has converged; `None` if it is contradicted. RTKLIB and NMEA number it 6 and 5 for a
    /// converged precise point, 6 and 2 for another, 5 and 0 for a contradicted one.
    trusted: Option<bool>,
}

/// The track in the format of a file extension: `pos` (RTKLIB), `nmea`, `kml` or `gpx`; `None` for any other.
pub fn track_text(ending: &str, recording: &Recording, followed: &Followed) -> Option<String> {
    let format: fn(&[Row]) -> String = match ending {
        "pos" => pos,
        "nmea" => nmea,
        "kml" => kml,
        "gpx" => gpx,
        _ => return None,
    };
    Some(format(&rows(recording, followed)))
}

fn rows(recording: &Recording, followed: &Followed) -> Vec<Row> {
    let utc = recording.receiver(Corrections::ALL).ut1_minus_gps;
    let states = followed.fixes.iter().zip(&followed.deviations).zip(&followed.healths);
    let rows = states.zip(&followed.heard).map(|(((fix, deviations), health), heard)| {
        let place = Geodetic::from_ecef(&fix.position);
        let day = i64::from(recording.midnight.day());
        Row {
            gps: calendar(day, fix.t),
            utc: calendar(day, fix.t + utc),
            latitude: place.latitude.to_degrees(),
            longitude: place.longitude.to_degrees(),
            height: place.height,
            deviations: *deviations,
            satellites: *heard,
            trusted: match health {
                Health::Contradicted(_) => None,
                health => Some(*health == Health::Converged),
            },
        }
    });
    rows.collect()
}

/// RTKLIB's solution file: GPS time, degrees, ellipsoidal height, quality 6 (precise point).
fn pos(rows: &[Row]) -> String {
    let mut text = String::from(
        "% program   : kestirim\n% (lat/lon/height=WGS84/ellipsoidal,Q=1:fix,2:float,3:sbas,4:dgps,5:single,6:ppp,ns=# of \
         satellites)\n%  GPST                  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   \
         sdu(m)  sdne(m)  sdeu(m)  sdun(m) age(s)  ratio\n",
    );
    for row in rows {
        let ([year, month, day, hour, minute], second) = row.gps;
        let quality = if row.trusted.is_some() { 6 } else { 5 };
        let [east, north, up] = row.deviations;
        // Writing to a `String` does not fail.
        let _ = writeln!(
            text,
            "{year:04}/{month:02}/{day:02} {hour:02}:{minute:02}:{second:06.3} {:14.9} {:14.9} {:10.4} {quality:3} {:3} \
             {north:8.4} {east:8.4} {up:8.4} {:8.4} {:8.4} {:8.4} {:6.2} {:6.1}",
            row.latitude, row.longitude, row.height, row.satellites, 0.0, 0.0, 0.0, 0.0, 0.0
        );
    }
    text
}

/// NMEA 0183: GGA and RMC for each position. The height is ellipsoidal, and the geoid separation is given as zero.
fn nmea(rows: &[Row]) -> String {
    let mut text = String::new();
    let mut say = |body: String| {
        let sum = body.bytes().fold(0, |sum, byte| sum ^ byte);
        let _ = write!(text, "${body}*{sum:02X}\r\n");
    };
    for row in rows {
        let ([year, month, day, hour, minute], second) = row.utc;
        let (latitude, north) = angle(row.latitude, 2, ['N', 'S']);
        let (longitude, east) = angle(row.longitude, 3, ['E', 'W']);
        let quality = match row.trusted {
            Some(true) => 5,
            Some(false) => 2,
            None => 0,
        };
        let valid = if row.trusted.is_some() { 'A' } else { 'V' };
        let clock = format!("{hour:02}{minute:02}{second:05.2}");
        let (count, height) = (row.satellites.min(99), row.height);
        say(format!(
            "GNGGA,{clock},{latitude},{north},{longitude},{east},{quality},{count:02},,{height:.3},M,0.000,M,,"
        ));
        let date = format!("{day:02}{month:02}{:02}", year % 100);
        say(format!("GNRMC,{clock},{valid},{latitude},{north},{longitude},{east},,,{date},,,A"));
    }
    text
}

/// Degrees and minutes to a tenth of a millimetre or two, and the letter of the hemisphere.
fn angle(degrees: f64, digits: usize, [positive, negative]: [char; 2]) -> (String, char) {
    const PARTS: i64 = 100_000_000;
    let parts = (degrees.abs() * 60.0 * PARTS as f64).round() as i64;
    let (whole, minutes) = (parts / (60 * PARTS), parts % (60 * PARTS));
    let text = format!("{whole:0digits$}{:02}.{:08}", minutes / PARTS, minutes % PARTS);
    (text, if degrees < 0.0 { negative } else { positive })
}

fn instant((date, second): Calendar) -> String {
    let [year, month, day, hour, minute] = date;
    format!("{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:06.3}Z")
}

/// KML: a line and the last place. Contradicted positions are left out.
fn kml(rows: &[Row]) -> String {
    let place = |row: &Row| format!("{:.9},{:.9},{:.4}", row.longitude, row.latitude, row.height);
    let trusted = || rows.iter().filter(|row| row.trusted.is_some());
    let line = trusted().map(place).collect::<Vec<_>>().join("\n");
    let last = trusted().next_back().map(|row| {
        format!("<Placemark><name>last</name><Point><coordinates>{}</coordinates></Point></Placemark>\n", place(row))
    });
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n<name>kestirim</name>\n\
         <Placemark><name>track</name><LineString><coordinates>\n{line}\n</coordinates></LineString></Placemark>\n{}</Document>\n</kml>\n",
        last.unwrap_or_default()
    )
}

/// GPX: a track, each position with its time. Contradicted positions are left out.
fn gpx(rows: &[Row]) -> String {
    let point = |row: &Row| {
        format!(
            "<trkpt lat=\"{:.9}\" lon=\"{:.9}\"><ele>{:.4}</ele><time>{}</time><sat>{}</sat></trkpt>\n",
            row.latitude,
            row.longitude,
            row.height,
            instant(row.utc),
            row.satellites
        )
    };
    let points: String = rows.iter().filter(|row| row.trusted.is_some()).map(point).collect();
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<gpx version=\"1.1\" creator=\"kestirim\" \
         xmlns=\"http://www.topografix.com/GPX/1/1\">\n<trk><name>kestirim</name><trkseg>\n{points}</trkseg></trk>\n</gpx>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        Row {
            gps: calendar(59_025, 86_399.999_6),
            utc: calendar(59_025, 17.5),
            latitude: -55.5,
            longitude: 8.456_789_012,
            height: 57.1234,
            deviations: [0.01, 0.02, 0.03],
            satellites: 12,
            trusted: Some(true),
        }
    }

    #[test]
    fn formats_of_other_programs() {
        let rows = [row(), Row { trusted: None, ..row() }];
        let pos = pos(&rows);
        let line = pos.lines().nth(3).expect("a position");
        assert!(line.starts_with("2020/06/26 00:00:00.000  -55.500000000    8.456789012    57.1234   6  12   0.0200   0.0100"));
        let nmea = nmea(&rows);
        // The sum by hand: exclusive or of what stands between $ and *.
        for sentence in nmea.lines() {
            let (body, sum) = sentence[1..].split_once('*').expect("a sum");
            assert_eq!(format!("{:02X}", body.bytes().fold(0, |a, b| a ^ b)), sum);
        }
        assert!(nmea.starts_with(
            "$GNGGA,000017.50,5530.00000000,S,00827.40734072,E,5,12,,57.123,M,0.000,M,,*"
        ));
        assert!(nmea.contains("$GNRMC,000017.50,V,"));
        assert_eq!(kml(&rows).matches("8.456789012,-55.500000000,57.1234").count(), 2);
        let gpx = gpx(&rows);
        assert_eq!(gpx.matches("<trkpt").count(), 1);
        assert!(gpx.contains("<time>2020-06-25T00:00:17.500Z</time>"));
    }
}
