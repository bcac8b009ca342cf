//! `metadata.yaml` of a rosbag2 folder, version 9: what is in the recording.

use crate::wire::topics::{Qos, Topic};

/// What a recording holds.
#[derive(Clone, Debug, Default)]
pub(super) struct Contents {
    /// Messages of each topic, in the order of the topics.
    pub counts: Vec<u64>,
    /// Time of the first and of the last message [ns].
    pub times: Option<(u64, u64)>,
}

impl Contents {
    /// Of a recording without messages.
    pub(super) fn new(n_topics: usize) -> Self {
        Self { counts: vec![0; n_topics], times: None }
    }

    /// Takes note of a message.
    pub(super) fn add(&mut self, topic: usize, time_ns: u64) {
        self.counts[topic] += 1;
        let (first, last) = self.times.unwrap_or((time_ns, time_ns));
        self.times = Some((first.min(time_ns), last.max(time_ns)));
    }

    /// All messages.
    pub(super) fn n_messages(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// The text of `metadata.yaml`.
pub(super) fn file_text(topics: &[Topic], contents: &Contents, file_name: &str) -> String {
    format!(
        "rosbag2_bagfile_information:\n{}",
        indented(2, &information(topics, contents, file_name))
    )
}

/// The same without its outermost key, as the recording itself holds it.
pub(super) fn information(topics: &[Topic], contents: &Contents, file_name: &str) -> String {
    let (first, last) = contents.times.unwrap_or_default();
    let (duration, n_messages) = (last - first, contents.n_messages());
    // A JSON string is a YAML string too, whatever characters the folder's name has.
    let file_name = serde_json::Value::from(file_name);
    let topics: String = topics.iter().zip(&contents.counts).map(topic).collect();
    format!(
        "version: 9
storage_identifier: mcap
duration:
  nanoseconds: {duration}
starting_time:
  nanoseconds_since_epoch: {first}
message_count: {n_messages}
topics_with_message_count:
{topics}compression_format: \"\"
compression_mode: \"\"
relative_file_paths:
  - {file_name}
files:
  - path: {file_name}
    starting_time:
      nanoseconds_since_epoch: {first}
    duration:
      nanoseconds: {duration}
    message_count: {n_messages}
custom_data: ~
ros_distro: jazzy
"
    )
}

fn topic((topic, n_messages): (&Topic, &u64)) -> String {
    format!(
        "  - topic_metadata:
      name: {}
      type: {}
      serialization_format: cdr
      offered_qos_profiles:
{}      type_description_hash: {}
    message_count: {n_messages}
",
        topic.name,
        topic.type_name,
        indented(8, &qos_profiles(topic.qos)),
        topic.message_type.type_hash
    )
}

/// The quality of service as a list of one, in the words of rosbag2.
pub(super) fn qos_profiles(qos: Qos) -> String {
    // What rosbag2 writes for a time without limit.
    const FOREVER: &str = "sec: 9223372036\n    nsec: 854775807";
    let reliability = if qos.is_reliable { "reliable" } else { "best_effort" };
    let durability = if qos.is_latched { "transient_local" } else { "volatile" };
    format!(
        "- history: keep_last
  depth: {}
  reliability: {reliability}
  durability: {durability}
  deadline:
    {FOREVER}
  lifespan:
    {FOREVER}
  liveliness: automatic
  liveliness_lease_duration:
    {FOREVER}
  avoid_ros_namespace_conventions: false
",
        qos.depth
    )
}

fn indented(n_spaces: usize, text: &str) -> String {
    text.lines().map(|line| format!("{}{line}\n", " ".repeat(n_spaces))).collect()
}
