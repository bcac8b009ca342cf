//! Opens the connections that a scene enables: recording, streams, ROS 2. A connection whose feature
//! is missing is an error that names the feature.

#[cfg(feature = "bag")]
use std::time::Duration;
use std::{
    path::Path,
    sync::{Arc, atomic::AtomicU64},
};

use super::{launch::RunError, outputs::OutputSinks, server::SimulationServer};
use crate::host::progress_bar::Progress;
#[cfg(feature = "bag")]
use crate::{bag::recording::INPUTS, cosim::compile::PHYSICS_VERSION, scene::Shape};
use crate::{
    io::source::Source,
    scene::{Controller, OnError, Scene},
    wire::to_ros::Encoder,
};

/// Lengths of the lists that are streamed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sizes {
    /// Number of grains.
    pub(super) n_grains: usize,
    /// Number of vertices of the membrane.
    pub(super) n_vertices: usize,
}

/// Opens the connections of a scene. One that cannot be opened is logged and skipped, unless the
/// run depends on it.
pub(super) struct Connections<'a> {
    /// The scene.
    pub(super) scene: &'a Arc<Scene>,
    /// Its file.
    #[cfg_attr(
        not(feature = "ros"),
        expect(dead_code, reason = "only ROS 2 clients load other scenes")
    )]
    pub(super) scene_file: &'a Path,
    /// Encodes the messages of all connections.
    #[cfg_attr(
        not(any(feature = "ros", feature = "bag")),
        expect(dead_code, reason = "without them no messages are sent")
    )]
    pub(super) encoder: &'a Arc<Encoder>,
    /// Shows messages.
    pub(super) progress: &'a Progress,
    /// Length of a substep (s).
    #[cfg_attr(not(feature = "bag"), expect(dead_code, reason = "only recordings hold it"))]
    pub(super) substep_s: f64,
    /// Additional metadata for the recording.
    #[cfg_attr(not(feature = "bag"), expect(dead_code, reason = "only recordings hold it"))]
    pub(super) facts: &'a [(&'static str, String)],
}

/// Why the ROS 2 node could not be started.
#[derive(Debug, thiserror::Error)]
pub(super) enum ConnectError {
    /// The scene disables it.
    #[error("`outputs.ros.enabled` is false")]
    Disabled,
    /// Built without it.
    #[cfg(not(feature = "ros"))]
    #[error("ROS 2 needs a build with feature `ros`")]
    NoFeature,
    /// The environment selects no usable discovery range.
    #[cfg(feature = "ros")]
    #[error(transparent)]
    Range(#[from] crate::ros::discovery::DiscoveryRangeError),
    /// The node or one of its entities could not be created.
    #[cfg(feature = "ros")]
    #[error(transparent)]
    Ros(#[from] crate::ros::node::RosError),
    /// A sink could not be started.
    #[cfg(feature = "ros")]
    #[error("cannot start the thread of a sink: {0}")]
    Sink(#[from] std::io::Error),
}

/// External inputs of a run.
#[derive(Default)]
pub struct ExternalInputs {
    /// Sources of commands.
    pub sources: Vec<Box<dyn Source>>,
    /// The service server.
    pub server: Option<SimulationServer>,
    /// Time of another simulator (ns), if the run follows its clock.
    pub clock: Option<Arc<AtomicU64>>,
}

impl Connections<'_> {
    /// Opens all connections.
    ///
    /// # Errors
    /// If a connection fails that the run depends on.
    pub(super) fn open(&self, sizes: Sizes) -> Result<(OutputSinks, ExternalInputs), RunError> {
        let mut outputs = OutputSinks::default();
        if self.scene.outputs.bag.enabled {
            self.open_bag(&mut outputs)?;
        }
        if self.scene.outputs.stream {
            self.open_stream(&mut outputs, sizes);
        }
        let mut external = ExternalInputs::default();
        let opened = if self.scene.outputs.ros.enabled {
            self.open_ros(&mut outputs, &mut external)
        } else {
            Err(ConnectError::Disabled)
        };
        match opened {
            Err(reason) if matches!(self.scene.controller, Controller::Topics { .. }) => {
                return Err(RunError::NoTopics(reason.to_string()));
            }
            Err(reason) if self.scene.outputs.ros.enabled => {
                self.progress.say(&format!("{reason}; the run continues without ROS 2"));
            }
            _ => {}
        }
        Ok((outputs, external))
    }

    #[cfg(feature = "bag")]
    fn open_bag(&self, outputs: &mut OutputSinks) -> Result<(), RunError> {
        use crate::bag::sink::Bag;

        let subject = self.subject();
        let folder = self.bag_folder();
        let opened = Bag::create(&folder, Arc::clone(self.encoder), subject)
            .map_err(|error| error.to_string())
            .and_then(|bag| {
                let added = outputs.fanout.add(Box::new(bag), self.bag_delivery());
                added.map_err(|error| error.to_string())
            });
        match (opened, self.scene.outputs.bag.on_error) {
            (Ok(()), on_error) => {
                outputs.bag = Some(folder);
                outputs.stops_with_bag = on_error == OnError::Stop;
            }
            (Err(reason), OnError::Stop) => return Err(RunError::Recording(reason)),
            (Err(reason), OnError::Continue) => {
                self.progress.say(&format!("{reason}; the run continues without a recording"));
            }
        }
        Ok(())
    }

    #[cfg(not(feature = "bag"))]
    fn open_bag(&self, _outputs: &mut OutputSinks) -> Result<(), RunError> {
        let reason = "recordings need a build with feature `bag`".to_owned();
        if self.scene.outputs.bag.on_error == OnError::Stop {
            return Err(RunError::Recording(reason));
        }
        self.progress.say(&reason);
        Ok(())
    }

    /// Describes the run in the recording, so that it can be simulated again.
    #[cfg(feature = "bag")]
    fn subject(&self) -> crate::bag::RunDescription {
        let bag = &self.scene.outputs.bag;
        let whole_ns = |time: f64| Duration::from_secs_f64(time).as_nanos();
        let format = crate::bag::Format {
            compression: bag.compression,
            split_bytes: bag.split_size.map(|mebibytes| mebibytes << 20),
            split_ns: bag.split_duration.map(|it| u64::try_from(whole_ns(it)).unwrap_or(u64::MAX)),
        };
        let mut facts = vec![
            ("seed", self.scene.seed.to_string()),
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("commit", option_env!("JAMGRIP_COMMIT").unwrap_or("unknown").to_owned()),
            ("physics", PHYSICS_VERSION.to_string()),
            ("tick_ns", self.scene.time.tick_ns.to_string()),
            ("substep_s", format!("{:e}", self.substep_s)),
            ("machine", format!("{} {}", std::env::consts::OS, std::env::consts::ARCH)),
        ];
        let inputs = self.encoder.topics().iter().filter(|it| it.is_input);
        let inputs: Vec<&str> = inputs.map(|it| it.name.as_str()).collect();
        facts.push((INPUTS, serde_json::json!(inputs).to_string()));
        facts.extend_from_slice(self.facts);
        let scene_text = crate::scene::to_yaml(self.scene);
        crate::bag::RunDescription { scene_text, scene_files: self.scene_files(), facts, format }
    }

    /// The mesh files of the scene. One that can no longer be read is logged and skipped.
    #[cfg(feature = "bag")]
    fn scene_files(&self) -> Vec<(String, Vec<u8>)> {
        let mut files = Vec::new();
        for object in &self.scene.objects {
            let Shape::Mesh { file, .. } = &object.shape else { continue };
            match std::fs::read(file) {
                Ok(bytes) => {
                    let name = file.file_name().unwrap_or_default().to_string_lossy();
                    files.push((name.into_owned(), bytes));
                }
                Err(error) => {
                    let path = file.display();
                    self.progress.say(&format!("{path}: not stored in the recording: {error}"));
                }
            }
        }
        files
    }

    #[cfg(feature = "bag")]
    fn bag_folder(&self) -> std::path::PathBuf {
        let chosen = self.scene.outputs.bag.folder.clone();
        chosen.unwrap_or_else(|| {
            let name = format!("{}_{}", self.scene.name, crate::host::clock::utc_stamp());
            std::path::PathBuf::from("bags").join(name)
        })
    }

    #[cfg(feature = "bag")]
    fn bag_delivery(&self) -> crate::io::fanout::Delivery {
        use crate::{io::fanout::Delivery, scene::OnFull};

        // A second of ticks: enough for a disk that stalls for a moment.
        let depth = 1000;
        match self.scene.outputs.bag.on_full {
            OnFull::Wait => Delivery::Every { depth },
            OnFull::DropOldest => Delivery::Latest { depth },
        }
    }

    #[cfg(feature = "shm")]
    fn open_stream(&self, outputs: &mut OutputSinks, sizes: Sizes) {
        use crate::shm::stream::{Stream, prefix};

        match Stream::open(&prefix(), sizes.n_grains, sizes.n_vertices) {
            Ok(stream) => outputs.stream = Some(stream),
            Err(error) => self.progress.say(&format!("{error}; the run continues without streams")),
        }
    }

    #[cfg(not(feature = "shm"))]
    fn open_stream(&self, _outputs: &mut OutputSinks, sizes: Sizes) {
        let Sizes { n_grains, n_vertices } = sizes;
        self.progress.say(&format!(
            "streams need a build with feature `shm`; {n_grains} grains and \
             {n_vertices} vertices are not streamed"
        ));
    }

    #[cfg(feature = "ros")]
    fn open_ros(
        &self,
        outputs: &mut OutputSinks,
        external: &mut ExternalInputs,
    ) -> Result<(), ConnectError> {
        use crate::{
            io::{fanout::Delivery, published::PublishedUpTo},
            ros::{
                discovery::DiscoveryRange,
                node::{RosNode, RosSink},
                service::RosServiceServer,
                subscribe::{RosClock, RosSource},
            },
            simulator::{Simulator, Version, services},
            wire::topics::full_name,
        };

        let range =
            DiscoveryRange::choose(&self.scene.outputs.ros, |name| std::env::var(name).ok());
        let node = RosNode::join_as(&self.scene.outputs.ros.node, &range?);
        let node = node?;
        let log = Arc::clone(&node);
        self.progress.add_listener(Box::new(move |text| log.warn(text)));
        let published = Arc::new(PublishedUpTo::default());
        let sink = RosSink::new(&node, self.encoder)?;
        let sink = sink.reporting_to(&published);
        let source = RosSource::new(&node, self.encoder)?;
        // Controllers do not need old states, but half a second covers a short stall.
        let delivery = Delivery::Latest { depth: 500 };
        outputs.fanout.add(Box::new(sink), delivery)?;
        external.sources.push(Box::new(source));
        if self.encoder.follows_clock() {
            let name = full_name(&self.scene.outputs.ros, "/clock");
            let clock = RosClock::new(&node, &name)?;
            external.clock = Some(clock.time_ns());
            external.sources.push(Box::new(clock));
        }
        let ros = &self.scene.outputs.ros;
        let prefix = ros.interfaces_prefix.as_deref();
        let (mut offers, endpoints) = services::endpoints(&ros.node, prefix);
        let mut channels = services::action_topics(&ros.node, prefix);
        offers.iter_mut().for_each(|it| it.name = full_name(ros, &it.name));
        channels.iter_mut().for_each(|it| it.name = full_name(ros, &it.name));
        let services = RosServiceServer::open(&node, &offers, &channels, &published);
        let services = Box::new(services?);
        let is_stopped = matches!(self.scene.controller, Controller::Topics { .. });
        let version = match self.scene.outputs.ros.interfaces_version {
            Some(1) => Version::One,
            Some(2) => Version::Two,
            _ => Version::of_distribution(&std::env::var("ROS_DISTRO").unwrap_or_default()),
        };
        let simulator = Simulator::new(self.scene, endpoints, is_stopped)
            .with_n_topics(channels.len())
            .with_scene_file(self.scene_file)
            .with_version(version);
        external.server = Some(SimulationServer::new(simulator, services, published));
        Ok(())
    }

    #[cfg(not(feature = "ros"))]
    fn open_ros(
        &self,
        _outputs: &mut OutputSinks,
        _external: &mut ExternalInputs,
    ) -> Result<(), ConnectError> {
        Err(ConnectError::NoFeature)
    }
}
