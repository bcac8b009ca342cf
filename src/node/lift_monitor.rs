//! Metrics of a lift: how high the object was lifted, whether it was held, how hard it was pushed.
//! They are computed from snapshots alone, whatever controlled the run.

use crate::{base::Real, snapshot::Snapshot};

/// The flange holds still when it is slower than this (m/s) …
const STILL_SPEED: Real = 1e-3;
/// … for this time (s) …
const STILL_TIME: Real = 0.1;
/// … this far above its lowest height so far (m) …
const RAISED: Real = 0.02;
/// … and the commanded gauge pressure is below this (Pa).
const VACUUM: Real = -1e3;
/// Smallest fraction of the rise of the flange at which an object counts as held.
const HELD_SHARE: Real = 0.9;
/// Largest overlap of grains, over their diameter, at which Hertz' law is valid.
const OVERLAP_LIMIT: Real = 0.1;

/// Computes the metrics of a run.
#[derive(Clone, Debug)]
pub struct LiftMonitor {
    object_lowest: Real,
    flange_lowest: Real,
    still_since: Option<Real>,
    metrics: LiftMetrics,
}

/// Metrics of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LiftMetrics {
    /// Greatest height of the object above its lowest height before (m).
    pub lift_height: Real,
    /// Time for which the flange held still, raised and under vacuum (s).
    pub hold_time: Real,
    /// Smallest ratio of the rise of the object to that of the flange in that time.
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

    /// True if no overlap was outside the validity of the contact law.
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
            metrics: LiftMetrics::default(),
        }
    }
}

impl LiftMonitor {
    /// Takes the results of a tick of `tick` seconds.
    pub fn update(&mut self, snapshot: &Snapshot, tick: Real) {
        let time = std::time::Duration::from_nanos(snapshot.time_ns).as_secs_f64();
        let flange = snapshot.flange.pose.translation.vector.z;
        let force = snapshot.contact_force_world();
        let metrics = &mut self.metrics;
        metrics.peak_push_force = metrics.peak_push_force.max(force.z);
        metrics.peak_pull_force = metrics.peak_pull_force.max(-force.z);
        let overlap = snapshot.jamming.overlap_ratio_max;
        metrics.overlap_ratio_max = metrics.overlap_ratio_max.max(overlap);
        let overlap = snapshot.jamming.membrane_overlap_ratio_max;
        metrics.membrane_overlap_ratio_max = metrics.membrane_overlap_ratio_max.max(overlap);
        self.flange_lowest = self.flange_lowest.min(flange);
        let Some(object) = snapshot.objects.first() else { return };
        let height = object.body.pose.translation.vector.z;
        self.object_lowest = self.object_lowest.min(height);
        let lifted = height - self.object_lowest;
        metrics.lift_height = metrics.lift_height.max(lifted);
        let raised = flange - self.flange_lowest;
        let is_still = snapshot.flange.twist.linear.norm() < STILL_SPEED;
        let since = *self.still_since.get_or_insert(time);
        if !is_still {
            self.still_since = None;
        } else if STILL_TIME <= time - since
            && RAISED <= raised
            && snapshot.chamber.gauge_setpoint < VACUUM
        {
            let share = lifted / raised;
            let is_first = metrics.hold_time == 0.0;
            metrics.hold_share_min =
                if is_first { share } else { metrics.hold_share_min.min(share) };
            metrics.hold_time += tick;
        }
    }

    /// The metrics so far.
    pub fn metrics(&self) -> LiftMetrics {
        self.metrics
    }
}
