//! The foot's tracker on an ESP32-C3, with SDA at GPIO 4 and SCL at GPIO 5. The sensor is polled every 10 ms, because
//! Wokwi's model of it has no interrupt.
#![no_std]
#![no_main]

use embassy_futures::block_on;
use esp_hal::delay::Delay;
use esp_hal::i2c::master::{Config, I2c};
use esp_hal::main;
use esp_hal::system::software_reset;
use esp_hal::time::{Duration, Instant, Rate};
use esp_println::println;
use foot::{Error, Foot};

esp_bootloader_esp_idf::esp_app_desc!();

#[main]
fn main() -> ! {
    block_on(walk());
    Delay::new().delay_millis(1_000);
    software_reset()
}

/// The sensor's sample rate, Hz: a sample that is read every 10 ms is then at most 1 ms old.
const RATE: u32 = 1000;
const PERIOD: Duration = Duration::from_millis(10);

/// Tracks the foot until the sensor or its bus fails.
async fn walk() {
    let board = esp_hal::init(esp_hal::Config::default());
    let Ok(bus) = I2c::new(board.I2C0, Config::default().with_frequency(Rate::from_khz(400)))
    else {
        return println!("the bus does not take its settings");
    };
    let bus = bus.with_sda(board.GPIO4).with_scl(board.GPIO5).into_async();
    let mut foot = match Foot::new(bus, RATE).await {
        Ok(foot) => foot,
        Err(error) => return println!("no sensor: {error:?}"),
    };
    println!("walk");
    let mut due = Instant::now();
    loop {
        while Instant::now() < due {}
        let now = Instant::now();
        match foot.step(now.duration_since_epoch().as_micros()).await {
            Ok(Some(footprint)) => println!("{footprint:?}"),
            Ok(None) => {}
            Err(refused @ Error::Refused(_)) => println!("{refused:?}"),
            Err(error) => return println!("{error:?}"),
        }
        // After a delay by a slow serial line, missed samples are not made up for.
        due = (due + PERIOD).max(Instant::now());
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    println!("{info}");
    software_reset()
}
