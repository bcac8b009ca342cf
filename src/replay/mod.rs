//! Recordings, run again.

pub mod again; // a run from what is in a recording
pub mod branch; // a new run from a recorded moment
pub mod crew; // parts of it side by side
pub mod cue; // what is wanted of one that plays
pub mod history; // which releases changed results
pub mod part; // from one checkpoint to the next
pub mod play; // publishes again with the original timing
#[cfg(feature = "ros")]
pub mod prompter; // services that give cues
#[cfg(feature = "ros")]
pub mod stage; // where played messages go
pub mod verify; // is every tick as it was?

/// A time for people [s].
fn seconds(time_ns: u64) -> f64 {
    std::time::Duration::from_nanos(time_ns).as_secs_f64()
}
