//! A network of its own: a namespace with nothing but a loopback interface. What speaks DDS here never
//! uses another.

use std::{
    fs,
    process::{Command, Stdio},
};

use crate::benchmarks::{Case, Figures, Options};

/// Brings loopback up and becomes the program.
const ENTER: &str = concat!(include_str!("loopback_up.sh"), "exec \"$0\" \"$@\"\n");
/// Set inside, so that a namespace that is none does not make another.
const INSIDE: &str = "JAMGRIP_BENCH_PRIVATE_NETWORK";
/// Interfaces that a new namespace may have from the start, all of them down.
const HARMLESS: [&str; 7] = ["lo", "tunl", "gre", "erspan", "sit", "ip6", "ip_vti"];

/// There is no network of its own.
#[derive(Debug, thiserror::Error)]
pub enum PrivateError {
    /// The system does not allow one.
    #[error(
        "this system allows no private network, and no other is used:\n{tried}run as root, with \
         CAP_SYS_ADMIN in a container, or allow unprivileged user namespaces"
    )]
    Refused {
        /// What was tried.
        tried: String,
    },
    /// What ran inside failed.
    #[error("in its own network: {0}")]
    Inside(String),
}

/// True in a network that has only loopback.
pub(super) fn is_private() -> bool {
    let Ok(interfaces) = fs::read_to_string("/proc/net/dev") else { return false };
    let names = interfaces.lines().skip(2).filter_map(|line| line.split(':').next());
    names.map(str::trim).all(|name| HARMLESS.iter().any(|it| name.starts_with(it)))
}

/// Runs the case by this program in a network of its own.
pub(super) fn run(case: &Case, options: &Options) -> Result<Figures, PrivateError> {
    if std::env::var_os(INSIDE).is_some() {
        let tried = "unshare: the new network has interfaces\n".to_owned();
        return Err(PrivateError::Refused { tried });
    }
    let inside = |text: String| PrivateError::Inside(text);
    let program = std::env::current_exe().map_err(|error| inside(error.to_string()))?;
    let mut tried = String::new();
    for option in ["-n", "-rn"] {
        // Whether it is allowed is asked first: what fails later has another reason.
        let allowed = Command::new("unshare").args([option, "true"]).output();
        match allowed {
            Ok(output) if output.status.success() => {}
            Ok(output) => {
                let fault = String::from_utf8_lossy(&output.stderr);
                tried += &format!("unshare {option}: {}\n", fault.trim());
                continue;
            }
            Err(error) => {
                tried += &format!("unshare {option}: {error}\n");
                continue;
            }
        }
        let output = Command::new("unshare")
            .args([option, "sh", "-c", ENTER])
            .arg(&program)
            .args(["bench", "--json", "--case", case.name])
            .args(["--threads", &options.n_threads.to_string()])
            .args(["--seconds", &options.seconds.to_string()])
            .arg("--cache")
            .arg(options.cache.folder())
            .env(INSIDE, "1")
            .stdin(Stdio::null())
            .output()
            .map_err(|error| inside(error.to_string()))?;
        if !output.status.success() {
            return Err(inside(String::from_utf8_lossy(&output.stderr).trim().to_owned()));
        }
        let figures: Result<Vec<Figures>, _> = serde_json::from_slice(&output.stdout);
        let figures = figures.map_err(|error| inside(error.to_string()))?;
        return figures.into_iter().next().ok_or_else(|| inside("no figures".to_owned()));
    }
    Err(PrivateError::Refused { tried })
}
