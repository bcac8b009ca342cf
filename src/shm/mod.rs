//! Zero-copy streams in shared memory, over iceoryx2.

pub mod rows; // row types of the streams
pub mod stream; // the streams
