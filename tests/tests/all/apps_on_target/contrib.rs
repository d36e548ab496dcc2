//! The programs of `contrib`, as starting points for users: they build and link for their boards. There is no emulator
//! of these boards here, so nothing else is tested.

use anyhow::{Result, ensure};
use object::{Object, ObjectSymbol};
use target_bench::{Apart, App, CORTEX_M4F, RV32IMC, Target};

/// The flash sizes of the chips, bytes.
const NRF52840: u64 = 1 << 20;
const ESP32C3: u64 = 4 << 20;

fn check(target: &'static Target, name: &'static str, flash: u64, symbols: &[&str]) -> Result<()> {
    let Some(app) = App::apart(target, Apart { folder: "contrib", name })? else { return Ok(()) };
    let (bytes, sizes) = (app.file()?, app.elf()?);
    println!("{name}: {} bytes of flash, {} of static RAM", sizes.flash_bytes, sizes.ram_bytes);
    ensure!(sizes.flash_bytes < flash, "{name} has {} bytes", sizes.flash_bytes);
    let elf = object::File::parse(&*bytes)?;
    for wanted in symbols {
        let is_there = elf.symbols().any(|symbol| symbol.name() == Ok(wanted));
        ensure!(is_there, "{name} has no {wanted}");
    }
    Ok(())
}

#[test]
fn a_foot_at_an_nrf52840() -> Result<()> {
    // The interrupt of the bus whose DMA fetches samples, and the log buffer that a probe reads.
    check(&CORTEX_M4F, "foot-nrf52840", NRF52840, &["TWISPI0", "_SEGGER_RTT"])
}

#[test]
fn a_foot_at_an_esp32c3() -> Result<()> {
    check(&RV32IMC, "foot-esp32c3", ESP32C3, &["esp_app_desc", "_start_trap"])
}
