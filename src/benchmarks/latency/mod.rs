//! Latency of the loop at 1 kHz with a busy solver: from a command on a topic to the first tick
//! that uses it, and from a tick to its sample at a subscriber, over ROS 2 and in shared memory.
//!
//! The loop is `node::run` with its own sinks and sources. The gripper is replaced by a plant that
//! keeps all solver threads busy for most of each tick. Another process subscribes and commands;
//! both use the same clock. Everything runs in a private network: nothing leaves or enters this
//! host.

mod idle_plant; // a plant that only ticks in real time
mod listener; // the subscriber process
mod private_network; // a separate network namespace

use std::{
    process::{Child, Command, Stdio},
    sync::Arc,
};

use serde::{Deserialize, Serialize};

use super::{BenchError, BenchResult, Case, Options, lift};
use crate::{
    base::{
        Real,
        real::{real, real_of},
    },
    host::{progress_bar::Progress, shutdown::Shutdown},
    io::fanout::Delivery,
    node::{
        Inputs, RunContext, Supervision, command_sources::CommandSources, lockstep::Gate,
        outputs::OutputSinks,
    },
    ros::{
        discovery::{DiscoveryExtent, DiscoveryRange},
        node::{RosNode, RosSink},
        subscribe::RosSource,
    },
    scene::{Lockstep, Scene},
    shm::stream::Stream,
    wire::to_ros::Encoder,
};
use idle_plant::IdlePlant;
pub use listener::listen;
use listener::{ListenerSamples, Samples};
pub use private_network::PrivateNetworkError;

/// The scene that determines the sizes of messages, with commands from topics at 1 kHz.
const OVERRIDES: [&str; 2] = ["controller=topics", "outputs.state_rate=1 kHz"];
/// Ticks that are not counted: readers are matched, caches are filled.
const N_FIRST: u64 = 200;
/// Shortest time for a meaningful percentile of 99.9 (s).
const SECONDS_MIN: Real = 3.0;

/// The latencies of the loop cannot be measured.
#[derive(Debug, thiserror::Error)]
pub enum LatencyError {
    /// There is no private network.
    #[error(transparent)]
    Private(#[from] PrivateNetworkError),
    /// ROS 2 or shared memory cannot be opened.
    #[error("{0}")]
    Closed(String),
    /// The other process failed.
    #[error("the listener failed: {0}")]
    Listener(String),
    /// Too few samples arrived.
    #[error("{path}: only {n} samples arrived, expected at least {expected}")]
    Silent {
        /// Path through the loop.
        path: &'static str,
        /// Number of samples that arrived.
        n: usize,
        /// Minimum number of samples.
        expected: usize,
    },
}

/// Latency of one path through the loop.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Latency {
    /// Name of the path.
    pub path: String,
    /// Number of samples.
    pub n: usize,
    /// Number of samples that were sent but did not arrive.
    pub n_lost: usize,
    /// Median (us).
    pub p50_us: Real,
    /// 99th percentile (us).
    pub p99_us: Real,
    /// 99.9th percentile (us).
    pub p999_us: Real,
    /// Maximum (us).
    pub max_us: Real,
}

/// Measures in this process if its network is private, otherwise in a new process in a private
/// network.
pub(super) fn run(case: &Case, options: &Options) -> Result<BenchResult, BenchError> {
    if private_network::is_private() {
        return measure(case, options);
    }
    let result = private_network::run(case, options);
    result.map_err(|error| BenchError::Latency { error: error.into() })
}

fn measure(case: &Case, options: &Options) -> Result<BenchResult, BenchError> {
    let latency = |error| BenchError::Latency { error };
    let overrides = OVERRIDES.map(str::to_owned);
    let scene = lift::scene(&overrides)?;
    let session = lift::session(&scene, options)?;
    let seconds = options.seconds.max(SECONDS_MIN);
    let mut plant = IdlePlant::new(session, scene.time.tick_ns, options)?;
    let prefix = format!("jamgrip_bench_{}", std::process::id());
    let mesh = &plant.session().coupled().system.model.membrane.mesh;
    let encoder =
        Arc::new(Encoder::new(&Arc::new(scene.clone()), &mesh.triangles, &mesh.positions));
    let mut context = context(&scene, &encoder, &prefix, &plant, seconds).map_err(latency)?;
    let child = spawn(&prefix, seconds).map_err(latency)?;
    let shutdown = context.shutdown().clone();
    let listener = std::thread::spawn(move || {
        let samples = samples_of(child);
        // Without the other process there are no commands, and the run would wait forever.
        shutdown.request();
        samples
    });
    let report = crate::node::run(&mut plant, &mut context);
    report.ending.map_err(|error| BenchError::Diverged { case: case.name.to_owned(), error })?;
    let samples = listener.join().expect("a panic is a bug in this program").map_err(latency)?;
    context.close();
    let latencies = plant.latencies(&samples).map_err(latency)?;
    let state = &plant.session().coupled().system.state;
    Ok(BenchResult {
        case: case.name.to_owned(),
        n_grains: state.grains.len(),
        n_vertices: state.membrane.positions.len(),
        threads: options.n_threads,
        real_time_factor: report.real_time_factor,
        latencies,
        peak_rss_bytes: super::process::peak(),
        ..BenchResult::default()
    })
}

/// Everything around the plant, in real time.
fn context(
    scene: &Scene,
    encoder: &Arc<Encoder>,
    prefix: &str,
    plant: &IdlePlant,
    seconds: Real,
) -> Result<RunContext, LatencyError> {
    let closed = |error: &dyn std::fmt::Display| LatencyError::Closed(error.to_string());
    let node = RosNode::join(&discovery_range()).map_err(|it| closed(&it))?;
    let sink = RosSink::new(&node, encoder).map_err(|it| closed(&it))?;
    let source = RosSource::new(&node, encoder).map_err(|it| closed(&it))?;
    let mut outputs = OutputSinks::default();
    let delivery = Delivery::Latest { depth: 500 };
    outputs.fanout.add(Box::new(sink), delivery).map_err(|it| closed(&it))?;
    let state = &plant.session().coupled().system.state;
    let (n_grains, n_vertices) = (state.grains.len(), state.membrane.positions.len());
    let stream = Stream::open(prefix, n_grains, n_vertices).map_err(|it| closed(&it))?;
    outputs.stream = Some(stream);
    let end = std::time::Duration::from_secs_f64(seconds).as_nanos();
    let mut scene = scene.clone();
    scene.outputs.real_time = true;
    let inputs = Inputs {
        command_sources: CommandSources::new(&scene, vec![Box::new(source)]),
        gate: Gate::new(Lockstep::OFF),
        server: None,
    };
    let (progress, shutdown) = (Progress::new(true), Shutdown::default());
    let end_ns = Some(u64::try_from(end).unwrap_or(u64::MAX));
    let supervision = Supervision { progress, shutdown, end_ns };
    Ok(RunContext::new(Arc::new(scene), inputs, outputs, supervision))
}

/// The network is private, so any domain will do.
fn discovery_range() -> DiscoveryRange {
    DiscoveryRange { domain_id: 0, extent: DiscoveryExtent::Host }
}

/// Starts this program again as the process that subscribes and commands.
fn spawn(prefix: &str, seconds: Real) -> Result<Child, LatencyError> {
    let failed = |error: std::io::Error| LatencyError::Listener(error.to_string());
    let program = std::env::current_exe().map_err(failed)?;
    let mut command = Command::new(program);
    command.args(["bench-listener", prefix, &seconds.to_string()]);
    command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().map_err(failed)
}

fn samples_of(child: Child) -> Result<ListenerSamples, LatencyError> {
    let failed = |text: String| LatencyError::Listener(text);
    let output = child.wait_with_output().map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        return Err(failed(String::from_utf8_lossy(&output.stderr).trim().to_owned()));
    }
    serde_json::from_slice(&output.stdout).map_err(|error| failed(error.to_string()))
}

/// Times from `sent` to `received`, matched by their marks; marks up to `first` do not count.
fn latency(
    path: &'static str,
    first: u64,
    sent: &Samples,
    received: &Samples,
) -> Result<Latency, LatencyError> {
    let sent: Vec<(u64, u64)> = sent.iter().copied().filter(|(mark, _)| first < *mark).collect();
    let mut times = Vec::with_capacity(sent.len());
    let mut rest = received.iter().peekable();
    for &(mark, sent_ns) in &sent {
        while rest.next_if(|(other, _)| *other < mark).is_some() {}
        if let Some((_, received_ns)) = rest.next_if(|(other, _)| *other == mark) {
            times.push(1e-3 * real_of(received_ns.saturating_sub(sent_ns)));
        }
    }
    // Half of them: a path that loses more is broken, and its percentiles mean nothing.
    let expected = sent.len().div_ceil(2).max(1);
    if times.len() < expected {
        return Err(LatencyError::Silent { path, n: times.len(), expected });
    }
    Ok(percentiles(path, times, sent.len()))
}

/// The percentiles of `times` (us), out of `n_sent` samples.
fn percentiles(path: &str, mut times: Vec<Real>, n_sent: usize) -> Latency {
    times.sort_by(Real::total_cmp);
    let n = times.len();
    let at = |share: Real| {
        let rank = crate::base::real::count(share * real(n));
        times[rank.min(n) - 1]
    };
    Latency {
        path: path.to_owned(),
        n,
        n_lost: n_sent - n,
        p50_us: at(0.5),
        p99_us: at(0.99),
        p999_us: at(0.999),
        max_us: times[n - 1],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: computed by hand. Sample k takes k us; two are lost, one is among the first ones.
    #[test]
    fn percentiles_are_those_of_received_samples() {
        let sent: Samples = (1..=1003).map(|k| (k, 10_000 * k)).collect();
        let receive = |(mark, left): &(u64, u64)| (*mark, left + 1000 * (mark - 1));
        let received: Samples =
            sent.iter().filter(|(mark, _)| *mark != 500 && *mark != 501).map(receive).collect();
        let found = latency("path", 1, &sent, &received).unwrap();
        assert_eq!((found.n, found.n_lost), (1000, 2));
        let [p50, p99, p999] = [found.p50_us, found.p99_us, found.p999_us].map(|it| it.round());
        assert_eq!(format!("{p50} {p99} {p999} {}", found.max_us.round()), "502 992 1001 1002");
    }

    #[test]
    fn too_few_samples_are_an_error() {
        let sent: Samples = (1..=100).map(|k| (k, k)).collect();
        let error = latency("path", 0, &sent, &sent[..49].to_vec()).unwrap_err();
        assert!(matches!(error, LatencyError::Silent { n: 49, expected: 50, .. }), "{error}");
    }
}
