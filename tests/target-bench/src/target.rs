//! The table of targets.

/// A bare-metal target and the machine that QEMU emulates for it.
#[derive(Debug)]
pub struct Target {
    /// The full target triple.
    pub triple: &'static str,
    /// The program of the emulator.
    pub(crate) qemu: &'static str,
    /// The emulator's arguments that select the machine.
    pub(crate) machine: &'static [&'static str],
    /// The emulator's arguments that select the machine for applications, which need serial ports.
    pub(crate) board: &'static [&'static str],
}

/// Every instruction takes 2⁸ ns of virtual time, because the images count instructions by a clock.
/// `support/src/counter.rs` holds the same shift for the images, and the reason why it is 8.
pub(crate) const ICOUNT: &str = "shift=8,sleep=off";

/// BBC micro:bit: 16 MHz, 256 KiB of flash, 16 KiB of RAM.
pub static CORTEX_M0: Target = Target {
    triple: "thumbv6m-none-eabi",
    qemu: "qemu-system-arm",
    machine: &["-machine", "microbit"],
    board: &["-machine", "lm3s6965evb", "-cpu", "cortex-m0"],
};

/// Arm MPS2 with application note 386: 25 MHz, a single-precision floating-point unit.
pub static CORTEX_M4F: Target = Target {
    triple: "thumbv7em-none-eabihf",
    qemu: "qemu-system-arm",
    machine: &["-machine", "mps2-an386"],
    board: &["-machine", "lm3s6965evb", "-cpu", "cortex-m4"],
};

/// QEMU's own RISC-V machine, with the instruction set of an ESP32-C3.
pub static RV32IMC: Target = Target {
    triple: "riscv32imc-unknown-none-elf",
    qemu: "qemu-system-riscv32",
    machine: &["-machine", "virt", "-bios", "none"],
    board: &["-machine", "virt", "-bios", "none"],
};

/// All targets.
pub static TARGETS: [&Target; 3] = [&CORTEX_M0, &CORTEX_M4F, &RV32IMC];
