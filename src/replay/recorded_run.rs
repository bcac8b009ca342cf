//! A run set up from a recording alone: the scene with its files, a checkpoint or a newly settled
//! start, and the commands, each in its tick.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use crate::{
    bag::{
        OpenBagError,
        recording::{CheckpointLocation, RecordedChange, RecordedCommand, Recording, RunHistory},
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
        from_ros::{CommandCodec, CommandDecodeError},
        topics::topics,
    },
};

/// Why a recorded run cannot be simulated again.
#[derive(Debug, thiserror::Error)]
pub enum ReplayError {
    /// The path is not a recording.
    #[error(transparent)]
    Open(#[from] OpenBagError),
    /// A file of the recording cannot be read.
    #[error("{}: {error}; check the disk", path.display())]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// The error of the operating system.
        error: io::Error,
    },
    /// The recording contains no scene.
    #[error(
        "{}: no scene.yaml is attached (written by `{library}`): this is not a recording by \
         jamgrip, so it can be played but not simulated",
        path.display()
    )]
    NoScene {
        /// The recording.
        path: PathBuf,
        /// The program that wrote it.
        library: String,
    },
    /// This version cannot read the recorded scene.
    #[error("{}: the scene, recorded by jamgrip {version}, cannot be read:\n{error}", path.display())]
    UnreadableScene {
        /// The recording.
        path: PathBuf,
        /// The version that recorded it.
        version: String,
        /// The error in the scene.
        error: SceneError,
    },
    /// The scene cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A checkpoint cannot be used.
    #[error(
        "checkpoint at tick {tick} (recorded by jamgrip {version}): {error}; \
         with --settle --jobs 1 the run starts from the scene and uses no checkpoint"
    )]
    Checkpoint {
        /// Its tick.
        tick: u64,
        /// The version that recorded it.
        version: String,
        /// The error in the checkpoint.
        error: SavedStateError,
    },
    /// The run did not start with the scene, and the state at its start was not recorded.
    #[error("{}: it starts at tick {tick}, but contains no checkpoint of that state", path.display())]
    NoStart {
        /// The recording.
        path: PathBuf,
        /// Its first tick.
        tick: u64,
    },
    /// A recorded command cannot be decoded.
    #[error("command in tick {tick}: {error}")]
    Command {
        /// Its tick.
        tick: u64,
        /// The error in the command.
        error: CommandDecodeError,
    },
    /// A recorded change cannot be applied.
    #[error("after tick {tick} (recorded by jamgrip {version}): {what}: {reason}")]
    Change {
        /// The tick before the change.
        tick: u64,
        /// Description of the change.
        what: String,
        /// The version that recorded it.
        version: String,
        /// Why it cannot be applied.
        reason: String,
    },
    /// The start state cannot be prepared.
    #[error(transparent)]
    Start(#[from] StartError),
    /// The simulation diverged, unlike the recorded one.
    #[error(transparent)]
    Diverged(#[from] Diverged),
}

/// A recording with its scene and history.
pub struct RecordedRun {
    /// Path of the recording.
    pub path: PathBuf,
    /// The part of the recording before its first message.
    pub recording: Recording,
    /// The scene.
    pub scene: Scene,
    /// The history of the run.
    pub history: RunHistory,
}

impl RecordedRun {
    /// Reads a recording.
    ///
    /// # Errors
    /// If the path is not a recording, or the scene cannot be read.
    pub fn open(path: &Path) -> Result<Self, ReplayError> {
        let recording = Recording::open(path)?;
        let scene = read_scene(path, &recording, &[])?;
        let history = recording.history(&topics(&scene), scene.time.tick_ns);
        let path = path.to_owned();
        let history =
            history.map_err(|error| ReplayError::Unreadable { path: path.clone(), error })?;
        Ok(Self { path, recording, scene, history })
    }

    /// The scene with overrides of the form `key=value`.
    ///
    /// # Errors
    /// If an override is invalid.
    pub fn changed_scene(&self, overrides: &[String]) -> Result<Scene, SceneError> {
        match read_scene(&self.path, &self.recording, overrides) {
            Ok(scene) => Ok(scene),
            Err(ReplayError::UnreadableScene { error, .. }) => Err(error),
            // It could be read before.
            Err(_) => Ok(self.scene.clone()),
        }
    }

    /// A session of `scene` at the last checkpoint up to `tick`; `None` if there is none.
    ///
    /// # Errors
    /// If the checkpoint cannot be used.
    pub fn session_before(
        &self,
        tick: u64,
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Option<Session>, ReplayError> {
        let checkpoint = self.history.checkpoint_before(tick);
        checkpoint.map(|it| self.session_at(it, scene, n_threads)).transpose()
    }

    /// A session of `scene` at a checkpoint.
    ///
    /// # Errors
    /// If the checkpoint cannot be used.
    pub fn session_at(
        &self,
        checkpoint: &CheckpointLocation,
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Session, ReplayError> {
        let mut session =
            self.resume(checkpoint.tick, &self.read(checkpoint)?, scene, n_threads)?;
        if let Some(start) = self.history.checkpoints.first()
            && (start.tick, self.history.changes.is_empty()) == (0, false)
            && 0 < checkpoint.tick
        {
            let remembered = session.remember_start(&self.read(start)?);
            remembered.map_err(|error| self.checkpoint_error(start.tick, error))?;
        }
        Ok(session)
    }

    /// A session of `scene` from a state saved after `tick`.
    ///
    /// # Errors
    /// If the state cannot be used.
    pub fn resume(
        &self,
        tick: u64,
        bytes: &[u8],
        scene: &Scene,
        n_threads: usize,
    ) -> Result<Session, ReplayError> {
        let pool = parallel::ThreadPool::new(n_threads).map_err(StartError::from)?;
        let session = Session::resume(Compiled::new(scene, &pool)?, bytes);
        session.map_err(|error| self.checkpoint_error(tick, error))
    }

    fn read(&self, checkpoint: &CheckpointLocation) -> Result<Vec<u8>, ReplayError> {
        checkpoint
            .read()
            .map_err(|error| ReplayError::Unreadable { path: self.path.clone(), error })
    }

    fn checkpoint_error(&self, tick: u64, error: SavedStateError) -> ReplayError {
        ReplayError::Checkpoint { tick, version: self.recording.version().to_owned(), error }
    }

    /// Applies a recorded change.
    ///
    /// # Errors
    /// If the change cannot be decoded or applied.
    pub fn change(
        &self,
        session: &mut Session,
        recorded: &RecordedChange,
    ) -> Result<(), ReplayError> {
        let to_error = |reason: String| ReplayError::Change {
            tick: recorded.tick,
            what: recorded.what.clone(),
            version: self.recording.version().to_owned(),
            reason,
        };
        let change = Change::from_bytes(&recorded.change).map_err(|it| to_error(it.to_string()))?;
        session.change(&change).map_err(|it| to_error(it.to_string()))
    }

    /// The recorded commands as a script.
    ///
    /// # Errors
    /// If a command cannot be decoded.
    pub fn script(&self) -> Result<Script, ReplayError> {
        let mut topics = topics(&self.scene);
        let inputs = self.recording.inputs().unwrap_or_default();
        for (topic, name) in topics.iter_mut().filter(|it| it.is_input).zip(inputs) {
            topic.name = name;
        }
        let objects = self.scene.objects.iter().map(|it| it.name.clone()).collect();
        let codec = CommandCodec::new(topics.clone(), objects);
        let mut commands = Vec::with_capacity(self.history.commands.len());
        for RecordedCommand { tick, topic, cdr } in &self.history.commands {
            let Some(index) = topics.iter().position(|it| it.name == *topic) else { continue };
            let command = codec.decode(index, cdr);
            let command = command.map_err(|error| ReplayError::Command { tick: *tick, error })?;
            commands.push((*tick, command));
        }
        Ok(Script::new(commands))
    }
}

/// Parses the scene of a recording, with the files it refers to in a temporary folder.
fn read_scene(
    path: &Path,
    recording: &Recording,
    overrides: &[String],
) -> Result<Scene, ReplayError> {
    let Some(text) = &recording.scene_text else {
        let library = recording.library.clone();
        return Err(ReplayError::NoScene { path: path.to_owned(), library });
    };
    let unreadable = |error| ReplayError::Unreadable { path: path.to_owned(), error };
    let folder = TempFiles::new(&recording.scene_files).map_err(unreadable)?;
    let mut all = folder.overrides();
    all.extend_from_slice(overrides);
    let source = format!("{}: scene.yaml", path.display());
    scene::parse(text, &source, Path::new(""), &all).map_err(|error| ReplayError::UnreadableScene {
        path: path.to_owned(),
        version: recording.version().to_owned(),
        error,
    })
}

/// Files in a temporary folder, which is removed on drop.
struct TempFiles {
    folder: PathBuf,
    files: Vec<PathBuf>,
}

impl TempFiles {
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
            // Only the file name is used, so that a recording cannot write to other folders.
            let name = Path::new(name).file_name().unwrap_or("file".as_ref());
            let file = this.folder.join(name);
            fs::write(&file, contents)?;
            this.files.push(file);
        }
        Ok(this)
    }

    /// Overrides that make the scene read these files.
    fn overrides(&self) -> Vec<String> {
        let change = |file: &PathBuf| {
            // A JSON string is also a YAML string.
            let file = serde_json::Value::from(file.to_string_lossy());
            format!("object.shape.mesh.file={file}")
        };
        self.files.first().map(change).into_iter().collect()
    }
}

impl Drop for TempFiles {
    fn drop(&mut self) {
        if !self.files.is_empty() {
            // Best effort: the files are small and in the folder for temporary files.
            drop(fs::remove_dir_all(&self.folder));
        }
    }
}
