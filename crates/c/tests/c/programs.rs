//! The C programs print what the crates compute, on this computer and on three targets.

use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, ensure};
use kestirim_scalar::{Q12_20, Q16_16};

use crate::tools::{
    arguments, crate_folder, have, include, library, output_folder, program, quickly, recordings,
    run,
};
use crate::{reference, streams};

/// All programs; their sources are in `tests/programs`.
pub(crate) const PROGRAMS: [&str; 6] = ["pedestrian", "robot", "wheels", "uav", "drone", "gnss"];

/// The input of a program, and its expected output.
struct Case {
    stream: Vec<u8>,
    expected: String,
}

impl Case {
    fn of(name: &str, data: &Path, fixed: bool) -> Result<Self> {
        type Reference = fn(&[u8]) -> String;
        let (stream, float, in_fixed): (_, Reference, Reference) = match name {
            "pedestrian" => (
                streams::walk(data)?,
                reference::pedestrian::<f32>,
                reference::pedestrian::<Q12_20>,
            ),
            "robot" => (streams::drive(data)?, reference::robot::<f32>, reference::robot::<Q12_20>),
            "wheels" => {
                (streams::drive(data)?, reference::wheels::<f32>, reference::wheels::<Q12_20>)
            }
            "uav" => (streams::flight(), reference::uav::<f32>, reference::uav::<Q16_16>),
            "drone" => {
                (streams::search(data)?, reference::drone::<f32>, reference::drone::<Q16_16>)
            }
            _ => (streams::epochs(), reference::gnss, reference::gnss),
        };
        let expected = if fixed { in_fixed(&stream) } else { float(&stream) };
        ensure!(expected.lines().count() > 1, "{name}: a stream that tells nothing");
        Ok(Self { stream, expected })
    }

    fn check(&self, told: &str, of: &str) -> Result<()> {
        for (number, (told, expected)) in told.lines().zip(self.expected.lines()).enumerate() {
            ensure!(told == expected, "{of}, line {}:\n{told} is to be\n{expected}", number + 1);
        }
        let lines = (told.lines().count(), self.expected.lines().count());
        ensure!(lines.0 == lines.1, "{of}: {} lines are to be {}", lines.0, lines.1);
        Ok(())
    }
}

#[test]
fn c_on_this_computer_tells_the_bits_of_the_crates() -> Result<()> {
    if !have("C on this computer", &["cc", "cargo"])? {
        return Ok(());
    }
    let Some(data) = recordings("C on this computer")? else { return Ok(()) };
    let library = library(&mut Command::new("cargo"), None, false)?;
    let folder = output_folder().join("host");
    fs::create_dir_all(&folder)?;
    for (name, sleep) in PROGRAMS.into_iter().flat_map(|name| [(name, ""), (name, "-DSLEEP")]) {
        let binary = folder.join(format!("{name}{sleep}"));
        let (source, port) = (program(&format!("{name}.c")), program("port_host.c"));
        let mut command = Command::new("cc");
        command.args(["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror"]);
        command.args([sleep].iter().filter(|argument| !argument.is_empty()));
        run(command.args(arguments(&[
            &"-I",
            &include(),
            &source,
            &port,
            &library,
            &"-o",
            &binary,
        ])))?;
        let case = Case::of(name, &data, false)?;
        let stream = folder.join(format!("{name}.bin"));
        fs::write(&stream, &case.stream)?;
        let told = run(Command::new(&binary).stdin(File::open(&stream)?))?;
        case.check(std::str::from_utf8(&told.stdout)?, &format!("{name} {sleep}"))?;
    }
    Ok(())
}

#[test]
fn cmake_finds_the_library() -> Result<()> {
    if !have("the CMake package", &["cmake", "cc", "cargo", "make"])? {
        return Ok(());
    }
    let example = crate_folder().join("contrib/cmake/example");
    let build = output_folder().join("cmake");
    // The same library as for the other programs, so that it is not compiled again.
    let cargo = format!("-DKESTIRIM_BUILD={}", output_folder().display());
    run(Command::new("cmake").args(arguments(&[&"-S", &example, &"-B", &build, &cargo])))?;
    run(quickly(Command::new("cmake").arg("--build").arg(&build)))?;
    let told = run(&mut Command::new(build.join("standing")))?;
    let told = String::from_utf8(told.stdout)?;
    assert!(told.starts_with("0.00") || told.starts_with("-0.00"), "{told}");
    assert!(told.ends_with("good\n"), "{told}");
    Ok(())
}

/// The functions that a minimal program with the pedestrian's tracker calls.
const SMALLEST: [&str; 3] =
    ["kestirim_pedestrian_init", "kestirim_pedestrian_update", "kestirim_pedestrian_position"];
/// The largest flash size of these functions with a floating-point unit, bytes: with `core` built for size like
/// everything else, and with `core` as Rust ships it.
const LARGEST_FOOT: [u64; 2] = [13_000, 13_500];

/// A bare-metal target, and the machine that QEMU emulates for it.
struct Target {
    triple: &'static str,
    /// Whether to use the feature `fixed`, because there is no floating-point unit.
    fixed: bool,
    clang: &'static [&'static str],
    board: &'static str,
    qemu: &'static [&'static str],
    programs: &'static [&'static str],
    /// The programs that also test snapshots: a restored estimator is on the stack in addition.
    sleepers: &'static [&'static str],
}

/// A BBC micro:bit, with 16 KiB of RAM: the GNSS filter and the drone's lattice do not fit with their stacks.
const CORTEX_M0: Target = Target {
    triple: "thumbv6m-none-eabi",
    fixed: true,
    clang: &["--target=armv6m-none-eabi", "-mcpu=cortex-m0", "-mfloat-abi=soft"],
    board: "microbit.ld",
    qemu: &["qemu-system-arm", "-machine", "microbit"],
    programs: &["pedestrian", "robot", "wheels", "uav"],
    sleepers: &["robot", "wheels", "uav"],
};

const CORTEX_M4F: Target = Target {
    triple: "thumbv7em-none-eabihf",
    fixed: false,
    clang: &[
        "--target=armv7em-none-eabihf",
        "-mcpu=cortex-m4",
        "-mfloat-abi=hard",
        "-mfpu=fpv4-sp-d16",
    ],
    board: "mps2-an386.ld",
    qemu: &["qemu-system-arm", "-machine", "mps2-an386"],
    programs: &PROGRAMS,
    sleepers: &PROGRAMS,
};

/// The instruction set of an ESP32-C3. The programs are compiled without compressed instructions: with these, clang 14
/// cannot align the three instructions of a semihosting call.
const RV32IMC: Target = Target {
    triple: "riscv32imc-unknown-none-elf",
    fixed: true,
    clang: &["--target=riscv32-none-elf", "-march=rv32im", "-mabi=ilp32"],
    board: "virt.ld",
    qemu: &["qemu-system-riscv32", "-machine", "virt", "-bios", "none"],
    programs: &PROGRAMS,
    sleepers: &PROGRAMS,
};

impl Target {
    /// The cargo of the toolchain that runs these tests, if that has the target's `core`.
    fn cargo_with_core(&self) -> Result<Option<PathBuf>> {
        let sysroot = run(Command::new("rustc").args(["--print", "sysroot"]))?.stdout;
        let own = PathBuf::from(String::from_utf8(sysroot)?.trim_end());
        let has_core = own.join("lib/rustlib").join(self.triple).join("lib").is_dir();
        Ok(has_core.then(|| own.join("bin/cargo")))
    }

    /// A cargo that can build for the target: ours, if rustup installed the target, or Debian's with the library's
    /// sources.
    fn cargo(&self) -> Result<Option<Command>> {
        if let Some(cargo) = self.cargo_with_core()? {
            return Ok(Some(Command::new(cargo)));
        }
        if Path::new("/usr/lib/rustlib/src/rust/library/Cargo.lock").is_file() {
            let mut cargo = Command::new("/usr/bin/cargo");
            // Cargo and rustup set variables for this very process, which would change other builds.
            cargo.env_clear().envs(
                ["PATH", "HOME"].map(|name| (name, std::env::var_os(name).unwrap_or_default())),
            );
            cargo.env("RUSTC", "/usr/bin/rustc").env("RUSTC_BOOTSTRAP", "1");
            return Ok(Some(cargo));
        }
        crate::tools::skip(self.triple, "no Rust toolchain for it", "KESTIRIM_REQUIRE_C")?;
        Ok(None)
    }

    /// Builds the static library for the target; `None` without the tools.
    fn library(&self) -> Result<Option<PathBuf>> {
        let Some(mut cargo) = self.cargo()? else { return Ok(None) };
        if self.cargo_with_core()?.is_none() {
            // The environment instead of flags, which must precede cargo's subcommand.
            cargo.env("CARGO_UNSTABLE_BUILD_STD", "core");
            cargo.env("CARGO_UNSTABLE_BUILD_STD_FEATURES", "compiler-builtins-mem");
        }
        library(&mut cargo, Some(self.triple), self.fixed).map(Some)
    }

    fn compile(&self, file: &str, sleep: &[&str], folder: &Path) -> Result<PathBuf> {
        let object =
            folder.join(file).with_extension(if sleep.is_empty() { "o" } else { "sleep.o" });
        let mut command = Command::new("clang");
        command.args(self.clang).args(["-std=c99", "-Os", "-ffreestanding", "-Wall", "-Wextra"]);
        command.args(["-ffunction-sections", "-fdata-sections", "-Werror", "-c"]).args(sleep);
        run(command.args(arguments(&[&"-I", &include(), &program(file), &"-o", &object])))?;
        Ok(object)
    }

    /// Links a program, with these functions of the library whether it calls them or not; returns the image's path.
    fn link(
        &self,
        name: &str,
        sleep: &[&str],
        library: &Path,
        functions: &[String],
    ) -> Result<PathBuf> {
        let folder = output_folder().join(format!("images-{}", self.triple));
        fs::create_dir_all(&folder)?;
        let main = self.compile(&format!("{name}.c"), sleep, &folder)?;
        let port = self.compile("port_bare.c", &[], &folder)?;
        // No board needs to hold all functions at once.
        let (name, board) =
            if functions.is_empty() { (name, self.board) } else { ("all", "roomy.ld") };
        let image = folder.join(format!("{name}{}", sleep.concat()));
        let mut linker = Command::new("ld.lld");
        linker.current_dir(program("")).args(["--gc-sections", "--nmagic", "-T", board]);
        linker.args(functions.iter().map(|name| format!("--undefined={name}")));
        run(linker.args(arguments(&[&"-T", &"bare.ld", &main, &port, &library, &"-o", &image])))?;
        Ok(image)
    }

    /// The output of a program for a stream.
    fn emulate(&self, image: &Path, stream: &[u8]) -> Result<String> {
        let folder = tempfile::tempdir()?;
        fs::write(folder.path().join("stream.bin"), stream)?;
        let (qemu, machine) = self.qemu.split_first().context("an emulator")?;
        let mut command = Command::new("timeout");
        command.arg("120").arg(qemu).args(machine).current_dir(folder.path()).stdin(Stdio::null());
        command.args(["-display", "none", "-monitor", "none", "-serial", "none"]);
        command.args(["-chardev", "file,id=host,path=told.txt"]);
        command.args(["-semihosting-config", "enable=on,target=native,chardev=host"]);
        let ended = command.arg("-kernel").arg(image).output()?;
        let told = fs::read_to_string(folder.path().join("told.txt"))?;
        ensure!(ended.status.success(), "{} failed: {told}", image.display());
        Ok(told)
    }

    /// Builds and runs the library, in the long form only: it takes minutes for each target, and CI has half an hour.
    fn check(&self) -> Result<()> {
        if std::env::var("KESTIRIM_SHORT").is_ok_and(|value| value == "1") {
            writeln!(std::io::stderr(), "SKIPPED: {}: KESTIRIM_SHORT=1", self.triple)?;
            return Ok(());
        }
        let [qemu, ..] = self.qemu else { return Ok(()) };
        if !have(self.triple, &["clang", "ld.lld", "llvm-nm", "llvm-size", "timeout", qemu])? {
            return Ok(());
        }
        let Some(data) = recordings(self.triple)? else { return Ok(()) };
        let Some(library) = self.library()? else { return Ok(()) };
        let empty = flash(&self.link("empty", &[], &library, &[])?)?;
        let functions = functions()?;
        let all = self.link("empty", &[], &library, &functions)?;
        assert_eq!(missing(&all, &functions)?, Vec::<&String>::new(), "{}", self.triple);
        assert_eq!(panics(&all)?, Vec::<String>::new(), "{}: a function can panic", self.triple);
        // The size that functions add to a program that contains everything else already.
        let over = |functions: &[String]| -> Result<u64> {
            Ok(flash(&self.link("empty", &[], &library, functions)?)? - empty)
        };
        let foot = over(&SMALLEST.map(str::to_owned))?;
        println!("{} on {}: {foot} bytes over C without it", SMALLEST.join(", "), self.triple);
        let [built, shipped] = LARGEST_FOOT;
        let most = if self.cargo_with_core()?.is_some() { shipped } else { built };
        assert!(self.fixed || foot <= most, "the smallest foot has {foot} bytes");
        for name in self.programs {
            let of = format!("{name} on {}", self.triple);
            let image = self.link(name, &[], &library, &[])?;
            let case = Case::of(name, &data, self.fixed)?;
            case.check(&self.emulate(&image, &case.stream)?, &of)?;
            assert_eq!(panics(&image)?, Vec::<String>::new(), "{of} can panic");
            let (awake, over) = (flash(&image)?, over(&called(name, &functions)?)?);
            if !self.sleepers.contains(name) {
                println!("{of}: {awake} bytes of flash, {over} over C without it");
                continue;
            }
            let sleeping = self.link(name, &["-DSLEEP"], &library, &[])?;
            case.check(&self.emulate(&sleeping, &case.stream)?, &format!("{of}, asleep"))?;
            let sleep = flash(&sleeping)? - awake;
            println!(
                "{of}: {awake} bytes of flash, {over} over C without it, {sleep} more that sleeps"
            );
        }
        Ok(())
    }
}

/// The flash size of an image, bytes.
fn flash(image: &Path) -> Result<u64> {
    let sizes = run(Command::new("llvm-size").arg(image))?.stdout;
    let sizes = String::from_utf8(sizes)?;
    let mut numbers = sizes.lines().nth(1).context("sizes")?.split_whitespace();
    let (text, data) = (numbers.next().context("text")?, numbers.next().context("data")?);
    Ok(text.parse::<u64>()? + data.parse::<u64>()?)
}

/// The functions declared in the header.
fn functions() -> Result<Vec<String>> {
    let header = fs::read_to_string(include().join("kestirim.h"))?;
    let is_in_name = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let declared = header.lines().filter(|line| !line.starts_with([' ', '/', '#']));
    let name = |line: &str| {
        let name = line.split_once('(')?.0.rsplit(|letter| !is_in_name(letter)).next()?;
        name.starts_with("kestirim_").then(|| name.to_owned())
    };
    let functions: Vec<_> = declared.filter_map(name).collect();
    ensure!(functions.len() > 40, "the header declares {functions:?}");
    Ok(functions)
}

/// The functions that a program calls.
fn called(name: &str, functions: &[String]) -> Result<Vec<String>> {
    let source = fs::read_to_string(program(&format!("{name}.c")))?;
    let calls = |function: &&String| source.contains(&format!("{function}("));
    Ok(functions.iter().filter(calls).cloned().collect())
}

/// The functions that an image lacks.
fn missing<'a>(image: &Path, functions: &'a [String]) -> Result<Vec<&'a String>> {
    let symbols = String::from_utf8(run(Command::new("llvm-nm").arg(image))?.stdout)?;
    let names: std::collections::BTreeSet<_> =
        symbols.lines().filter_map(|line| line.split(' ').next_back()).collect();
    Ok(functions.iter().filter(|name| !names.contains(name.as_str())).collect())
}

/// The parts of the panic machinery that an image links.
fn panics(image: &Path) -> Result<Vec<String>> {
    let symbols = run(Command::new("llvm-nm").arg(image))?.stdout;
    let is_of_panics = |line: &&str| {
        ["panicking", "unwrap_failed", "expect_failed", "rust_begin_unwind"]
            .iter()
            .any(|part| line.contains(part))
            || line.split_once("slice_").is_some_and(|(_, rest)| rest.contains("fail"))
    };
    Ok(String::from_utf8(symbols)?.lines().filter(is_of_panics).map(str::to_owned).collect())
}

#[test]
fn cortex_m0() -> Result<()> {
    CORTEX_M0.check()
}

#[test]
fn cortex_m4f() -> Result<()> {
    CORTEX_M4F.check()
}

#[test]
fn rv32imc() -> Result<()> {
    RV32IMC.check()
}
