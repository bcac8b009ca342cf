//! Everywhere a run's results go: sinks behind their queues, and the zero-copy streams, which are
//! written on the tick's own thread.

use std::{path::PathBuf, sync::Arc, time::Duration};

use crate::{
    io::{
        fanout::Fanout,
        sink::{Packet, SinkCounters},
    },
    snapshot::view::View,
    wire::to_ros::Encoder,
};

/// How long a sink may take to complete its work at the end.
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
    /// True if the run shall end when the recording fails.
    pub stops_with_bag: bool,
    /// Who makes messages, as the sinks were opened with it or as it became since.
    pub encoder: Option<Arc<Encoder>>,
}

/// What became of the outputs.
#[derive(Debug, Default)]
pub struct Closed {
    /// What became of the packets, output by output.
    pub counters: Vec<SinkCounters>,
    /// What went wrong since the last look.
    pub faults: Vec<String>,
}

impl OutputSinks {
    /// Gives out one tick. Waits only for a recording that was asked to miss nothing.
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

    /// What became of the packets so far, output by output.
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
    fn take_stream_fault(&mut self) -> Option<String> {
        self.stream.as_mut()?.take_error()
    }

    #[cfg(not(feature = "shm"))]
    fn take_stream_fault(&mut self) -> Option<String> {
        None
    }

    /// What went wrong since the last call, and whether the run must end for it.
    pub fn take_faults(&mut self) -> (Vec<String>, bool) {
        let faults = self.fanout.take_errors();
        let must_stop = self.stops_with_bag && faults.iter().any(|fault| fault.sink == "bag");
        let texts = faults.into_iter().map(|fault| fault.text);
        (texts.chain(self.take_stream_fault()).collect(), must_stop)
    }

    /// Completes everything.
    pub fn close(mut self) -> Closed {
        let (mut faults, _) = self.take_faults();
        let mut counters = self.counters();
        let (ends, late) = self.fanout.close(TIMEOUT);
        for end in ends {
            if let Some(before) = counters.iter_mut().find(|it| it.name == end.counters.name) {
                *before = end.counters;
            }
        }
        faults.extend(late.into_iter().map(|fault| fault.text));
        Closed { counters, faults }
    }
}
