//! The foot on an ESP32-C3: SDA at pin 4, SCL at pin 5. The sensor is asked every 10 ms: Wokwi's has no interrupt.
#![no_std]
#![no_main]

use embassy_futures::block_on;
use esp_hal::delay::Delay;
use esp_hal::i2c::master::{Config, I2c};
use esp_hal::main;
use esp_hal::system::software_reset;
use esp_hal::time::{Duration, Instant, Rate};
use esp_println::println;
use foot::{Foot, RATE};

esp_bootloader_esp_idf::esp_app_desc!();

#[main]
fn main() -> ! {
    block_on(walk());
    Delay::new().delay_millis(1_000);
    software_reset()
}

/// Tracks for as long as there is a sensor.
async fn walk() {
    let board = esp_hal::init(esp_hal::Config::default());
    let Ok(bus) = I2c::new(board.I2C0, Config::default().with_frequency(Rate::from_khz(400)))
    else {
        return println!("the bus does not take its settings");
    };
    let bus = bus.with_sda(board.GPIO4).with_scl(board.GPIO5).into_async();
    let mut foot = match Foot::new(bus).await {
        Ok(foot) => foot,
        Err(error) => return println!("no sensor: {error:?}"),
    };
    println!("walk");
    let period = Duration::from_micros(1_000_000 / u64::from(RATE));
    let mut due = Instant::now();
    loop {
        while Instant::now() < due {}
        let time_us = Instant::now().duration_since_epoch().as_micros();
        match foot.step(time_us).await {
            Ok(Some(footprint)) => println!("{footprint:?}"),
            Ok(None) => {}
            Err(error) => println!("{error:?}"),
        }
        due += period;
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    println!("{info}");
    software_reset()
}
