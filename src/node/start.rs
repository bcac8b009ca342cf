//! Creates the session of a run, with its settled state from the cache or computed and cached.

use crate::host::{
    cache::{Cache, Lookup},
    progress_bar::Progress,
};
use crate::{
    cosim::compile::{CompileError, Compiled},
    physics::health::Diverged,
    session::Session,
};

/// Why a session could not be created.
#[derive(Debug, thiserror::Error)]
pub enum StartError {
    /// The scene cannot be simulated.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The solver threads could not be started.
    #[error(transparent)]
    Threads(#[from] crate::base::parallel::ThreadPoolError),
    /// Filling the membrane with grains diverged.
    #[error("filling the membrane: {0}")]
    Settle(#[from] Diverged),
}

/// A session and where its settled state came from.
pub struct Started {
    /// The session.
    pub session: Session,
    /// `cached` or `settled`.
    pub origin: &'static str,
}

/// Creates the session of a compiled scene.
///
/// # Errors
/// If filling the membrane fails. A cache that cannot be read or written is only reported.
pub fn start(
    compiled: Compiled,
    cache: &Cache,
    progress: &Progress,
) -> Result<Started, StartError> {
    let key = compiled.start_digest();
    let (scene, pool) = (compiled.scene.clone(), compiled.pool.clone());
    let compiled = match cache.load(key) {
        Lookup::Missing => compiled,
        Lookup::Damaged(path) => {
            let path = path.display();
            progress.say(&format!("start state {path}: the file is damaged; it is computed again"));
            compiled
        }
        Lookup::State(bytes) => match Session::from_start_state(compiled, &bytes) {
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
