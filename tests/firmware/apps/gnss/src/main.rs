//! The application on the board that QEMU emulates.

#![no_std]
#![no_main]

use board::{CmsdkUart, Tape};
use cortex_m_rt::entry;
use gnss_app::{App, Epoch, Error, Products};
use kestirim_ppp_filter::{Health, SatelliteReport, Slipped};
// The interrupt table, as for all programs of this board; this one handles none.
use mps2_an386 as _;

/// The number of ports: receiver and modem.
const PORTS: usize = 2;

#[entry]
fn main() -> ! {
    match receive(&Tape::open()) {
        Ok(()) => board::exit(),
        Err(error) => {
            defmt::error!("{}", error);
            board::fail()
        }
    }
}

fn receive(tape: &Tape<PORTS>) -> Result<(), Error> {
    let [receiver, modem] = tape.ports();
    let mut app = App::new(receiver, Products::new(modem), CmsdkUart::first());
    while tape.wait() {
        while let Some(epoch) = app.poll(tape.time_us())? {
            log(&epoch);
        }
    }
    Ok(())
}

fn log(epoch: &Epoch) {
    for unused in &epoch.unused {
        defmt::warn!("G{=u8} {}", unused.satellite, unused.reason);
    }
    match &epoch.solution {
        Ok(solution) => {
            if matches!(solution.health, Health::Contradicted(_) | Health::Unchecked) {
                defmt::warn!("{}", solution.health);
            }
            solution.satellites.iter().for_each(log_satellite);
        }
        Err(error) => defmt::warn!("{}", error),
    }
}

fn log_satellite(report: &SatelliteReport) {
    for (what, decision) in [("code", &report.code), ("phase", &report.phase)] {
        if decision.was_treated() {
            defmt::warn!("G{=u8} {=str} {}", report.satellite, what, decision.reason);
        }
    }
    if let Some(slipped @ (Slipped::Seen(_) | Slipped::Contradicted)) = report.slipped {
        defmt::info!("G{=u8} slipped: {}", report.satellite, slipped);
    }
}
