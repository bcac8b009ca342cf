//! From a scene to a run and its summary.

use std::{path::PathBuf, sync::Arc, time::Duration};

use super::{
    Crew, Ending, Report,
    cache::Cache,
    judge::Judge,
    orders::Orders,
    outlets::{Closed, Outlets},
    pacer::{self, Pacer},
    plant::Plant,
    progress::Progress,
    schedule::Schedule,
    shutdown::Shutdown,
    start::{self, StartError, Started},
    summary::Summary,
};
use crate::{
    cosim::compile::Compiled,
    physics::health::Diverged,
    scene::{Controller, OnError, Scene},
    sinks::RunStatistics,
    sources::Source,
    wire::to_ros::Encoder,
};

/// What the command line adds to a scene.
#[derive(Clone, Debug)]
pub struct Options {
    /// Solver threads; they do not change the result.
    pub n_threads: usize,
    /// Simulated time after which the run ends [s].
    pub duration: Option<f64>,
    /// Where settled start states are kept.
    pub cache: Cache,
    /// True shows no progress.
    pub is_quiet: bool,
}

/// Why a run could not begin or go on.
#[derive(Debug, thiserror::Error)]
pub enum RunError {
    /// There is no session.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The system cannot go on. What was recorded until then is complete.
    #[error(transparent)]
    Diverged(#[from] Diverged),
    /// The recording cannot begin, or failed, and the scene says to stop then.
    #[error("{0}\nthe scene says to stop then; --set outputs.bag.on_error=continue runs on")]
    Recording(String),
    /// Commands shall come over ROS 2, but there is no ROS 2.
    #[error(
        "controller: topics, but ROS 2 is not there: {0}; allow it, or choose controller=builtin"
    )]
    NoTopics(String),
    /// Signals cannot be listened to.
    #[error("Ctrl-C cannot be listened to: {0}; run jamgrip as a process of its own")]
    Signals(#[from] ctrlc::Error),
}

/// A finished run. There is a summary even if it ended in a fault.
#[derive(Debug)]
pub struct Finished {
    /// What came of it.
    pub summary: Summary,
    /// Why it ended early.
    pub fault: Option<RunError>,
}

/// Runs `scene` from its start to its end.
///
/// # Errors
/// If the run cannot begin.
pub fn launch(scene: &Scene, options: &Options) -> Result<Finished, RunError> {
    let since_start = Pacer::start(false);
    let shutdown = Shutdown::listen()?;
    let progress = Progress::new(options.is_quiet);
    let compiled = Compiled::new(scene, options.n_threads).map_err(StartError::from)?;
    let substep_s = compiled.model.substep;
    let mesh = &compiled.model.membrane.mesh;
    let encoder = Arc::new(Encoder::new(scene, &mesh.triangles, &mesh.positions));
    let sizes = Sizes { n_grains: scene.grains.count, n_vertices: mesh.n_vertices() };
    // Recording first: a folder that cannot be written is noticed before the bag is filled.
    let (outlets, outside) = Doors { scene, encoder: &encoder, progress: &progress }.open(sizes)?;
    let started = start::start(compiled, options.n_threads, &options.cache, &progress)?;
    let Started { mut session, origin } = started;
    let end_ns = end_ns(scene, options.duration);
    progress.running(end_ns);
    let mut crew = Crew {
        orders: Orders::new(scene, outside),
        outlets,
        schedule: Schedule::new(&scene.outputs, scene.time.tick_ns),
        judge: Judge::default(),
        progress,
        shutdown,
        tick_ns: scene.time.tick_ns,
        end_ns,
        is_real_time: scene.outputs.real_time,
        about: RunStatistics { substep_s, seed: scene.seed, ..RunStatistics::default() },
    };
    let start_time_s = since_start.wall_time_s();
    let report = super::run(&mut session, &mut crew);
    Ok(finish(scene, crew, report, Beginning { sizes, substep_s, origin, start_time_s }))
}

/// Lengths of the lists that are streamed.
#[derive(Clone, Copy, Debug)]
struct Sizes {
    n_grains: usize,
    n_vertices: usize,
}

/// What is known before the first tick.
struct Beginning {
    sizes: Sizes,
    substep_s: f64,
    origin: &'static str,
    start_time_s: f64,
}

/// The earlier of the scene's and the command line's end [ns].
fn end_ns(scene: &Scene, duration: Option<f64>) -> Option<u64> {
    let of_scene = match scene.controller {
        Controller::Topics { duration } => duration,
        Controller::Builtin(_) => None,
    };
    let ends = duration.into_iter().chain(of_scene).map(Duration::from_secs_f64);
    ends.min().map(|end| u64::try_from(end.as_nanos()).unwrap_or(u64::MAX))
}

fn finish(
    scene: &Scene,
    crew: Crew,
    report: Report<<crate::session::Session as Plant>::Fault>,
    beginning: Beginning,
) -> Finished {
    let Crew { orders, outlets, judge, progress, .. } = crew;
    let bag = outlets.bag.as_ref().map(|folder| folder.display().to_string());
    let sources = orders.counters();
    drop(orders);
    let Closed { counters, faults } = outlets.close();
    faults.iter().for_each(|fault| progress.say(fault));
    let (ending, fault) = match report.ending {
        Ok(Ending::RecordingFailed) => {
            let text = Ending::RecordingFailed.to_string();
            (text.clone(), Some(RunError::Recording(text)))
        }
        Ok(ending) => (ending.to_string(), None),
        Err(fault) => ("diverged".to_owned(), Some(RunError::from(fault))),
    };
    let last = &report.last.snapshot;
    let summary = Summary {
        scene: scene.name.clone(),
        seed: scene.seed,
        ending,
        verdict: judge.verdict(),
        real_time_factor: report.real_time_factor,
        wall_time_s: report.wall_time_s,
        start_time_s: beginning.start_time_s,
        start_state: beginning.origin,
        sim_time_s: Duration::from_nanos(last.time_ns).as_secs_f64(),
        substep_s: beginning.substep_s,
        n_grains: beginning.sizes.n_grains,
        n_vertices: beginning.sizes.n_vertices,
        state_digest: last.digest,
        bag,
        sinks: counters,
        sources,
        commands: last.command_counts,
    };
    Finished { summary, fault }
}

/// Opens what the scene asks for. What cannot be opened is said and left out, unless the run
/// would be pointless without it.
struct Doors<'a> {
    scene: &'a Scene,
    encoder: &'a Arc<Encoder>,
    progress: &'a Progress,
}

type Outside = Vec<Box<dyn Source>>;

impl Doors<'_> {
    fn open(&self, sizes: Sizes) -> Result<(Outlets, Outside), RunError> {
        let mut outlets = Outlets::default();
        if self.scene.outputs.bag.enabled {
            self.open_bag(&mut outlets)?;
        }
        if self.scene.outputs.stream {
            self.open_stream(&mut outlets, sizes);
        }
        let mut outside = Outside::new();
        let opened = if self.scene.outputs.ros.enabled {
            self.open_ros(&mut outlets, &mut outside)
        } else {
            Err("outputs.ros.enabled is false".to_owned())
        };
        match opened {
            Err(reason) if matches!(self.scene.controller, Controller::Topics { .. }) => {
                return Err(RunError::NoTopics(reason));
            }
            Err(reason) if self.scene.outputs.ros.enabled => {
                self.progress.say(&format!("{reason}; the run goes on without ROS 2"));
            }
            _ => {}
        }
        Ok((outlets, outside))
    }

    #[cfg(feature = "bag")]
    fn open_bag(&self, outlets: &mut Outlets) -> Result<(), RunError> {
        use crate::sinks::bag::{Bag, Subject};

        let scene_text = crate::scene::to_yaml(self.scene);
        let subject = Subject { scene_text, seed: self.scene.seed };
        let folder = self.bag_folder();
        let opened = Bag::create(&folder, Arc::clone(self.encoder), subject)
            .map_err(|error| error.to_string())
            .and_then(|bag| {
                let added = outlets.fanout.add(Box::new(bag), self.bag_delivery());
                added.map_err(|error| error.to_string())
            });
        match (opened, self.scene.outputs.bag.on_error) {
            (Ok(()), on_error) => {
                outlets.bag = Some(folder);
                outlets.stops_with_bag = on_error == OnError::Stop;
            }
            (Err(reason), OnError::Stop) => return Err(RunError::Recording(reason)),
            (Err(reason), OnError::Continue) => {
                self.progress.say(&format!("{reason}; the run goes on without a recording"));
            }
        }
        Ok(())
    }

    #[cfg(not(feature = "bag"))]
    fn open_bag(&self, _outlets: &mut Outlets) -> Result<(), RunError> {
        let reason = "this jamgrip was built without recordings (feature `bag`)".to_owned();
        if self.scene.outputs.bag.on_error == OnError::Stop {
            return Err(RunError::Recording(reason));
        }
        self.progress.say(&reason);
        Ok(())
    }

    #[cfg(feature = "bag")]
    fn bag_folder(&self) -> PathBuf {
        let chosen = self.scene.outputs.bag.folder.clone();
        chosen.unwrap_or_else(|| {
            let name = format!("{}_{}", self.scene.name, pacer::utc_stamp());
            PathBuf::from("bags").join(name)
        })
    }

    #[cfg(feature = "bag")]
    fn bag_delivery(&self) -> crate::sinks::fanout::Delivery {
        use crate::{scene::OnFull, sinks::fanout::Delivery};

        // A second of ticks: long enough for a disk to catch its breath.
        let depth = 1000;
        match self.scene.outputs.bag.on_full {
            OnFull::Wait => Delivery::Every { depth },
            OnFull::DropOldest => Delivery::Latest { depth },
        }
    }

    #[cfg(feature = "shm")]
    fn open_stream(&self, outlets: &mut Outlets, sizes: Sizes) {
        use crate::sinks::shm::{Stream, prefix};

        match Stream::open(&prefix(), sizes.n_grains, sizes.n_vertices) {
            Ok(stream) => outlets.stream = Some(stream),
            Err(error) => self.progress.say(&format!("{error}; the run goes on without streams")),
        }
    }

    #[cfg(not(feature = "shm"))]
    fn open_stream(&self, _outlets: &mut Outlets, sizes: Sizes) {
        let Sizes { n_grains, n_vertices } = sizes;
        self.progress.say(&format!(
            "this jamgrip was built without streams (feature `shm`): {n_grains} grains and \
             {n_vertices} vertices stay inside"
        ));
    }

    #[cfg(feature = "ros")]
    fn open_ros(&self, outlets: &mut Outlets, outside: &mut Outside) -> Result<(), String> {
        use crate::{
            sinks::{
                fanout::Delivery,
                reach::Reach,
                ros::{RosNode, RosSink},
            },
            sources::ros::RosSource,
        };

        let reach = Reach::choose(&self.scene.outputs.ros, |name| std::env::var(name).ok());
        let reach = reach.map_err(|error| error.to_string())?;
        let node = RosNode::join(&reach).map_err(|error| error.to_string())?;
        let sink = RosSink::new(&node, self.encoder).map_err(|error| error.to_string())?;
        let source = RosSource::new(&node, self.encoder).map_err(|error| error.to_string())?;
        // Old states are worth nothing to a controller, but half a second bridges a hiccup.
        let delivery = Delivery::Latest { depth: 500 };
        outlets.fanout.add(Box::new(sink), delivery).map_err(|error| error.to_string())?;
        outside.push(Box::new(source));
        Ok(())
    }

    #[cfg(not(feature = "ros"))]
    fn open_ros(&self, _outlets: &mut Outlets, _outside: &mut Outside) -> Result<(), String> {
        Err("this jamgrip was built without ROS 2 (feature `ros`)".to_owned())
    }
}
