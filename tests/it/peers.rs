//! Independent programs in Python that read what we write, and say what we read.
//!
//! Their packages live in a virtual environment of their own, `target/peers`, which is made on
//! first use and when `tests/peers/requirements.txt` changes.

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::OnceLock,
};

const SCRIPTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peers");

/// Python with the packages of `tests/peers/requirements.txt`.
pub(crate) fn python() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let environment = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().unwrap().join("peers");
        fs::create_dir_all(&environment).unwrap();
        // Another test process may be at it too.
        let lock = File::create(environment.join("lock")).unwrap();
        lock.lock().unwrap();
        let (python, installed) =
            (environment.join("bin/python"), environment.join("installed.txt"));
        let requirements = Path::new(SCRIPTS).join("requirements.txt");
        let wanted = fs::read_to_string(&requirements).unwrap();
        if fs::read_to_string(&installed).ok().as_deref() != Some(&wanted) {
            must_run(
                Command::new("python3").args(["-m", "venv"]).arg(&environment),
                "install the system packages python3 and python3-venv",
            );
            let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
            must_run(
                Command::new(&python).args(pip).arg(requirements),
                "the packages of tests/peers/requirements.txt come from PyPI: check the network",
            );
            fs::write(installed, wanted).unwrap();
        }
        python
    })
}

/// A script of `tests/peers`, ready to run.
pub(crate) fn script(name: &str) -> Command {
    let mut command = Command::new(python());
    command.arg(Path::new(SCRIPTS).join(name));
    command
}

/// Runs a script of `tests/peers` and returns what it wrote; panics with its complaints if it fails.
pub(crate) fn run(name: &str, arguments: &[&str]) -> String {
    let output = must_run(script(name).args(arguments), "see what it says");
    String::from_utf8(output.stdout).unwrap()
}

fn must_run(command: &mut Command, remedy: &str) -> Output {
    let output = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}; {remedy}"));
    let (said, complained) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?} failed: {said}{complained}; {remedy}");
    output
}

#[test]
fn standard_messages_are_those_of_rosbags() {
    // Oracle: the type store of PyPI's rosbags.
    run("standard_messages.py", &["msgs/standard", "--check"]);
}

#[test]
fn type_hashes_are_those_of_rosbags() {
    use jamgrip::wire::topics::topics;
    let kinds = topics(&crate::synthetic::scene()).into_iter().map(|topic| topic.message_type);
    let hashes: Vec<String> = kinds.map(|it| format!("{}={}", it.name, it.type_hash)).collect();
    let arguments: Vec<&str> = hashes.iter().map(String::as_str).collect();
    // Oracle: RIHS01 hashes that rosbags computes from the .msg files.
    run("type_hashes.py", &arguments);
}
