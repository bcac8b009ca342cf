//! Flags that help with an error. The library does not know the command line.

use std::error::Error;

use jamgrip::{
    node::launch::RunError,
    node::start::StartError,
    scene::{SceneError, error::Diagnostic},
};

/// What to add to the text of an error.
pub(crate) fn of(error: &(dyn Error + 'static)) -> Option<&'static str> {
    if let Some(scene) = error.downcast_ref::<SceneError>() {
        let is_override = |it: &Diagnostic| it.location.source.starts_with("override ");
        let has_override = match scene {
            SceneError::NotAnOverride { .. } => true,
            SceneError::Invalid(diagnostics) => diagnostics.iter().any(is_override),
            _ => false,
        };
        return has_override.then_some("Overrides are set with --set KEY=VALUE.");
    }
    match error.downcast_ref::<RunError>()? {
        RunError::Start(StartError::Threads(_)) => Some("--threads sets the number of threads."),
        RunError::Recording(_) => Some("--set outputs.bag.on_error=continue continues the run."),
        RunError::NoTopics(_) => Some("--set controller=builtin runs without ROS 2."),
        _ => None,
    }
}
