//! What a recording shows over time: forces, pressure, heights, and what happened when.

use std::{collections::BTreeMap, path::Path};

use crate::{
    bag::{
        NotABag,
        reader::{Channel, Item, Reader, Recorded},
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

/// What a page shows.
#[derive(Debug, Default)]
pub(super) struct Course {
    /// Full name of the node, once one of its topics was met.
    node: Option<String>,
    /// Curves by picture and label.
    curves: BTreeMap<(Picture, String), Vec<[f64; 2]>>,
    /// What happened: simulated time (s) and what.
    pub(super) events: Vec<(f64, String)>,
    /// What is wrong with the recording.
    pub(super) damages: Vec<String>,
    /// Messages of all kinds.
    pub(super) n_messages: u64,
    /// The last of what is told only when it changes.
    last: BTreeMap<&'static str, String>,
}

/// The pictures, in the order of the page.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Picture {
    Force,
    Object,
    Pressure,
    Height,
    Packing,
    Speed,
}

impl Picture {
    fn title(self) -> &'static str {
        match self {
            Self::Force => "Force on the gripper",
            Self::Object => "Contact force on objects",
            Self::Pressure => "Gauge pressure in the bag",
            Self::Height => "Heights",
            Self::Packing => "Packing",
            Self::Speed => "Simulated over wall time",
        }
    }

    fn y_label(self) -> &'static str {
        match self {
            Self::Force | Self::Object => "force [N]",
            Self::Pressure => "gauge pressure [kPa]",
            Self::Height => "height [mm]",
            Self::Packing => "share",
            Self::Speed => "real-time factor",
        }
    }
}

impl Course {
    /// Reads all of a recording.
    ///
    /// # Errors
    /// If there is none.
    pub(super) fn read(path: &Path) -> Result<Self, NotABag> {
        let mut course = Self::default();
        for file in crate::bag::files(path)? {
            let reader = Reader::open(&file)
                .map_err(|fault| NotABag::Unreadable { path: file.clone(), fault })?;
            for item in reader {
                match item {
                    Item::Channel(channel) => course.meet(&channel),
                    Item::Message(message) => course.take(&message),
                    Item::Damage(it) => course.damages.push(format!("{}: {it}", file.display())),
                    _ => {}
                }
            }
        }
        Ok(course)
    }

    /// The pictures that have anything to show.
    pub(super) fn plots(&self) -> Vec<Plot> {
        let mut plots: Vec<(Picture, Plot)> = Vec::new();
        for ((picture, label), points) in &self.curves {
            let series = Series {
                label: label.clone(),
                kind: Kind::Line,
                points: points.clone(),
                deviations: Vec::new(),
            };
            match plots.last_mut() {
                Some((last, plot)) if last == picture => plot.series.push(series),
                _ => plots.push((*picture, empty_plot(*picture, series))),
            }
        }
        plots.into_iter().map(|(_, plot)| crate::report::plot::reduced(plot)).collect()
    }

    /// A node may have another name than usual: two topics that no other node has tell it.
    fn meet(&mut self, channel: &Channel) {
        let own =
            [(Statistics::TYPE.name, "/statistics"), (VacuumState::TYPE.name, "/vacuum_state")];
        for (type_name, end) in own {
            if channel.type_name() == type_name
                && let Some(node) = channel.topic.strip_suffix(end)
            {
                self.node.get_or_insert(node.to_owned());
            }
        }
    }

    fn take(&mut self, message: &Recorded) {
        self.n_messages += 1;
        let Some(cdr) = message.data.strip_prefix(&CDR_HEADER) else { return };
        if message.channel.type_name() == WorldChange::TYPE.name {
            return self.world_change(message.log_time, cdr);
        }
        let node = self.node.as_deref().unwrap_or(NODE);
        let Some(name) = message.channel.topic.strip_prefix(node) else { return };
        let time_s = seconds(message.log_time);
        match name {
            "/wrench" => self.force(Picture::Force, "objects on the gripper", time_s, cdr),
            "/flange/wrench" => self.force(Picture::Force, "gripper on its mount", time_s, cdr),
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
            _ => self.of_object(name, time_s, cdr),
        }
    }

    fn of_object(&mut self, name: &str, time_s: f64, cdr: &[u8]) {
        let Some((object, rest)) = name.strip_prefix("/object/").and_then(|it| it.split_once('/'))
        else {
            return;
        };
        match rest {
            "pose" => self.height(object, time_s, cdr),
            "contact_wrench" => self.force(Picture::Object, object, time_s, cdr),
            _ => {}
        }
    }

    fn point(&mut self, picture: Picture, label: &str, time_s: f64, value: f64) {
        self.curves.entry((picture, label.to_owned())).or_default().push([time_s, value]);
    }

    /// Tells of something unless it is as it was.
    fn change(&mut self, kind: &'static str, time_s: f64, text: String) {
        if self.last.get(kind) != Some(&text) {
            self.events.push((time_s, text.clone()));
            self.last.insert(kind, text);
        }
    }

    fn force(&mut self, picture: Picture, label: &str, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = WrenchStamped::from_cdr(cdr) {
            self.point(picture, &format!("{label}, z"), time_s, it.wrench.force.z);
        }
    }

    fn height(&mut self, label: &str, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = PoseStamped::from_cdr(cdr) {
            self.point(Picture::Height, label, time_s, 1e3 * it.pose.position.z);
        }
    }

    fn vacuum_state(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = VacuumState::from_cdr(cdr) else { return };
        self.point(Picture::Pressure, "actual", time_s, it.gauge / 1e3);
        self.point(Picture::Pressure, "commanded", time_s, it.gauge_setpoint / 1e3);
        self.point(Picture::Packing, "jammed fraction", time_s, it.jammed_fraction);
        self.point(Picture::Packing, "solid fraction", time_s, it.solid_fraction);
        self.point(Picture::Packing, "sliding fraction", time_s, it.sliding_fraction);
    }

    fn statistics(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = Statistics::from_cdr(cdr) else { return };
        self.point(Picture::Speed, "last second", time_s, it.real_time_factor);
        if !it.phase.is_empty() {
            self.change("phase", time_s, format!("phase {}", it.phase));
        }
        if !it.is_valid {
            self.change("validity", time_s, "grains overlap too much for the model".to_owned());
        }
    }

    fn vacuum_command(&mut self, time_s: f64, cdr: &[u8]) {
        if let Ok(it) = Float64::from_cdr(cdr) {
            let text = format!("command: gauge pressure {} kPa", it.data / 1e3);
            self.change("vacuum", time_s, text);
        }
    }

    fn world_change(&mut self, time_ns: u64, cdr: &[u8]) {
        if let Ok(it) = WorldChange::from_cdr(cdr) {
            let text = format!("changed from outside: {}", it.what);
            self.events.push((seconds(time_ns), text));
        }
    }

    fn object_command(&mut self, time_s: f64, cdr: &[u8]) {
        let Ok(it) = ObjectCommand::from_cdr(cdr) else { return };
        let verb = if it.mode == ObjectCommand::MODE_RELEASE { "release" } else { "drive" };
        self.change("object", time_s, format!("command: {verb} {}", it.object));
    }

    fn detection(&mut self, time_s: f64, status: i8) {
        let text = match status {
            ObjectDetectionStatus::OBJECT_DETECTED_AT_MIN_PRESSURE => {
                "object detected, vacuum builds up"
            }
            ObjectDetectionStatus::OBJECT_DETECTED_AT_MAX_PRESSURE => {
                "object detected, full vacuum"
            }
            ObjectDetectionStatus::NO_OBJECT_DETECTED => "nothing touches the bag",
            _ => "touched, but not gripped",
        };
        self.change("detection", time_s, text.to_owned());
    }
}

fn seconds(time_ns: u64) -> f64 {
    std::time::Duration::from_nanos(time_ns).as_secs_f64()
}

fn empty_plot(picture: Picture, first: Series) -> Plot {
    Plot {
        title: picture.title().to_owned(),
        source_says: String::new(),
        x_label: "simulated time [s]".to_owned(),
        y_label: picture.y_label().to_owned(),
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

    fn message(topic: &str, type_name: &str, cdr: &[u8]) -> Recorded {
        let (name, encoding) = (type_name.to_owned(), "ros2msg".to_owned());
        let schema = Some(Arc::new(Schema { id: 1, name, encoding, data: Vec::new() }));
        let (topic, encoding) = (topic.to_owned(), "cdr".to_owned());
        let channel = Channel { id: 1, topic, encoding, metadata: BTreeMap::new(), schema };
        let data = [&CDR_HEADER[..], cdr].concat();
        let channel = Arc::new(channel);
        Recorded { channel, sequence: 0, log_time: 5_000_000, publish_time: 5_000_000, data }
    }

    /// Oracle: the same messages of a node that has its usual name.
    #[test]
    fn a_renamed_node_is_drawn_like_any_other() {
        let course = |node: &str| {
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
            let mut course = Course::default();
            messages.iter().for_each(|it| course.meet(&it.channel));
            messages.iter().for_each(|it| course.take(it));
            (course.plots(), course.events)
        };
        let (plots, events) = course("/left/grip");
        let titles: Vec<&str> = plots.iter().map(|it| it.title.as_str()).collect();
        assert_eq!(titles, ["Force on the gripper", "Gauge pressure in the bag", "Packing"]);
        assert_eq!(plots[0].series[0].points.len(), 1, "what is on others' topics is not drawn");
        assert_eq!(events.len(), 1);
        assert_eq!(format!("{plots:?}"), format!("{:?}", course("/jamgrip").0));
    }
}
