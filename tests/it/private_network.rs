//! A private network for every test that uses DDS: no traffic leaves or enters.
//!
//! A test runs its body by starting this binary again, for this one test, in a network namespace
//! with only a loopback interface. If the system does not allow such a namespace, the test fails
//! with instructions: it never passes without having run.

use std::{
    io::Write,
    path::PathBuf,
    process::{Command, Stdio},
};

use jamgrip::ros::discovery::{DiscoveryExtent, DiscoveryRange};

/// Set inside the network namespace.
const INSIDE: &str = "JAMGRIP_TEST_PRIVATE_NETWORK";
/// Printed once the namespace exists and its loopback interface is up.
const READY: &str = "private network is ready";

/// Brings up the loopback interface and becomes the test.
const ENTER: &str = concat!(
    include_str!("../../src/benchmarks/latency/loopback_up.sh"),
    "echo \"private network is ready\"\nexec \"$0\" \"$@\"\n"
);

/// Runs `body` for the test of this name, inside a private network.
pub(crate) fn inside(test: &str, body: impl FnOnce()) {
    if std::env::var_os(INSIDE).is_some() {
        return body();
    }
    let here = std::env::current_exe().unwrap();
    let first = if is_root() { "-n" } else { "-rn" };
    let mut tried = String::new();
    for option in [first, "-rn"] {
        let output = Command::new("unshare")
            .args([option, "sh", "-c", ENTER])
            .arg(&here)
            .args(["--exact", test, "--nocapture"])
            .env(INSIDE, "1")
            .stdin(Stdio::null())
            .output()
            .unwrap_or_else(|it| panic!("`unshare` (util-linux) cannot be run: {it}; install it"));
        let output_text = String::from_utf8_lossy(&output.stdout).into_owned();
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        if output_text.contains(READY) {
            assert!(
                output_text.contains("1 passed") || !output.status.success(),
                "no test `{test}`"
            );
            assert!(
                output.status.success(),
                "`{test}` failed in its private network:\n{output_text}\n{errors}"
            );
            // Measurements, shown with `--nocapture`.
            write!(std::io::stderr().lock(), "{errors}").unwrap();
            return;
        }
        tried += &format!("unshare {option}: {}\n", errors.trim());
    }
    panic!(
        "`{test}` DID NOT RUN: this system allows no private network, and DDS tests never use \
         another.\n{tried}Run as root, with CAP_SYS_ADMIN in a container, or allow unprivileged user \
         namespaces (sysctl kernel.unprivileged_userns_clone=1, \
         kernel.apparmor_restrict_unprivileged_userns=0)."
    );
}

/// As `inside`, with the Python peers installed while there is still a network.
pub(crate) fn inside_with_peers(test: &str, body: impl FnOnce()) {
    crate::peers::python();
    inside(test, body);
}

/// A domain for this process, on this host only.
pub(crate) fn discovery_range() -> DiscoveryRange {
    let id = u16::try_from(std::process::id() % 200).unwrap();
    DiscoveryRange { domain_id: 1 + id, extent: DiscoveryExtent::Host }
}

/// A file for CycloneDDS: loopback only, found without multicast.
pub(crate) fn cyclone_config(folder: &std::path::Path) -> PathBuf {
    let path = folder.join("cyclonedds.xml");
    let text = r#"<CycloneDDS><Domain id="any">
  <General>
    <Interfaces><NetworkInterface name="lo" multicast="false"/></Interfaces>
    <AllowMulticast>false</AllowMulticast>
  </General>
  <Discovery>
    <ParticipantIndex>auto</ParticipantIndex>
    <MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>
    <Peers><Peer address="127.0.0.1"/></Peers>
  </Discovery>
</Domain></CycloneDDS>
"#;
    std::fs::write(&path, text).unwrap();
    path
}

fn is_root() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().any(|it| it.starts_with("Uid:\t0\t"))
}
