//! Borrowed results, the source of zero-copy streams.

use super::Snapshot;
use crate::base::{Real, Vec3};

/// Results of a tick, borrowed from the session. All slices are in the order of ids.
pub struct View<'a> {
    /// The snapshot of the same tick.
    pub snapshot: &'a Snapshot,
    /// Positions of the grains (m).
    pub grain_positions: &'a [Vec3],
    /// Velocities of the grains (m/s).
    pub grain_velocities: &'a [Vec3],
    /// Angular velocities of the grains (rad/s).
    pub grain_spins: &'a [Vec3],
    /// Radii of the grains (m).
    pub grain_radii: &'a [Real],
    /// Sum of normal force magnitudes on each grain (N).
    pub grain_normal_forces: &'a [Real],
    /// Positions of the membrane's vertices (m).
    pub vertex_positions: &'a [Vec3],
    /// Velocities of the membrane's vertices (m/s).
    pub vertex_velocities: &'a [Vec3],
    /// Contact force on each vertex (N).
    pub vertex_contact_forces: &'a [Vec3],
}
