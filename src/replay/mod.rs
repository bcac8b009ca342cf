//! Playing, verifying and branching from recordings.

pub mod branch; // a new run from a recorded moment
pub mod compatibility; // which releases changed results
#[cfg(feature = "report")]
pub mod page; // an HTML page about a recording
#[cfg(feature = "report")]
mod page_data; // time series and events for the page
pub mod play; // publishes a recording with its original timing
pub mod player_command; // pause, seek, rate
#[cfg(feature = "ros")]
pub mod player_node; // publishes the recorded messages
#[cfg(feature = "ros")]
pub mod player_services; // the services of rosbag2's player
pub mod recorded_run; // a run set up from a recording
pub mod segment; // from one checkpoint to the next
pub mod verify; // compares the digest of every tick
pub mod workers; // segments in parallel

/// A time in seconds.
fn seconds(time_ns: u64) -> f64 {
    std::time::Duration::from_nanos(time_ns).as_secs_f64()
}
