//! A thread that runs asynchronous tasks until it is dropped.

use std::thread::JoinHandle;

use smol::{LocalExecutor, channel};

use crate::ros::node::RosError;

/// A thread with an executor. Dropping it cancels its tasks and joins the thread.
pub(crate) struct Worker {
    stop: channel::Sender<()>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread; `spawn_tasks` adds its tasks to the executor.
    ///
    /// # Errors
    /// If the operating system cannot start the thread.
    pub(crate) fn start(
        name: &str,
        spawn_tasks: impl FnOnce(&LocalExecutor<'static>) + Send + 'static,
    ) -> Result<Self, RosError> {
        let (stop, stopped) = channel::bounded::<()>(1);
        let body = move || {
            let executor = LocalExecutor::new();
            spawn_tasks(&executor);
            // Nothing is ever sent: `recv` returns when the channel is closed.
            let _closed = smol::block_on(executor.run(stopped.recv()));
        };
        let thread = std::thread::Builder::new().name(name.to_owned()).spawn(body);
        let thread = thread.map_err(|reason| RosError::Thread { reason })?;
        Ok(Self { stop, thread: Some(thread) })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.stop.close();
        if let Some(thread) = self.thread.take() {
            // A thread that panicked has nothing left to stop.
            drop(thread.join());
        }
    }
}
