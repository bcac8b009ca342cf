//! ROS 2: the node, its publishers, subscriptions and services.

mod client; // identity of a service client
pub mod discovery; // the discovery range
mod discovery_info; // services in `ros_discovery_info`
pub mod node; // the node and its publishers
pub mod service; // service servers and action topics
pub mod subscribe; // commands from topics
