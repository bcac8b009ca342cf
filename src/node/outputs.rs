//! Outputs of a run: sinks behind their queues, and the zero-copy streams, which are written on
//! the thread of the tick.

use std::{path::PathBuf, sync::Arc, time::Duration};

use crate::{
    io::{
        fanout::Fanout,
        sink::{Packet, SinkCounters},
    },
    snapshot::view::View,
    wire::to_ros::Encoder,
};

/// How long a sink may take to close.
const TIMEOUT: Duration = Duration::from_secs(30);

/// All outputs of a run.
#[derive(Default)]
pub struct OutputSinks {
    /// Sinks with threads of their own.
    pub fanout: Fanout,
    /// Zero-copy streams.
    #[cfg(feature = "shm")]
    pub stream: Option<crate::shm::stream::Stream>,
    /// Folder of the recording.
    pub bag: Option<PathBuf>,
    /// True if the run ends when the recording fails.
    pub stops_with_bag: bool,
    /// The current encoder.
    pub encoder: Option<Arc<Encoder>>,
}

/// Result of closing the outputs.
#[derive(Debug, Default)]
pub struct Closed {
    /// Counters of the outputs.
    pub counters: Vec<SinkCounters>,
    /// Errors since the last call of `take_errors`.
    pub errors: Vec<String>,
}

impl OutputSinks {
    /// Publishes one tick. Waits only for a recording that must not drop packets.
    pub fn publish(&mut self, view: &View<'_>, packet: &Arc<Packet>) {
        self.write_stream(view);
        self.fanout.publish(packet);
    }

    #[cfg(feature = "shm")]
    fn write_stream(&mut self, view: &View<'_>) {
        if let Some(stream) = &mut self.stream {
            stream.write(view);
        }
    }

    #[cfg(not(feature = "shm"))]
    fn write_stream(&mut self, _view: &View<'_>) {}

    /// Counters of the outputs so far.
    pub fn counters(&self) -> Vec<SinkCounters> {
        self.fanout.counters().into_iter().chain(self.stream_counters()).collect()
    }

    #[cfg(feature = "shm")]
    fn stream_counters(&self) -> Option<SinkCounters> {
        self.stream.as_ref().map(|stream| stream.counters().clone())
    }

    #[cfg(not(feature = "shm"))]
    fn stream_counters(&self) -> Option<SinkCounters> {
        None
    }

    #[cfg(feature = "shm")]
    fn take_stream_error(&mut self) -> Option<String> {
        self.stream.as_mut()?.take_error()
    }

    #[cfg(not(feature = "shm"))]
    fn take_stream_error(&mut self) -> Option<String> {
        None
    }

    /// Errors since the last call, and whether the run must end because of them.
    pub fn take_errors(&mut self) -> (Vec<String>, bool) {
        let errors = self.fanout.take_errors();
        let must_stop = self.stops_with_bag && errors.iter().any(|error| error.sink == "bag");
        let texts = errors.into_iter().map(|error| error.text);
        (texts.chain(self.take_stream_error()).collect(), must_stop)
    }

    /// Closes all outputs.
    pub fn close(mut self) -> Closed {
        let (mut errors, _) = self.take_errors();
        let mut counters = self.counters();
        let (ends, late) = self.fanout.close(TIMEOUT);
        for end in ends {
            if let Some(before) = counters.iter_mut().find(|it| it.name == end.counters.name) {
                *before = end.counters;
            }
        }
        errors.extend(late.into_iter().map(|error| error.text));
        Closed { counters, errors }
    }
}
