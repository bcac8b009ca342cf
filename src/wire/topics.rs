//! The closed list of topics, and messages encoded once for all who carry them.

/// A ROS 2 topic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Full name, such as `/jamgrip/wrench`.
    pub name: String,
    /// ROS 2 type, such as `geometry_msgs/msg/WrenchStamped`.
    pub type_name: &'static str,
    /// How it is offered.
    pub qos: Qos,
    /// True for topics that carry commands to us.
    pub is_input: bool,
}

/// Quality of service, as far as we use it. History is always keep-last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Qos {
    /// Reliable, else best effort.
    pub is_reliable: bool,
    /// Depth of the history.
    pub depth: u32,
    /// Transient local (latched), else volatile.
    pub is_latched: bool,
}

/// One message, encoded once: ROS 2 and bags carry the same bytes.
#[derive(Clone, Debug)]
pub struct Message {
    /// Index into the list of topics.
    pub topic: usize,
    /// Simulated time [ns].
    pub time_ns: u64,
    /// The body in CDR, little endian, without the four bytes that name the encoding.
    pub cdr: Vec<u8>,
}
