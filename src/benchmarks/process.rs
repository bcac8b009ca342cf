//! What the system tells of this process: memory, processor time, priority. All of it is Linux'; elsewhere
//! nothing is told.

use std::fs;

use crate::base::{Real, real::real_of};

/// Forgets the peak of memory so far: what comes next is then counted alone.
pub(super) fn forget_peak() {
    // Without the right to do so the peak is that of all cases so far.
    drop(fs::write("/proc/self/clear_refs", "5"));
}

/// Largest resident set since the last `forget_peak` (bytes).
pub(super) fn peak() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// Processor time of all threads that there are (s).
pub(super) fn processor_s() -> Option<Real> {
    let mut sum = 0;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        // A thread that ended meanwhile has no file any more.
        let Ok(text) = fs::read_to_string(thread.ok()?.path().join("schedstat")) else { continue };
        sum += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(1e-9 * real_of(sum))
}

/// How nice this process is; 0 where that is not told.
pub(super) fn niceness() -> i32 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name of the program, in parentheses, may hold anything; the 17th word after it is meant.
    let after = stat.rsplit_once(')').map_or("", |(_, after)| after);
    after.split_whitespace().nth(16).and_then(|it| it.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the memory that is written to, and a loop that runs until its time is counted.
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
