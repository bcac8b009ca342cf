//! Python peers of the tests: an environment of their own under `target/peers`.

use std::{
    fs::File,
    path::{Path, PathBuf},
    process::Command,
    sync::OnceLock,
};

const REQUIREMENTS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/peers/requirements.txt");
const FOLDER: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/target/peers");

/// The Python that has all of `tests/peers/requirements.txt`; made at first use.
pub(crate) fn python() -> &'static Path {
    static PYTHON: OnceLock<PathBuf> = OnceLock::new();
    PYTHON.get_or_init(|| {
        let folder = Path::new(FOLDER);
        std::fs::create_dir_all(folder).unwrap();
        // Another test process may be at it too.
        let lock = File::create(folder.join("lock")).unwrap();
        lock.lock().unwrap();
        let python = folder.join("bin/python");
        let wanted = std::fs::read_to_string(REQUIREMENTS).unwrap();
        let stamp = folder.join("installed.txt");
        if std::fs::read_to_string(&stamp).ok().as_ref() != Some(&wanted) {
            let bare = "Debian and Ubuntu need `apt install python3 python3-venv`";
            run(Command::new("python3").args(["-m", "venv"]).arg(folder), bare);
            let network = "the first run of the tests needs the network, later ones do not";
            let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r"];
            run(Command::new(&python).args(pip).arg(REQUIREMENTS), network);
            std::fs::write(stamp, wanted).unwrap();
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

fn run(command: &mut Command, remedy: &str) {
    let output = command.output().unwrap_or_else(|it| panic!("{command:?}: {it}; {remedy}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?} failed: {said}\n{remedy}");
}
