//! One error type for a program that uses the library.

use crate::{
    base::parallel::ThreadPoolError,
    cosim::{change_error::ChangeError, compile::CompileError, saved_state::SavedStateError},
    physics::health::Diverged,
    scene::SceneError,
    session::SessionError,
};

/// Any error of the library. Every function returns a more specific error, which converts into
/// this one with `?`.
#[derive(Debug, thiserror::Error)]
#[error(transparent)]
#[non_exhaustive]
pub enum Error {
    /// The scene is invalid.
    Scene(#[from] SceneError),
    /// The solver threads could not be started.
    Threads(#[from] ThreadPoolError),
    /// The scene cannot be simulated.
    Compile(#[from] CompileError),
    /// The session could not be created.
    Session(#[from] SessionError),
    /// The simulation diverged.
    Diverged(#[from] Diverged),
    /// A change of the world was rejected.
    Change(#[from] ChangeError),
    /// A saved state could not be read.
    SavedState(#[from] SavedStateError),
}
