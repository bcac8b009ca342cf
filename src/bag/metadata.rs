//! `metadata.yaml` of a rosbag2 folder, version 9.

use crate::wire::topics::{Qos, Topic};

/// The contents of a file of a recording.
#[derive(Clone, Debug, Default)]
pub struct FileContents {
    /// Name of the file.
    pub file: String,
    /// Number of messages on each topic, in the order of the topics.
    pub counts: Vec<u64>,
    /// Times of the first and last message (ns).
    pub times: Option<(u64, u64)>,
}

impl FileContents {
    /// A file without messages.
    pub fn new(file: String, n_topics: usize) -> Self {
        Self { file, counts: vec![0; n_topics], times: None }
    }

    /// Counts a message.
    pub fn add(&mut self, topic: usize, time_ns: u64) {
        self.counts[topic] += 1;
        let (first, last) = self.times.unwrap_or((time_ns, time_ns));
        self.times = Some((first.min(time_ns), last.max(time_ns)));
    }

    /// Total number of messages.
    pub fn n_messages(&self) -> u64 {
        self.counts.iter().sum()
    }
}

/// An entry of `metadata.yaml` about a topic.
#[derive(Clone, Debug)]
pub struct TopicMetadata {
    /// Name.
    pub name: String,
    /// Type, such as `std_msgs/msg/String`.
    pub type_name: String,
    /// Encoding of the messages.
    pub encoding: String,
    /// List of QoS profiles as YAML; empty if unknown.
    pub qos: String,
    /// Hash of the type description; empty if unknown.
    pub type_hash: String,
}

impl TopicMetadata {
    /// The entry of one of our topics.
    pub fn of(topic: &Topic) -> Self {
        Self {
            name: topic.name.clone(),
            type_name: topic.message_type.name.to_owned(),
            encoding: "cdr".to_owned(),
            qos: qos_profiles(topic.qos),
            type_hash: topic.message_type.type_hash.to_owned(),
        }
    }
}

/// The text of `metadata.yaml`.
pub fn file_text(rows: &[TopicMetadata], files: &[FileContents]) -> String {
    format!("rosbag2_bagfile_information:\n{}", indented(2, &information(rows, files)))
}

/// The same without the outermost key, as stored in the recording itself.
pub fn information(rows: &[TopicMetadata], files: &[FileContents]) -> String {
    let starts = files.iter().filter_map(|it| Some(it.times?.0));
    let ends = files.iter().filter_map(|it| Some(it.times?.1));
    let (first, last) = (starts.min().unwrap_or(0), ends.max().unwrap_or(0));
    let n_messages: u64 = files.iter().map(FileContents::n_messages).sum();
    let total = |i: usize| files.iter().map(|file| file.counts[i]).sum::<u64>();
    let topics: String = rows.iter().enumerate().map(|(i, row)| topic(row, total(i))).collect();
    let topics = if topics.is_empty() { " []\n".to_owned() } else { format!("\n{topics}") };
    let names: String = files.iter().map(|it| format!("  - {}\n", quoted(&it.file))).collect();
    let files: String = files.iter().map(file).collect();
    format!(
        "version: 9
storage_identifier: mcap
duration:
  nanoseconds: {}
starting_time:
  nanoseconds_since_epoch: {first}
message_count: {n_messages}
topics_with_message_count:{topics}compression_format: \"\"
compression_mode: \"\"
relative_file_paths:
{names}files:
{files}custom_data: ~
ros_distro: jazzy
",
        last - first
    )
}

/// Quotes a text as a JSON string, which is also a YAML string.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn file(contents: &FileContents) -> String {
    let (first, last) = contents.times.unwrap_or_default();
    format!(
        "  - path: {}
    starting_time:
      nanoseconds_since_epoch: {first}
    duration:
      nanoseconds: {}
    message_count: {}
",
        quoted(&contents.file),
        last - first,
        contents.n_messages()
    )
}

fn topic(row: &TopicMetadata, n_messages: u64) -> String {
    let qos = match row.qos.as_str() {
        "" => " []\n".to_owned(),
        text => format!("\n{}", indented(8, text)),
    };
    format!(
        "  - topic_metadata:
      name: {}
      type: {}
      serialization_format: {}
      offered_qos_profiles:{qos}      type_description_hash: {}
    message_count: {n_messages}
",
        row.name,
        row.type_name,
        row.encoding,
        if row.type_hash.is_empty() { "\"\"" } else { &row.type_hash }
    )
}

/// The QoS profile as a list with one entry, with the names of rosbag2.
pub fn qos_profiles(qos: Qos) -> String {
    // rosbag2 writes this for an unlimited time.
    const UNLIMITED: &str = "sec: 9223372036\n    nsec: 854775807";
    let reliability = if qos.is_reliable { "reliable" } else { "best_effort" };
    let durability = if qos.is_latched { "transient_local" } else { "volatile" };
    format!(
        "- history: keep_last
  depth: {}
  reliability: {reliability}
  durability: {durability}
  deadline:
    {UNLIMITED}
  lifespan:
    {UNLIMITED}
  liveliness: automatic
  liveliness_lease_duration:
    {UNLIMITED}
  avoid_ros_namespace_conventions: false
",
        qos.depth
    )
}

fn indented(n_spaces: usize, text: &str) -> String {
    text.lines().map(|line| format!("{}{line}\n", " ".repeat(n_spaces))).collect()
}

/// QoS profiles with the names of version 9. Recordings of other programs may use the numbers of
/// older versions. Returns an empty text if the input is not a list.
pub fn qos_with_names(text: &str) -> String {
    if !text.trim_start().starts_with('-') {
        return String::new();
    }
    let with_names = |line: &str| {
        let Some((key, value)) = line.split_once(": ") else { return format!("{line}\n") };
        let name = match value.trim().parse() {
            Ok(number) => name_of(key.trim_start_matches(['-', ' ']), number),
            Err(_) => None,
        };
        format!("{key}: {}\n", name.unwrap_or(value))
    };
    text.lines().map(with_names).collect()
}

/// The name of a value of rmw's enumerations.
fn name_of(key: &str, number: usize) -> Option<&'static str> {
    let names: &[&str] = match key {
        "history" => &["system_default", "keep_last", "keep_all", "unknown"],
        "reliability" => {
            &["system_default", "reliable", "best_effort", "unknown", "best_available"]
        }
        "durability" => {
            &["system_default", "transient_local", "volatile", "unknown", "best_available"]
        }
        "liveliness" => &[
            "system_default",
            "automatic",
            "manual_by_node",
            "manual_by_topic",
            "unknown",
            "best_available",
        ],
        _ => return None,
    };
    names.get(number).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: rmw/types.h, which defines the enumerations.
    #[test]
    fn numbers_of_older_versions_become_names() {
        let old = "- history: 3\n  depth: 0\n  reliability: 1\n  durability: 2\n  liveliness: 1\n";
        let new = "- history: unknown\n  depth: 0\n  reliability: reliable\n  \
                   durability: volatile\n  liveliness: automatic\n";
        assert_eq!(qos_with_names(old), new);
        assert_eq!(qos_with_names(new), new);
        assert_eq!(qos_with_names(""), "");
        assert_eq!(qos_with_names("{}"), "");
    }
}
