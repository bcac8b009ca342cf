//! Reads scenes from text: the defaults, then the scene file, then the overrides.

use std::path::Path;

use super::{
    Scene, Shape, check,
    error::{Diagnostic, DiagnosticKind, SceneError},
    keys::Section,
    mesh_file,
    read::Reader,
    schema,
    tree::{Entry, Location, Node, Value},
    unset::{self, Unset},
    yaml,
};

/// The file with all defaults.
pub(super) const DEFAULTS_FILE: &str = "launch_configs/defaults.yaml";
/// Its text.
pub(super) const DEFAULTS: &str = include_str!("../../launch_configs/defaults.yaml");

/// Reads a scene file, with overrides of the form `key=value`.
///
/// # Errors
/// All errors at once, each with location, value, limit and remedy.
pub fn load(file: &Path, overrides: &[String]) -> Result<Scene, SceneError> {
    let source = file.display().to_string();
    let text = std::fs::read_to_string(file).map_err(|error| SceneError::Unreadable {
        file: source.clone(),
        reason: error.to_string(),
    })?;
    let folder = file.parent().unwrap_or(Path::new(""));
    parse(&text, &source, folder, overrides)
}

/// Reads a scene from text. `source` names it in messages; paths of mesh files are relative to `folder`.
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
    tree.merge(yaml::parse(text, source)?);
    for text in overrides {
        tree.merge(one_override(text)?);
    }
    tree.location = Location::of_source(source);
    let mut scene = unset::scene();
    let mut reader = Reader::new(&tree, &defaults);
    schema::scene(&mut reader, &mut scene);
    let mut diagnostics = reader.finish();
    diagnostics.extend(load_meshes(&mut scene, &tree, folder));
    diagnostics.extend(check::diagnostics(&scene, &tree));
    if diagnostics.is_empty() {
        return Ok(scene);
    }
    diagnostics.sort_by(|a, b| a.location.cmp(&b.location));
    Err(SceneError::Invalid(diagnostics))
}

/// The text of a scene of an experiment, and its overrides.
pub(crate) struct Layers<'a> {
    /// The YAML.
    pub(crate) text: &'a str,
    /// Its name in messages.
    pub(crate) source: &'a str,
    /// Sections that hold variants of the scene, and the name of the variant to apply.
    pub(crate) variants: (&'a [&'static str], &'static str),
    /// Overrides of the form `key=value`.
    pub(crate) overrides: &'a [String],
    /// True if the defaults of the gripper apply.
    pub(crate) on_defaults: bool,
}

/// A scene of an experiment: its keys, and rules that involve several of them.
pub(crate) trait Keys: Section + Unset {
    /// Violated rules that involve several keys: the key, the reason, and the remedy.
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)>;
}

/// Reads a scene of an experiment from layers of text.
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
    tree.merge(written);
    if let Some(over) = over {
        tree.merge(over);
    }
    for text in layers.overrides {
        tree.merge(one_override(text)?);
    }
    tree.location = Location::of_source(layers.source);
    let mut reader = Reader::new(&tree, &defaults);
    keys.walk(&mut reader);
    let mut diagnostics = reader.finish();
    if diagnostics.is_empty() {
        diagnostics.extend(keys.unfit().into_iter().map(|(key, reason, remedy)| {
            let node = tree.at(key).unwrap_or(&tree);
            let value = node.describe().trim_matches('`').to_owned();
            let kind = DiagnosticKind::Invalid { value, reason, remedy };
            Diagnostic { location: node.location.clone(), key: key.to_owned(), kind }
        }));
    }
    if diagnostics.is_empty() {
        return Ok(keys);
    }
    diagnostics.sort_by(|a, b| a.location.cmp(&b.location));
    Err(SceneError::Invalid(diagnostics))
}

/// Parses `object.friction=0` into a tree.
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
    let location = Location::of_source(&source);
    node.location = location.clone();
    for key in path.rsplit('.') {
        let entry = Entry { key: key.trim().to_owned(), location: location.clone(), node };
        node = Node { location: location.clone(), value: Value::Map(vec![entry]) };
    }
    Ok(node)
}

/// Reads the mesh files of shapes.
fn load_meshes(scene: &mut Scene, tree: &Node, folder: &Path) -> Vec<Diagnostic> {
    let mut diagnostics = Vec::new();
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
                let location = tree.at(key).unwrap_or(tree).location.clone();
                let kind = DiagnosticKind::Invalid {
                    value: file.display().to_string(),
                    reason: error.to_string(),
                    remedy: "use a closed .stl or .obj mesh; its path is relative to the scene file",
                };
                diagnostics.push(Diagnostic { location, key: key.to_owned(), kind });
            }
        }
    }
    diagnostics
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

    fn error_text(text: &str, overrides: &[&str]) -> String {
        read(text, overrides).expect_err("the scene is wrong").to_string()
    }

    #[test]
    fn defaults_fill_what_a_scene_leaves_out() {
        let scene = read(MINIMAL, &[]).unwrap();
        assert_eq!(scene.grains.radius_min.to_bits(), 0.0019_f64.to_bits(), "table 5");
        assert_eq!(scene.time.tick_ns, 1_000_000);
        assert_eq!(scene.gravity, Vec3::new(0.0, 0.0, -9.81));
    }

    /// Oracle: the scene itself, before it was printed and read again.
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
    fn overrides_win_and_their_errors_name_them() {
        let scene = read(MINIMAL, &["object.friction=0", "grains.youngs_modulus=100MPa"]).unwrap();
        assert_eq!(scene.objects[0].friction.to_bits(), 0.0_f64.to_bits());
        assert_eq!(scene.grains.material.youngs_modulus.to_bits(), 1e8_f64.to_bits());
        let unknown = error_text(MINIMAL, &["object.fricton=0"]);
        assert_eq!(
            unknown,
            "override object.fricton=0: object.fricton: unknown key; did you mean `friction`?"
        );
        assert!(error_text(MINIMAL, &["seed"]).contains("not of the form key=value"));
    }

    /// Errors of several kinds, none of which hides another.
    #[test]
    fn all_errors_are_reported_in_the_order_of_the_text() {
        let text = "name: x\ngrains:\n  radius_min: -2 mm\n  radiusmax: 2 mm\n  count: many\n";
        let found = error_text(text, &[]);
        let lines: Vec<&str> = found.lines().collect();
        let expected = [
            "x.yaml: object.shape: is missing",
            "x.yaml: object.position: is missing",
            "x.yaml:3:15: grains.radius_min: `-2 mm` is out of range",
            "x.yaml:4:3: grains.radiusmax: unknown key; did you mean `radius_max`",
            "x.yaml:5:10: grains.count: expected an integer, found `many`",
        ];
        assert_eq!(lines.len(), expected.len(), "{found}");
        for (line, expected) in lines.iter().zip(expected) {
            assert!(line.starts_with(expected), "{line}\n{expected}");
        }
    }
}
