//! Small files of each format, made by hand.

mod navigation;

use std::iter;
use std::path::Path;

use crate::error::Warning;
use crate::text::Text;

pub(crate) use self::navigation::{navigation_2, navigation_3, navigation_4};

/// Absolute biases of one satellite, differential ones of another, and a bias of a receiver and of a phase.
pub(crate) fn biases() -> String {
    lines(&[
        "%=BIA 1.00 WHU 2021:242:32849 WHU 2021:210:00000 2021:210:86400 A 00001072",
        "+BIAS/SOLUTION",
        "*BIAS SVN_ PRN STATION__ OBS1 OBS2 BIAS_START____ BIAS_END______ UNIT __ESTIMATED_VALUE____",
        " OSB  G063 G01           C1C       2021:210:00000 2021:211:00000 ns                  9.7876 .606000E-01",
        " OSB  G063 G01           C2L       2021:210:00000 2021:210:86400 ns   0.163019000000000E+02 .146400E+00",
        " OSB  G063 G01           L1C       2021:210:00000 2021:210:86400 cyc  0.163019000000000E+02 .146400E+00",
        " DSB  G061 G02           C1C  C1W  2021:210:00000 0000:000:00000 ns                 -1.5000      0.0047",
        " DSB  G061 G02           C2W  C2L  2021:210:00000 0000:000:00000 ns                 -0.5000      0.0047",
        " DSB  G    G   HERE      C1C  C1W  2021:210:00000 0000:000:00000 ns                 -1.5000      0.0047",
        "-BIAS/SOLUTION",
        "%=ENDBIA",
    ])
}

/// A header line.
pub(crate) fn header(content: &str, label: &str) -> String {
    format!("{content:<60}{label}\n")
}

pub(crate) fn text(content: impl AsRef<[u8]>) -> Text {
    Text::unpack(Path::new("file"), content.as_ref().to_vec()).expect("nothing is packed")
}

pub(crate) fn sentences(warnings: &[Warning]) -> Vec<String> {
    warnings.iter().map(Warning::to_string).collect()
}

pub(crate) fn lines(lines: &[&str]) -> String {
    lines.iter().flat_map(|line| [*line, "\n"]).collect()
}

/// Three epochs of RINEX 3: a satellite that appears, a blank phase, a loss of lock, another system, an event.
pub(crate) fn observations_3() -> String {
    observations_3_header() + &observations_3_body()
}

pub(crate) fn observations_3_header() -> String {
    [
        header("     3.04           OBSERVATION DATA    M", "RINEX VERSION / TYPE"),
        header("HERE00XXX", "MARKER NAME"),
        header("1                   RECEIVER             2.0", "REC # / TYPE / VERS"),
        header("1                   ANT  TYPE       DOME", "ANT # / TYPE"),
        header("  4000000.1000   200000.0000  4900000.0000", "APPROX POSITION XYZ"),
        header("        1.5000        0.2000       -0.1000", "ANTENNA: DELTA H/E/N"),
        header("G    5 C1C L1C C2W L2W", "SYS / # / OBS TYPES"),
        header("       C1W", "SYS / # / OBS TYPES"),
        header("J    1 C1C", "SYS / # / OBS TYPES"),
        header("  2020     1     1     0     0    0.0000000     GPS", "TIME OF FIRST OBS"),
        header("", "END OF HEADER"),
    ]
    .concat()
}

fn observations_3_body() -> String {
    lines(&[
        "> 2020 01 01 00 00  0.0000000  0  2",
        "G05  20000000.125   105100000.25017  20000001.500    81900000.500    20000000.625",
        "J07  19000000.000",
        "> 2020 01 01 00 00 15.0000000  4  1",
        "a word in between                                           COMMENT",
        "> 2020 01 01 00 00 30.0000000  1  3",
        "G12  22000000.000   115600000.000    22000001.000    90100000.000    22000000.500",
        "J07  19000100.000",
        "G05  20000100.125                    20000101.500    81900400.50011  20000100.625",
        "> 2020 01 01 00 01  0.0000000  0  1",
        "G05  20000200.125   105101000.250    20000201.500    81900800.500    20000200.625",
    ])
}

/// The epochs of [`observations_3`] in Compact RINEX (Hatanaka).
pub(crate) fn compressed_3() -> String {
    let front = [
        header("3.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE"),
        header("BY HAND                                 01-Jan-20 00:00", "CRINEX PROG / DATE"),
    ];
    let body = lines(&[
        "> 2020 01 01 00 00  0.0000000  0  2      G05J07",
        "",
        "3&20000000125 3&105100000250 3&20000001500 3&81900000500 3&20000000625   17",
        "3&19000000000 ",
        "> 2020 01 01 00 00 15.0000000  4  1",
        "a word in between                                           COMMENT",
        "> 2020 01 01 00 00 30.0000000  1  3      G12J07G05",
        "",
        "3&22000000000 3&115600000000 3&22000001000 3&90100000000 3&22000000500 ",
        "3&19000100000 ",
        "3&20000100125  3&20000101500 3&81900400500 3&20000100625       11",
        "                 1 &           0  1      G05&&&&&&",
        "",
        "100000 3&105101000250 100000 400000 100000       &&",
    ]);
    front.concat() + &observations_3_header() + &body
}

/// RINEX 2 with thirteen satellites, six observables and two epochs.
pub(crate) fn observations_2() -> String {
    let front = [
        header("     2.11           OBSERVATION DATA    M (MIXED)", "RINEX VERSION / TYPE"),
        header("HERE", "MARKER NAME"),
        header("        0.0000        0.0000        0.0000", "ANTENNA: DELTA H/E/N"),
        header("     6    L1    L2    C1    P2    P1    S1", "# / TYPES OF OBSERV"),
        header("  1999    12    31    23    59   30.0000000", "TIME OF FIRST OBS"),
        header("", "END OF HEADER"),
    ];
    let mut body = lines(&[
        " 99 12 31 23 59 30.0000000  0 13  1G 2 03 04 05 06 07 08 09 10 11R12",
        "                                 13",
    ]);
    for satellite in 0..13 {
        let code = if satellite == 2 { "" } else { "20000000.000" };
        body += &lines(&[
            &format!(
                "10000000{satellite:02}.250 1  80000000.500  {code:>14}    20000001.000    20000000.500"
            ),
            "        45.000",
        ]);
    }
    body += &lines(&[
        " 00  1  1  0  0  0.0000000  0  1G 5",
        " 100000100.000    80000100.000    20000100.000    20000101.000",
        "        45.000",
    ]);
    front.concat() + &body
}

pub(crate) fn compressed_2() -> String {
    let front = [
        header("1.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE"),
        header("BY HAND                                 01-Jan-20 00:00", "CRINEX PROG / DATE"),
        header("     2.11           OBSERVATION DATA    G", "RINEX VERSION / TYPE"),
        header("     6    L1    L2    C1    P2    P1    S1", "# / TYPES OF OBSERV"),
        header("", "END OF HEADER"),
    ];
    let body = lines(&[
        "&99 12 31 23 59 30.0000000  0  1G05",
        "3&-123456",
        "1&100000000250 2&-500 3&20000000000 3&20000001000  3&45000  1 2",
        "                &              2   G12",
        "42",
        "1000 0 1500 -2000",
        "3&1 3&22 3&333 3&4444 3&55555 3&-666666",
        "                3              1   &&&",
        "0",
        "2000 600 100 0",
    ]);
    front.concat() + &body
}

pub(crate) fn orbits() -> String {
    lines(&[
        "#cP2020  1  1  0  0  0.00000000       2 ORBIT IGS14 FIT  ME",
        "## 2086 259200.00000000   900.00000000 58849 0.0000000000000",
        "+    2   G05R07  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0",
        "++         2  2  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0",
        "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc",
        "%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc",
        "%f  1.2500000  1.025000000  0.00000000000  0.000000000000000",
        "%i    0    0    0    0      0      0      0      0         0",
        "/* BY HAND",
        "*  2020  1  1  0  0  0.00000000",
        "PG05  10000.000001 -20000.000000  15000.500000    100.000000 10  9  8 120",
        "VG05  10000.000001 -20000.000000  15000.500000    100.000000",
        "PG09      0.000000      0.000000      0.000000    100.000000",
        "PJ07  10000.000000 -20000.000000  15000.500000 999999.999999",
        "*  2020  1  1  0 15  0.00000000",
        "PG05  10001.000000 -20001.000000  15001.500000 999999.999999              EP  MP",
        "EOF",
    ])
}

pub(crate) fn clocks() -> String {
    let front = [
        header("     3.00           C                   G", "RINEX VERSION / TYPE"),
        header("   GPS", "TIME SYSTEM ID"),
        header("", "END OF HEADER"),
    ];
    let body = lines(&[
        "AR HERE 2020  1  1  0  0  0.000000  2    0.159438015248E-04  0.640687583086E-11",
        "AS G05  2020  1  1  0  0  0.000000  4    0.100000000000E-04  0.640687583086E-11",
        "    0.640687583086E-11  0.640687583086E-11",
        "AS J07  2020  1  1  0  0  0.000000  1    0.159438015248E-04",
        "AS G05  2020  1  1  0  0 30.000000  1   -0.200000000000D-04",
    ]);
    front.concat() + &body
}

pub(crate) fn antennas() -> String {
    let row = |name: &str, values: [f64; 3]| {
        let [a, b, c] = values;
        format!("{name:>8}{a:8.2}{b:8.2}{c:8.2}\n")
    };
    let frequency = |name: &str, rows: String| {
        header(&format!("   {name}"), "START OF FREQUENCY")
            + &header("      1.50     -2.50    100.00", "NORTH / EAST / UP")
            + &rows
            + &header(&format!("   {name}"), "END OF FREQUENCY")
    };
    let satellite = |from: &str, until: &str| {
        [
            header("", "START OF ANTENNA"),
            header(
                "BLOCK IIF           G05                 G050      2009-043A",
                "TYPE / SERIAL NO",
            ),
            header("     0.0", "DAZI"),
            header("     0.0   2.0   1.0", "ZEN1 / ZEN2 / DZEN"),
            header("     1", "# OF FREQUENCIES"),
            header(from, "VALID FROM"),
            if until.is_empty() { String::new() } else { header(until, "VALID UNTIL") },
            frequency("G01", row("NOAZI", [1.0, 2.0, 3.0])),
            header("", "END OF ANTENNA"),
        ]
        .concat()
    };
    let receiver = |radome: &str| {
        let rows = row("NOAZI", [1.0, 2.0, -3.25])
            + &row("0.0", [1.0, 2.0, 3.0])
            + &row("180.0", [4.0, 5.0, 6.0])
            + &row("360.0", [1.0, 2.0, 3.0]);
        let rms = header("   G01", "START OF FREQ RMS")
            + &row("NOAZI", [0.1, 0.1, 0.1])
            + &header("   G01", "END OF FREQ RMS");
        [
            header("", "START OF ANTENNA"),
            header(&format!("{:<16}{radome}", "ANT  TYPE"), "TYPE / SERIAL NO"),
            header("   180.0", "DAZI"),
            header("     0.0  10.0   5.0", "ZEN1 / ZEN2 / DZEN"),
            frequency("G01", rows.clone()),
            rms,
            frequency("R01", rows.clone()),
            frequency("G02", rows),
            header("", "END OF ANTENNA"),
        ]
        .concat()
    };
    [
        header("     1.4            M", "ANTEX VERSION / SYST"),
        header("A", "PCV TYPE / REFANT"),
        header("", "END OF HEADER"),
        satellite(
            "  2009     8    17     0     0    0.0000000",
            "  2013     6    30    23    59   59.9999999",
        ),
        satellite("  2013     7     1     0     0    0.0000000", ""),
        receiver("NONE"),
        receiver("DOME"),
    ]
    .concat()
}

pub(crate) fn earth_rotation() -> String {
    lines(&[
        "VERSION 2",
        "A SOLUTION",
        "NUTATION MODEL       : IAU2000R06               SUBDAILY POLE MODEL: DESAI2016",
        "  MJD         X-P      Y-P   UT1UTC    LOD   S-X   S-Y  S-UT  S-LD  NR  NF  NT",
        "              E-6\"     E-6\"    E-7S E-7S/D   E-6\"  E-6\" E-7S E-7S/D",
        "61161.00   155985   417263   329162   4722     6     6     4     2 140 100 115",
        "61161.50   156395   417298   326801   3705     5     5     4     5 140 100 115",
    ])
}

pub(crate) fn loading() -> String {
    let mut file = lines(&["$$ Ocean loading displacement", "$$", "  HERE"]);
    file += "$$ Here,                  RADI TANG  lon/lat:  358.0000   50.0000   10.000\n";
    for row in 0..6 {
        file.extend(
            (0..11).map(|wave| format!(" {row}.{wave:02}")).chain(iter::once("\n".to_owned())),
        );
    }
    file.clone() + &file.replace("HERE", "THERE").replace("358.0000", "  1.0000")
}
