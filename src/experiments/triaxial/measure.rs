//! Measurements on a specimen.
//!
//! ```text
//! p_plate = F/A,  A = V/h            σ_d = p_plate − p_c,   ε = ln(h_0/h)
//! σ_zz = 1/V_m Σ_c f_z l_z,   σ_rr = 1/2V_m Σ_c (f_x l_x + f_y l_y)
//! ```
//!
//! F is the force of the grains on a plate, V the volume inside membrane and plates, h the distance
//! of the plates. Stresses are those in the middle half of the height, away from the end rings,
//! which hold the membrane: V_m is its volume; f and l are force and branch vector of each contact,
//! and of l only the part inside V_m counts. For contacts with the membrane l goes from the contact
//! point to the center of the grain.

use super::build::{BOTTOM, TOP};
use crate::{
    base::{Real, Vec3, real::real},
    measure,
    physics::{
        System,
        contact::sums,
        membrane::{pressure, stretch},
    },
};

/// Forces of the grains on the lower and the upper plate, outward along the axis (N).
pub(super) fn plate_forces(system: &System) -> [Real; 2] {
    let on = |wall: u32, sign: Real| {
        let contacts = system.scratch.touching_walls(&system.state);
        let of_wall = contacts.filter(|(_, [w, _])| *w == wall as usize);
        sign * of_wall.map(|(contact, _)| contact.force.z).sum::<Real>()
    };
    [on(BOTTOM, 1.0), on(TOP, -1.0)]
}

/// Distance of the plates (m).
pub(super) fn height(system: &System) -> Real {
    let z = |wall: u32| system.state.walls[wall as usize].pose.translation.z;
    z(TOP) - z(BOTTOM)
}

/// Volume inside membrane and plates (m³).
pub(super) fn volume(system: &System) -> Real {
    pressure::volume(&system.model.membrane.mesh, &system.state.membrane.positions)
}

/// Mean distance of the membrane from the axis in the middle half of the height and at the ends
/// (m).
pub(super) fn radii(system: &System) -> [Real; 2] {
    let mesh = &system.model.membrane.mesh;
    let top = mesh.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    let mean = |is_in: &dyn Fn(Real) -> bool| {
        let (mut sum, mut n) = (0.0, 0);
        for (reference, position) in mesh.positions.iter().zip(&system.state.membrane.positions) {
            if is_in(reference.z.abs() / top) {
                sum += position.xy().norm();
                n += 1;
            }
        }
        sum / real(n)
    };
    [mean(&|z| z <= 0.25), mean(&|z| z >= 0.75)]
}

/// Pressure that the springs of the membrane add to the confining pressure in the middle half (Pa);
/// negative if the grains have contracted. It is the lateral virial of the springs over twice the
/// volume, Σ F (Δx² + Δy²)/L / 2V, from the means over the edges around the axis and the other
/// edges, of which there are twice as many.
pub(super) fn hoop_pressure(system: &System) -> Real {
    let membrane = &system.model.membrane;
    let (mesh, material) = (&membrane.mesh, &membrane.material);
    let stiffness = stretch::stiffness(material.youngs_modulus, material.thickness);
    let top = mesh.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    let (mut sums, mut n) = ([0.0; 2], [0; 2]);
    for ends in &mesh.edges {
        let edge = |all: &[Vec3]| all[ends[0] as usize] - all[ends[1] as usize];
        let (first, now) = (edge(&mesh.positions), edge(&system.state.membrane.positions));
        let [low, high] = ends.map(|v| mesh.positions[v as usize].z.abs());
        if low.max(high) <= 0.5 * top {
            let kind = usize::from(first.z.abs() > 1e-6 * top);
            let tension = stiffness * (now.norm() - first.norm());
            sums[kind] += tension * now.xy().norm_squared() / now.norm();
            n[kind] += 1;
        }
    }
    let [around, across] = [0, 1].map(|kind| sums[kind] / real(n[kind].max(1)));
    // A row of triangles has as many vertices as half its triangles: one edge around, two across.
    let n_vertices = real(mesh.triangles.len()) / 2.0;
    let volume = middle_section(system) * height(system);
    n_vertices * (around + 2.0 * across) / (2.0 * volume)
}

/// Kinetic energy of the grains (J). That of the membrane is not included: single vertices of a few
/// milligrams may oscillate forever between two contacts while nothing else moves.
pub(super) fn grain_energy(system: &System) -> Real {
    let grains = &system.state.grains;
    let twice = |i: usize| {
        let gyration = 0.4 * grains.radii[i] * grains.radii[i];
        let (v, w) =
            (grains.velocities[i].norm_squared(), grains.angular_velocities[i].norm_squared());
        grains.masses[i] * (v + gyration * w)
    };
    0.5 * (0..grains.len()).map(twice).sum::<Real>()
}

/// Stress and energy of all contacts.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct ContactSums {
    /// Axial and mean lateral stress of the grains in the middle half of the height (Pa).
    pub(super) stress: [Real; 2],
    /// Elastic energy of contacts between grains and with plates and membrane (J).
    pub(super) elastic_energy: Real,
    /// Largest overlap of two grains over their mean diameter.
    pub(super) overlap_over_diameter: Real,
    /// Mean unbalanced force of a grain over the mean contact force.
    pub(super) unbalanced: Real,
    /// Contacts per grain.
    pub(super) coordination: Real,
}

/// Sums over all contacts of the last substep.
pub(super) fn contacts(system: &System) -> ContactSums {
    let z = |wall: u32| system.state.walls[wall as usize].pose.translation.z;
    let mut sum = Sum {
        center: 0.5 * (z(BOTTOM) + z(TOP)),
        half_height: 0.25 * (z(TOP) - z(BOTTOM)),
        ..Sum::default()
    };
    of_grains(system, &mut sum);
    of_membrane(system, &mut sum);
    for (contact, _) in system.scratch.touching_walls(&system.state) {
        sum.n += 1;
        sum.force += contact.force.norm();
        sum.normal_overlap += contact.normal * contact.overlap;
    }
    let n_grains = system.state.grains.len();
    let volume = middle_section(system) * 2.0 * sum.half_height;
    let unbalanced: Real = (0..n_grains)
        .map(|i| sums::on_grain(&system.state.grains, &system.scratch, i).0.norm())
        .sum();
    let mean_force = sum.force / real(sum.n.max(1));
    ContactSums {
        stress: [sum.axial / volume, sum.lateral / (2.0 * volume)],
        elastic_energy: 0.4 * sum.normal_overlap,
        overlap_over_diameter: sum.overlap_over_diameter,
        unbalanced: unbalanced / real(n_grains) / mean_force.max(Real::MIN_POSITIVE),
        coordination: measure::packing(&system.state, &system.scratch).coordination_number,
    }
}

/// Mean cross-section inside the membrane in the middle half of the height (m²).
fn middle_section(system: &System) -> Real {
    let mesh = &system.model.membrane.mesh;
    let top = mesh.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    let (mut squares, mut n) = (0.0, 0);
    for (reference, position) in mesh.positions.iter().zip(&system.state.membrane.positions) {
        if reference.z.abs() <= 0.5 * top {
            squares += position.xy().norm_squared();
            n += 1;
        }
    }
    // A ring of vertices is a polygon, which is smaller than its circle.
    let turn = 2.0 * std::f64::consts::PI / real(mesh.rims[0].len());
    std::f64::consts::PI * (turn.sin() / turn) * squares / real(n)
}

#[derive(Default)]
struct Sum {
    /// Height of the specimen's center (m).
    center: Real,
    /// Half of the middle half of its height (m).
    half_height: Real,
    axial: Real,
    lateral: Real,
    /// Σ F ξ (J); a Hertz contact stores 2/5 of it.
    normal_overlap: Real,
    overlap_over_diameter: Real,
    force: Real,
    n: usize,
}

impl Sum {
    /// Adds a contact: its force on the body at `end` (m), its branch vector up to there, and F ξ.
    fn add(&mut self, force: &Vec3, end: &Vec3, branch: &Vec3, normal_overlap: Real) {
        let share = self.share(end.z - branch.z, end.z);
        self.axial += share * force.z * branch.z;
        self.lateral += share * (force.x * branch.x + force.y * branch.y);
        self.normal_overlap += normal_overlap;
        self.force += force.norm();
        self.n += 1;
    }

    /// Share of a line between two heights (m) that is in the middle half.
    fn share(&self, from: Real, to: Real) -> Real {
        let (low, high) = (from.min(to) - self.center, from.max(to) - self.center);
        let inside = high.min(self.half_height) - low.max(-self.half_height);
        // Lines within a nanometer of the horizontal are completely inside or outside.
        if high - low < 1e-9 {
            return if low.abs() < self.half_height { 1.0 } else { 0.0 };
        }
        (inside / (high - low)).clamp(0.0, 1.0)
    }
}

fn of_grains(system: &System, sum: &mut Sum) {
    let grains = &system.state.grains;
    for (pair, ids) in system.scratch.touching_pairs(&system.state) {
        let [i, j] = ids.map(|id| id as usize);
        let branch = grains.positions[i] - grains.positions[j];
        sum.add(&pair.force, &grains.positions[i], &branch, pair.normal * pair.overlap);
        let diameter = grains.radii[i] + grains.radii[j];
        sum.overlap_over_diameter = sum.overlap_over_diameter.max(pair.overlap / diameter);
    }
}

fn of_membrane(system: &System, sum: &mut Sum) {
    let (grains, membrane) = (&system.state.grains, &system.state.membrane);
    let triangles = &system.model.membrane.mesh.triangles;
    for (patches, center) in system.scratch.patch_forces.iter().zip(&grains.positions) {
        for patch in &patches.contacts[..patches.n] {
            let corners =
                triangles[patch.triangle as usize].map(|v| membrane.positions[v as usize]);
            let point: Vec3 = corners.iter().zip(patch.weights).map(|(r, w)| r * w).sum();
            sum.add(&patch.force, center, &(center - point), patch.normal * patch.overlap);
        }
    }
    let ids = &system.state.springs.spheres.ids;
    for (contact, [grain, vertex]) in system.scratch.sphere_forces.iter().zip(ids) {
        if contact.flags.touches() {
            let grain = *grain as usize;
            let center = &grains.positions[grain];
            let arm = center - membrane.positions[*vertex as usize];
            let branch = arm.normalize() * (grains.radii[grain] - 0.5 * contact.overlap);
            sum.add(&contact.force, center, &branch, contact.normal * contact.overlap);
        }
    }
}
