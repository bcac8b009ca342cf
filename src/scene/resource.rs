//! Objects and scenes from files or text that a client names: scene files, and URDF for objects.

use std::{
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    Object, Scene,
    error::{DiagnosticKind, SceneError},
    text,
};

/// Formats of objects, as file name extensions.
pub const FORMATS: [&str; 2] = ["urdf", "yaml"];

/// The key that names another file.
const MESH_FILE: &str = "object.shape.mesh.file";

/// Why an object or a scene cannot be loaded.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResourceError {
    /// The format is not supported.
    #[error("`{0}` is neither URDF (.urdf) nor a scene (.yaml)")]
    UnsupportedFormat(String),
    /// The resource does not exist.
    #[error("{0}")]
    NoResource(String),
    /// The text is malformed.
    #[error("{0}")]
    Malformed(String),
    /// A file that it refers to does not exist.
    #[error("{0}")]
    MissingAssets(String),
    /// It has features that cannot be simulated.
    #[error("{0}")]
    Unsupported(String),
}

/// Loads an object from a file (`uri`: a path relative to `folder`, or `file://`) or from text.
///
/// # Errors
/// If there is no object that can be simulated.
pub fn object(uri: &str, string: &str, folder: &Path) -> Result<Object, ResourceError> {
    if string.trim().is_empty() {
        let (path, text) = open(uri, folder)?;
        let inside = path.parent().unwrap_or(folder).to_owned();
        return match path.extension().and_then(|it| it.to_str()) {
            Some("urdf") => urdf(&text, &inside),
            Some("yaml" | "yml") => of_scene(&text, uri, &inside),
            _ => Err(ResourceError::UnsupportedFormat(uri.to_owned())),
        };
    }
    if string.contains("<robot") {
        urdf(string, folder)
    } else if string.trim_start().starts_with('<') {
        Err(ResourceError::UnsupportedFormat("text that starts with `<`".to_owned()))
    } else {
        of_scene(string, "resource_string", folder)
    }
}

#[cfg(feature = "meshes")]
fn urdf(text: &str, folder: &Path) -> Result<Object, ResourceError> {
    super::urdf::read(text, folder, &default_object()?)
}

#[cfg(not(feature = "meshes"))]
fn urdf(_: &str, _: &Path) -> Result<Object, ResourceError> {
    let why = "URDF needs a build with feature `meshes`";
    Err(ResourceError::Unsupported(why.to_owned()))
}

/// Loads a scene from a file, or from text if no file is named. With `ignores_assets`, an object whose
/// mesh cannot be loaded is skipped.
///
/// # Errors
/// If there is no scene that can be simulated.
pub fn scene(
    uri: &str,
    string: &str,
    folder: &Path,
    ignores_assets: bool,
) -> Result<Scene, ResourceError> {
    let unsupported = |what: &str| Err(ResourceError::UnsupportedFormat(what.to_owned()));
    let (text, source, inside) = if !uri.is_empty() || string.trim().is_empty() {
        let (path, text) = open(uri, folder)?;
        if !matches!(path.extension().and_then(|it| it.to_str()), Some("yaml" | "yml")) {
            return unsupported(uri);
        }
        (text, uri, path.parent().unwrap_or(folder).to_owned())
    } else if string.trim_start().starts_with('<') {
        return unsupported("text that starts with `<`");
    } else {
        (string.to_owned(), "resource_string", folder.to_owned())
    };
    match text::parse(&text, source, &inside, &[]) {
        Ok(scene) => Ok(scene),
        Err(error) => match (of_mesh(&error), without_object(&text, source, &inside)) {
            (Some(_), Ok(scene)) if ignores_assets => Ok(scene),
            (Some(file), Ok(_)) if file.exists() => {
                Err(ResourceError::Unsupported(error.to_string()))
            }
            (Some(_), Ok(_)) => Err(ResourceError::MissingAssets(error.to_string())),
            _ => Err(ResourceError::Malformed(error.to_string())),
        },
    }
}

/// The mesh file that cannot be loaded, if that is the error.
fn of_mesh(error: &SceneError) -> Option<PathBuf> {
    let SceneError::Invalid(diagnostics) = error else { return None };
    diagnostics.iter().find_map(|it| match &it.kind {
        DiagnosticKind::Invalid { value, .. } if it.key == MESH_FILE => Some(PathBuf::from(value)),
        _ => None,
    })
}

/// The scene without its object.
fn without_object(text: &str, source: &str, folder: &Path) -> Result<Scene, SceneError> {
    let placeholder = ["object.shape.sphere.radius=10 mm", "object.position=[100 m, 0 m, 100 m]"];
    let scene = text::parse(text, source, folder, &placeholder.map(str::to_owned))?;
    Ok(Scene { objects: Vec::new(), ..scene })
}

/// Reads a file: its path and its text.
fn open(uri: &str, folder: &Path) -> Result<(PathBuf, String), ResourceError> {
    if uri.is_empty() {
        let why = "neither uri nor resource_string is given".to_owned();
        return Err(ResourceError::NoResource(why));
    }
    let path = path(uri, folder)
        .ok_or_else(|| ResourceError::NoResource(format!("`{uri}` is not a file")))?;
    let text = std::fs::read_to_string(&path)
        .map_err(|error| ResourceError::NoResource(format!("`{uri}`: {error}")))?;
    Ok((path, text))
}

/// The path of a URI: a path or `file://`; `None` for other schemes.
pub fn path(uri: &str, folder: &Path) -> Option<PathBuf> {
    let path = uri.strip_prefix("file://").unwrap_or(uri);
    (!path.contains("://")).then(|| folder.join(path))
}

/// The files of these formats in `folder`, by name.
pub fn files(folder: &Path, formats: &[&str]) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let has_format = |file: &PathBuf| {
        let end = file.extension().and_then(|it| it.to_str());
        end.is_some_and(|end| formats.contains(&end))
    };
    let mut files: Vec<PathBuf> = entries.map(|it| it.path()).filter(has_format).collect();
    files.sort();
    files
}

/// Folders and their modification times, to notice changes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FolderState(Vec<(PathBuf, Option<SystemTime>)>);

impl FolderState {
    /// The current state of `folders`.
    pub fn of(folders: &[PathBuf]) -> Self {
        let changed = |it: &PathBuf| std::fs::metadata(it).and_then(|it| it.modified()).ok();
        Self(folders.iter().map(|it| (it.clone(), changed(it))).collect())
    }
}

/// The object of a scene. It is moved far above everything else, because its position does not matter.
fn of_scene(text: &str, source: &str, folder: &Path) -> Result<Object, ResourceError> {
    let overrides = [
        "controller=topics",
        "object.position=[0 m, 0 m, 10 m]",
        "flange.position=[0 m, 0 m, 100 m]",
    ];
    let scene: Result<Scene, _> = text::parse(text, source, folder, &overrides.map(str::to_owned));
    let scene = scene.map_err(|error| ResourceError::Malformed(error.to_string()))?;
    let object = scene.objects.into_iter().next();
    object.ok_or_else(|| ResourceError::Malformed(format!("`{source}` has no object")))
}

/// An object with default values.
#[cfg(feature = "meshes")]
fn default_object() -> Result<Object, ResourceError> {
    let text = "name: defaults\nobject: { shape: { sphere: { radius: 10 mm } } }\n";
    of_scene(text, "the defaults", Path::new(""))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Shape;

    /// Oracle: the values in the text.
    #[test]
    fn urdf_and_scene_texts_are_objects() {
        let urdf = r#"<robot name="ball"><link name="body">
            <inertial><mass value="0.1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
            <collision><geometry><sphere radius="0.02"/></geometry></collision></link></robot>"#;
        let object = super::object("", urdf, Path::new("")).unwrap();
        assert_eq!(
            (object.name.as_str(), &object.shape),
            ("ball", &Shape::Sphere { radius: 0.02 })
        );
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 0.02_f64.powi(3);
        assert!((object.material.density * volume - 0.1).abs() < 1e-12);
        let yaml = "name: x\nobject: { name: cube, shape: { box: { size: [1 cm, 2 cm, 3 cm] } } }";
        let object = super::object("", yaml, Path::new("")).unwrap();
        assert_eq!(object.name, "cube");
    }

    /// Oracle: the documented kind of each error, and of `ignores_assets`.
    #[test]
    fn scenes_are_read_or_rejected_by_kind() {
        use ResourceError as F;
        let folder = tempfile::tempdir().unwrap();
        let of = |uri: &str, text: &str, ignores| super::scene(uri, text, folder.path(), ignores);
        let ball =
            "name: x\nobject: { shape: { sphere: { radius: 10 mm } }, position: [0 m, 0 m, 1 cm] }";
        std::fs::write(folder.path().join("ball.yaml"), ball).unwrap();
        assert_eq!(of("ball.yaml", "", false).unwrap(), of("", ball, false).unwrap());
        let mesh = "name: x\nobject: { shape: { mesh: { file: no.obj, unit: 1 mm } }, position: [0 m, 0 m, 1 cm] }";
        assert!(matches!(of("", mesh, false), Err(F::MissingAssets(_))));
        assert_eq!(of("", mesh, true).unwrap().objects, []);
        std::fs::write(folder.path().join("no.obj"), "no mesh").unwrap();
        assert!(matches!(of("", mesh, false), Err(F::Unsupported(_))));
        assert!(matches!(of("", "", false), Err(F::NoResource(_))));
        assert!(matches!(of("no.yaml", ball, false), Err(F::NoResource(_))));
        assert!(matches!(of("no.obj", "", false), Err(F::UnsupportedFormat(_))));
        assert!(matches!(of("", "<sdf/>", false), Err(F::UnsupportedFormat(_))));
        assert!(matches!(of("", "name: 1", true), Err(F::Malformed(_))));
    }

    #[test]
    fn each_error_has_its_kind() {
        use ResourceError as F;
        let of = |uri: &str, text: &str| super::object(uri, text, Path::new("/nowhere"));
        let link =
            |inside: &str| format!("<robot name=\"r\"><link name=\"l\">{inside}</link></robot>");
        let mesh =
            "<collision><geometry><mesh filename=\"package://a/b.stl\"/></geometry></collision>";
        assert!(matches!(of("", ""), Err(F::NoResource(_))));
        assert!(matches!(of("no.urdf", ""), Err(F::NoResource(_))));
        assert!(matches!(of("", "<sdf/>"), Err(F::UnsupportedFormat(_))));
        assert!(matches!(of("", "<robot"), Err(F::Malformed(_))));
        assert!(matches!(of("", "name: 1"), Err(F::Malformed(_))));
        assert!(matches!(of("", &link(mesh)), Err(F::MissingAssets(_))));
        assert!(matches!(of("", &link("")), Err(F::Unsupported(_))));
    }
}
