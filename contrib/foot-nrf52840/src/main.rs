//! The foot's tracker on an nRF52840-DK, with SDA at P0.26, SCL at P0.27 and the sensor's interrupt at P1.01. The
//! processor sleeps until a sample is ready, and while DMA reads it.
#![no_std]
#![no_main]

use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_nrf::gpio::{Input, Pull};
use embassy_nrf::twim::{self, Twim};
use embassy_nrf::{bind_interrupts, peripherals};
use embassy_time::{Duration, Instant, Timer, with_timeout};
use foot::{Error, Foot};
use panic_probe as _;

bind_interrupts!(struct Interrupts {
    TWISPI0 => twim::InterruptHandler<peripherals::TWISPI0>;
});

/// The sensor's sample rate, Hz.
const RATE: u32 = 100;
/// The time after power-on until an MPU-6050 responds (its data sheet).
const START: Duration = Duration::from_millis(100);
/// The time without a sample after which the sensor is assumed to have lost its settings.
const PATIENCE: Duration = Duration::from_millis(200);

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let board = embassy_nrf::init(embassy_nrf::config::Config::default());
    let mut config = twim::Config::default();
    config.frequency = twim::Frequency::K400;
    // DMA cannot read flash: constants are copied into this buffer.
    let mut copies = [0; 16];
    let mut bus =
        Twim::new(board.TWISPI0, Interrupts, board.P0_26, board.P0_27, config, &mut copies);
    let mut ready = Input::new(board.P1_01, Pull::None);
    loop {
        Timer::after(START).await;
        if let Err(error) = walk(&mut bus, &mut ready).await {
            defmt::error!("{}", error);
        }
    }
}

/// Tracks the foot until the sensor is silent or its bus fails.
async fn walk(bus: &mut Twim<'_>, ready: &mut Input<'_>) -> Result<(), Error<twim::Error>> {
    let mut foot = Foot::new(bus, RATE).await?;
    defmt::info!("walk");
    while with_timeout(PATIENCE, ready.wait_for_rising_edge()).await.is_ok() {
        let time_us = Instant::now().as_micros();
        match foot.step(time_us).await {
            Ok(Some(footprint)) => defmt::info!("{}", footprint),
            Ok(None) => {}
            Err(refused @ Error::Refused(_)) => defmt::warn!("{}", refused),
            Err(error) => return Err(error),
        }
    }
    defmt::warn!("no samples");
    Ok(())
}
