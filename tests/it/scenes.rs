//! Every shipped scene is valid, and every bad scene is rejected with exactly the message in its .txt
//! file.
//!
//! After a change of a message: `JAMGRIP_UPDATE=1 cargo test --release scenes`, then read the diff.

use std::{
    fs,
    path::{Path, PathBuf},
};

use jamgrip::scene;

fn yaml_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut files: Vec<_> =
        entries.filter(|path| path.extension().is_some_and(|it| it == "yaml")).collect();
    files.sort();
    files
}

/// Oracle: the scene itself, before it was printed and read again.
#[test]
fn shipped_scenes_parse_and_their_printed_form_is_the_same_scene() {
    let scenes: Vec<_> = yaml_files("launch_configs")
        .into_iter()
        .filter(|path| !path.ends_with("defaults.yaml"))
        .collect();
    assert!(3 <= scenes.len(), "the three scenes of the README are among {scenes:?}");
    for path in scenes {
        let scene = scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        let printed = scene::to_yaml(&scene);
        let again = scene::parse(&printed, "printed", Path::new(""), &[]);
        assert_eq!(again.unwrap_or_else(|error| panic!("{error}")), scene, "{}", path.display());
    }
}

/// Oracle: the message in the .txt file, as reviewed.
#[test]
fn bad_scenes_are_rejected_with_location_value_limit_and_remedy() {
    let scenes = yaml_files("tests/golden/bad_scenes");
    assert!(20 <= scenes.len(), "bad scenes are missing");
    let is_update = std::env::var_os("JAMGRIP_UPDATE").is_some();
    for path in scenes {
        let golden = path.with_extension("txt");
        let found = match scene::load(&path, &[]) {
            Ok(_) => panic!("{} was accepted", path.display()),
            Err(error) => format!("{error}\n"),
        };
        if is_update {
            fs::write(&golden, &found).unwrap();
        }
        let expected = fs::read_to_string(&golden).unwrap_or_default();
        assert_eq!(found, expected, "{}", golden.display());
    }
}
