//! The robot on an ESP32-C3: sets up the board and runs the loop.
//!
//! The tests build and link it but never run it: there is no such board here.
//!
//! | pin | to |
//! |---|---|
//! | 4, 5, 6, 7 | DW1000: SCK, MISO, MOSI, CSn |
//! | 3 | DW1000: RSTn (open drain) |
//! | 8, 9 | BNO055: SDA, SCL; its address pin high |
//! | 21 | telemetry, 921 600 baud |
#![no_std]
#![no_main]

use defmt::{error, info, warn};
use esp_hal::delay::Delay;
use esp_hal::gpio::{DriveMode, Level, Output, OutputConfig};
use esp_hal::i2c::master::{Config as I2cConfig, I2c};
use esp_hal::spi::master::{Config as SpiConfig, Spi};
use esp_hal::system::software_reset;
use esp_hal::time::{Duration, Instant, Rate};
use esp_hal::uart::{Config as UartConfig, UartTx};
use esp_hal::{Config, main};
use esp_println as _;
use robot_app::{Imu, Radio, Robot, TAG};

esp_bootloader_esp_idf::esp_app_desc!();

/// The duration of an anchor's turn: each is polled ten times a second.
const TURN: Duration = Duration::from_millis(25);

/// The reason why the program restarts.
#[derive(defmt::Format)]
enum Failure {
    /// A bus or the serial line does not accept its settings.
    Settings,
    Radio(robot_app::RadioError),
    Imu(robot_app::ImuError),
    Robot(robot_app::Error),
}

#[main]
fn main() -> ! {
    let Err(failure) = run();
    error!("{}", failure);
    Delay::new().delay_millis(1_000);
    software_reset()
}

fn run() -> Result<core::convert::Infallible, Failure> {
    let board = esp_hal::init(Config::default());
    let mut delay = Delay::new();

    let spi = Spi::new(board.SPI2, SpiConfig::default().with_frequency(Rate::from_mhz(3)))
        .map_err(|_| Failure::Settings)?
        .with_sck(board.GPIO4)
        .with_miso(board.GPIO5)
        .with_mosi(board.GPIO6);
    let select = Output::new(board.GPIO7, Level::High, OutputConfig::default());
    let open_drain = OutputConfig::default().with_drive_mode(DriveMode::OpenDrain);
    let mut reset = Output::new(board.GPIO3, Level::Low, open_drain);
    delay.delay_millis(1);
    reset.set_high();
    delay.delay_millis(5);
    let radio = Radio::new(spi, select, delay, &TAG).map_err(Failure::Radio)?;

    let i2c = I2c::new(board.I2C0, I2cConfig::default().with_frequency(Rate::from_khz(400)))
        .map_err(|_| Failure::Settings)?
        .with_sda(board.GPIO8)
        .with_scl(board.GPIO9);
    let imu = Imu::new(i2c, &mut delay).map_err(Failure::Imu)?;

    let line = UartTx::new(board.UART0, UartConfig::default().with_baudrate(921_600))
        .map_err(|_| Failure::Settings)?
        .with_tx(board.GPIO21);

    let mut robot = Robot::new(radio, imu, line).map_err(Failure::Robot)?;
    info!("on its way");
    let mut turn = Instant::now();
    loop {
        let step = robot.step(turn.duration_since_epoch().as_micros()).map_err(Failure::Robot)?;
        if let Err(error) = step.range {
            warn!("anchor {}: {}", step.anchor, error);
        }
        if let Err(error) = step.acceleration {
            warn!("{}", error);
        }
        // A step that took longer than its turn delays all later ones.
        turn = (turn + TURN).max(Instant::now());
        while Instant::now() < turn {}
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    error!("{}", defmt::Display2Format(info));
    software_reset()
}
