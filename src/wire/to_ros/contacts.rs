//! Contacts between membrane and objects, as data and as arrows.

use super::{WORLD, parts};
use crate::{
    base::Vec3,
    snapshot::ContactSnapshot,
    wire::messages::{
        geometry_msgs::{Pose, Quaternion, Vector3},
        jamgrip_msgs::{Contact, ContactArray},
        std_msgs::ColorRGBA,
        visualization_msgs::{Marker, MarkerArray},
    },
};

/// Largest number of arrows; they show the strongest contacts.
const ARROWS_MAX: usize = 200;
/// Length of an arrow per force (m/N).
const ARROW_LENGTH: f64 = 0.02;

/// All contacts.
pub(super) fn array(contacts: &[ContactSnapshot], objects: &[&str], time_ns: u64) -> ContactArray {
    let contact = |it: &ContactSnapshot| {
        // The normal points from the object to the membrane; the membrane pushes against it.
        let normal_part: Vec3 = it.normal * it.normal.dot(&it.force);
        Contact {
            object: objects.get(it.object).copied().unwrap_or_default().to_owned(),
            point: parts::point(&it.point),
            normal: parts::vector(&it.normal),
            normal_force: it.normal_force,
            tangential_force: parts::vector(&(it.force - normal_part)),
            force: parts::vector(&it.force),
            overlap: it.overlap,
        }
    };
    ContactArray {
        header: parts::header(time_ns, WORLD),
        contacts: contacts.iter().map(contact).collect(),
    }
}

/// Arrows along the forces on the objects. Their IDs are 0, 1, 2 … from the strongest on. They
/// expire after two periods, so that no arrow outlives its contact.
pub(super) fn markers(contacts: &[ContactSnapshot], time_ns: u64, rate: f64) -> MarkerArray {
    let mut strongest: Vec<&ContactSnapshot> = contacts.iter().collect();
    strongest.sort_by(|a, b| b.normal_force.total_cmp(&a.normal_force));
    strongest.truncate(ARROWS_MAX);
    let arrow = |(id, contact): (i32, &ContactSnapshot)| Marker {
        header: parts::header(time_ns, WORLD),
        ns: "contacts".to_owned(),
        id,
        r#type: Marker::ARROW,
        action: Marker::ADD,
        pose: Pose {
            orientation: Quaternion { w: 1.0, ..Default::default() },
            ..Default::default()
        },
        // For an arrow between two points: diameters of shaft and head, and length of the head (m).
        scale: Vector3 { x: 0.0006, y: 0.0015, z: 0.002 },
        color: ColorRGBA { r: 0.1, g: 0.5, b: 0.9, a: 1.0 },
        lifetime: parts::duration(2.0 / rate),
        points: vec![
            parts::point(&contact.point),
            parts::point(&(contact.point + contact.force * ARROW_LENGTH)),
        ],
        ..Default::default()
    };
    MarkerArray { markers: (0..).zip(strongest).map(arrow).collect() }
}
