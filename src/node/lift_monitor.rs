//! What came of a run: how high the object was lifted, whether it was held, how hard it was
//! pushed. Judged from snapshots alone, whoever gave the commands.

use crate::{base::Real, snapshot::Snapshot};

/// The flange holds when it is slower than this (m/s) …
const STILL_SPEED: Real = 1e-3;
/// … for this time (s) …
const STILL_TIME: Real = 0.1;
/// … this far above the lowest place it has been (m) …
const RAISED: Real = 0.02;
/// … and the pump is asked for a vacuum beyond this (Pa).
const VACUUM: Real = -1e3;
/// Share of the flange's rise that a held object has at least.
const HELD_SHARE: Real = 0.9;
/// Largest overlap of grains, over their diameter, at which Hertz' law is trusted.
const OVERLAP_LIMIT: Real = 0.1;

/// Watches a run.
#[derive(Clone, Debug)]
pub struct LiftMonitor {
    object_lowest: Real,
    flange_lowest: Real,
    still_since: Option<Real>,
    verdict: LiftMetrics,
}

/// What came of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LiftMetrics {
    /// Greatest height of the object over its lowest place before (m).
    pub lift_height: Real,
    /// Time for which the flange held still, raised and under vacuum (s).
    pub hold_time: Real,
    /// Smallest share of the flange's rise that the object had in that time.
    pub hold_share_min: Real,
    /// Greatest upward force of the object on the gripper (N).
    pub peak_push_force: Real,
    /// Greatest downward force of the object on the gripper (N).
    pub peak_pull_force: Real,
    /// Largest overlap between grains over the mean diameter.
    pub overlap_ratio_max: Real,
    /// Largest overlap between grain and membrane over the mean diameter.
    pub membrane_overlap_ratio_max: Real,
}

impl LiftMetrics {
    /// True if the object stayed up for as long as the flange held.
    pub fn is_held(&self) -> bool {
        0.0 < self.hold_time && HELD_SHARE <= self.hold_share_min
    }

    /// True if no grain overlapped more than the contact law bears.
    pub fn is_valid(&self) -> bool {
        self.overlap_ratio_max <= OVERLAP_LIMIT
    }

    /// The limit of `is_valid`.
    pub fn overlap_limit(&self) -> Real {
        OVERLAP_LIMIT
    }
}

impl Default for LiftMonitor {
    fn default() -> Self {
        Self {
            object_lowest: Real::INFINITY,
            flange_lowest: Real::INFINITY,
            still_since: None,
            verdict: LiftMetrics::default(),
        }
    }
}

impl LiftMonitor {
    /// Looks at the end of a tick of `tick` seconds.
    pub fn look(&mut self, seen: &Snapshot, tick: Real) {
        let time = std::time::Duration::from_nanos(seen.time_ns).as_secs_f64();
        let flange = seen.flange.pose.translation.vector.z;
        let force = seen.contact_force_world();
        let verdict = &mut self.verdict;
        verdict.peak_push_force = verdict.peak_push_force.max(force.z);
        verdict.peak_pull_force = verdict.peak_pull_force.max(-force.z);
        let overlap = seen.jamming.overlap_ratio_max;
        verdict.overlap_ratio_max = verdict.overlap_ratio_max.max(overlap);
        let overlap = seen.jamming.membrane_overlap_ratio_max;
        verdict.membrane_overlap_ratio_max = verdict.membrane_overlap_ratio_max.max(overlap);
        self.flange_lowest = self.flange_lowest.min(flange);
        let Some(object) = seen.objects.first() else { return };
        let height = object.body.pose.translation.vector.z;
        self.object_lowest = self.object_lowest.min(height);
        let lifted = height - self.object_lowest;
        verdict.lift_height = verdict.lift_height.max(lifted);
        let raised = flange - self.flange_lowest;
        let is_still = seen.flange.twist.linear.norm() < STILL_SPEED;
        let since = *self.still_since.get_or_insert(time);
        if !is_still {
            self.still_since = None;
        } else if STILL_TIME <= time - since
            && RAISED <= raised
            && seen.chamber.gauge_setpoint < VACUUM
        {
            let share = lifted / raised;
            let is_first = verdict.hold_time == 0.0;
            verdict.hold_share_min =
                if is_first { share } else { verdict.hold_share_min.min(share) };
            verdict.hold_time += tick;
        }
    }

    /// The verdict so far.
    pub fn verdict(&self) -> LiftMetrics {
        self.verdict
    }
}
