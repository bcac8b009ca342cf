//! A run from what is in a recording alone: the scene with the files it names, a checkpoint or a
//! start settled anew, and the commands, each in its tick.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::{
    bag::{
        NotABag,
        recording::{Alteration, Course, Order, Place, Recording},
        source::Script,
    },
    base::parallel,
    command::change::Change,
    cosim::{
        compile::{CompileError, Compiled},
        saved_state::SavedStateError,
    },
    node::start::StartError,
    physics::health::Diverged,
    scene::{self, Scene, SceneError},
    session::Session,
    wire::{
        from_ros::{CommandCodec, NotACommand},
        topics::topics,
    },
};

/// Why a recording cannot be run again.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The path is no recording.
    #[error(transparent)]
    NotABag(#[from] NotABag),
    /// A file of it cannot be read.
    #[error("{}: {fault}; check the disk", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// What the system says.
        fault: io::Error,
    },
    /// There is no scene in it.
    #[error(
        "{}: no scene.yaml is attached to it (written by `{library}`): it is no recording of \
         jamgrip's and cannot be run again, only played",
        path.display()
    )]
    NoScene {
        /// The recording.
        path: PathBuf,
        /// What wrote it.
        library: String,
    },
    /// The scene in it is not one that this version reads.
    #[error("{}: its scene, recorded by jamgrip {version}, cannot be read:\n{fault}", path.display())]
    OtherScene {
        /// The recording.
        path: PathBuf,
        /// The version that recorded it.
        version: String,
        /// What is wrong with it.
        fault: SceneError,
    },
    /// The scene cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A checkpoint is of no use.
    #[error(
        "checkpoint at tick {tick} (recorded by jamgrip {version}): {fault}; \
         with --settle --jobs 1 the run starts from the scene and takes up none"
    )]
    Checkpoint {
        /// Its tick.
        tick: u64,
        /// The version that recorded it.
        version: String,
        /// What is wrong with it.
        fault: SavedStateError,
    },
    /// The run did not begin at the scene's start, and where it began was not kept.
    #[error("{}: it begins at tick {tick}, but no checkpoint of that start is in it", path.display())]
    NoStart {
        /// The recording.
        path: PathBuf,
        /// Its first tick.
        tick: u64,
    },
    /// A recorded command cannot be read.
    #[error("command in tick {tick}: {fault}")]
    Command {
        /// Its tick.
        tick: u64,
        /// What is wrong with it.
        fault: NotACommand,
    },
    /// The world cannot be changed as it was.
    #[error("after tick {tick} (recorded by jamgrip {version}): {what}: {fault}")]
    Change {
        /// The tick before.
        tick: u64,
        /// What was done to the world.
        what: String,
        /// The version that recorded it.
        version: String,
        /// Why not.
        fault: String,
    },
    /// The bag cannot be filled.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The filling or the run broke off where the recorded one did not.
    #[error(transparent)]
    Diverged(#[from] Diverged),
}

/// A recording with its scene read and its course known.
pub struct RecordedRun {
    /// Where it is.
    pub path: PathBuf,
    /// What it says of itself.
    pub recording: Recording,
    /// Its scene.
    pub scene: Scene,
    /// What happened.
    pub course: Course,
}

impl RecordedRun {
    /// Reads a recording.
    ///
    /// # Errors
    /// If it is none, or its scene cannot be read.
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        let recording = Recording::open(path)?;
        let scene = read_scene(path, &recording, &[])?;
        let course = recording.course(&topics(&scene), scene.time.tick_ns);
        let path = path.to_owned();
        let course =
            course.map_err(|fault| ReplayError::Unreadable { path: path.clone(), fault })?;
        Ok(Self { path, recording, scene, course })
    }

    /// The scene with changes of the form `key=value`.
    ///
    /// # Errors
    /// If a change is wrong.
    pub fn changed_scene(&self, overrides: &[String]) -> Result<Scene, SceneError> {
        match read_scene(&self.path, &self.recording, overrides) {
            Ok(scene) => Ok(scene),
            Err(ReplayError::OtherScene { fault, .. }) => Err(fault),
            // It could be read a moment ago.
            Err(_) => Ok(self.scene.clone()),
        }
    }

    /// A session of `scene` at the last checkpoint at or before `tick`; `None` without one.
    ///
    /// # Errors
    /// If the checkpoint cannot be used.
    pub fn session_before(
        &self,
        tick: u64,
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Option<Session>, ReplayError> {
        let place = self.course.checkpoint_before(tick);
        place.map(|it| self.session_at(it, scene, n_threads)).transpose()
    }

    /// A session of `scene` at a checkpoint.
    ///
    /// # Errors
    /// If the checkpoint cannot be used.
    pub fn session_at(
        &self,
        place: &Place,
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Session, ReplayError> {
        let mut session = self.resume(place.tick, &self.read(place)?, scene, n_threads)?;
        if let Some(start) = self.course.checkpoints.first()
            && (start.tick, self.course.changes.is_empty()) == (0, false)
            && 0 < place.tick
        {
            let told = session.remember_start(&self.read(start)?);
            told.map_err(|fault| self.of_no_use(start.tick, fault))?;
        }
        Ok(session)
    }

    /// A session of `scene` from what a session of it saved after `tick`.
    ///
    /// # Errors
    /// If the bytes cannot be used.
    pub fn resume(
        &self,
        tick: u64,
        bytes: &[u8],
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Session, ReplayError> {
        let pool = parallel::ThreadPool::new(n_threads).map_err(StartError::from)?;
        let session = Session::resume(Compiled::new(scene, &pool)?, bytes);
        session.map_err(|fault| self.of_no_use(tick, fault))
    }

    fn read(&self, place: &Place) -> Result<Vec<u8>, ReplayError> {
        place.read().map_err(|fault| ReplayError::Unreadable { path: self.path.clone(), fault })
    }

    fn of_no_use(&self, tick: u64, fault: SavedStateError) -> ReplayError {
        ReplayError::Checkpoint { tick, version: self.recording.version().to_owned(), fault }
    }

    /// Changes the world as it was changed in the recorded run.
    ///
    /// # Errors
    /// If the change cannot be read, or not be made.
    pub fn change(&self, session: &mut Session, recorded: &Alteration) -> Result<(), ReplayError> {
        let refused = |fault: String| ReplayError::Change {
            tick: recorded.tick,
            what: recorded.what.clone(),
            version: self.recording.version().to_owned(),
            fault,
        };
        let change = Change::from_bytes(&recorded.change).map_err(|it| refused(it.to_string()))?;
        session.change(&change).map_err(|it| refused(it.to_string()))
    }

    /// The recorded commands.
    ///
    /// # Errors
    /// If one cannot be read.
    pub fn script(&self) -> Result<Script, ReplayError> {
        let mut topics = topics(&self.scene);
        let inputs = self.recording.inputs().unwrap_or_default();
        for (topic, name) in topics.iter_mut().filter(|it| it.is_input).zip(inputs) {
            topic.name = name;
        }
        let objects = self.scene.objects.iter().map(|it| it.name.clone()).collect();
        let codec = CommandCodec::new(topics.clone(), objects);
        let mut commands = Vec::with_capacity(self.course.commands.len());
        for Order { tick, topic, cdr } in &self.course.commands {
            let Some(index) = topics.iter().position(|it| it.name == *topic) else { continue };
            let command = codec.decode(index, cdr);
            let command = command.map_err(|fault| ReplayError::Command { tick: *tick, fault })?;
            commands.push((*tick, command));
        }
        Ok(Script::new(commands))
    }
}

/// The scene in a recording; the files it names are put into a folder for as long as it is read.
fn read_scene(
    path: &Path,
    recording: &Recording,
    overrides: &[String],
) -> Result<Scene, ReplayError> {
    let Some(text) = &recording.scene_text else {
        let library = recording.library.clone();
        return Err(ReplayError::NoScene { path: path.to_owned(), library });
    };
    let unreadable = |fault| ReplayError::Unreadable { path: path.to_owned(), fault };
    let folder = Unpacked::new(&recording.scene_files).map_err(unreadable)?;
    let mut all = folder.overrides();
    all.extend_from_slice(overrides);
    let source = format!("{}: scene.yaml", path.display());
    scene::parse(text, &source, Path::new(""), &all).map_err(|fault| ReplayError::OtherScene {
        path: path.to_owned(),
        version: recording.version().to_owned(),
        fault,
    })
}

/// A folder of files that goes when it is dropped.
struct Unpacked {
    folder: PathBuf,
    files: Vec<PathBuf>,
}

impl Unpacked {
    fn new(files: &[(String, Vec<u8>)]) -> io::Result<Self> {
        use std::sync::atomic::{AtomicU64, Ordering};
        static COUNT: AtomicU64 = AtomicU64::new(0);

        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("jamgrip_scene_{}_{number}", std::process::id());
        let mut this = Self { folder: std::env::temp_dir().join(name), files: Vec::new() };
        if files.is_empty() {
            return Ok(this);
        }
        fs::create_dir_all(&this.folder)?;
        for (name, contents) in files {
            // A name from a recording is a name, not a path to somewhere else.
            let name = Path::new(name).file_name().unwrap_or("file".as_ref());
            let file = this.folder.join(name);
            fs::write(&file, contents)?;
            this.files.push(file);
        }
        Ok(this)
    }

    /// Changes of a scene that make it read these files.
    fn overrides(&self) -> Vec<String> {
        let change = |file: &PathBuf| {
            // A JSON string is a YAML string, whatever stands in it.
            let file = serde_json::Value::from(file.to_string_lossy());
            format!("object.shape.mesh.file={file}")
        };
        self.files.first().map(change).into_iter().collect()
    }
}

impl Drop for Unpacked {
    fn drop(&mut self) {
        if !self.files.is_empty() {
            // What stays behind is small and in the folder for such things.
            drop(fs::remove_dir_all(&self.folder));
        }
    }
}
