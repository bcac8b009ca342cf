//! From scene text to `Scene`: defaults below, the scene file on top, overrides above all.

use std::path::Path;

use super::{
    Scene, Shape, check,
    error::{Fault, Problem, SceneError},
    keys::Section,
    mesh_file,
    read::Reader,
    schema,
    tree::{Entry, Node, Place, Value},
    unset::{self, Unset},
    yaml,
};

/// The one place of all defaults.
pub(super) const DEFAULTS_FILE: &str = "launch_configs/defaults.yaml";
/// Its text.
pub(super) const DEFAULTS: &str = include_str!("../../launch_configs/defaults.yaml");

/// Reads a scene file, with overrides of the form `key=value`.
///
/// # Errors
/// All faults at once, each with place, value, limit and remedy.
pub fn load(file: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
    let source = file.display().to_string();
    let text = std::fs::read_to_string(file).map_err(|error| SceneError::Unreadable {
        file: source.clone(),
        reason: error.to_string(),
    })?;
    let folder = file.parent().unwrap_or(Path::new(""));
    parse(&text, &source, folder, overrides)
}

/// Reads a scene from text. `source` names it in messages; mesh files are looked for in `folder`.
///
/// # Errors
/// As for `load`.
pub fn parse(
    text: &str,
    source: &str,
    folder: &Path,
    overrides: &[String],
) -> Result<Scene, SceneError> {
    let defaults = yaml::parse(DEFAULTS, DEFAULTS_FILE)?;
    let mut tree = defaults.clone();
    tree.lay(yaml::parse(text, source)?);
    for text in overrides {
        tree.lay(one_override(text)?);
    }
    tree.place = Place::whole(source);
    let mut scene = unset::scene();
    let mut reader = Reader::new(&tree, &defaults);
    schema::scene(&mut reader, &mut scene);
    let mut faults = reader.finish();
    faults.extend(load_meshes(&mut scene, &tree, folder));
    faults.extend(check::faults(&scene, &tree));
    if faults.is_empty() {
        return Ok(scene);
    }
    faults.sort_by(|a, b| a.place.cmp(&b.place));
    Err(SceneError::Faults(faults))
}

/// The text of a scene of another kind than the gripper's, and what is laid over it.
pub(crate) struct Layers<'a> {
    /// The YAML.
    pub(crate) text: &'a str,
    /// Names it in messages.
    pub(crate) source: &'a str,
    /// Sections that hold changes of the rest, and of these the one that is laid over it.
    pub(crate) variants: (&'a [&'static str], &'static str),
    /// Changes of the form `key=value`.
    pub(crate) overrides: &'a [String],
    /// True if the gripper's defaults lie below.
    pub(crate) on_defaults: bool,
}

/// A scene of another kind: its keys, and the rules that join them.
pub(crate) trait Keys: Section + Unset {
    /// Rules that join several keys: key, what is wrong with its value, and the remedy.
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)>;
}

/// Reads a scene of another kind from layers of text.
///
/// # Errors
/// As for `load`.
pub(crate) fn read<K: Keys>(layers: &Layers<'_>) -> Result<K, SceneError> {
    let mut keys = K::unset();
    let defaults = yaml::parse(DEFAULTS, DEFAULTS_FILE)?;
    let mut written = yaml::parse(layers.text, layers.source)?;
    let (sections, chosen) = layers.variants;
    let over = written.get(chosen).cloned();
    if let Value::Map(entries) = &mut written.value {
        entries.retain(|entry| !sections.contains(&entry.key.as_str()));
    }
    let mut tree = if layers.on_defaults { defaults.clone() } else { written.clone() };
    tree.lay(written);
    if let Some(over) = over {
        tree.lay(over);
    }
    for text in layers.overrides {
        tree.lay(one_override(text)?);
    }
    tree.place = Place::whole(layers.source);
    let mut reader = Reader::new(&tree, &defaults);
    keys.walk(&mut reader);
    let mut faults = reader.finish();
    if faults.is_empty() {
        faults.extend(keys.unfit().into_iter().map(|(key, reason, remedy)| {
            let node = tree.at(key).unwrap_or(&tree);
            let value = node.describe().trim_matches('`').to_owned();
            let problem = Problem::Unfit { value, reason, remedy };
            Fault { place: node.place.clone(), key: key.to_owned(), problem }
        }));
    }
    if faults.is_empty() {
        return Ok(keys);
    }
    faults.sort_by(|a, b| a.place.cmp(&b.place));
    Err(SceneError::Faults(faults))
}

/// `object.friction=0` as the tree it stands for.
fn one_override(text: &str) -> Result<Node, SceneError> {
    let not_an_override = || SceneError::NotAnOverride { text: text.to_owned() };
    let (path, value) = text.split_once('=').ok_or_else(not_an_override)?;
    if path.is_empty() || path.split('.').any(str::is_empty) {
        return Err(not_an_override());
    }
    let source = format!("override {text}");
    let mut node = yaml::parse(value, &source)?;
    if value.trim().is_empty() {
        node.value = Value::Null;
    }
    let place = Place::whole(&source);
    node.place = place.clone();
    for key in path.rsplit('.') {
        let entry = Entry { key: key.trim().to_owned(), place: place.clone(), node };
        node = Node { place: place.clone(), value: Value::Map(vec![entry]) };
    }
    Ok(node)
}

/// Reads the files that shapes name.
fn load_meshes(scene: &mut Scene, tree: &Node, folder: &Path) -> Vec<Fault> {
    let mut faults = Vec::new();
    for object in &mut scene.objects {
        let Shape::Mesh { file, unit, vertices, triangles } = &mut object.shape else { continue };
        if file.as_os_str().is_empty() || unit.is_nan() {
            continue;
        }
        *file = folder.join(&file);
        match mesh_file::read(file, *unit) {
            Ok(surface) => (*vertices, *triangles) = (surface.vertices, surface.triangles),
            Err(error) => {
                let key = "object.shape.mesh.file";
                let place = tree.at(key).unwrap_or(tree).place.clone();
                let problem = Problem::Unfit {
                    value: file.display().to_string(),
                    reason: error.to_string(),
                    remedy: "name a closed .stl or .obj mesh, its path relative to the scene file",
                };
                faults.push(Fault { place, key: key.to_owned(), problem });
            }
        }
    }
    faults
}

#[cfg(test)]
mod tests {
    use super::{super::to_yaml, *};
    use crate::base::Vec3;

    const MINIMAL: &str = "name: minimal\nobject:\n  shape: { sphere: { radius: 10 mm } }\n  \
                           position: [0 mm, 0 mm, 10 mm]\n";

    fn read(text: &str, overrides: &[&str]) -> Result<Scene, SceneError> {
        let overrides: Vec<String> = overrides.iter().map(|it| (*it).to_owned()).collect();
        parse(text, "x.yaml", Path::new(""), &overrides)
    }

    fn complaint(text: &str, overrides: &[&str]) -> String {
        read(text, overrides).expect_err("the scene is wrong").to_string()
    }

    #[test]
    fn defaults_fill_what_a_scene_leaves_out() {
        let scene = read(MINIMAL, &[]).unwrap();
        assert_eq!(scene.grains.radius_min.to_bits(), 0.0019_f64.to_bits(), "table 5");
        assert_eq!(scene.time.tick_ns, 1_000_000);
        assert_eq!(scene.gravity, Vec3::new(0.0, 0.0, -9.81));
    }

    /// Oracle: the scene itself, before it was written out and read again.
    #[test]
    fn a_printed_scene_reads_back_as_the_same_scene() {
        let variants: [&[&str]; 5] = [
            &[],
            &["object.shape.box.size=[20 mm, 21.3 mm, 20 mm]", "time.substep=7.3 us"],
            &["controller=topics", "topics.duration=3 s", "outputs.ros.domain_id=7"],
            &["object.orientation.roll_pitch_yaw=[10 deg, 20 deg, 30 deg]"],
            &["object.shape.capsule={radius: 5 mm, height: 20 mm}", "outputs.bag.folder=a \"b\""],
        ];
        for overrides in variants {
            let scene = read(MINIMAL, overrides).unwrap();
            let text = to_yaml(&scene);
            let again = read(&text, &[]).unwrap_or_else(|error| panic!("{text}\n{error}"));
            assert_eq!(again, scene, "{text}");
        }
    }

    #[test]
    fn overrides_win_and_their_faults_name_them() {
        let scene = read(MINIMAL, &["object.friction=0", "grains.youngs_modulus=100MPa"]).unwrap();
        assert_eq!(scene.objects[0].friction.to_bits(), 0.0_f64.to_bits());
        assert_eq!(scene.grains.material.youngs_modulus.to_bits(), 1e8_f64.to_bits());
        let unknown = complaint(MINIMAL, &["object.fricton=0"]);
        assert_eq!(
            unknown,
            "override object.fricton=0: object.fricton: unknown key; did you mean `friction`?"
        );
        assert!(complaint(MINIMAL, &["seed"]).contains("not of the form key=value"));
    }

    /// Three faults of three kinds, none of which hides another.
    #[test]
    fn all_faults_come_at_once_in_the_order_of_the_text() {
        let text = "name: x\ngrains:\n  radius_min: -2 mm\n  radiusmax: 2 mm\n  count: many\n";
        let complaint = complaint(text, &[]);
        let lines: Vec<&str> = complaint.lines().collect();
        let expected = [
            "x.yaml: object.shape: is missing",
            "x.yaml: object.position: is missing",
            "x.yaml:3:15: grains.radius_min: `-2 mm` is out of range",
            "x.yaml:4:3: grains.radiusmax: unknown key; did you mean `radius_max`",
            "x.yaml:5:10: grains.count: expected a whole number, found `many`",
        ];
        assert_eq!(lines.len(), expected.len(), "{complaint}");
        for (line, expected) in lines.iter().zip(expected) {
            assert!(line.starts_with(expected), "{line}\n{expected}");
        }
    }
}
