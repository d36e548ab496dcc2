//! The application on the board that QEMU emulates.

#![no_std]
#![no_main]

use board::{Tape, Uart};
use cortex_m_rt::entry;
use drone_app::{App, Error, Event};
use kestirim_particle_filter::Xoshiro128PlusPlus;
use rand_core::SeedableRng;

/// The number of ports: satellite receiver and radio.
const PORTS: usize = 2;

#[entry]
fn main() -> ! {
    match search(&Tape::open()) {
        Ok(()) => board::exit(),
        Err(error) => {
            defmt::error!("{}", error);
            board::fail()
        }
    }
}

fn search(tape: &Tape<PORTS>) -> Result<(), Error> {
    // The board has no source of randomness.
    let mut entropy = Xoshiro128PlusPlus::seed_from_u64(7);
    let [gps, radio] = tape.ports();
    let mut app = App::new(gps, radio, Uart::first(), &mut entropy)?;
    while tape.wait() {
        while let Some(event) = app.poll(tape.time_us())? {
            match event {
                Event::Located(estimate) => defmt::debug!("{}", estimate),
                Event::NoFix | Event::Refused(_) => defmt::warn!("{}", event),
            }
        }
    }
    Ok(())
}
