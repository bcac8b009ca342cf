//! Independent Python programs that read what we write and publish what we receive.
//!
//! Their packages are in a virtual environment, `target/peers`, which is created on first use and
//! when `tests/peers/requirements.txt` changes.

use std::{
    fs::{self, File},
    path::{Path, PathBuf},
    process::{Command, Output},
    sync::OnceLock,
};

const REQUIREMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peers/requirements.txt");
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/target/peers");

/// Python with the packages of `tests/peers/requirements.txt`.
pub(crate) fn python() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let folder = Path::new(FOLDER);
        fs::create_dir_all(folder).unwrap();
        // Another test process may be doing the same.
        let lock = File::create(folder.join("lock")).unwrap();
        lock.lock().unwrap();
        let python = folder.join("bin/python");
        let required = fs::read_to_string(REQUIREMENTS).unwrap();
        let installed = folder.join("installed.txt");
        if fs::read_to_string(&installed).ok().as_ref() != Some(&required) {
            let bare = "Debian and Ubuntu need `apt-get install -y python3 python3-venv`";
            must_run(Command::new("python3").args(["-m", "venv"]).arg(folder), bare);
            let network = "the first run of the tests needs the network, later ones do not";
            let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
            must_run(Command::new(&python).args(pip).arg(REQUIREMENTS), network);
            fs::write(installed, required).unwrap();
        }
        python
    })
}

/// A script of `tests/peers`, ready to run.
pub(crate) fn script(name: &str) -> Command {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/peers").join(name);
    assert!(path.exists(), "{} is missing", path.display());
    let mut command = Command::new(python());
    command.arg(path);
    command
}

/// Runs a script of `tests/peers` and returns its output; panics with its errors if it fails.
pub(crate) fn run(name: &str, arguments: &[&str]) -> String {
    let output = must_run(script(name).args(arguments), "see its output");
    String::from_utf8(output.stdout).unwrap()
}

fn must_run(command: &mut Command, remedy: &str) -> Output {
    let output = command.output().unwrap_or_else(|e| panic!("{command:?}: {e}; {remedy}"));
    let (output_text, errors) =
        (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert!(output.status.success(), "{command:?} failed: {output_text}{errors}; {remedy}");
    output
}

#[test]
fn standard_messages_are_those_of_rosbags() {
    // Oracle: the type store of PyPI's rosbags.
    run("standard_messages.py", &["msgs/standard", "--check"]);
}

/// The list of types is the generated file: all types that are recorded, published, or part of
/// services and actions.
#[test]
fn type_hashes_are_those_of_rosbags() {
    let generated = std::fs::read_to_string("src/wire/messages/generated.rs").unwrap();
    let after = |line: &str, key: &str| {
        line.trim().strip_prefix(key)?.strip_suffix("\",").map(str::to_owned)
    };
    let names: Vec<String> = generated.lines().filter_map(|it| after(it, "name: \"")).collect();
    let messages = names.iter().filter(|it| it.contains("/msg/"));
    let hashes = generated.lines().filter_map(|it| after(it, "type_hash: \""));
    let hashes: Vec<String> = messages.zip(hashes).map(|(a, b)| format!("{a}={b}")).collect();
    for topic in jamgrip::wire::topics::topics(&crate::synthetic::scene()) {
        let message_type = topic.message_type;
        let listed = format!("{}={}", message_type.name, message_type.type_hash);
        assert!(hashes.contains(&listed), "{listed} is in the list");
    }
    let arguments: Vec<&str> = hashes.iter().map(String::as_str).collect();
    // Oracle: RIHS01 hashes that rosbags computes, and those of its own store of types.
    run("type_hashes.py", &arguments);
}
