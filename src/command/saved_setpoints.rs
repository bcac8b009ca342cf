//! Setpoints as bytes, to restore them when a session is resumed.

use serde::{Deserialize, Serialize};

use super::{
    CommandCounts,
    apply::{CommandProcessor, Target},
};
use crate::{
    base::Real,
    cosim::saved_state::{SavedStateError, check_counts, pose, pose_row},
};

/// A pose and when it was commanded (ns).
type SavedTarget = ([Real; 7], u64);

/// All setpoints that change during a run.
#[derive(Serialize, Deserialize)]
struct Numbers {
    gauge_setpoint: Real,
    flange: SavedTarget,
    drives: Vec<Option<SavedTarget>>,
    counts: [u64; 3],
}

impl CommandProcessor {
    /// The setpoints as bytes.
    pub fn save(&self) -> Vec<u8> {
        let saved = |target: &Target| (pose_row(&target.pose), target.time_ns);
        let CommandCounts { n_applied, n_limited, n_rejected } = self.counts;
        let numbers = Numbers {
            gauge_setpoint: self.gauge_setpoint,
            flange: saved(&self.flange),
            drives: self.drives.iter().map(|drive| drive.as_ref().map(saved)).collect(),
            counts: [n_applied, n_limited, n_rejected],
        };
        postcard::to_stdvec(&numbers).expect("a list of numbers always serializes")
    }

    /// Restores saved setpoints.
    ///
    /// # Errors
    /// If the bytes are corrupt, or belong to a scene with another number of objects.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), SavedStateError> {
        let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
        let numbers: Numbers = postcard::from_bytes(bytes).map_err(|_| corrupt)?;
        check_counts(&[("driven objects", numbers.drives.len(), self.drives.len())])?;
        let target = |(row, time_ns): &SavedTarget| Target { pose: pose(row), time_ns: *time_ns };
        let [n_applied, n_limited, n_rejected] = numbers.counts;
        self.gauge_setpoint = numbers.gauge_setpoint;
        self.flange = target(&numbers.flange);
        self.drives = numbers.drives.iter().map(|drive| drive.as_ref().map(target)).collect();
        self.counts = CommandCounts { n_applied, n_limited, n_rejected };
        Ok(())
    }
}
