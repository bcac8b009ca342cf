//! A session at its first tick: with a settled bag from the cache, or settled now and kept.

use crate::host::{
    cache::{Cache, Found},
    progress_bar::Progress,
};
use crate::{
    cosim::compile::{CompileError, Compiled},
    physics::health::Diverged,
    session::Session,
};

/// Why there is no session.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The scene cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The solver's threads could not be started.
    #[error("the solver's threads cannot be started: {0}; ask for fewer")]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
    /// The bag could not be filled.
    #[error("filling the bag: {0}")]
    Settle(#[from] Diverged),
}

/// A session and where its grains came from.
pub struct Started {
    /// The session.
    pub session: Session,
    /// `cached` or `settled`.
    pub origin: &'static str,
}

/// Starts a session of a compiled scene.
///
/// # Errors
/// If the bag cannot be filled. A cache that cannot be read or written costs time only.
pub fn start(
    compiled: Compiled,
    cache: &Cache,
    progress: &Progress,
) -> Result<Started, StartError> {
    let key = compiled.start_digest();
    let (scene, pool) = (compiled.scene.clone(), compiled.pool.clone());
    let compiled = match cache.load(key) {
        Found::Nothing => compiled,
        Found::Damaged(path) => {
            let path = path.display();
            progress.say(&format!("start state {path}: the file is damaged; it is settled anew"));
            compiled
        }
        Found::State(bytes) => match Session::from_start_state(compiled, &bytes) {
            Ok(session) => return Ok(Started { session, origin: "cached" }),
            Err(error) => {
                progress.say(&error);
                Compiled::new(&scene, &pool)?
            }
        },
    };
    let session = Session::settle(compiled, &mut |it| progress.settling(it.stage, it.share))?;
    if let Err(error) = cache.store(key, &session.start_state()) {
        progress.say(&error);
    }
    Ok(Started { session, origin: "settled" })
}
