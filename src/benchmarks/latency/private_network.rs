//! A private network: a namespace with only a loopback interface. DDS traffic of benchmarks never
//! uses another one.

use std::{
    fs,
    process::{Command, Stdio},
};

use crate::benchmarks::{BenchResult, Case, Options};

/// Brings loopback up and executes the program.
const ENTER: &str = concat!(include_str!("loopback_up.sh"), "exec \"$0\" \"$@\"\n");
/// Set inside, so that a namespace that is not private does not create another one.
const INSIDE: &str = "JAMGRIP_BENCH_PRIVATE_NETWORK";
/// Interfaces that a new namespace may have from the start; all of them are down.
const HARMLESS: [&str; 7] = ["lo", "tunl", "gre", "erspan", "sit", "ip6", "ip_vti"];

/// There is no private network.
#[derive(Debug, thiserror::Error)]
pub enum PrivateNetworkError {
    /// The system does not allow one.
    #[error(
        "this system does not allow a private network, and no other is used:\n{tried}run as root, with \
         CAP_SYS_ADMIN in a container, or allow unprivileged user namespaces"
    )]
    NotPermitted {
        /// The failed attempts.
        tried: String,
    },
    /// The process inside failed.
    #[error("in the private network: {0}")]
    Inside(String),
}

/// True in a network that has only loopback.
pub(super) fn is_private() -> bool {
    let Ok(interfaces) = fs::read_to_string("/proc/net/dev") else { return false };
    let names = interfaces.lines().skip(2).filter_map(|line| line.split(':').next());
    names.map(str::trim).all(|name| HARMLESS.iter().any(|it| name.starts_with(it)))
}

/// Runs the case with this program in a private network.
pub(super) fn run(case: &Case, options: &Options) -> Result<BenchResult, PrivateNetworkError> {
    if std::env::var_os(INSIDE).is_some() {
        let tried = "unshare: the new network has interfaces\n".to_owned();
        return Err(PrivateNetworkError::NotPermitted { tried });
    }
    let inside = |text: String| PrivateNetworkError::Inside(text);
    let program = std::env::current_exe().map_err(|error| inside(error.to_string()))?;
    let mut tried = String::new();
    for option in ["-n", "-rn"] {
        // Check first that it is allowed: a later failure has another cause.
        let allowed = Command::new("unshare").args([option, "true"]).output();
        match allowed {
            Ok(output) if output.status.success() => {}
            Ok(output) => {
                let error = String::from_utf8_lossy(&output.stderr);
                tried += &format!("unshare {option}: {}\n", error.trim());
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
        let results: Result<Vec<BenchResult>, _> = serde_json::from_slice(&output.stdout);
        let results = results.map_err(|error| inside(error.to_string()))?;
        return results.into_iter().next().ok_or_else(|| inside("no result".to_owned()));
    }
    Err(PrivateNetworkError::NotPermitted { tried })
}
