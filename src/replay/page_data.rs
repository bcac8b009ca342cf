//! The data of a page: time series of forces, pressure and heights, and events.

use std::{collections::BTreeMap, path::Path};

use crate::{
    bag::{
        OpenBagError,
        reader::{Channel, Item, Reader, RecordedMessage},
        writer::CDR_HEADER,
    },
    experiments::findings::{Kind, Plot, Series},
    wire::{
        messages::{
            RosMessage,
            geometry_msgs::{PoseStamped, WrenchStamped},
            jamgrip_msgs::{
                ObjectCommand, ObjectDetectionStatus, Statistics, VacuumState, WorldChange,
            },
            std_msgs::Float64,
        },
        topics::NODE,
    },
};

/// The data of a page.
#[derive(Debug, Default)]
pub(super) struct PageData {
    /// Full name of the node, once one of its topics was found.
    node: Option<String>,
    /// Time series by plot and label.
    curves: BTreeMap<(PlotKind, String), Vec<[f64; 2]>>,
    /// Events: simulation time (s) and text.
    pub(super) events: Vec<(f64, String)>,
    /// Damaged parts of the recording.
    pub(super) damages: Vec<String>,
    /// Total number of messages.
    pub(super) n_messages: u64,
    /// The last text of events that are only listed when they change.
    last: BTreeMap<&'static str, String>,
}

/// The plots, in the order of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum PlotKind {
    Force,
    Object,
    Pressure,
    Height,
    Packing,
    Speed,
}

impl PlotKind {
    fn title(self) -> &'static str {
        match self {
            Self::Force => "Force on the gripper",
            Self::Object => "Contact force on objects",
            Self::Pressure => "Gauge pressure in the gripper",
            Self::Height => "Heights",
            Self::Packing => "Packing",
            Self::Speed => "Real-time factor",
        }
    }

    fn y_label(self) -> &'static str {
        match self {
            Self::Force | Self::Object => "force [N]",
            Self::Pressure => "gauge pressure [kPa]",
            Self::Height => "height [mm]",
            Self::Packing => "fraction",
            Self::Speed => "real-time factor",
        }
    }
}

impl PageData {
    /// Reads a whole recording.
    ///
    /// # Errors
    /// If the path is not a recording.
    pub(super) fn read(path: &Path) -> Result<Self, OpenBagError> {
        let mut data = Self::default();
        for file in crate::bag::files(path)? {
            let reader = Reader::open(&file)
                .map_err(|error| OpenBagError::Unreadable { path: file.clone(), error })?;
            for item in reader {
                match item {
                    Item::Channel(channel) => data.find_node(&channel),
                    Item::Message(message) => data.add(&message),
                    Item::Damage(it) => data.damages.push(format!("{}: {it}", file.display())),
                    _ => {}
                }
            }
        }
        Ok(data)
    }

    /// The plots that have data.
    pub(super) fn plots(&self) -> Vec<Plot> {
        let mut plots: Vec<(PlotKind, Plot)> = Vec::new();
        for ((plot_kind, label), points) in &self.curves {
            let series = Series {
                label: label.clone(),
                kind: Kind::Line,
                points: points.clone(),
                deviations: Vec::new(),
            };
            match plots.last_mut() {
                Some((last, plot)) if last == plot_kind => plot.series.push(series),
                _ => plots.push((*plot_kind, empty_plot(*plot_kind, series))),
            }
        }
        plots.into_iter().map(|(_, plot)| crate::report::plot::reduced(plot)).collect()
    }

    /// Finds the name of the node, which may differ from the default, by two topics that no other
    /// node has.
    fn find_node(&mut self, channel: &Channel) {
        let known =
            [(Statistics::TYPE.name, "/statistics"), (VacuumState::TYPE.name, "/vacuum_state")];
        for (type_name, end) in known {
            if channel.type_name() == type_name
                && let Some(node) = channel.topic.strip_suffix(end)
            {
                self.node.get_or_insert(node.to_owned());
            }
        }
    }

    fn add(&mut self, message: &RecordedMessage) {
        self.n_messages += 1;
        let Some(cdr) = message.data.strip_prefix(&CDR_HEADER) else { return };
        if message.channel.type_name() == WorldChange::TYPE.name {
            return self.world_change(message.log_time, cdr);
        }
        let node = self.node.as_deref().unwrap_or(NODE);
        let Some(name) = message.channel.topic.strip_prefix(node) else { return };
        let time_s = seconds(message.log_time);
        match name {
            "/wrench" => self.force(PlotKind::Force, "objects on the gripper", time_s, cdr),
            "/flange/wrench" => self.force(PlotKind::Force, "gripper on its mount", time_s, cdr),
            "/flange/pose" => self.height("flange", time_s, cdr),
            "/vacuum_state" => self.vacuum_state(time_s, cdr),
            "/statistics" => self.statistics(time_s, cdr),
            "/vacuum_cmd" => self.vacuum_command(time_s, cdr),
            "/object_cmd" => self.object_command(time_s, cdr),
            "/object_detection_status" => {
                if let Ok(it) = ObjectDetectionStatus::from_cdr(cdr) {
                    self.detection(time_s, it.status);
                }
            }
            _ => self.object_message(name, time_s, cdr),
        }
    }

    fn object_message(&mut self, name: &str, time_s: f64, cdr: &[u8]) {
        let Some((object, rest)) = name.strip_prefix("/object/").and_then(|it| it.split_once('/'))
        else {
            return;
        };
        match rest {
            "pose" => self.height(object, time_s, cdr),
            "contact_wrench" => self.force(PlotKind::Object, object, time_s, cdr),
            _ => {}
        }
    }

    fn point(&mut self, plot_kind: PlotKind, label: &str, time_s: f64, value: f64) {
        self.curves.entry((plot_kind, label.to_owned())).or_default().push([time_s, value]);
    }

    /// Adds an event unless its text is the same as before.
    fn add_if_changed(&mut self, kind: &'static str, time_s: f64, text: String) {
        if self.last.get(kind) != Some(&text) {
            self.events.push((time_s, text.clone()));
            self.last.insert(kind, text);
        }
    }

    fn force(&mut self, plot_kind: PlotKind, label: &str, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = WrenchStamped::from_cdr(cdr) {
            self.point(plot_kind, &format!("{label}, z"), time_s, it.wrench.force.z);
        }
    }

    fn height(&mut self, label: &str, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = PoseStamped::from_cdr(cdr) {
            self.point(PlotKind::Height, label, time_s, 1e3 * it.pose.position.z);
        }
    }

    fn vacuum_state(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = VacuumState::from_cdr(cdr) else { return };
        self.point(PlotKind::Pressure, "actual", time_s, it.gauge / 1e3);
        self.point(PlotKind::Pressure, "commanded", time_s, it.gauge_setpoint / 1e3);
        self.point(PlotKind::Packing, "jammed fraction", time_s, it.jammed_fraction);
        self.point(PlotKind::Packing, "solid fraction", time_s, it.solid_fraction);
        self.point(PlotKind::Packing, "sliding fraction", time_s, it.sliding_fraction);
    }

    fn statistics(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = Statistics::from_cdr(cdr) else { return };
        self.point(PlotKind::Speed, "last second", time_s, it.real_time_factor);
        if !it.phase.is_empty() {
            self.add_if_changed("phase", time_s, format!("phase {}", it.phase));
        }
        if !it.is_valid {
            self.add_if_changed(
                "validity",
                time_s,
                "grains overlap too much for the model".to_owned(),
            );
        }
    }

    fn vacuum_command(&mut self, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = Float64::from_cdr(cdr) {
            let text = format!("command: gauge pressure {} kPa", it.data / 1e3);
            self.add_if_changed("vacuum", time_s, text);
        }
    }

    fn world_change(&mut self, time_ns: u64, cdr: &[u8]) {
        if let Ok(it) = WorldChange::from_cdr(cdr) {
            let text = format!("world changed: {}", it.what);
            self.events.push((seconds(time_ns), text));
        }
    }

    fn object_command(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = ObjectCommand::from_cdr(cdr) else { return };
        let verb = if it.mode == ObjectCommand::MODE_RELEASE { "release" } else { "drive" };
        self.add_if_changed("object", time_s, format!("command: {verb} {}", it.object));
    }

    fn detection(&mut self, time_s: f64, status: i8) {
        let text = match status {
            ObjectDetectionStatus::OBJECT_DETECTED_AT_MIN_PRESSURE => {
                "object detected, vacuum builds up"
            }
            ObjectDetectionStatus::OBJECT_DETECTED_AT_MAX_PRESSURE => {
                "object detected, full vacuum"
            }
            ObjectDetectionStatus::NO_OBJECT_DETECTED => "nothing touches the gripper",
            _ => "touched but not gripped",
        };
        self.add_if_changed("detection", time_s, text.to_owned());
    }
}

fn seconds(time_ns: u64) -> f64 {
    std::time::Duration::from_nanos(time_ns).as_secs_f64()
}

fn empty_plot(plot_kind: PlotKind, first: Series) -> Plot {
    Plot {
        title: plot_kind.title().to_owned(),
        source_says: String::new(),
        x_label: "simulation time [s]".to_owned(),
        y_label: plot_kind.y_label().to_owned(),
        log_x: false,
        log_y: false,
        series: vec![first],
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::bag::reader::Schema;

    fn message(topic: &str, type_name: &str, cdr: &[u8]) -> RecordedMessage {
        let (name, encoding) = (type_name.to_owned(), "ros2msg".to_owned());
        let schema = Some(Arc::new(Schema { id: 1, name, encoding, data: Vec::new() }));
        let (topic, encoding) = (topic.to_owned(), "cdr".to_owned());
        let channel = Channel { id: 1, topic, encoding, metadata: BTreeMap::new(), schema };
        let data = [&CDR_HEADER[..], cdr].concat();
        let channel = Arc::new(channel);
        RecordedMessage { channel, sequence: 0, log_time: 5_000_000, publish_time: 5_000_000, data }
    }

    /// Oracle: the same messages from a node with the default name.
    #[test]
    fn a_renamed_node_gives_the_same_plots() {
        let data = |node: &str| {
            let wrench = WrenchStamped::default().to_cdr();
            let messages = [
                message(
                    &format!("{node}/vacuum_state"),
                    VacuumState::TYPE.name,
                    &VacuumState::default().to_cdr(),
                ),
                message(&format!("{node}/wrench"), WrenchStamped::TYPE.name, &wrench),
                message("/someone_else/wrench", WrenchStamped::TYPE.name, &wrench),
                message(
                    "/jamgrip/world_change",
                    WorldChange::TYPE.name,
                    &WorldChange::default().to_cdr(),
                ),
            ];
            let mut data = PageData::default();
            messages.iter().for_each(|it| data.find_node(&it.channel));
            messages.iter().for_each(|it| data.add(it));
            (data.plots(), data.events)
        };
        let (plots, events) = data("/left/grip");
        let titles: Vec<&str> = plots.iter().map(|it| it.title.as_str()).collect();
        assert_eq!(titles, ["Force on the gripper", "Gauge pressure in the gripper", "Packing"]);
        assert_eq!(plots[0].series[0].points.len(), 1, "topics of other nodes are not drawn");
        assert_eq!(events.len(), 1);
        assert_eq!(format!("{plots:?}"), format!("{:?}", data("/jamgrip").0));
    }
}
