//! Memory, processor time and priority of this process, from Linux; unknown elsewhere.

use std::fs;

use crate::base::{Real, real::real_of};

/// Resets the peak of memory, so that only later memory counts.
pub(super) fn reset_peak() {
    // Without permission the peak is that of all cases so far.
    drop(fs::write("/proc/self/clear_refs", "5"));
}

/// Largest resident set since the last `reset_peak` (bytes).
pub(super) fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// Processor time of all current threads (s).
pub(super) fn processor_s() -> Option<Real> {
    let mut sum = 0;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        // A thread that has ended in the meantime has no file.
        let Ok(text) = fs::read_to_string(thread.ok()?.path().join("schedstat")) else { continue };
        sum += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(1e-9 * real_of(sum))
}

/// Niceness of this process; 0 if unknown.
pub(super) fn niceness() -> i32 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The program name in parentheses may contain anything; the niceness is the 17th word after it.
    let after = stat.rsplit_once(')').map_or("", |(_, after)| after);
    after.split_whitespace().nth(16).and_then(|it| it.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the memory that is allocated, and a loop that runs until its time is counted.
    #[test]
    #[cfg(target_os = "linux")]
    fn memory_and_time_are_those_of_this_process() {
        let block = vec![1_u8; 50 << 20];
        assert!(peak().unwrap() > u64::try_from(std::hint::black_box(block).len()).unwrap());
        let start = processor_s().unwrap();
        while processor_s().unwrap() < start + 0.01 {}
        assert!((-20..=19).contains(&niceness()));
    }
}
