//! The same packing in other DEM codes, alternating with jamgrip: LAMMPS, LIGGGHTS and YADE, as far
//! as installed. They run as separate programs and measure their own times; their output is parsed
//! strictly.

mod error; // what can go wrong
mod input; // input files
mod output; // parsed output
mod tool; // where the programs are

use std::{
    fs, io,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::{packing::Boxed, process::niceness, repetitions::Work, result::median, sanity::Limits};
use crate::{
    base::{
        Real,
        real::{real, real_of},
    },
    physics::System,
};
pub use error::ReferenceError;
use input::{numbers, packing};
use output::{Repetition, read, tail};
use tool::{TOOLS, Tool, on_path};

/// Niceness of jamgrip's solver threads relative to the process.
const NICE: i32 = 10;

/// The result of a reference code.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReferenceResult {
    /// Name of the code.
    pub peer: String,
    /// Version that it prints.
    pub version: String,
    /// Contacts between grains times steps per second and thread, the median of all runs.
    pub contact_steps_per_s_per_core: Real,
    /// Time of the slowest run divided by that of the fastest, minus one.
    pub spread: Real,
    /// Contacts at the end.
    pub n_contacts: Real,
    /// Kinetic energy at the end (J), without spins.
    pub kinetic_energy_j: Real,
    /// Contact-steps per second of jamgrip divided by its own.
    pub ratio: Real,
}

/// All installed reference codes, with the packing of a case.
pub(super) struct ReferenceCodes {
    folder: Folder,
    case: Value,
    n_threads: usize,
    work: Work,
    n_contacts_min: Real,
    found: Vec<(Tool, PathBuf, Vec<Repetition>)>,
    /// Codes that are not installed, with the remedy.
    pub(super) missing: Vec<String>,
}

impl ReferenceCodes {
    /// Finds installed codes, and writes the packing of `boxed` in `system` for them.
    pub(super) fn new(
        boxed: &Boxed,
        system: &System,
        (work, limits): (Work, &Limits),
        n_threads: usize,
    ) -> Result<Self, ReferenceError> {
        let (mut found, mut missing) = (Vec::new(), Vec::new());
        for tool in TOOLS {
            match tool.program() {
                Some(program) => found.push((tool, program, Vec::new())),
                None => missing.push(format!("{}: not installed; {}", tool.name(), tool.remedy())),
            }
        }
        let folder = Folder::new()
            .map_err(|reason| ReferenceError::Io { peer: "reference codes", reason })?;
        for (tool, ..) in &found {
            let (name, text) = tool.script();
            let write = || {
                fs::write(folder.0.join(name), text)?;
                fs::write(folder.0.join(tool.data()), packing(*tool, system, boxed))
            };
            write().map_err(|reason| ReferenceError::Io { peer: tool.name(), reason })?;
        }
        let n_contacts_min = limits.contacts_per_grain * real(system.state.grains.len());
        let case = numbers(boxed, work);
        Ok(Self { folder, case, n_threads, work, n_contacts_min, found, missing })
    }

    /// One run of each.
    pub(super) fn repetition(&mut self) -> Result<(), ReferenceError> {
        for k in 0..self.found.len() {
            let (tool, program, _) = &self.found[k];
            let repetition = self.run(*tool, program)?;
            self.found[k].2.push(repetition);
        }
        Ok(())
    }

    /// The results, compared with jamgrip's contact-steps per second and thread.
    pub(super) fn results(&self, ours: Real) -> Vec<ReferenceResult> {
        let of_tool = |(tool, _, repetitions): &(Tool, PathBuf, Vec<Repetition>)| {
            let n_steps = real_of(self.work.n_steps);
            let speed = |repetition: &Repetition| {
                let [before, after] = repetition.n_contacts;
                0.5 * (before + after) * n_steps / repetition.wall_s / real(self.n_threads)
            };
            let mut speeds: Vec<Real> = repetitions.iter().map(speed).collect();
            speeds.sort_by(Real::total_cmp);
            let last = repetitions.last()?;
            let theirs = median(&speeds);
            Some(ReferenceResult {
                peer: tool.name().to_owned(),
                version: last.version.clone(),
                contact_steps_per_s_per_core: theirs,
                spread: speeds[speeds.len() - 1] / speeds[0] - 1.0,
                n_contacts: last.n_contacts[1],
                kinetic_energy_j: last.kinetic_energy,
                ratio: ours / theirs,
            })
        };
        self.found.iter().filter_map(of_tool).collect()
    }

    fn run(&self, tool: Tool, program: &Path) -> Result<Repetition, ReferenceError> {
        let peer = tool.name();
        let mut command = self.command(tool, program)?;
        command.current_dir(&self.folder.0).stdin(Stdio::null());
        let output = command.output().map_err(|reason| ReferenceError::Io { peer, reason })?;
        let stdout = String::from_utf8_lossy(&output.stdout).into_owned();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        if !output.status.success() {
            let tail = tail(&format!("{stdout}\n{stderr}"));
            return Err(ReferenceError::Failed { peer, status: output.status, tail });
        }
        let repetition = read(tool, &stdout)?;
        let fewest = repetition.n_contacts[0].min(repetition.n_contacts[1]);
        if fewest >= self.n_contacts_min {
            return Ok(repetition);
        }
        Err(ReferenceError::Empty { peer, found: fewest, expected: self.n_contacts_min })
    }

    /// The command line of a code, with the niceness of jamgrip's solver threads.
    fn command(&self, tool: Tool, program: &Path) -> Result<Command, ReferenceError> {
        let mut command = Command::new("nice");
        command.arg("-n").arg((NICE - niceness()).to_string());
        let n_threads = self.n_threads.to_string();
        let script = tool.script().0;
        if tool == Tool::Yade {
            let mut case = self.case.clone();
            case["data"] = json!(tool.data());
            command.arg(program).arg(format!("-j{n_threads}")).args(["-n", "-x", script]);
            command.env("JAMGRIP_CASE", case.to_string());
            return Ok(command);
        }
        let home = program.parent().and_then(Path::parent);
        if 1 < self.n_threads {
            // MPI of the same environment: programs and launchers of different ones do not work
            // together.
            let own = home.map(|it| it.join("bin/mpiexec")).filter(|it| it.is_file());
            let launcher = own.or_else(|| on_path("mpirun"));
            let launcher = launcher.ok_or(ReferenceError::NoMpi { peer: tool.name() })?;
            command.arg(launcher).args(["-n", &n_threads]);
            command.env("OMPI_ALLOW_RUN_AS_ROOT", "1").env("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
            command.env("OMPI_MCA_hwloc_base_binding_policy", "none");
        }
        if let Some(library) =
            home.map(|it| it.join("lib")).filter(|it| it.join("libmpi.so.12").is_file())
        {
            command.env("LD_LIBRARY_PATH", library);
        }
        command.env("OMP_NUM_THREADS", "1");
        command.arg(program).args(["-in", script, "-log", "none", "-var", "data", tool.data()]);
        let law = if tool == Tool::LammpsHistory { "history" } else { "mindlin" };
        command.args(["-var", "law", law]);
        for (name, value) in self.case.as_object().into_iter().flatten() {
            command.args(["-var", name, &value.to_string()]);
        }
        Ok(command)
    }
}

/// A temporary folder.
struct Folder(PathBuf);

impl Folder {
    fn new() -> io::Result<Self> {
        let path = std::env::temp_dir().join(format!("jamgrip-peers-{}", std::process::id()));
        fs::create_dir_all(&path)?;
        Ok(Self(path))
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // A folder that cannot be removed only takes space.
        drop(fs::remove_dir_all(&self.0));
    }
}
