//! Row types in shared memory: fixed layouts that any process on this host can read in place.
//!
//! All numbers are in SI units, along world axes unless a field says otherwise, and in the
//! precision of the core: they are neither rounded nor packed. Every field is eight bytes wide, so
//! the layouts have no padding and are the same in C, C++ and Python's `ctypes`. Row `i` of a list
//! is the grain or vertex with ID `i`.

use crate::{
    base::{Pose, Vec3, real::Wrench},
    snapshot::{BodySnapshot, ObjectSnapshot, view::View},
};
#[cfg(feature = "shm")]
use iceoryx2::prelude::ZeroCopySend;

/// The coupled system at the end of one tick.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "shm", derive(ZeroCopySend), type_name("jamgrip::StateRow"))]
pub struct StateRow {
    /// The tick.
    pub tick: u64,
    /// Simulation time at its end (ns).
    pub time_ns: u64,
    /// Digest of the whole state.
    pub digest: u64,
    /// Number of grains.
    pub n_grains: u64,
    /// Number of vertices of the membrane.
    pub n_vertices: u64,
    /// The gripper's flange.
    pub flange: BodyRow,
    /// The object to grip: the first of the scene.
    pub object: BodyRow,
    /// Total contact force on the object from membrane and table, without gravity (N).
    pub object_contact_force: [f64; 3],
    /// Total contact torque on the object about its center of mass (N m).
    pub object_contact_torque: [f64; 3],
    /// Contact force of the objects on the gripper, along flange axes (N).
    pub contact_force: [f64; 3],
    /// Contact torque of the objects on the gripper about the flange's origin, along flange axes (N
    /// m).
    pub contact_torque: [f64; 3],
    /// Force of the whole gripper on its mount, along flange axes (N).
    pub mount_force: [f64; 3],
    /// Torque of the whole gripper on its mount about the flange's origin, along flange axes (N m).
    pub mount_torque: [f64; 3],
    /// Commanded gauge pressure, clamped to its limits (Pa).
    pub gauge_setpoint: f64,
    /// Actual gauge pressure, negative under vacuum (Pa).
    pub gauge: f64,
    /// Absolute ambient pressure (Pa).
    pub ambient: f64,
    /// Volume enclosed by membrane and flange (m³).
    pub volume: f64,
    /// Mean number of contacts per grain.
    pub coordination_number: f64,
    /// Fraction of grains with at least four contacts.
    pub jammed_fraction: f64,
    /// Grain volume over enclosed volume.
    pub solid_fraction: f64,
}

/// Pose and velocity of a body.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "shm", derive(ZeroCopySend), type_name("jamgrip::BodyRow"))]
pub struct BodyRow {
    /// Position of the frame's origin x, y, z (m).
    pub position: [f64; 3],
    /// Orientation as a unit quaternion x, y, z, w.
    pub orientation: [f64; 4],
    /// Velocity of the frame's origin (m/s).
    pub linear_velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub angular_velocity: [f64; 3],
}

/// The header of a list of rows.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "shm", derive(ZeroCopySend), type_name("jamgrip::RowsHeader"))]
pub struct RowsHeader {
    /// The tick.
    pub tick: u64,
    /// Simulation time at its end (ns).
    pub time_ns: u64,
    /// Number of rows.
    pub count: u64,
}

/// One grain.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "shm", derive(ZeroCopySend), type_name("jamgrip::GrainRow"))]
pub struct GrainRow {
    /// Position x, y, z (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Angular velocity (rad/s).
    pub spin: [f64; 3],
    /// Radius (m).
    pub radius: f64,
    /// Sum of the magnitudes of normal forces (N).
    pub normal_force: f64,
}

/// One vertex of the membrane.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "shm", derive(ZeroCopySend), type_name("jamgrip::VertexRow"))]
pub struct VertexRow {
    /// Position x, y, z (m).
    pub position: [f64; 3],
    /// Velocity (m/s).
    pub velocity: [f64; 3],
    /// Contact force on the vertex (N).
    pub contact_force: [f64; 3],
}

impl StateRow {
    /// The row of a tick.
    pub fn of(view: &View<'_>) -> Self {
        let snapshot = view.snapshot;
        let object = snapshot.objects.first();
        let (object_contact_force, object_contact_torque) =
            object.map_or(([0.0; 3], [0.0; 3]), |it| force_and_torque(&it.contact_wrench));
        let (contact_force, contact_torque) = force_and_torque(&snapshot.contact_wrench);
        let (mount_force, mount_torque) = force_and_torque(&snapshot.mount_wrench);
        Self {
            tick: snapshot.tick.0,
            time_ns: snapshot.time_ns,
            digest: snapshot.digest,
            n_grains: view.grain_positions.len() as u64,
            n_vertices: view.vertex_positions.len() as u64,
            flange: BodyRow::of(&snapshot.flange),
            object: object.map(of_object).unwrap_or_default(),
            object_contact_force,
            object_contact_torque,
            contact_force,
            contact_torque,
            mount_force,
            mount_torque,
            gauge_setpoint: snapshot.chamber.gauge_setpoint,
            gauge: snapshot.chamber.gauge,
            ambient: snapshot.chamber.ambient,
            volume: snapshot.chamber.volume,
            coordination_number: snapshot.jamming.coordination_number,
            jammed_fraction: snapshot.jamming.jammed_fraction,
            solid_fraction: snapshot.jamming.solid_fraction,
        }
    }
}

impl BodyRow {
    /// The row of a body.
    pub fn of(body: &BodySnapshot) -> Self {
        let (position, orientation) = position_and_orientation(&body.pose);
        Self {
            position,
            orientation,
            linear_velocity: body.twist.linear.into(),
            angular_velocity: body.twist.angular.into(),
        }
    }
}

impl GrainRow {
    /// The row of grain `i`.
    pub fn of(view: &View<'_>, i: usize) -> Self {
        Self {
            position: view.grain_positions[i].into(),
            velocity: view.grain_velocities[i].into(),
            spin: view.grain_spins[i].into(),
            radius: view.grain_radii[i],
            normal_force: view.grain_normal_forces[i],
        }
    }
}

impl VertexRow {
    /// The row of vertex `i`.
    pub fn of(view: &View<'_>, i: usize) -> Self {
        Self {
            position: view.vertex_positions[i].into(),
            velocity: view.vertex_velocities[i].into(),
            contact_force: view.vertex_contact_forces[i].into(),
        }
    }
}

fn of_object(object: &ObjectSnapshot) -> BodyRow {
    BodyRow::of(&object.body)
}

fn position_and_orientation(pose: &Pose) -> ([f64; 3], [f64; 4]) {
    let q = pose.rotation.coords;
    (pose.translation.vector.into(), [q.x, q.y, q.z, q.w])
}

fn force_and_torque(wrench: &Wrench) -> ([f64; 3], [f64; 3]) {
    let row = |v: Vec3| v.into();
    (row(wrench.force), row(wrench.torque))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{align_of, offset_of, size_of};

    /// Oracle: fields counted by hand; C lays out eight-byte fields without padding.
    #[test]
    fn layouts_have_no_padding() {
        assert_eq!(align_of::<StateRow>(), 8);
        assert_eq!(size_of::<BodyRow>(), 13 * 8);
        assert_eq!(size_of::<StateRow>(), (5 + 2 * 13 + 6 * 3 + 7) * 8);
        assert_eq!(size_of::<RowsHeader>(), 3 * 8);
        assert_eq!(size_of::<GrainRow>(), 11 * 8);
        assert_eq!(size_of::<VertexRow>(), 9 * 8);
        assert_eq!(offset_of!(StateRow, flange), 5 * 8);
        assert_eq!(offset_of!(StateRow, contact_force), (5 + 2 * 13 + 2 * 3) * 8);
        assert_eq!(offset_of!(GrainRow, radius), 9 * 8);
    }
}
