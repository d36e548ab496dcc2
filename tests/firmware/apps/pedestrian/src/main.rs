//! The application on the board that QEMU emulates.

#![no_std]
#![no_main]

use core::convert::Infallible;

use board::{CardSelect, Delay, Mpu9250, NoAcknowledge, Only, Recording, Spi, Uart};
use cortex_m_rt::entry;
use embedded_hal_bus::spi::ExclusiveDevice;
use embedded_sdmmc::{Mode, SdCard, TimeSource, Timestamp, VolumeIdx, VolumeManager};
use pedestrian_app::{App, Error, SensorError};

/// The number type: fixed point if the processor has no floating-point unit.
#[cfg(target_abi = "eabihf")]
type Number = f32;
#[cfg(not(target_abi = "eabihf"))]
type Number = kestirim_scalar::Q12_20;

type FileError = embedded_sdmmc::Error<embedded_sdmmc::sdcard::spi::Error>;
type Failure = Error<SensorError<NoAcknowledge>, FileError, Infallible>;

#[entry]
fn main() -> ! {
    let recording = Recording::open();
    match walk(&recording) {
        Ok(()) => board::exit(),
        Err(error) => {
            defmt::error!("{}", error);
            board::fail()
        }
    }
}

fn walk(recording: &Recording<6>) -> Result<(), Failure> {
    let Ok(spi) = ExclusiveDevice::new(Spi::new(), CardSelect::new(), Delay);
    let volumes: VolumeManager<_, _, 1, 1> =
        VolumeManager::new_with_limits(SdCard::new(spi, Delay), NoCalendar, 0);
    let volume = volumes.open_volume(VolumeIdx(0)).map_err(Error::Log)?;
    let root = volume.open_root_dir().map_err(Error::Log)?;
    let file =
        root.open_file_in_dir("WALK.TXT", Mode::ReadWriteCreateOrTruncate).map_err(Error::Log)?;

    let i2c = Only(Mpu9250::new(recording));
    let mut app = App::<Number, _, _, _>::new(i2c, &mut Delay, file, Uart::first())?;
    while recording.wait() {
        match app.poll(recording.time_us()) {
            Ok(Some(event)) => defmt::info!("{}", event),
            Ok(None) => {}
            // A reading is missing, which the tracker tolerates.
            Err(error) => defmt::warn!("{}", error),
        }
    }
    defmt::info!("{}", app.finish()?);
    Ok(())
}

/// A time source without a date: the board has no calendar clock.
struct NoCalendar;

impl TimeSource for NoCalendar {
    fn get_timestamp(&self) -> Timestamp {
        Timestamp::from_fat(0, 0)
    }
}
