//! Scenes that are loaded while the run goes on: compiled and filled on a thread of their own, so
//! that questions are answered meanwhile.

use std::{
    sync::mpsc::{self, Receiver, TryRecvError},
    thread,
};

use super::start::{self, StartError};
use crate::host::{cache::Cache, progress_bar::Progress};
use crate::{base::parallel, cosim::compile::Compiled, scene::Scene};

/// Settles scenes, one at a time.
pub struct Loader {
    n_threads: usize,
    cache: Cache,
    settling: Option<Receiver<Settled>>,
}

/// The settled bag of a scene, or why there is none.
pub type Settled = Result<Vec<u8>, String>;

impl Loader {
    /// A loader that fills bags with so many threads, or takes them from `cache`.
    pub fn new(n_threads: usize, cache: Cache) -> Self {
        Self { n_threads, cache, settling: None }
    }

    /// Begins with `scene`; whatever was begun before is not waited for.
    pub fn begin(&mut self, scene: Scene) {
        let (done, settling) = mpsc::channel();
        let (n_threads, cache) = (self.n_threads, self.cache.clone());
        let work = move || {
            let settled = settle(&scene, n_threads, &cache).map_err(|it| it.to_string());
            // Nobody waits any more if the run has ended.
            drop(done.send(settled));
        };
        let spawned = thread::Builder::new().name("loader".to_owned()).spawn(work);
        if let Err(error) = spawned {
            log::warn!("no thread for a scene to be loaded: {error}");
        }
        self.settling = Some(settling);
    }

    /// What came of it, once.
    pub fn poll(&mut self) -> Option<Settled> {
        let settled = match self.settling.as_ref()?.try_recv() {
            Ok(settled) => settled,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err("its filling broke off".to_owned()),
        };
        self.settling = None;
        Some(settled)
    }
}

fn settle(scene: &Scene, n_threads: usize, cache: &Cache) -> Result<Vec<u8>, StartError> {
    // Threads of its own: those of the run are busy with the run.
    let compiled = Compiled::new(scene, &parallel::ThreadPool::new(n_threads)?)?;
    // The terminal's line belongs to the run.
    let started = start::start(compiled, cache, &Progress::new(true))?;
    Ok(started.session.start_state())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the contract. Work that breaks off is told once, like all other work.
    #[test]
    fn what_breaks_off_is_told_once() {
        let mut loader = Loader::new(1, Cache::new("nowhere".into()));
        assert_eq!(loader.poll(), None, "nothing was begun");
        let (done, settling) = mpsc::channel();
        loader.settling = Some(settling);
        assert_eq!(loader.poll(), None, "it is not done");
        drop(done);
        assert!(loader.poll().is_some_and(|it| it.is_err()));
        assert_eq!(loader.poll(), None);
    }
}
