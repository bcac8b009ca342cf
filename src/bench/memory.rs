//! How much memory this process has held at most.

use std::fs;

/// Forgets the peak so far, where the system can: what comes next is then counted alone.
pub(super) fn forget_peak() {
    // Elsewhere than on Linux, or without the right, the peak is that of all cases so far.
    drop(fs::write("/proc/self/clear_refs", "5"));
}

/// Largest resident set since the last `forget_peak` [bytes], where the system tells it.
pub(super) fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}
