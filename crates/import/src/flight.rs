//! Flights of fixed-wing aircraft as autopilots log them: angle of attack, pitch rate, airspeed and pitch angle, with
//! the commands to elevator and throttle. A table of text is a [`crate::NamedTable`].
//!
//! | | `ArduPilot` `.bin`, `.log` (`AP_Logger/LogStructure.h`, `ArduPlane/Log.cpp`) | PX4 `.ulg` (its uORB messages) |
//! |---|---|---|
//! | `alpha` | `AOA.AOA`, °: what the autopilot computes from airspeed and wind | none |
//! | `q` | `IMU.GyrY`, rad/s | `vehicle_angular_velocity.xyz[1]`, else `sensor_combined.gyro_rad[1]`, rad/s |
//! | `V` | `ARSP.Airspeed`, m/s: calibrated, not true airspeed | `airspeed_validated.true_airspeed_m_s`, else `airspeed.true_airspeed_m_s` |
//! | `theta` | `ATT.Pitch`, ° | the pitch of the quaternion `vehicle_attitude.q` |
//! | `delta_e` | `AETR.Elev`, −4500 to 4500 | `vehicle_torque_setpoint.xyz[1]`, else `actuator_controls_0.control[1]`, −1 to 1 |
//! | `delta_t` | `AETR.Thr`, % | `vehicle_thrust_setpoint.xyz[0]`, else `actuator_controls_0.control[3]`, 0 to 1 |
//!
//! Both count rates and angles nose up, as the model does, and an elevator's command positive nose up, where an
//! elevator's deflection is negative. No log gives the deflection for a full command: `--units delta_e=-0.0056deg`
//! states it, for 25° of 4500. `--columns alpha=NAME.FIELD` takes another field; its unit must be given, too.
//!
//! Each sample of the pitch rate is a row (of the pitch angle if there is none, then of the airspeed). A measurement of
//! another kind stands in the row nearest in time and in no other; commands hold until the next one, for a second at
//! most.

mod order;
mod rows;
mod sources;

pub(crate) use sources::{Channel, Family, NAMES, Source};

use crate::containers::{self, Signals};
use crate::damage::{Damage, Fault};
use crate::error::{Error, listed};
use crate::options::Options;

/// The measurements and commands at one time of a flight.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Time on the log's clock, µs.
    pub time_us: i64,
    /// α, q, V, θ in rad, rad/s, m/s, rad, each if it was measured at that time.
    pub state: [Option<f64>; 4],
    /// The elevator deflection, rad, and the throttle, 0 to 1.
    pub input: [f64; 2],
}

/// A flight as read from an autopilot's log.
#[derive(Debug, Clone, PartialEq)]
pub struct Flight {
    /// The rows in order of strictly increasing time.
    pub rows: Vec<Row>,
    /// Which of α, q, V, θ the log holds at all.
    pub has: [bool; 4],
    /// What was recognised, one sentence each.
    pub conclusions: Vec<String>,
    /// What was skipped.
    pub damage: Damage,
}

/// Reads a flight; `None` if the file is not an autopilot's log.
///
/// # Errors
/// What was expected and what was found, and which option decides where the log does not tell.
pub fn read(bytes: &[u8], options: &Options) -> Result<Option<Flight>, Error> {
    let Some((family, is_text)) = containers::autopilot(bytes) else { return Ok(None) };
    options.refuse_beside(&NAMES)?;
    let sources = sources::wanted(family, options)?;
    let signals = containers::signals(bytes, family, is_text, sources, options)?;
    flight(family, signals, options).map(Some)
}

fn flight(family: Family, signals: Signals, options: &Options) -> Result<Flight, Error> {
    let Signals { channels, names, notes, losses, part } = signals;
    let mut chosen: [Option<Channel>; 6] = Default::default();
    for channel in channels {
        let slot = &mut chosen[channel.source.quantity];
        if slot.is_none() && !channel.times.is_empty() {
            *slot = Some(channel);
        }
    }
    let found = || listed(names.iter().map(String::as_str));
    for (quantity, channel) in chosen.iter().enumerate() {
        let (is_needed, said) = (quantity >= 4, options.columns.of(NAMES[quantity]));
        if let (None, Some(pick)) = (channel, said) {
            let wanted = listed([pick.name.as_str()]);
            let problem = format!("expected {wanted} as --columns says, found {}", found());
            return Err(Error::options(problem));
        }
        if channel.is_none() && is_needed {
            let (name, usual) = (NAMES[quantity], family.usual(quantity));
            let problem = format!("expected {name} as {usual} of {family}, found {}", found());
            return Err(Error::undecided(problem, format!("--columns {name}=NAME.FIELD")));
        }
    }
    if chosen[..4].iter().all(Option::is_none) {
        let usual: Vec<_> = (0..4).map(|quantity| family.usual(quantity)).collect();
        let usual = listed(usual.into_iter().filter(|usual| !usual.is_empty()));
        return Err(Error::log(format!("expected one of {usual} of {family}, found {}", found())));
    }
    let mut disorder = Damage::of(part);
    let mut told = Vec::new();
    for channel in chosen.iter_mut().flatten() {
        told.push(channel.in_si(options)?);
        for record in channel.put_in_order() {
            disorder
                .add(Fault::OutOfOrder, record, || "expected a later time than before".to_owned());
        }
    }
    let mut conclusions = vec![format!("{}: {family}", told.join(", "))];
    let missing: Vec<_> = (0..4).filter(|&i| chosen[i].is_none()).map(|i| NAMES[i]).collect();
    if !missing.is_empty() {
        conclusions.push(format!("not in the log: {}", missing.join(", ")));
    }
    conclusions.extend(chosen.iter().flatten().filter_map(|it| it.source.note.map(str::to_owned)));
    conclusions.extend(notes);
    let has = std::array::from_fn(|i| chosen[i].is_some());
    let (rows, without) = rows::of(&chosen);
    if without > 0 {
        conclusions.push(format!(
            "{without} samples have no command of elevator and throttle in the second before them: left out"
        ));
    }
    if rows.is_empty() {
        return Err(Error::log("expected measurements with commands before them, found none"));
    }
    // A lost stretch counts as the rows that it would have held.
    let damage = Damage::joined([losses.damage(part, rows.len()), disorder]);
    damage.accept(rows.len() + damage.count(), options.strict)?;
    Ok(Flight { rows, has, conclusions, damage })
}
