//! The membrane in its plane: the lattice of springs as an elastic sheet, and the decay of an
//! oscillation (Götz 2024, eqs. 12–16).

use super::{Law, RowSpec, measure::worst, scene::LawsScene};
use crate::{
    base::{Mat3, Real, Vec3, real::real},
    experiments::{findings::Expected, record::Record},
    physics::membrane::{
        MembraneMaterial, MembraneModel, MembraneScratch, MembraneState, forces,
        mesh::Mesh,
        pressure,
        stretch::{self, Spring, tension},
    },
};

pub(super) struct Stretching;

/// Rings of the patches.
const RINGS: [usize; 3] = [3, 6, 12];
/// Directions of the strain (rad).
const DIRECTIONS: [Real; 5] = [0.0, 0.2, 0.5, 1.0, 1.4];
const STRAIN: Real = 1e-6;

impl Law for Stretching {
    fn name(&self) -> &'static str {
        "stretching"
    }

    fn n_points(&self, _: &LawsScene) -> usize {
        RINGS.len() + 1
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        match RINGS.get(point) {
            Some(&rings) => patch(scene, rings, record),
            None => ring_down(scene, record),
        }
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }
}

/// A flat hexagon of the scene's membrane without bending.
fn patch(scene: &LawsScene, rings: usize, record: &mut Record) {
    let material = MembraneMaterial {
        bending_stiffness: 0.0,
        bending_damping: 0.0,
        ..scene.membrane.material
    };
    let mesh = Mesh::hexagonal_patch(scene.membrane.edge, rings).expect("there are rings");
    let model = MembraneModel::new(mesh, material);
    let in_plane = material.youngs_modulus * material.thickness;
    for direction in DIRECTIONS {
        let (s, c) = direction.sin_cos();
        let (along, across) = (Vec3::new(c, s, 0.0), Vec3::new(-s, c, 0.0));
        let pull = stress(&model, &(along * along.transpose()));
        let [xx, yy] = [along, across].map(|n| n.dot(&(pull * n)) / STRAIN);
        // Plane stress: T_xx = E d/(1−ν²) ε, T_yy = ν T_xx.
        let ratio = yy / xx;
        worst(record, "C2.poisson_ratio", ratio - 1.0 / 3.0);
        worst(record, "C2.modulus", xx * (1.0 - ratio * ratio) / in_plane - 1.0);
        let shear = stress(&model, &(along * across.transpose() + across * along.transpose()));
        let modulus = along.dot(&(shear * across)) / (2.0 * STRAIN);
        worst(record, "U9.shear_modulus", modulus / (in_plane * 3.0 / 8.0) - 1.0);
    }
    let tension = stress(&model, &Mat3::identity());
    let expected = 3.0_f64.sqrt() * stretch::stiffness(material.youngs_modulus, material.thickness);
    for axis in 0..2 {
        worst(record, "U10.tension", tension[(axis, axis)] / (expected * STRAIN) - 1.0);
    }
}

/// Mean stress (N/m) under a strain of this shape: the virial −Σ r ⊗ F / area.
fn stress(model: &MembraneModel, shape: &Mat3) -> Mat3 {
    let mut state = MembraneState::at_rest(&model.mesh);
    for position in &mut state.positions {
        *position += shape * *position * STRAIN;
    }
    let mut scratch = MembraneScratch::new(model);
    forces(model, &state, 0.0, &mut scratch);
    let pairs = model.mesh.positions.iter().zip(&scratch.forces);
    let virial: Mat3 = pairs.map(|(r, f)| r * f.transpose()).sum();
    -virial / pressure::area(&model.mesh, &model.mesh.positions)
}

/// Two vertices of the membrane released from a stretched state: the decay of amplitude in a
/// period.
fn ring_down(scene: &LawsScene, record: &mut Record) {
    let MembraneMaterial { youngs_modulus, thickness, density, .. } = scene.membrane.material;
    let (edge, gamma) = (scene.membrane.edge, 0.15);
    let mass = density * thickness * edge * edge * 0.75_f64.sqrt();
    let k = stretch::stiffness(youngs_modulus, thickness);
    let spring = Spring::new(edge, k, gamma, [mass; 2]);
    let damped = (1.0 - gamma * gamma).sqrt();
    let period = 2.0 * std::f64::consts::PI / ((2.0 * k / mass).sqrt() * damped);
    let n_steps = 20_000;
    let dt = period / real(n_steps);
    let (mut stretch, mut rate) = (0.01 * edge, 0.0);
    for _ in 0..n_steps {
        rate -= 2.0 * tension(spring.numbers(), edge + stretch, rate) / mass * dt;
        stretch += rate * dt;
    }
    record.set("C2.ring_down", stretch / (0.01 * edge), "1");
}

const ROUNDING: &str = "1e-5: second order in a strain of 1e-6, rounding of lengths relative to \
                       it; three mesh sizes, five directions";

const ROWS: &[RowSpec] = &[
    (
        "C2.modulus",
        "largest relative error of the modulus of a patch, over mesh sizes and directions",
        "lattice: E d = 2/√3 k with k = √3/2 E d, Götz (2024) eq. 14",
        Expected::at_most(1e-5),
        ROUNDING,
    ),
    (
        "C2.poisson_ratio",
        "largest error of Poisson's ratio of a patch, over mesh sizes and directions",
        "lattice: 1/3, Götz (2024) section 3.1",
        Expected::at_most(1e-5),
        ROUNDING,
    ),
    (
        "U9.shear_modulus",
        "largest relative error of the shear modulus, over mesh sizes and directions",
        "lattice: √3/4 k = 3/8 E d",
        Expected::at_most(1e-5),
        ROUNDING,
    ),
    (
        "U10.tension",
        "largest relative error of the tension under equibiaxial stretch",
        "lattice: √3 k ε",
        Expected::at_most(1e-5),
        ROUNDING,
    ),
    (
        "C2.ring_down",
        "amplitude of a damped pair of vertices after one period, at γ = 0.15",
        "damped oscillator: e^(−2πγ/√(1−γ²)) = 0.385; Götz (2024) eqs. 15, 16",
        Expected::within(0.385_481, 1e-3),
        "1e-3: first-order integrator over 20000 steps",
    ),
];
