//! Builds scenes in code: a base scene with some keys changed.

use std::{
    fmt::Display,
    path::{Path, PathBuf},
};

use super::{Scene, SceneError, load, parse};

/// Name of the default scene in error messages.
const DEFAULT_NAME: &str = "default scene";
/// Text of the default scene.
const DEFAULT: &str = include_str!("../../launch_configs/pick_and_lift.yaml");

/// Builds a [`Scene`] from a base scene and changed keys.
///
/// Keys and values are those of scene files; `docs/scene_keys.md` lists them.
///
/// ```
/// use jamgrip::Scene;
///
/// let scene = Scene::builder()
///     .set("grains.count", 500)
///     .set("grains.friction", 0.4)
///     .set("object.position", "[5 mm, 0 mm, 22.5 mm]")
///     .build()?;
/// assert_eq!(scene.grains.count, 500);
/// # Ok::<(), jamgrip::Error>(())
/// ```
#[derive(Clone, Debug, Default)]
#[must_use]
pub struct SceneBuilder {
    base: Base,
    overrides: Vec<String>,
}

/// The scene to which the changed keys are applied.
#[derive(Clone, Debug, Default)]
enum Base {
    /// The default scene.
    #[default]
    Default,
    /// A scene file.
    File(PathBuf),
    /// YAML text.
    Text(String),
}

impl SceneBuilder {
    /// Starts from a scene file instead of the default scene.
    pub fn file(mut self, file: impl Into<PathBuf>) -> Self {
        self.base = Base::File(file.into());
        self
    }

    /// Starts from the YAML text of a scene instead of the default scene. Mesh files are read
    /// relative to the working directory.
    pub fn yaml(mut self, text: impl Into<String>) -> Self {
        self.base = Base::Text(text.into());
        self
    }

    /// Sets a key, for example `.set("membrane.radius", "40 mm")`. Values are written as in scene
    /// files, with their unit; a later call for the same key wins.
    pub fn set(mut self, key: &str, value: impl Display) -> Self {
        self.overrides.push(format!("{key}={value}"));
        self
    }

    /// Reads and checks the scene.
    ///
    /// # Errors
    /// If a key is unknown, a value is unusable, or a file cannot be read. All errors of a scene
    /// are reported at once.
    pub fn build(&self) -> Result<Scene, SceneError> {
        let in_working_directory = Path::new("");
        match &self.base {
            Base::Default => parse(DEFAULT, DEFAULT_NAME, in_working_directory, &self.overrides),
            Base::File(file) => load(file, &self.overrides),
            Base::Text(text) => parse(text, "scene", in_working_directory, &self.overrides),
        }
    }
}

impl Scene {
    /// Starts a builder from the default scene.
    pub fn builder() -> SceneBuilder {
        SceneBuilder::default()
    }

    /// Reads a scene file.
    ///
    /// # Errors
    /// As for [`SceneBuilder::build`].
    pub fn load(file: impl AsRef<Path>) -> Result<Self, SceneError> {
        load(file.as_ref(), &[])
    }
}

/// The default gripper over a steel cylinder: `launch_configs/pick_and_lift.yaml`.
impl Default for Scene {
    fn default() -> Self {
        Self::builder().build().expect("the default scene is valid")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the file that the default scene is documented to be.
    #[test]
    fn default_scene_is_pick_and_lift() {
        let file = Path::new("launch_configs/pick_and_lift.yaml");
        assert_eq!(Scene::default(), Scene::load(file).unwrap());
    }

    /// Oracle: the values set.
    #[test]
    fn keys_are_set_and_checked() {
        let scene = Scene::builder().set("membrane.radius", "39.5 mm").set("seed", 7).build();
        let scene = scene.unwrap();
        assert!((scene.membrane.radius - 0.0395).abs() < 1e-15);
        assert_eq!(scene.seed, 7);
        let text = "name: ball\nobject: { shape: { sphere: { radius: 15 mm } }, \
                    position: [0 mm, 0 mm, 15 mm] }\n";
        assert_eq!(Scene::builder().yaml(text).build().unwrap().name, "ball");
        let error = Scene::builder().set("membrane.radios", "41 mm").build().unwrap_err();
        assert!(error.to_string().contains("did you mean `radius`?"), "{error}");
    }
}
