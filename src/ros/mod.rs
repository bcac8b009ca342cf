//! ROS 2: the node, its publishers, subscriptions and services.

mod client; // service clients
pub mod discovery; // the discovery range
mod discovery_info; // services in `ros_discovery_info`
pub mod node; // the node and its publishers
pub mod service; // service servers and action topics
pub mod subscribe; // commands from topics
pub(crate) mod worker; // a thread that runs asynchronous tasks
