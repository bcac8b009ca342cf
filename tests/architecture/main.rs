//! Rules of this project that the compiler does not check.
//!
//! `rules.rs` contains the tables; `planted.rs` tests that violations are found.
#![expect(clippy::unwrap_used, reason = "a failing unwrap is a failing test")]

mod documents; // paths and links in Markdown files and comments
mod files; // format of source files
mod paths; // which paths a source file names
mod planted; // planted violations
mod rules; // what each module may use
mod violations; // forbidden names in a source file
mod words; // words that must not come back

use std::{
    fs,
    path::{Path, PathBuf},
};

use rules::{BANS, FOREIGN, FREE, GENERATED, UNSAFE, is_in};
use violations::{foreign, is_banned, module, violations};

#[test]
fn modules_use_only_what_they_may() {
    let order = modules_in_reading_order();
    assert!(10 <= order.len(), "the list in src/lib.rs is read: {order:?}");
    let sources = sources();
    let found = sources.iter().flat_map(|(file, text)| violations(file, text, &order));
    assert_none(&found.collect::<Vec<_>>());
}

/// Every entry of the tables still applies to something, and every dependency is in them.
#[test]
fn the_tables_are_up_to_date() {
    let order = modules_in_reading_order();
    let sources = sources();
    let read = |(file, text): &(String, String)| {
        (file.clone(), paths::read(&module(file), text).unwrap_or_default())
    };
    let read: Vec<_> = sources.iter().map(read).collect();
    let mut outdated = Vec::new();
    for (path, places) in FOREIGN {
        for place in *places {
            let is_used = read.iter().any(|(file, paths)| {
                is_in(file, &[place])
                    && paths.mentions.iter().any(|it| foreign(it).is_some_and(|it| it.0 == *path))
            });
            if !is_used {
                outdated.push(format!("FOREIGN: nothing in `{place}` uses `{path}`"));
            }
        }
    }
    for ban in BANS {
        let unknown = ban.modules.iter().filter(|it| !order.iter().any(|name| name == *it));
        outdated.extend(unknown.map(|it| format!("BANS: no module `{it}` in src/lib.rs")));
        for place in ban.except {
            let is_needed = read.iter().any(|(file, paths)| {
                is_in(file, &[place]) && paths.mentions.iter().any(|it| is_banned(file, it, ban))
            });
            if !is_needed {
                outdated.push(format!(
                    "BANS: `{place}` is not needed as an exception from \"{}\"",
                    ban.why
                ));
            }
        }
    }
    for place in UNSAFE {
        let is_needed =
            read.iter().any(|(file, it)| is_in(file, &[place]) && !it.unsafe_lines.is_empty());
        if !is_needed {
            outdated.push(format!("UNSAFE: no unsafe code in `{place}`"));
        }
    }
    let gone = GENERATED.iter().filter(|it| !Path::new(it).exists());
    outdated.extend(gone.map(|it| format!("GENERATED: `{it}` does not exist")));

    let dependencies = dependencies();
    let crates = FOREIGN.iter().map(|it| it.0.split("::").next().unwrap());
    let listed: Vec<&str> = crates.chain(FREE.iter().copied()).collect();
    let missing = dependencies.iter().filter(|it| !listed.contains(&it.as_str()));
    outdated.extend(missing.map(|it| format!("FOREIGN or FREE must say where `{it}` is used")));
    let gone = listed.iter().filter(|it| !dependencies.iter().any(|name| name == *it));
    outdated.extend(gone.map(|it| format!("`{it}` is not a dependency in Cargo.toml")));
    assert_none(&outdated);
}

/// A table of the architecture that omits a module misleads the reader.
#[test]
fn architecture_names_every_module() {
    let text = read(Path::new("ARCHITECTURE.md"));
    let missing = modules_in_reading_order().into_iter().filter(|module| {
        let named = [format!("`src/{module}`"), format!("`src/{module}.rs`")];
        !named.iter().any(|it| text.contains(it))
    });
    assert_none(&missing.map(|it| format!("ARCHITECTURE.md: no `src/{it}`")).collect::<Vec<_>>());
}

pub(crate) fn assert_none(violations: &[String]) {
    assert!(violations.is_empty(), "\n{}", violations.join("\n"));
}

/// The `pub mod` lines of `src/lib.rs`, top to bottom.
fn modules_in_reading_order() -> Vec<String> {
    let name = |line: &str| Some(line.strip_prefix("pub mod ")?.split(';').next()?.to_owned());
    read(Path::new("src/lib.rs")).lines().filter_map(name).collect()
}

/// The crates under `[dependencies]` in Cargo.toml, as code names them.
fn dependencies() -> Vec<String> {
    let manifest = read(Path::new("Cargo.toml"));
    let lines = manifest.lines().skip_while(|it| *it != "[dependencies]").skip(1);
    let lines = lines.take_while(|it| !it.starts_with('['));
    lines.filter_map(|it| Some(it.split_once(" = ")?.0.replace('-', "_"))).collect()
}

/// The files of the library and the program with their text.
fn sources() -> Vec<(String, String)> {
    let name = |it: &PathBuf| it.to_str().unwrap().to_owned();
    files_in("src", &["rs"]).iter().map(|it| (name(it), read(it))).collect()
}

/// The files in `folder` and the folders below it with one of these extensions, sorted.
pub(crate) fn files_in(folder: &str, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::from(folder)];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).into_iter().flatten() {
            let path = entry.unwrap().path();
            let extension = path.extension().and_then(|it| it.to_str()).unwrap_or("");
            if path.is_dir() {
                open.push(path);
            } else if extensions.contains(&extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

pub(crate) fn read(file: &Path) -> String {
    fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}
