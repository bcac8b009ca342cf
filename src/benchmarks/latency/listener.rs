//! The other process: it subscribes to ticks over ROS 2 and in shared memory, and publishes
//! commands.

use std::{
    error::Error,
    sync::atomic::{AtomicBool, Ordering},
    thread,
    time::Duration,
};

use serde::{Deserialize, Serialize};

use super::discovery_range;
use crate::{
    base::Real,
    benchmarks::lift,
    host::clock::{Stopwatch, wall_ns},
    ros::node::{Body, RosNode},
    shm::stream::Services,
    wire::{
        messages::{RosMessage, rosgraph_msgs::Clock, std_msgs::Float64},
        topics::{CommonTopic, Topic, topics},
    },
};

/// Numbers of samples, and the wall-clock times at which they were sent or received (ns).
pub(super) type Samples = Vec<(u64, u64)>;

/// Time between two commands: not a multiple of a tick, so that they arrive at all times within a
/// tick.
const COMMAND_EVERY: Duration = Duration::from_micros(10_300);
/// Polling interval of ROS 2, which adds to the measured latency.
const POLL_EVERY: Duration = Duration::from_micros(20);
/// Timeout of discovery (s).
const TIMEOUT: Real = 30.0;
/// Time for which it still listens after the run (s).
const MARGIN: Real = 1.0;

/// All samples of the listener.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct ListenerSamples {
    /// Ticks received over ROS 2.
    pub(super) ros: Samples,
    /// Ticks received in shared memory.
    pub(super) stream: Samples,
    /// Published commands, by their numbers.
    pub(super) commands: Samples,
}

/// The number of the command with this gauge pressure (Pa).
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "whole numbers of pascals that `pressure` made"
)]
pub(super) fn number(gauge_pa: f64) -> u64 {
    (-gauge_pa).round().max(0.0) as u64
}

/// The gauge pressure of the command with this number (Pa).
fn pressure(number: u32) -> f64 {
    -f64::from(number)
}

/// Subscribes to the run whose streams have `prefix`, publishes commands for `seconds` (s), and
/// returns all samples as JSON.
///
/// # Errors
/// If there is no such run.
pub fn listen(prefix: &str, seconds: Real) -> Result<String, Box<dyn Error + Send + Sync>> {
    let topics = topics(&lift::scene(&[]).map_err(|error| error.to_string())?);
    let [clock, vacuum] =
        [CommonTopic::Clock, CommonTopic::VacuumCommand].map(|it| &topics[it as usize]);
    let node = RosNode::join_as("listener", &discovery_range())?;
    let is_over = AtomicBool::new(false);
    let samples = thread::scope(|scope| {
        let stream = scope.spawn(|| stream(prefix, &is_over));
        let ros = scope.spawn(|| ros(&node, clock, &is_over));
        let commands = command(&node, [clock, vacuum], seconds);
        is_over.store(true, Ordering::Relaxed);
        let joined = "a panic is a bug in this program";
        Ok::<_, Box<dyn Error + Send + Sync>>(ListenerSamples {
            ros: ros.join().expect(joined)?,
            stream: stream.join().expect(joined)?,
            commands: commands?,
        })
    });
    Ok(serde_json::to_string(&samples?)?)
}

fn stream(prefix: &str, is_over: &AtomicBool) -> Result<Samples, Box<dyn Error + Send + Sync>> {
    let services = Services::join(prefix)?;
    let tick = services.tick()?.listener_builder().create()?;
    let states = services.state()?.subscriber_builder().create()?;
    let mut samples = Samples::new();
    while !is_over.load(Ordering::Relaxed) {
        tick.timed_wait(|_| (), Duration::from_millis(100))?;
        while let Some(sample) = states.receive()? {
            samples.push((sample.time_ns, wall_ns()));
        }
    }
    Ok(samples)
}

fn ros(
    node: &RosNode,
    clock: &Topic,
    is_over: &AtomicBool,
) -> Result<Samples, Box<dyn Error + Send + Sync>> {
    let clock = node.subscription::<Clock>(clock)?;
    let mut samples = Samples::new();
    while !is_over.load(Ordering::Relaxed) {
        while let Some((message, _)) = clock.take().map_err(|error| error.to_string())? {
            let at = wall_ns();
            let (sec, nanosec) = (message.clock.sec, message.clock.nanosec);
            let sec = u64::try_from(sec).unwrap_or(0);
            samples.push((sec * 1_000_000_000 + u64::from(nanosec), at));
        }
        thread::sleep(POLL_EVERY);
    }
    Ok(samples)
}

/// Publishes commands for `seconds` (s), then waits for the end of the run.
fn command(
    node: &RosNode,
    [clock, topic]: [&Topic; 2],
    seconds: Real,
) -> Result<Samples, Box<dyn Error + Send + Sync>> {
    let publisher = node.publisher(topic)?;
    let watch = Stopwatch::start();
    while node.n_readers(&topic.name) == 0 || node.n_writers(&clock.name) == 0 {
        if TIMEOUT < watch.total_s() {
            return Err(format!("no subscriber of {} after 30 s", topic.name).into());
        }
        thread::sleep(COMMAND_EVERY);
    }
    let mut samples = Samples::new();
    let watch = Stopwatch::start();
    let mut number = 0;
    while watch.total_s() < seconds + MARGIN {
        // Commands after the end of the run would count as lost.
        if watch.total_s() < seconds - MARGIN {
            number += 1;
            samples.push((u64::from(number), wall_ns()));
            let body = Body::new(Float64 { data: pressure(number) }.to_cdr());
            publisher.publish(body).map_err(|error| error.to_string())?;
        }
        thread::sleep(COMMAND_EVERY);
    }
    Ok(samples)
}
