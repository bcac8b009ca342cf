//! What each module may use: the tables. Paths are those of files and folders from the repository's root, so
//! that moving a file means replacing its path here; an entry that applies to nothing is a failure.

/// Third-party crates, and the files or folders that may use them. The longest path decides.
pub(crate) const FOREIGN: &[(&str, &[&str])] = &[
    ("rapier3d_f64", &["src/cosim/rapier_world.rs", "src/cosim/volume.rs"]),
    (
        "rapier3d_f64::parry",
        &[
            "src/cosim/rapier_world.rs",
            "src/cosim/volume.rs",
            "src/physics/boundary/polyhedron.rs",
            "src/physics/boundary/tests.rs",
        ],
    ),
    ("arrayvec", &["src/physics/"]),
    ("rayon", &["src/base/parallel.rs"]),
    ("libc", &["src/base/parallel.rs"]),
    ("rand_chacha", &["src/base/random.rs"]),
    ("xxhash_rust", &["src/base/digest.rs", "src/bag/chain.rs", "src/cosim/saved_state.rs"]),
    ("serde_saphyr", &["src/scene/yaml.rs"]),
    ("stl_io", &["src/scene/mesh_file.rs"]),
    ("tobj", &["src/scene/mesh_file.rs"]),
    ("urdf_rs", &["src/scene/urdf.rs"]),
    ("regex", &["src/simulator/filters.rs"]),
    ("byteorder", &["src/wire/", "src/ros/"]),
    ("cdr_encoding", &["src/wire/", "src/simulator/", "src/ros/"]),
    ("ros2_client", &["src/ros/"]),
    ("rustdds", &["src/ros/"]),
    ("smol", &["src/ros/"]),
    ("iceoryx2", &["src/shm/"]),
    (
        "mcap",
        &[
            "src/bag/writer.rs",
            "src/bag/reader.rs",
            "src/bag/index.rs",
            "src/bag/recover.rs",
            "src/bag/check.rs",
        ],
    ),
    ("zstd", &["src/bag/writer.rs", "src/bag/reader.rs"]),
    ("indicatif", &["src/host/progress_bar.rs", "src/runner/progress.rs"]),
    ("comfy_table", &["src/bin/jamgrip/summary.rs", "src/runner/table.rs"]),
    ("plotters", &["src/report/"]),
    ("maud", &["src/report/page.rs", "src/runner/report.rs", "src/replay/page.rs"]),
    ("csv", &["src/runner/folder.rs", "src/benchmarks/history_csv.rs"]),
    ("ctrlc", &["src/host/shutdown.rs"]),
    ("clap", &["src/bin/jamgrip/"]),
    ("env_logger", &["src/bin/jamgrip/main.rs"]),
];

/// Crates that any file may use.
pub(crate) const FREE: &[&str] =
    &["nalgebra", "serde", "serde_bytes", "serde_json", "postcard", "thiserror", "bytemuck", "log"];

/// Paths that `modules` must not use, except in the files `except`.
pub(crate) struct Ban {
    pub(crate) modules: &'static [&'static str],
    pub(crate) paths: &'static [&'static str],
    pub(crate) except: &'static [&'static str],
    pub(crate) why: &'static str,
}

/// Modules whose results depend on nothing but their arguments.
const PURE: &[&str] = &[
    "base",
    "physics",
    "cosim",
    "command",
    "session",
    "snapshot",
    "controller",
    "experiments",
    "measure",
];
const CLOCKS: &[&str] = &["std::time::Instant", "std::time::SystemTime"];
const SOCKETS: &[&str] = &["std::net", "std::os", "rustdds", "ros2_client", "iceoryx2"];

pub(crate) const BANS: &[Ban] = &[
    Ban {
        modules: PURE,
        paths: &["std::fs", "std::env", "std::process", "std::io", "log", "env_logger"],
        except: &[],
        why: "the core has no files, environment or logs",
    },
    Ban { modules: PURE, paths: SOCKETS, except: &[], why: "the core has no sockets" },
    Ban { modules: PURE, paths: CLOCKS, except: &[], why: "the core reads no clock" },
    Ban {
        modules: PURE,
        paths: &["std::thread"],
        except: &["src/base/parallel.rs"],
        why: "threads of the core are in one file",
    },
    Ban {
        modules: &["scene"],
        paths: &["std::thread", "std::process", "log", CLOCKS[0]],
        except: &[],
        why: "a scene depends on its files alone",
    },
    Ban {
        modules: &["scene", "wire", "simulator"],
        paths: SOCKETS,
        except: &[],
        why: "sockets belong to the transports",
    },
    Ban {
        modules: &["wire", "simulator"],
        paths: &["std::thread", CLOCKS[0], CLOCKS[1]],
        except: &[],
        why: "no clock and no thread",
    },
    Ban {
        modules: &["controller"],
        paths: &["crate::physics", "crate::cosim", "crate::session"],
        except: &[],
        why: "the built-in controller uses only what an external one can know",
    },
];

/// Files and folders with unsafe code.
pub(crate) const UNSAFE: &[&str] = &["src/base/parallel.rs", "src/base/lanes/"];

/// Generated files.
pub(crate) const GENERATED: &[&str] = &["src/wire/messages/generated.rs"];

/// Files whose numbers must have units.
pub(crate) const DATA_FILES: &[&str] = &[
    "src/scene/mod.rs",
    "src/snapshot/mod.rs",
    "src/physics/model.rs",
    "src/physics/state.rs",
    "src/physics/controls.rs",
    "src/physics/scratch.rs",
];

/// True if `file` is one of `places`, or in a folder among them.
pub(crate) fn is_in(file: &str, places: &[&str]) -> bool {
    places.iter().any(
        |place| {
            if place.ends_with('/') { file.starts_with(place) } else { file == *place }
        },
    )
}
