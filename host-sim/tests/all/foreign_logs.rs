//! Tests with the same ranges, levels and flights as written by other programs: the same answer, or a refusal that
//! names the remedy.

use std::fmt::Write;
use std::fs;

use serde_json::Value;

use crate::program::{Desk, host_sim, json, refusal};
use crate::room::Room;

/// The time (s), anchor and range (m) on each line of a log.
fn rows(log: &str) -> Vec<(f64, usize, f64)> {
    let text = fs::read_to_string(log).expect("a log");
    let row = |line: &str| {
        let fields: Vec<_> = line.split(',').collect();
        let anchor = fields[1].trim_start_matches('A').parse().expect("a number");
        (fields[0].parse().expect("a time"), anchor, fields[2].parse().expect("a range"))
    };
    text.lines().skip(1).map(row).collect()
}

/// The ranges of each epoch.
fn epochs(log: &str) -> Vec<(f64, [f64; 4])> {
    let mut epochs: Vec<(f64, [f64; 4])> = Vec::new();
    for (t, anchor, range) in rows(log) {
        if epochs.last().is_none_or(|(last, _)| *last != t) {
            epochs.push((t, [0.0; 4]));
        }
        epochs.last_mut().expect("an epoch").1[anchor] = range;
    }
    epochs
}

fn lines<T>(rows: impl IntoIterator<Item = T>, line: impl Fn(T) -> String) -> String {
    rows.into_iter().map(|row| line(row) + "\n").collect()
}

/// A comma-separated table as another program writes it.
fn rewritten(text: &str, separator: &str, decimal: &str) -> String {
    text.replace(',', separator).replace('.', decimal)
}

fn replay(room: &Room, log: &str, more: &[&str]) -> Value {
    let files = ["replay", "robot", "--anchors", &room.anchors, "--log", log, "--json"];
    let truth = ["--truth", &room.truth, "--height", "1"];
    json(&host_sim(&[&files[..], &truth, more].concat()))
}

#[test]
fn ranges_of_any_program_give_the_same_path() {
    let room = Room::clean();
    let plain = replay(&room, &room.log, &[]);
    let (table, epochs) = (fs::read_to_string(&room.log).expect("a log"), epochs(&room.log));
    let mm = |metres: f64| (metres * 1e3).round();
    let logs = [
        ("semicolons.csv", rewritten(&table, ";", ","), 0.1),
        ("tabs.txt", rewritten(&table, "\t", "."), 0.1),
        ("blanks.txt", format!("# of a tag\n{}", rewritten(&table, " ", ".")), 0.1),
        ("header.csv", table.replace("t,anchor,range", "Time (s),Anchor ID,Distance [m]"), 0.1),
        (
            "units.csv",
            "t,anchor,range\ns,-,mm\n".to_owned()
                + &lines(rows(&room.log), |(t, anchor, range)| {
                    format!("{t},A{anchor},{}", mm(range))
                }),
            1.0,
        ),
        (
            "ms.csv",
            "anchor,t,range_mm\n".to_owned()
                + &lines(rows(&room.log), |(t, anchor, range)| {
                    format!("A{anchor},{},{}", mm(t), mm(range))
                }),
            1.0,
        ),
        (
            "wide.csv",
            "t,d0,d1,d2,d3\n".to_owned()
                + &lines(&epochs, |(t, [a, b, c, d])| format!("{t},{a},{b},{c},{d}")),
            0.1,
        ),
        (
            "crazyflie.csv",
            "Timestamp,ranging.distance0,ranging.distance1,ranging.distance2,ranging.distance3\n"
                .to_owned()
                + &lines(&epochs, |(t, [a, b, c, d])| format!("{},{a},{b},{c},{d}", mm(*t))),
            0.1,
        ),
        (
            "trek.log",
            lines(&epochs, |(t, ranges)| {
                let [a, b, c, d] = ranges.map(|range| mm(range) as u32);
                format!("mc 0f {a:08x} {b:08x} {c:08x} {d:08x} 095f c1 {:08x} a0:0", mm(*t) as u32)
            }),
            1.0,
        ),
        (
            "lec.log",
            lines(&epochs, |(t, ranges)| {
                let mut line = format!("[{t:.3}] DIST,4");
                for (i, range) in ranges.iter().enumerate() {
                    let _ = write!(line, ",AN{i},A{i},1.00,2.00,3.00,{range:.3}");
                }
                line + ",POS,1.00,2.00,3.00,90"
            }),
            1.0,
        ),
        (
            "makerfabs.log",
            lines(&epochs, |(t, ranges)| {
                let [a, b, c, d] = ranges.map(|range| range * 100.0);
                format!(
                    "{t:.3} -> AT+RANGE=tid:0,mask:0F,seq:1,range:({a:.2},{b:.2},{c:.2},{d:.2},0,0,0,0)"
                )
            }),
            0.1,
        ),
    ];
    let length = |report: &Value| report["accuracy"]["rmse_m"].as_f64().expect("a number");
    for (name, text, tolerance_mm) in logs {
        let found = replay(&room, &room.desk.file(name, text), &[]);
        assert_eq!(found["updates"], plain["updates"], "{name}");
        assert_eq!(found["warnings"], plain["warnings"], "{name}");
        assert!(found["import"][0].is_string(), "{name}: {found}");
        let off_mm = 1e3 * (length(&found) - length(&plain)).abs();
        assert!(off_mm <= tolerance_mm, "{name}: {off_mm} mm");
    }
}

#[test]
fn a_clock_that_begins_anew_goes_on() {
    let room = Room::clean();
    let links = |log: &str| {
        let files = ["replay", "robot", "--anchors", &room.anchors, "--log", log, "--json"];
        json(&host_sim(&[&files[..], &["--height", "1"]].concat()))["links"].clone()
    };
    let microseconds = |name: &str, offset: u32| {
        let line = |(t, anchor, range): (f64, usize, f64)| {
            let time = ((t * 1e6).round() as u32).wrapping_add(offset);
            format!("{time},A{anchor},{range}")
        };
        let rows = lines(rows(&room.log), line);
        room.desk.file(name, "time_us,anchor,range\n".to_owned() + &rows)
    };
    // The second one after three seconds.
    let whole = links(&microseconds("whole.csv", 0));
    assert_eq!(whole, links(&microseconds("anew.csv", 0_u32.wrapping_sub(3_000_000))));
}

#[test]
fn what_a_log_of_ranges_does_not_tell_an_option_says() {
    let room = Room::clean();
    let counted = lines(epochs(&room.log), |(_, ranges)| {
        let range = |(i, range): (usize, &f64)| format!("A{i}[1.00,2.00,3.00]={range:.3} ");
        ranges.iter().enumerate().map(range).collect::<String>() + "le_us=2576 est[1,2,3,90]"
    });
    let counted = room.desk.file("les.log", counted);
    let replay_of =
        |log| ["replay", "robot", "--anchors", &room.anchors, "--height", "1", "--log", log];
    assert!(refusal(&replay_of(&counted)).contains("--units t=10Hz"));
    let found = replay(&room, &counted, &["--units", "t=10Hz"]);
    assert!(found["accuracy"]["rmse_m"].as_f64().expect("a number") < 0.1);
    let table = fs::read_to_string(&room.log).expect("a log");
    let two = room.desk.file(
        "two.csv",
        table.replace("t,anchor,range", "t,anchor,r,dist").replace("\n0", ",0\n0"),
    );
    let sentence = refusal(&replay_of(&two));
    assert!(sentence.contains("--columns range="), "{sentence}");
    let feet = room.desk.file(
        "feet.csv",
        "t,anchor,range\n".to_owned()
            + &lines(rows(&room.log), |(t, anchor, range)| {
                format!("{t},A{anchor},{:.5}", range / 0.3048)
            }),
    );
    let found = replay(&room, &feet, &["--units", "range=ft"]);
    assert!(found["accuracy"]["rmse_m"].as_f64().expect("a number") < 0.1);
    assert!(
        refusal(&[&replay_of(&feet)[..], &["--format", "razor"]].concat()).contains("--format")
    );
}

#[test]
fn a_damaged_log_of_ranges_is_read_on() {
    let room = Room::clean();
    let table = fs::read_to_string(&room.log).expect("a log");
    let mut damaged: Vec<_> = table.lines().collect();
    damaged[100] = "9.9,A1,x";
    damaged[300] = "\u{fffd}\u{fffd}\0,";
    let log = room.desk.file("damaged.csv", damaged.join("\n"));
    let found = replay(&room, &log, &[]);
    let told = found["warnings"].to_string();
    assert!(told.contains("2 lines") && told.contains("lines 101, 301"), "{told}");
    assert!(found["accuracy"]["rmse_m"].as_f64().expect("a number") < 0.1);
    let files = ["replay", "robot", "--anchors", &room.anchors, "--height", "1", "--log", &log];
    let sentence = refusal(&[&files[..], &["--strict"]].concat());
    assert!(sentence.contains("damaged.csv, line 101"), "{sentence}");
    let many = table.lines().enumerate().map(|(i, line)| if i % 20 == 19 { "x" } else { line });
    let log = room.desk.file("many.csv", many.collect::<Vec<_>>().join("\n"));
    let sentence = refusal(&["replay", "robot", "--anchors", &room.anchors, "--log", &log]);
    assert!(sentence.contains("expected at most"), "{sentence}");
}

#[test]
fn levels_of_any_program_give_the_same_place() {
    let desk = Desk::new();
    let row = |k: u32| {
        let (angle, radius) = (f64::from(k) * 0.7, 50.0 + 7.0 * f64::from(k));
        let (x, y) = (radius * angle.cos(), radius * angle.sin());
        let level = -20.0 - 20.0 * (x - 120.0).hypot(y + 40.0).hypot(40.0).log10();
        [f64::from(10 * k), x, y, 40.0, level]
    };
    let rows: Vec<_> = (0..30).map(row).collect();
    let table = |header: &str, scale: [f64; 5], separator: &str| {
        let line = |row: &[f64; 5]| {
            let fields: Vec<_> =
                row.iter().zip(scale).map(|(x, s)| format!("{:.4}", x * s)).collect();
            fields.join(separator)
        };
        format!("{header}\n{}", lines(&rows, line))
    };
    let place = |log: &str| {
        let estimate =
            json(&host_sim(&["replay", "drone", "--json", "--log", log]))["estimate"].clone();
        ["x", "y"].map(|axis| estimate[axis].as_f64().expect("a number"))
    };
    let plain = place(&desk.file("plain.csv", table("t,x,y,h,rssi_db", [1.0; 5], ",")));
    for (name, header, scale, separator) in [
        ("tabs.txt", "Time [s]\tX [m]\tY [m]\tAltitude (m)\tRSSI (dBm)", [1.0; 5], "\t"),
        ("ms.csv", "timestamp_ms;pos_x;pos_y;height;rssi", [1e3, 1.0, 1.0, 1.0, 1.0], ";"),
        ("cm.csv", "t,x_cm,y_cm,h_cm,level_db", [1.0, 100.0, 100.0, 100.0, 1.0], ","),
    ] {
        let found = place(&desk.file(name, table(header, scale, separator)));
        let off = (found[0] - plain[0]).hypot(found[1] - plain[1]);
        assert!(off < 0.05, "{name}: {off} m");
    }
    // Positions by latitude and longitude, relative to the first measurement.
    let degrees = [1.0, 1.0 / 69_460.0, 1.0 / 111_267.0, 1.0, 1.0];
    let log = desk.file("degrees.csv", {
        let line = |row: &[f64; 5]| {
            let [t, x, y, h, level] = std::array::from_fn(|i| row[i] * degrees[i]);
            format!("{t},{:.9},{:.9},{h},{level:.4}", 51.5 + y, 7.25 + x)
        };
        format!("time,latitude,longitude,alt,rssi\n{}", lines(&rows, line))
    });
    let found = place(&log);
    let off = (found[0] + rows[0][1] - plain[0]).hypot(found[1] + rows[0][2] - plain[1]);
    assert!(off < 1.5, "{off} m");
    let truth = desk.file("truth.csv", "x,y\n1,2\n");
    let sentence = refusal(&["replay", "drone", "--log", &log, "--truth", &truth]);
    assert!(sentence.contains("expected lat,lon as in the log"), "{sentence}");
}
