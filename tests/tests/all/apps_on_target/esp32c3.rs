//! The robot's application, linked for an ESP32-C3 with its hal. There is neither such a chip nor an emulator here: the
//! test shows that it builds, links and is what the second-stage bootloader starts, no more.

use anyhow::{Context, Result};
use object::{Object, ObjectSection, ObjectSymbol};
use target_bench::{Apart, App, RV32IMC};

use super::image;

/// The magic number by which the bootloader of ESP-IDF recognises an application's description.
const MAGIC: u32 = 0xabcd_5432;
/// The address ranges to which flash is mapped for data and for instructions, and that of the RAM.
const DATA: std::ops::Range<u64> = 0x3c00_0000..0x3c80_0000;
const INSTRUCTIONS: std::ops::Range<u64> = 0x4200_0000..0x4280_0000;

#[test]
fn it_links() -> Result<()> {
    let robot = Apart { folder: "tests/firmware/apps", name: "robot-esp32c3" };
    let Some(app) = App::apart(&RV32IMC, robot)? else { return Ok(()) };
    let bytes = app.file()?;
    let elf = object::File::parse(&*bytes)?;
    assert_eq!(elf.architecture(), object::Architecture::Riscv32);
    assert!(INSTRUCTIONS.contains(&elf.entry()), "{:#x} is in flash", elf.entry());

    let section = elf.section_by_name(".flash.appdesc").context("there is a description")?;
    // The bootloader reads the description behind the headers of image and segment.
    assert_eq!(section.address(), DATA.start + 0x20);
    let description = section.data()?;
    assert_eq!(description.first_chunk(), Some(&MAGIC.to_le_bytes()));
    let name = &description[48..80];
    assert!(name.starts_with(b"robot-esp32c3\0"), "{name:x?}");

    let has = |name: &str| elf.symbols().any(|symbol| symbol.name() == Ok(name));
    assert!(has("esp_app_desc") && has("_start_trap"), "the hal's run-time is linked");
    // The log's format strings are present for `espflash monitor`.
    assert!(elf.symbols().any(|symbol| {
        symbol.name().is_ok_and(|name| name.contains("defmt_info") && name.contains("on its way"))
    }));
    image::check_panics("robot-esp32c3", &app)
}
