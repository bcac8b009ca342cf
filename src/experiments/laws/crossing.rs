//! A grain that is moved over the membrane: force, direction and contact point over edges and
//! vertices (Götz 2024, eqs. 26–29).
//!
//! The vertices are held, friction is off, and nothing moves by itself, so the force is a function
//! of the grain's position alone. Where it changes much within a step, the step is halved
//! repeatedly; what remains in the end is a jump.

use super::{
    Law, RowSpec,
    build::{TestSystem, elastic},
    measure::{push, worst},
    scene::LawsScene,
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    experiments::{findings::Expected, record::Record},
    physics::{
        law::Surface,
        membrane::{MembraneModel, mesh::Mesh},
    },
};

pub(super) struct Crossing;

/// Halvings of a step: from a micrometer to far below what rounding can resolve.
const N_HALVINGS: usize = 24;
/// Change within a step, relative to the force, above which the step is halved.
const SUSPICIOUS: Real = 1e-4;
/// Speed of a slide (m/s), as in the source's friction test.
const SPEED: Real = 0.05;
/// Rings of the patch.
const RINGS: usize = 5;

impl Law for Crossing {
    fn name(&self) -> &'static str {
        "crossing"
    }

    fn n_points(&self, scene: &LawsScene) -> usize {
        2 * scene.crossing.n_paths + 1
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        if point == 2 * scene.crossing.n_paths {
            return slide(scene, record);
        }
        let (path_index, is_dented) = (point / 2, point % 2 == 1);
        let mut path = Path::new(scene, path_index, is_dented, elastic(0.0));
        let extremes = path.walk(scene.crossing.step);
        if is_dented {
            push(record, "way", "1", real(path_index));
            push(record, "jump", "1", extremes.jump);
            push(record, "change_per_step", "1", extremes.change);
            worst(record, "C4.dented_jump", extremes.jump);
        } else {
            worst(record, "C4.flat_force", extremes.off_hertz);
            worst(record, "C4.flat_direction", extremes.sideways);
            worst(record, "C4.flat_point", extremes.off_center);
        }
        worst(record, "C4.momentum", extremes.momentum);
        worst(record, "C4.angular_momentum", extremes.angular_momentum);
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }

    fn table(&self) -> Option<&'static str> {
        Some("laws_crossing")
    }
}

/// With friction, at one speed on the same paths: the largest change of force in a substep, and in
/// half of it. What is continuous changes half as much.
fn slide(scene: &LawsScene, record: &mut Record) {
    let substep = 4e-5;
    let mut largest = [0.0; 2];
    for path_index in 0..scene.crossing.n_paths {
        for (dt, largest) in [substep, 0.5 * substep].into_iter().zip(&mut largest) {
            let mut path = Path::new(scene, path_index, true, elastic(scene.membrane.friction));
            *largest = path.slide(SPEED, dt).max(*largest);
        }
    }
    record.set("C4.friction_continuous", largest[1] / largest[0], "1");
    record.set("friction_change_per_substep", largest[0], "1");
}

/// Extremes over a path, relative to the force or to the edge.
#[derive(Clone, Copy, Debug, Default)]
struct Extremes {
    change: Real,
    jump: Real,
    off_hertz: Real,
    sideways: Real,
    off_center: Real,
    momentum: Real,
    angular_momentum: Real,
}

/// A straight path over a patch, at heights that keep the grain in contact.
struct Path {
    test: TestSystem,
    from: Vec3,
    along: Vec3,
    /// Height of the grain's center at equal distances along the path (m).
    heights: Vec<Real>,
    length: Real,
    edge: Real,
}

impl Path {
    fn new(scene: &LawsScene, path_index: usize, is_dented: bool, surface: Surface) -> Self {
        let (edge, radius) = (scene.membrane.edge, scene.grain.radius);
        let mesh = Mesh::hexagonal_patch(edge, RINGS).expect("there are rings");
        let mut random = Random::new(u64::try_from(path_index).unwrap_or(0), Stream::Position);
        let dent = if is_dented { scene.crossing.dent_over_edge * edge } else { 0.0 };
        // Normals point down, out of the membrane: the grain is above.
        let flipped = mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mut positions = mesh.positions;
        for position in &mut positions {
            *position += Vec3::from_fn(|_, _| random.between(-dent, dent));
        }
        let mesh = Mesh::new(positions, flipped).expect("dents do not change the connectivity");
        let membrane = MembraneModel::new(mesh, scene.membrane.material);
        let material = &scene.grain.material;
        let mut test = TestSystem::on_membrane(material, surface, membrane, 1e-9);
        test.add_grain(Vec3::z() * radius, radius, material.density);
        let angle = random.between(0.0, 2.0 * std::f64::consts::PI);
        let along = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let across = Vec3::new(-along.y, along.x, 0.0) * random.between(-edge, edge);
        let length = 5.0 * edge;
        let from = across - along * (0.5 * length);
        let mut path = Self { test, from, along, heights: Vec::new(), length, edge };
        let overlap = scene.crossing.overlap_over_radius * radius;
        path.heights = (0..=50).map(|k| path.height(real(k) / 50.0, overlap)).collect();
        path
    }

    /// Height at which the deepest overlap is `overlap` (m).
    fn height(&mut self, share: Real, overlap: Real) -> Real {
        let radius = self.test.grains().radii[0];
        let (mut low, mut high) = (0.0, 2.0 * radius);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let position = self.from + self.along * (share * self.length) + Vec3::z() * middle;
            self.put_at(position);
            let patches = &self.test.system.scratch.patch_forces[0];
            let deepest = patches.contacts[..patches.n].iter().map(|it| it.overlap);
            if deepest.fold(0.0, Real::max) > overlap {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// Position of the grain after this share of the path (m).
    fn position(&self, share: Real) -> Vec3 {
        let n = self.heights.len() - 1;
        let at = share * real(n);
        let k = (0..n).rev().find(|&k| real(k) <= at).unwrap_or(0);
        let height = self.heights[k] + (self.heights[k + 1] - self.heights[k]) * (at - real(k));
        self.from + self.along * (share * self.length) + Vec3::z() * height
    }

    /// Puts the grain at rest at `position` (m) and returns the force on it (N).
    fn put_at(&mut self, position: Vec3) -> Vec3 {
        let grains = self.test.grains_mut();
        grains.positions[0] = position;
        grains.velocities[0] = Vec3::zeros();
        // Only the integrator updates the lists for motion.
        self.test.system.scratch.neighbors.is_built = false;
        self.test.step();
        let patches = &self.test.system.scratch.patch_forces[0];
        patches.contacts[..patches.n].iter().map(|it| it.force).sum()
    }

    /// Slides along the whole path in substeps of `dt` (s). Returns the largest change of force
    /// divided by the mean force.
    fn slide(&mut self, speed: Real, dt: Real) -> Real {
        self.put_at(self.position(0.0));
        self.test.system.model.substep = dt;
        let n_steps = n_steps(self.length / (speed * dt));
        let (mut largest, mut sum, mut last) = (0.0, 0.0, None::<Vec3>);
        for k in 0..n_steps {
            let [here, next] =
                [k, k + 1].map(|k| self.position((real(k) / real(n_steps)).min(1.0)));
            let grains = self.test.grains_mut();
            grains.positions[0] = here;
            grains.velocities[0] = (next - here) / dt;
            grains.angular_velocities[0] = Vec3::zeros();
            self.test.system.scratch.neighbors.is_built = false;
            self.test.step();
            let patches = &self.test.system.scratch.patch_forces[0];
            let force: Vec3 = patches.contacts[..patches.n].iter().map(|it| it.force).sum();
            sum += force.norm();
            if let Some(last) = last {
                largest = (force - last).norm().max(largest);
            }
            last = Some(force);
        }
        largest / (sum / real(n_steps))
    }

    fn walk(&mut self, step: Real) -> Extremes {
        let n_steps = n_steps(self.length / step);
        let mut extremes = Extremes::default();
        let mut last = self.put_at(self.position(0.0));
        for k in 1..=n_steps {
            let share = real(k) / real(n_steps);
            let force = self.put_at(self.position(share));
            self.compare(&force, &mut extremes);
            let change = (force - last).norm() / force.norm().max(last.norm());
            extremes.change = extremes.change.max(change);
            if change > SUSPICIOUS.max(extremes.jump) {
                let before = real(k - 1) / real(n_steps);
                extremes.jump = extremes.jump.max(self.halve([before, share], [last, force]));
            }
            last = force;
        }
        extremes
    }

    /// The jump within a part of the path, divided by the force.
    fn halve(&mut self, mut shares: [Real; 2], mut forces: [Vec3; 2]) -> Real {
        for _ in 0..N_HALVINGS {
            let middle = 0.5 * (shares[0] + shares[1]);
            let force = self.put_at(self.position(middle));
            let half = usize::from((force - forces[0]).norm() > (forces[1] - force).norm());
            shares[half] = middle;
            forces[half] = force;
        }
        (forces[1] - forces[0]).norm() / forces[0].norm().max(forces[1].norm())
    }

    /// Compares the force at the current position with Hertz and with Newton's third law.
    fn compare(&self, force: &Vec3, extremes: &mut Extremes) {
        let system = &self.test.system;
        let (position, radius) = (self.test.grains().positions[0], self.test.grains().radii[0]);
        let k = 4.0 / 3.0 * system.model.membrane_law.modulus * radius.sqrt();
        let expected = k * (radius - position.z).max(0.0).powf(1.5);
        let update = |value: Real, largest: &mut Real| *largest = largest.max(value);
        update((force.norm() / expected - 1.0).abs(), &mut extremes.off_hertz);
        update(force.xy().norm() / force.norm(), &mut extremes.sideways);
        let patches = &system.scratch.patch_forces[0];
        let vertices = &system.model.membrane.mesh.positions;
        let (mut moment, mut deepest) = (Vec3::zeros(), (0.0, Vec3::zeros()));
        for contact in &patches.contacts[..patches.n] {
            let corners = system.model.membrane.mesh.triangles[contact.triangle as usize];
            let point: Vec3 = (corners.iter().zip(contact.weights))
                .map(|(&v, weight)| vertices[v as usize] * weight)
                .sum();
            moment += point.cross(&contact.force);
            if contact.overlap > deepest.0 {
                deepest = (contact.overlap, point);
            }
        }
        update((deepest.1.xy() - position.xy()).norm() / self.edge, &mut extremes.off_center);
        let vertex_forces = &system.scratch.vertex_forces;
        let sum: Vec3 = vertex_forces.iter().sum();
        update((sum + force).norm() / force.norm(), &mut extremes.momentum);
        let moment_of_vertices: Vec3 =
            vertices.iter().zip(vertex_forces).map(|(r, f)| r.cross(f)).sum();
        let moment_error = (moment_of_vertices + moment).norm() / (force.norm() * self.edge);
        update(moment_error, &mut extremes.angular_momentum);
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand steps")]
fn n_steps(steps: Real) -> usize {
    steps.round().max(1.0) as usize
}

const ROWS: &[RowSpec] = &[
    (
        "C4.flat_force",
        "largest relative deviation from Hertz of the force on a grain moved over a flat membrane",
        "Hertz: on a flat membrane the mesh has no effect",
        Expected::at_most(1e-6),
        "1e-6 of the force is required; rounding of positions gives 1e-11",
    ),
    (
        "C4.flat_direction",
        "largest lateral share of that force",
        "none: the force is normal to the membrane",
        Expected::at_most(1e-6),
        "as above",
    ),
    (
        "C4.flat_point",
        "largest distance of the contact point from the point below the center, divided by the \
        edge",
        "Götz (2024) eqs. 26, 27",
        Expected::at_most(1e-6),
        "as above",
    ),
    (
        "C4.dented_jump",
        "largest jump of the force on a grain moved over a dented membrane, divided by the force",
        "none: the force is a continuous function of position",
        Expected::at_most(1e-6),
        "1e-6 of the force is required on a flat membrane; here each step that changes the force \
        by more than 1e-4 is halved 24 times, to 6e-14 m",
    ),
    (
        "C4.friction_continuous",
        "largest change of force in half a substep of a slide with friction over a dented \
        membrane, divided by that in a whole one",
        "1/2: the friction spring moves from triangle to triangle; a jump would give 1",
        Expected::within(0.5, 0.1),
        "0.1: a step may hit or miss the steepest position",
    ),
    (
        "C4.momentum",
        "sum of the forces on the grain and on the vertices, divided by the force",
        "action equals reaction; Götz (2024) eq. 28",
        Expected::at_most(1e-12),
        "rounding",
    ),
    (
        "C4.angular_momentum",
        "moment of the vertex forces plus that of the contacts, divided by force times edge",
        "the contact point is the center of the barycentric weights; Götz (2024) eqs. 27, 28",
        Expected::at_most(1e-12),
        "rounding",
    ),
];
