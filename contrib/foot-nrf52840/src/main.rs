//! The foot on an nRF52840-DK: SDA at P0.26, SCL at P0.27, the sensor's interrupt at P1.01. The processor sleeps until a
//! sample is ready, and while DMA fetches it.
#![no_std]
#![no_main]

use defmt_rtt as _;
use embassy_executor::Spawner;
use embassy_nrf::gpio::{Input, Pull};
use embassy_nrf::twim::{self, Twim};
use embassy_nrf::{bind_interrupts, peripherals};
use embassy_time::Instant;
use foot::Foot;
use panic_probe as _;

bind_interrupts!(struct Interrupts {
    TWISPI0 => twim::InterruptHandler<peripherals::TWISPI0>;
});

#[embassy_executor::main]
async fn main(_spawner: Spawner) {
    let board = embassy_nrf::init(embassy_nrf::config::Config::default());
    let mut config = twim::Config::default();
    config.frequency = twim::Frequency::K400;
    // DMA reads no flash: constants are copied here.
    let mut copies = [0; 16];
    let bus =
        Twim::new(board.TWISPI0, Interrupts, board.P0_26, board.P0_27, config, &mut copies);
    let mut ready = Input::new(board.P1_01, Pull::None);
    let mut foot = match Foot::new(bus).await {
        Ok(foot) => foot,
        Err(error) => defmt::panic!("no sensor: {}", error),
    };
    loop {
        ready.wait_for_rising_edge().await;
        let time_us = Instant::now().as_micros();
        match foot.step(time_us).await {
            Ok(Some(footprint)) => defmt::info!("{}", footprint),
            Ok(None) => {}
            Err(error) => defmt::warn!("{}", error),
        }
    }
}
