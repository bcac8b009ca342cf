//! Basic types: real numbers, ticks, random streams, digests, threads, SIMD lanes.

pub mod digest;
pub mod lanes;
pub mod parallel;
pub mod random;
pub mod real;
pub mod tick;

pub use real::{Mat3, Pose, Quat, Real, Vec3};
pub use tick::Tick;
