//! Tests of the recipes in `contrib` with the real engines, with tasks and servers killed in the middle: the merged
//! result equals a single run.
//!
//! Slurm is Debian's `slurm-wlm`, on the loopback interface only, as root; `hyperqueue` is the package of that name, in
//! a virtual environment below `target/tmp`. If they are missing these tests report SKIPPED, unless
//! `KESTIRIM_REQUIRE_ENGINES` is set.
#![cfg(target_os = "linux")]

use std::env;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const PLAN: &str = "system = 'drone'\ntrials = 300\nseeds = [1, 2]\nshards = 6\n\
                    [settings]\nfilter = 'published'\nparticles = 1000\nheight = [500, 800]";

/// The timeout of steps that take seconds.
const PATIENCE: Duration = Duration::from_secs(120);

fn contrib(recipe: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../contrib").join(recipe)
}

/// A search path that finds the program first.
fn path() -> OsString {
    let program = Path::new(env!("CARGO_BIN_EXE_host-sim")).parent().expect("a folder").to_owned();
    let known = env::var_os("PATH").unwrap_or_default();
    env::join_paths([program].into_iter().chain(env::split_paths(&known))).expect("folders")
}

fn command(program: impl AsRef<std::ffi::OsStr>, folder: &Path) -> Command {
    let mut command = Command::new(program);
    command.current_dir(folder).env("PATH", path()).env("RAYON_NUM_THREADS", "1");
    command
}

fn host_sim(folder: &Path, arguments: &[&str]) -> Output {
    command("host-sim", folder).args(arguments).output().expect("the program runs")
}

/// The rows and the text of a single run.
fn single_run(folder: &Path) -> (Vec<u8>, Vec<u8>) {
    fs::write(folder.join("plan.toml"), PLAN).expect("a plan");
    fs::create_dir(folder.join("one")).expect("a folder");
    assert!(host_sim(folder, &["sweep", "plan.toml", "--out", "one/all.csv"]).status.success());
    let text = host_sim(folder, &["merge", "one"]).stdout;
    (fs::read(folder.join("one/all.csv")).expect("rows"), text)
}

fn is_single_run(folder: &Path, (rows, text): &(Vec<u8>, Vec<u8>)) {
    let merged = host_sim(folder, &["merge", "rows", "--out", "merged.csv"]);
    assert!(merged.status.success(), "{}", String::from_utf8_lossy(&merged.stderr));
    assert!(merged.stdout == *text, "another text");
    assert!(fs::read(folder.join("merged.csv")).expect("rows") == *rows, "other rows");
}

/// The process ids of a folder's tasks.
fn tasks(folder: &Path) -> Vec<String> {
    let is_task = |process: &Path| {
        fs::read(process.join("cmdline")).is_ok_and(|it| it.starts_with(b"host-sim\0sweep\0"))
            && fs::read_link(process.join("cwd")).is_ok_and(|at| at == folder)
    };
    let processes = fs::read_dir("/proc").expect("processes").flatten();
    let tasks = processes.filter(|process| is_task(&process.path()));
    tasks.filter_map(|process| process.file_name().into_string().ok()).collect()
}

/// Kills a process; returns whether it existed.
fn kill(id: &str) -> bool {
    let killed = Command::new("kill").args(["-KILL", id]).stderr(Stdio::null()).status();
    killed.expect("kill runs").success()
}

/// Kills a task of a folder as soon as there is one.
fn kill_a_task(folder: &Path) {
    let begun = Instant::now();
    while !tasks(folder).first().is_some_and(|id| kill(id)) {
        assert!(begun.elapsed() < PATIENCE, "no task began");
        sleep(Duration::from_millis(20));
    }
}

/// Reports that an engine is missing.
fn skipped(engine: &str) {
    assert!(env::var_os("KESTIRIM_REQUIRE_ENGINES").is_none(), "{engine} is missing");
    println!("SKIPPED: {engine} is missing");
}

/// A Python interpreter with `hyperqueue`.
fn hyperqueue() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hyperqueue");
    let python = folder.join("bin/python");
    let has = || {
        Command::new(&python)
            .args(["-c", "import hyperqueue"])
            .output()
            .is_ok_and(|it| it.status.success())
    };
    if !has() && env::var_os("KESTIRIM_REQUIRE_ENGINES").is_some() {
        let made = Command::new("python3").args(["-m", "venv"]).arg(&folder).status();
        assert!(made.expect("python3").success());
        let install = ["-m", "pip", "install", "--quiet", "hyperqueue==0.27.0"];
        assert!(Command::new(&python).args(install).status().expect("pip").success());
    }
    has().then_some(python)
}

#[test]
fn hyperqueue_with_its_server_and_a_task_killed() {
    let Some(python) = hyperqueue() else { return skipped("HyperQueue") };
    let folder = tempfile::tempdir().expect("a folder");
    let folder = &folder.path().canonicalize().expect("a folder");
    let expected = single_run(folder);
    let start = || -> Child {
        let mut engine = command(&python, folder);
        engine.arg(contrib("hyperqueue/sweep.py")).args(["plan.toml", "rows"]);
        engine
            .env("HOME", folder)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("python")
    };
    // Server and worker are one process here, the tasks others.
    let mut engine = start();
    kill_a_task(folder);
    engine.kill().expect("SIGKILL");
    engine.wait().expect("it ends");
    // The tasks outlive it, and would be mistaken for those of the next one.
    while tasks(folder).iter().any(|id| kill(id)) {
        sleep(Duration::from_millis(20));
    }
    let leaves_a_hole = || {
        let mut engine = start();
        kill_a_task(folder);
        let merged = engine.wait().expect("it ends").success();
        if merged {
            // The killed task had found its shard done before, or just finished it: nothing lacks.
            is_single_run(folder, &expected);
            fs::remove_dir_all(folder.join("rows")).expect("rows");
        }
        !merged
    };
    assert!((0..10).any(|_| leaves_a_hole()), "holes were merged");
    assert!(start().wait().expect("it ends").success());
    is_single_run(folder, &expected);
}

/// The daemons of Slurm in a folder, on the loopback interface only.
struct Slurm<'a>(&'a Path);

impl Slurm<'_> {
    fn start(folder: &Path) -> Slurm<'_> {
        let host = fs::read_to_string("/proc/sys/kernel/hostname").expect("a name");
        let host = host.trim();
        let at = folder.display();
        let configuration = format!(
            "ClusterName=here\nSlurmctldHost={host}(127.0.0.1)\nSlurmUser=root\nSlurmctldPort=26817\nSlurmdPort=26818\n\
             AuthType=auth/none\nCredType=cred/none\nStateSaveLocation={at}/state\nSlurmdSpoolDir={at}/spool\n\
             SlurmctldPidFile={at}/slurmctld.pid\nSlurmdPidFile={at}/slurmd.pid\nSlurmctldLogFile={at}/slurmctld.log\n\
             SlurmdLogFile={at}/slurmd.log\nProctrackType=proctrack/pgid\nTaskPlugin=task/none\n\
             SelectType=select/cons_tres\nSelectTypeParameters=CR_Core\nReturnToService=2\n\
             SchedulerParameters=sched_interval=1,batch_sched_delay=0,bf_interval=1\n\
             NodeName={host} NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN\nPartitionName=all Nodes={host} Default=YES\n"
        );
        fs::write(folder.join("slurm.conf"), configuration).expect("a configuration");
        for made in ["state", "spool"] {
            fs::create_dir(folder.join(made)).expect("a folder");
        }
        let slurm = Slurm(folder);
        for daemon in ["slurmctld", "slurmd"] {
            assert!(slurm.command(daemon).status().expect("a daemon").success(), "{daemon}");
        }
        slurm
    }

    fn command(&self, program: &str) -> Command {
        let mut command = command(program, self.0);
        command.env("SLURM_CONF", self.0.join("slurm.conf"));
        command
    }

    fn said(&self, program: &str, arguments: &[&str]) -> String {
        let output = self.command(program).args(arguments).output().expect("Slurm");
        String::from_utf8_lossy(&output.stdout).into_owned()
    }

    /// Waits until a condition holds.
    fn until(&self, what: &str, is_so: impl Fn() -> bool) {
        let begun = Instant::now();
        while !is_so() {
            let log = || fs::read_to_string(self.0.join("slurmctld.log")).unwrap_or_default();
            assert!(begun.elapsed() < PATIENCE, "{what}: {}", log());
            sleep(Duration::from_millis(200));
        }
    }

    fn array(&self) {
        let recipe = contrib("slurm/sweep.sh");
        let recipe = recipe.to_str().expect("a path");
        let options = ["--array=0-5", "--output=/dev/null", recipe, "plan.toml", "rows"];
        assert!(self.said("sbatch", &options).contains("Submitted"));
    }

    fn is_done(&self) -> bool {
        self.said("squeue", &["--noheader"]).trim().is_empty()
    }
}

impl Drop for Slurm<'_> {
    fn drop(&mut self) {
        // Its files are in a temporary folder.
        let _ = self.command("scontrol").arg("shutdown").output();
    }
}

#[test]
fn slurm_with_a_task_killed() {
    let is_there = |program: &&str| {
        Command::new(program).arg("-V").output().is_ok_and(|it| it.status.success())
    };
    let is_root =
        fs::metadata("/proc/self").is_ok_and(|it| std::os::unix::fs::MetadataExt::uid(&it) == 0);
    if !(["slurmctld", "slurmd"].iter().all(is_there) && is_root) {
        return skipped("Slurm");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let folder = &folder.path().canonicalize().expect("a folder");
    let expected = single_run(folder);
    let slurm = Slurm::start(folder);
    slurm.until("a node", || slurm.said("sinfo", &["--noheader", "-o", "%t"]).trim() == "idle");
    slurm.array();
    kill_a_task(folder);
    slurm.until("the array", || slurm.is_done());
    let hole = host_sim(folder, &["merge", "rows"]);
    assert_eq!(hole.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&hole.stderr).contains("are missing"));
    slurm.array();
    slurm.until("the array again", || slurm.is_done());
    is_single_run(folder, &expected);
}
