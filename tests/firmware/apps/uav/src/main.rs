//! The application on the board that QEMU emulates.

#![no_std]
#![no_main]

use core::convert::Infallible;

use board::{Bno055, Delay, Ms4525do, NoAcknowledge, Only, Recording, Uart};
use cortex_m_rt::entry;
use uav_app::{App, Error, Sensors};

/// The number type: fixed point if the processor has no floating-point unit.
#[cfg(target_abi = "eabihf")]
type Number = f32;
#[cfg(not(target_abi = "eabihf"))]
type Number = kestirim_scalar::Q16_16;

#[entry]
fn main() -> ! {
    let recording = Recording::open();
    match fly(&recording) {
        Ok(()) => board::exit(),
        Err(error) => {
            defmt::error!("{}", error);
            board::fail()
        }
    }
}

fn fly(recording: &Recording<5>) -> Result<(), Error<NoAcknowledge, Infallible>> {
    let (inertial, airspeed) = (Only(Bno055::new(recording)), Only(Ms4525do::new(recording)));
    let sensors = Sensors::new(inertial, airspeed, Delay).map_err(Error::Sensor)?;
    let mut app = App::<Number, _, _, _, _>::new(sensors, Uart::first())?;
    defmt::info!("observing from {}", app.estimate());
    while recording.wait() {
        // The latest commands of the autopilot to the actuators.
        let [elevator, throttle, ..] = recording.values();
        match app.step(recording.time_us(), [elevator, throttle]) {
            Ok(Some(event)) => defmt::info!("{}", event),
            Ok(None) => {}
            // The observer has advanced without the sensors.
            Err(error) => defmt::warn!("{}", error),
        }
    }
    defmt::info!("landed at {}", app.estimate());
    Ok(())
}
