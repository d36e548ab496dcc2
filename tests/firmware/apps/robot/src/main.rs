//! The robot on QEMU's RISC-V machine: its radio and its IMU are simulated, its serial port is emulated,
//! its log leaves by semihosting.
#![no_std]
#![no_main]

mod stream;
mod uart;

use core::panic::PanicInfo;

use defmt_semihosting as _;
use kestirim_uwb_tracker::Outcome;
use riscv as _;
use robot_app::{Imu, ImuError, Radio, RadioError, Robot, Step, TAG};
use robot_world::{ChipSelect, I2cBus, Spi, World};
use semihosting::process;

use stream::Stream;
use uart::Uart;

/// The reason why the program ends with a failure.
#[derive(defmt::Format)]
enum Failure {
    NoStream,
    Radio(RadioError),
    Imu(ImuError),
    Robot(robot_app::Error),
}

#[riscv_rt::entry]
fn main() -> ! {
    match run() {
        Ok(()) => process::exit(0),
        Err(failure) => {
            defmt::error!("{}", failure);
            process::exit(1)
        }
    }
}

fn run() -> Result<(), Failure> {
    let world = World::new();
    let radio =
        Radio::new(Spi(&world), ChipSelect(&world), &world, &TAG).map_err(Failure::Radio)?;
    let imu = Imu::new(I2cBus(&world), &mut &world).map_err(Failure::Imu)?;
    let mut robot = Robot::new(radio, imu, Uart).map_err(Failure::Robot)?;
    for sample in Stream::open().ok_or(Failure::NoStream)? {
        world.advance(&sample);
        log(&robot.step(sample.time_us).map_err(Failure::Robot)?);
    }
    Ok(())
}

fn log(step: &Step) {
    match step.range {
        Ok(Outcome::Started) => defmt::info!("{}", step),
        Ok(_) => {}
        Err(error) => defmt::warn!("anchor {}: {}", step.anchor, error),
    }
    if let Err(error) = step.acceleration {
        defmt::warn!("{}", error);
    }
}

#[panic_handler]
fn panic(info: &PanicInfo<'_>) -> ! {
    if let Some(place) = info.location() {
        defmt::error!("panicked in {=str}, line {=u32}", place.file(), place.line());
    }
    process::exit(2)
}

/// The handler for processor faults, under the name that `riscv-rt` looks for.
#[allow(unsafe_code)] // Overrides the weak default, which would spin until the host's patience ends.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception() -> ! {
    process::exit(3)
}
