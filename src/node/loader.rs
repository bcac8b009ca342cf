//! Loads scenes during a run: compiles and settles them on a separate thread, so that requests are
//! served meanwhile.

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

/// The settled state of a scene, or why it could not be computed.
pub type Settled = Result<Vec<u8>, String>;

impl Loader {
    /// A loader that settles scenes with `n_threads` threads or takes them from `cache`.
    pub fn new(n_threads: usize, cache: Cache) -> Self {
        Self { n_threads, cache, settling: None }
    }

    /// Begins to settle `scene`. An earlier scene that is still being settled is abandoned.
    pub fn begin(&mut self, scene: Scene) {
        let (done, settling) = mpsc::channel();
        let (n_threads, cache) = (self.n_threads, self.cache.clone());
        let work = move || {
            let settled = settle(&scene, n_threads, &cache).map_err(|it| it.to_string());
            // The receiver is gone if the run has ended.
            drop(done.send(settled));
        };
        let spawned = thread::Builder::new().name("loader".to_owned()).spawn(work);
        if let Err(error) = spawned {
            log::warn!("cannot start a thread to load a scene: {error}");
        }
        self.settling = Some(settling);
    }

    /// Returns the result once it is there.
    pub fn poll(&mut self) -> Option<Settled> {
        let settled = match self.settling.as_ref()?.try_recv() {
            Ok(settled) => settled,
            Err(TryRecvError::Empty) => return None,
            Err(TryRecvError::Disconnected) => Err("settling it was aborted".to_owned()),
        };
        self.settling = None;
        Some(settled)
    }
}

fn settle(scene: &Scene, n_threads: usize, cache: &Cache) -> Result<Vec<u8>, StartError> {
    // Threads of its own: those of the run are busy with the run.
    let compiled = Compiled::new(scene, &parallel::ThreadPool::new(n_threads)?)?;
    // The progress line belongs to the run.
    let started = start::start(compiled, cache, &Progress::new(true))?;
    Ok(started.session.start_state())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the contract. Aborted work is reported once, like a result.
    #[test]
    fn aborted_work_is_reported_once() {
        let mut loader = Loader::new(1, Cache::new("nowhere".into()));
        assert_eq!(loader.poll(), None, "nothing to do");
        let (done, settling) = mpsc::channel();
        loader.settling = Some(settling);
        assert_eq!(loader.poll(), None, "not finished");
        drop(done);
        assert!(loader.poll().is_some_and(|it| it.is_err()));
        assert_eq!(loader.poll(), None);
    }
}
