//! A grain that is moved over the sheet: force, direction and contact point over edges and vertices
//! (Götz 2024, eqs. 26–29).
//!
//! The vertices are held, friction is off, and nothing moves by itself, so that the force is a function
//! of the grain's place alone. Where it changes much within a step, the step is halved again and
//! again: what is left in the end is a jump.

use super::{
    Law, Line,
    build::{Bench, elastic},
    judge, push,
    scene::Scene,
    worst,
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    experiments::{
        findings::{Curve, Expected, Findings},
        record::Record,
    },
    physics::{
        law::Surface,
        membrane::{MembraneModel, mesh::Mesh},
    },
};

pub(super) struct Crossing;

/// Halvings of a step: from a micrometre to far below rounding of what can be seen.
const N_HALVINGS: usize = 24;
/// Change within a step from which on it is halved, over the force.
const SUSPICIOUS: Real = 1e-4;
/// Speed of a slide [m/s]: that of the sources' friction test.
const SPEED: Real = 0.05;
/// Rings of the patch.
const RINGS: usize = 5;

impl Law for Crossing {
    fn name(&self) -> &'static str {
        "crossing"
    }

    fn n_points(&self, scene: &Scene) -> usize {
        2 * scene.crossing.n_ways + 1
    }

    fn measure(&self, scene: &Scene, point: usize, record: &mut Record) {
        if point == 2 * scene.crossing.n_ways {
            return slide(scene, record);
        }
        let (way, is_dented) = (point / 2, point % 2 == 1);
        let mut path = Path::new(scene, way, is_dented, elastic(0.0));
        let seen = path.walk(scene.crossing.step);
        if is_dented {
            push(record, "way", "1", real(way));
            push(record, "jump", "1", seen.jump);
            push(record, "change_per_step", "1", seen.change);
            worst(record, "C4.dented_jump", seen.jump);
        } else {
            worst(record, "C4.flat_force", seen.off_hertz);
            worst(record, "C4.flat_direction", seen.sideways);
            worst(record, "C4.flat_point", seen.off_centre);
        }
        worst(record, "C4.momentum", seen.momentum);
        worst(record, "C4.angular_momentum", seen.angular_momentum);
    }

    fn evaluate(&self, _: &Scene, record: &Record, findings: &mut Findings) {
        judge(ROWS, record, findings);
        findings
            .curves
            .push(Curve { name: "laws_crossing".to_owned(), columns: record.columns.clone() });
    }
}

/// With friction, at one speed on the same ways: the largest change of force in a substep, and in half
/// of it. What is continuous changes half as much.
fn slide(scene: &Scene, record: &mut Record) {
    let substep = 4e-5;
    let mut largest = [0.0; 2];
    for way in 0..scene.crossing.n_ways {
        for (dt, largest) in [substep, 0.5 * substep].into_iter().zip(&mut largest) {
            let mut path = Path::new(scene, way, true, elastic(scene.membrane.friction));
            *largest = path.slide(SPEED, dt).max(*largest);
        }
    }
    record.set("C4.friction_continuous", largest[1] / largest[0], "1");
    record.set("friction_change_per_substep", largest[0], "1");
}

/// What was seen on a way, as shares of the force, of its length and of the edge.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    change: Real,
    jump: Real,
    off_hertz: Real,
    sideways: Real,
    off_centre: Real,
    momentum: Real,
    angular_momentum: Real,
}

/// A straight way over a patch, at heights that keep the grain pressed in.
struct Path {
    bench: Bench,
    from: Vec3,
    along: Vec3,
    /// Height of the grain's centre at equal distances on the way [m].
    heights: Vec<Real>,
    length: Real,
    edge: Real,
}

impl Path {
    fn new(scene: &Scene, way: usize, is_dented: bool, surface: Surface) -> Self {
        let (edge, radius) = (scene.membrane.edge, scene.grain.radius);
        let mesh = Mesh::hexagonal_patch(edge, RINGS).expect("there are rings");
        let mut random = Random::new(u64::try_from(way).unwrap_or(0), Stream::Position);
        let dent = if is_dented { scene.crossing.dent_over_edge * edge } else { 0.0 };
        // Normals point down, out of the bag: the grain lies above.
        let turned = mesh.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let mut positions = mesh.positions;
        for position in &mut positions {
            *position += Vec3::from_fn(|_, _| random.between(-dent, dent));
        }
        let mesh = Mesh::new(positions, turned).expect("dents do not change who neighbours whom");
        let sheet = MembraneModel::new(mesh, scene.membrane.sheet);
        let material = &scene.grain.material;
        let mut bench = Bench::on_membrane(material, surface, sheet, 1e-9);
        bench.add_grain(Vec3::z() * radius, radius, material.density);
        let angle = random.between(0.0, 2.0 * std::f64::consts::PI);
        let along = Vec3::new(angle.cos(), angle.sin(), 0.0);
        let across = Vec3::new(-along.y, along.x, 0.0) * random.between(-edge, edge);
        let length = 5.0 * edge;
        let from = across - along * (0.5 * length);
        let mut path = Self { bench, from, along, heights: Vec::new(), length, edge };
        let overlap = scene.crossing.overlap_over_radius * radius;
        path.heights = (0..=50).map(|k| path.height(real(k) / 50.0, overlap)).collect();
        path
    }

    /// Height at which the deepest overlap is `overlap`.
    fn height(&mut self, share: Real, overlap: Real) -> Real {
        let radius = self.bench.grains().radii[0];
        let (mut low, mut high) = (0.0, 2.0 * radius);
        for _ in 0..40 {
            let middle = 0.5 * (low + high);
            let place = self.from + self.along * (share * self.length) + Vec3::z() * middle;
            self.put(place);
            let patches = &self.bench.system.scratch.patch_forces[0];
            let deepest = patches.contacts[..patches.n].iter().map(|it| it.overlap);
            if deepest.fold(0.0, Real::max) > overlap {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }

    /// The grain's place after this share of the way.
    fn place(&self, share: Real) -> Vec3 {
        let n = self.heights.len() - 1;
        let at = share * real(n);
        let k = (0..n).rev().find(|&k| real(k) <= at).unwrap_or(0);
        let height = self.heights[k] + (self.heights[k + 1] - self.heights[k]) * (at - real(k));
        self.from + self.along * (share * self.length) + Vec3::z() * height
    }

    /// Force on the grain if it is put, at rest, at `place`.
    fn put(&mut self, place: Vec3) -> Vec3 {
        let grains = self.bench.grains_mut();
        grains.positions[0] = place;
        grains.velocities[0] = Vec3::zeros();
        // The lists are told of motion by the integrator alone.
        self.bench.system.scratch.neighbors.is_built = false;
        self.bench.step();
        let patches = &self.bench.system.scratch.patch_forces[0];
        patches.contacts[..patches.n].iter().map(|it| it.force).sum()
    }

    /// Slides all the way in substeps of `dt` [s]; the largest change of force over the mean force.
    fn slide(&mut self, speed: Real, dt: Real) -> Real {
        self.put(self.place(0.0));
        self.bench.system.model.substep = dt;
        let n_steps = n_steps(self.length / (speed * dt));
        let (mut largest, mut sum, mut last) = (0.0, 0.0, None::<Vec3>);
        for k in 0..n_steps {
            let [here, next] = [k, k + 1].map(|k| self.place((real(k) / real(n_steps)).min(1.0)));
            let grains = self.bench.grains_mut();
            grains.positions[0] = here;
            grains.velocities[0] = (next - here) / dt;
            grains.angular_velocities[0] = Vec3::zeros();
            self.bench.system.scratch.neighbors.is_built = false;
            self.bench.step();
            let patches = &self.bench.system.scratch.patch_forces[0];
            let force: Vec3 = patches.contacts[..patches.n].iter().map(|it| it.force).sum();
            sum += force.norm();
            if let Some(last) = last {
                largest = (force - last).norm().max(largest);
            }
            last = Some(force);
        }
        largest / (sum / real(n_steps))
    }

    fn walk(&mut self, step: Real) -> Seen {
        let n_steps = n_steps(self.length / step);
        let mut seen = Seen::default();
        let mut last = self.put(self.place(0.0));
        for k in 1..=n_steps {
            let share = real(k) / real(n_steps);
            let force = self.put(self.place(share));
            self.look(&force, &mut seen);
            let change = (force - last).norm() / force.norm().max(last.norm());
            seen.change = seen.change.max(change);
            if change > SUSPICIOUS.max(seen.jump) {
                let before = real(k - 1) / real(n_steps);
                seen.jump = seen.jump.max(self.halve([before, share], [last, force]));
            }
            last = force;
        }
        seen
    }

    /// The jump within a piece of the way, over the force.
    fn halve(&mut self, mut shares: [Real; 2], mut forces: [Vec3; 2]) -> Real {
        for _ in 0..N_HALVINGS {
            let middle = 0.5 * (shares[0] + shares[1]);
            let force = self.put(self.place(middle));
            let half = usize::from((force - forces[0]).norm() > (forces[1] - force).norm());
            shares[half] = middle;
            forces[half] = force;
        }
        (forces[1] - forces[0]).norm() / forces[0].norm().max(forces[1].norm())
    }

    /// Against Hertz and Newton, at the present place.
    fn look(&self, force: &Vec3, seen: &mut Seen) {
        let system = &self.bench.system;
        let (position, radius) = (self.bench.grains().positions[0], self.bench.grains().radii[0]);
        let k = 4.0 / 3.0 * system.model.membrane_law.modulus * radius.sqrt();
        let expected = k * (radius - position.z).max(0.0).powf(1.5);
        let off = |value: Real, largest: &mut Real| *largest = largest.max(value);
        off((force.norm() / expected - 1.0).abs(), &mut seen.off_hertz);
        off(force.xy().norm() / force.norm(), &mut seen.sideways);
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
        off((deepest.1.xy() - position.xy()).norm() / self.edge, &mut seen.off_centre);
        let given = &system.scratch.vertex_forces;
        let sum: Vec3 = given.iter().sum();
        off((sum + force).norm() / force.norm(), &mut seen.momentum);
        let turned: Vec3 = vertices.iter().zip(given).map(|(r, f)| r.cross(f)).sum();
        let rest = (turned + moment).norm() / (force.norm() * self.edge);
        off(rest, &mut seen.angular_momentum);
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "some thousand steps")]
fn n_steps(steps: Real) -> usize {
    steps.round().max(1.0) as usize
}

const ROWS: &[Line] = &[
    (
        "C4.flat_force",
        "largest relative distance from Hertz of the force on a grain moved over a flat sheet",
        "Hertz: a flat sheet has no mesh",
        Expected::at_most(1e-6),
        "1e-6 of the force is asked for; rounding of positions gives 1e-11",
    ),
    (
        "C4.flat_direction",
        "largest sideways share of that force",
        "straight up",
        Expected::at_most(1e-6),
        "as above",
    ),
    (
        "C4.flat_point",
        "largest distance of the contact point from below the centre, over the edge",
        "Götz (2024) eqs. 26, 27",
        Expected::at_most(1e-6),
        "as above",
    ),
    (
        "C4.dented_jump",
        "largest jump of the force on a grain moved over a dented sheet, over the force",
        "none: the force is a continuous function of place",
        Expected::at_most(1e-6),
        "1e-6 of the force is asked for on a flat sheet; here each step that changes the force by more than \
         1e-4 is halved 24 times, to 6e-14 m",
    ),
    (
        "C4.friction_continuous",
        "largest change of force in half a substep of a slide with friction over a dented sheet, over \
         that in a whole one",
        "1/2: the friction spring is handed on from triangle to triangle; a jump would give 1",
        Expected::within(0.5, 0.1),
        "0.1: the steepest place is met by either or missed",
    ),
    (
        "C4.momentum",
        "force on the grain plus those on the vertices, over the force",
        "action equals reaction; Götz (2024) eq. 28",
        Expected::at_most(1e-12),
        "rounding",
    ),
    (
        "C4.angular_momentum",
        "moment of the vertices' forces plus that of the contacts, over force times edge",
        "barycentric weights have the contact point as centre; Götz (2024) eqs. 27, 28",
        Expected::at_most(1e-12),
        "rounding",
    ),
];
