//! Broadcast ephemerides, fitted to precise orbits and clocks, as a RINEX navigation file.

use std::fmt::Write as _;

use kestirim_gnss_files::{
    self as files, Antennas, Clocks, GpsTime as FileTime, Orbits, PhaseCentre, satellite_name,
};
use kestirim_gnss_ppp::constants::{EARTH_GRAVITY, EARTH_ROTATION};
use kestirim_gnss_ppp::{
    Bodies, BodyAxes, Carriers, Constellation, Ephemeris, GpsTime, Orbit, OrbitSample, Pattern,
};
use nalgebra::{DMatrix, DVector, Vector3};

/// The interval between ephemerides, and the time on either side over which one is fitted, s.
const INTERVAL: f64 = 7_200.0;
const REACH: f64 = 4_500.0;
/// The interval between samples of a fitted orbit, s.
const STEP: f64 = 300.0;
/// The number of fitted parameters.
const NUMBERS: usize = 15;
/// The step of each parameter for numerical differentiation: √m, 1, rad, rad/s, and so on.
const CHANGES: [f64; NUMBERS] =
    [1e-3, 1e-7, 1e-7, 1e-11, 1e-7, 1e-7, 1e-11, 1e-7, 1e-11, 1e-7, 1e-7, 1.0, 1.0, 1e-7, 1e-7];

/// The ephemerides of a day (modified Julian date), each with the number of its satellite, for the satellites that orbits,
/// clocks and antennas contain.
pub(super) fn ephemerides(
    day: i32,
    orbits: &Orbits,
    clocks: &Clocks,
    antennas: &Antennas,
) -> Vec<(u8, Ephemeris)> {
    let of_satellite = |number| {
        let precise = Precise { number, orbits, clocks, antennas };
        let fit = move |step| precise.fit(GpsTime::new(day, INTERVAL * f64::from(step)), step);
        (0..=12).filter_map(fit).map(move |ephemeris| (number, ephemeris))
    };
    clocks.satellites().flat_map(of_satellite).collect()
}

/// A navigation file.
pub(super) fn navigation(ephemerides: &[(u8, Ephemeris)]) -> String {
    let mut text = header("     3.05           NAVIGATION DATA     MIXED", "RINEX VERSION / TYPE");
    text += &header("", "END OF HEADER");
    for (number, ephemeris) in ephemerides {
        write(&mut text, *number, ephemeris);
    }
    text
}

/// The precise products of one satellite.
pub(super) struct Precise<'a> {
    pub(super) number: u8,
    pub(super) orbits: &'a Orbits,
    pub(super) clocks: &'a Clocks,
    pub(super) antennas: &'a Antennas,
}

impl Precise<'_> {
    /// The samples of the orbit, which count from `reference`.
    pub(super) fn samples(&self, reference: GpsTime) -> Vec<OrbitSample> {
        let sample = |it: &files::OrbitSample| {
            OrbitSample::from_ecef(reference, model(it.time), &Vector3::from(it.position))
        };
        self.orbits.satellite(self.number).iter().map(sample).collect()
    }

    fn fit(&self, time: GpsTime, issue: u16) -> Option<Ephemeris> {
        let samples = self.samples(time);
        let orbit = Orbit { reference: time, samples: &samples };
        let steps = (REACH / STEP) as i32;
        let positions: Vec<_> = (-steps..=steps)
            .filter_map(|step| {
                let at = time.plus(STEP * f64::from(step));
                let centre = orbit.at(at)?.position;
                Some((at, centre + self.to_phase_centre(&centre, at)?))
            })
            .collect();
        if positions.len() < NUMBERS {
            return None;
        }
        let state = orbit.at(time)?;
        let mut ephemeris = elements(self.constellation(), time, &state.position, &state.velocity);
        ephemeris.clock = self.clock(time)?;
        ephemeris.issue = issue;
        for _ in 0..8 {
            improve(&mut ephemeris, &positions);
        }
        Some(ephemeris)
    }

    const fn constellation(&self) -> Constellation {
        if self.number > 100 { Constellation::Galileo } else { Constellation::Gps }
    }

    /// The vector from the centre of mass to the phase centre of the combination of both carriers.
    pub(super) fn to_phase_centre(
        &self,
        centre: &Vector3<f64>,
        time: GpsTime,
    ) -> Option<Vector3<f64>> {
        let antenna =
            self.antennas.satellite(self.number, FileTime::new(time.day(), time.second()))?;
        let (carriers, on) = match self.constellation() {
            Constellation::Gps => (Carriers::L1L2, files::Carriers::L1L2),
            _ => (Carriers::E1E5a, files::Carriers::E1E5a),
        };
        let axes = BodyAxes::nominal(centre, &Bodies::at(time, -18.0).sun)?;
        let offset = |centre: &PhaseCentre| pattern(centre.offset).satellite_offset(&axes);
        let [first, second] = antenna.on(on)?.map(offset);
        Some(Vector3::from_fn(|axis, _| carriers.ionosphere_free([first[axis], second[axis]])))
    }

    /// The coefficients of a parabola through the clock's samples.
    fn clock(&self, time: GpsTime) -> Option<[f64; 3]> {
        let samples: Vec<_> = (self.clocks.satellite(self.number).iter())
            .map(|it| (model(it.time).since(time) / REACH, it.bias))
            .filter(|(away, _)| away.abs() <= 1.0)
            .collect();
        let first = samples.first().filter(|_| samples.len() > 10)?.1;
        let powers =
            DMatrix::from_fn(samples.len(), 3, |row, power| samples[row].0.powi(power as i32));
        let biases = DVector::from_fn(samples.len(), |row, _| samples[row].1 - first);
        let found = powers.tr_mul(&powers).cholesky()?.solve(&powers.tr_mul(&biases));
        Some([found[0] + first, found[1] / REACH, found[2] / (REACH * REACH)])
    }
}

pub(super) fn model(time: FileTime) -> GpsTime {
    GpsTime::new(time.day(), time.second())
}

const fn pattern(offset: [f64; 3]) -> Pattern<'static> {
    Pattern { offset, first: 0.0, step: 1.0, mean: &[], azimuth_step: 0.0, by_azimuth: &[] }
}

/// The elliptic elements of a position and a velocity in the axes of their time.
fn elements(
    constellation: Constellation,
    time: GpsTime,
    position: &Vector3<f64>,
    velocity: &Vector3<f64>,
) -> Ephemeris {
    let radius = position.norm();
    let momentum = position.cross(velocity);
    let axis = 1.0 / (2.0 / radius - velocity.norm_squared() / EARTH_GRAVITY);
    let to_perigee = velocity.cross(&momentum) / EARTH_GRAVITY - position / radius;
    let eccentricity = to_perigee.norm();
    let node = f64::atan2(momentum.x, -momentum.y);
    let to_node = Vector3::new(node.cos(), node.sin(), 0.0);
    let across = momentum.normalize().cross(&to_node);
    let perigee = f64::atan2(to_perigee.dot(&across), to_perigee.dot(&to_node));
    let argument = f64::atan2(position.dot(&across), position.dot(&to_node));
    let anomaly = 2.0
        * f64::atan(
            ((1.0 - eccentricity) / (1.0 + eccentricity)).sqrt()
                * ((argument - perigee) / 2.0).tan(),
        );
    Ephemeris {
        constellation,
        time,
        clock_time: time,
        clock: [0.0; 3],
        issue: 0,
        group_delay: 0.0,
        root_of_axis: axis.sqrt(),
        eccentricity,
        mean_anomaly: anomaly - eccentricity * anomaly.sin(),
        mean_motion_correction: 0.0,
        perigee,
        node: node + EARTH_ROTATION * time.second_of_week(),
        node_rate: 0.0,
        inclination: f64::atan2(momentum.xy().norm(), momentum.z),
        inclination_rate: 0.0,
        latitude_terms: [0.0; 2],
        radius_terms: [0.0; 2],
        inclination_terms: [0.0; 2],
        accuracy: 2.0,
        holds: INTERVAL,
    }
}

/// The fitted parameters, in the order of [`CHANGES`].
fn numbers(it: &mut Ephemeris) -> [&mut f64; NUMBERS] {
    let ([a, b], [c, d], [e, f]) =
        (&mut it.latitude_terms, &mut it.radius_terms, &mut it.inclination_terms);
    [
        &mut it.root_of_axis,
        &mut it.eccentricity,
        &mut it.mean_anomaly,
        &mut it.mean_motion_correction,
        &mut it.perigee,
        &mut it.node,
        &mut it.node_rate,
        &mut it.inclination,
        &mut it.inclination_rate,
        a,
        b,
        c,
        d,
        e,
        f,
    ]
}

/// One Gauss–Newton step.
fn improve(ephemeris: &mut Ephemeris, positions: &[(GpsTime, Vector3<f64>)]) {
    let rows = 3 * positions.len();
    let at = |it: &Ephemeris| {
        DVector::from_iterator(
            rows,
            positions.iter().flat_map(|(time, _)| <[f64; 3]>::from(it.orbit_at(*time).position)),
        )
    };
    let now = at(ephemeris);
    let wanted =
        DVector::from_iterator(rows, positions.iter().flat_map(|(_, it)| <[f64; 3]>::from(*it)));
    let mut jacobian = DMatrix::zeros(rows, NUMBERS);
    for (place, change) in CHANGES.iter().enumerate() {
        let mut changed = *ephemeris;
        *numbers(&mut changed)[place] += change;
        jacobian.set_column(place, &(at(&changed) - &now));
    }
    let factors = jacobian.qr();
    let mut residuals = wanted - now;
    factors.q_tr_mul(&mut residuals);
    let step = factors.r().solve_upper_triangular(&residuals.rows(0, NUMBERS)).expect("full rank");
    for (place, number) in numbers(ephemeris).into_iter().enumerate() {
        *number += step[place] * CHANGES[place];
    }
}

fn header(content: &str, label: &str) -> String {
    format!("{content:<60}{label}\n")
}

/// The data sources of LNAV, and of F/NAV and I/NAV.
const LNAV: f64 = 1.0;
const FNAV: f64 = 258.0;
const INAV: f64 = 517.0;

/// Writes the records of an ephemeris, for Galileo as both messages.
fn write(text: &mut String, number: u8, it: &Ephemeris) {
    if it.constellation == Constellation::Galileo {
        write_record(text, number, it, FNAV);
        write_record(text, number, it, INAV);
    } else {
        write_record(text, number, it, LNAV);
    }
}

/// Writes a record. The accuracy field is set to the messages' value: 2 m for GPS, 3.12 m for Galileo.
fn write_record(text: &mut String, number: u8, it: &Ephemeris, sources: f64) {
    let galileo = it.constellation == Constellation::Galileo;
    let hour = it.time.since(GpsTime::new(59_025, 0.0)) / 3600.0;
    let (day, hour) = if hour < 24.0 { (25, hour) } else { (26, hour - 24.0) };
    let ([cuc, cus], [crc, crs], [cic, cis]) =
        (it.latitude_terms, it.radius_terms, it.inclination_terms);
    let rows = [
        [f64::from(it.issue), crs, it.mean_motion_correction, it.mean_anomaly],
        [cuc, it.eccentricity, cus, it.root_of_axis],
        [it.time.second_of_week(), cic, it.node, cis],
        [it.inclination, crc, it.perigee, it.node_rate],
        [it.inclination_rate, sources, 2111.0, 0.0],
        [if galileo { 3.12 } else { 2.0 }, 0.0, 0.0, 1.0],
        [it.time.second_of_week(), if galileo { 0.0 } else { 4.0 }, 0.0, 0.0],
    ];
    let fixed = |value: f64| {
        let plain = format!("{value:.12e}");
        let (mantissa, exponent) = plain.split_once('e').expect("an exponent");
        let exponent: i32 = exponent.parse().expect("a number");
        let sign = if exponent < 0 { '-' } else { '+' };
        format!("{:>19}", format!("{mantissa}e{sign}{:02}", exponent.abs()))
    };
    let name = satellite_name(number);
    let clock = it.clock.map(fixed).concat();
    writeln!(text, "{name} 2020 06 {day} {hour:02} 00 00{clock}").expect("memory");
    for row in rows {
        writeln!(text, "    {}", row.map(fixed).concat()).expect("memory");
    }
}
