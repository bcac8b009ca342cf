//! Bending of the membrane: the lattice of hinges as an elastic plate, and strips clamped at one
//! end (Götz 2024, eqs. 17–25).
//!
//! ```text
//! D = k_el/4,  ν_b = −1/3
//! energy per area: cylinder D κ²/2, sphere 2/3 D κ², saddle 4/3 D κ²
//! strip of width b: E I = (1 − ν_b²) D b = 8/9 D b if narrow, D b if wide
//! tip under force F: F L³/(3 E I);  ω_1 = 3.516 √(E I/(ρ d b)) / L²
//! ```
//!
//! A strip is not clamped exactly at a row of vertices, and it has no hinges along its free edges.
//! So E I comes from the difference between two lengths, and its growth with the width from the
//! difference between two widths.

use super::{Law, RowSpec, scene::LawsScene};
use crate::{
    base::{Real, Vec3, real::real},
    experiments::{findings::Expected, record::Record},
    physics::membrane::{
        MembraneMaterial, MembraneModel, MembraneScratch, MembraneState, forces, mesh::Mesh,
    },
};

pub(super) struct Plate;

/// Curvatures (κ_xx, κ_xy, κ_yy) and energy per area in units of D κ².
const SHAPES: [([Real; 3], Real); 5] = [
    ([1.0, 0.0, 0.0], 0.5),
    ([0.75, 0.433_012_701_892_219_3, 0.25], 0.5),
    ([1.0, 0.0, 1.0], 2.0 / 3.0),
    ([1.0, 0.0, -1.0], 4.0 / 3.0),
    ([0.0, 1.0, 0.0], 4.0 / 3.0),
];

impl Law for Plate {
    fn name(&self) -> &'static str {
        "plate"
    }

    fn n_points(&self, _: &LawsScene) -> usize {
        4
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        match point {
            0 => curvatures(scene, record),
            1 => {
                let [narrow, wide] = [8, 16].map(|b| bending_stiffness(scene, [64, 96], b));
                record.set(
                    "U12.narrow_strip",
                    (wide - narrow) / (8.0 * edge_stiffness(scene)),
                    "1",
                );
            }
            2 => {
                let [narrow, wide] = [32, 48].map(|b| bending_stiffness(scene, [8, 12], b));
                record.set("U12.wide_strip", (wide - narrow) / (16.0 * edge_stiffness(scene)), "1");
            }
            _ => natural_frequency(scene, record),
        }
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }
}

/// D times the spacing of rows across a strip (N m²).
fn edge_stiffness(scene: &LawsScene) -> Real {
    let row = 0.75_f64.sqrt() * scene.membrane.edge;
    0.25 * scene.membrane.material.bending_stiffness * row
}

/// The scene's membrane without springs: bending alone.
fn bending_only(scene: &LawsScene) -> MembraneMaterial {
    MembraneMaterial { youngs_modulus: 0.0, bending_damping: 0.0, ..scene.membrane.material }
}

/// Energy of a patch bent to a given curvature.
fn curvatures(scene: &LawsScene, record: &mut Record) {
    let (edge, curvature) = (scene.membrane.edge, 1e-4);
    let mesh = Mesh::hexagonal_patch(edge, 12).expect("there are rings");
    let model = MembraneModel::new(mesh, bending_only(scene));
    let area = real(model.mesh.hinges.len()) * edge * edge * 0.75_f64.sqrt() / 3.0;
    let stiffness = 0.25 * scene.membrane.material.bending_stiffness;
    let mut scratch = MembraneScratch::new(&model);
    let mut worst = 0.0_f64;
    for ([xx, xy, yy], oracle) in SHAPES {
        let mut state = MembraneState::at_rest(&model.mesh);
        for p in &mut state.positions {
            p.z = 0.5 * curvature * (xx * p.x * p.x + 2.0 * xy * p.x * p.y + yy * p.y * p.y);
        }
        forces(&model, &state, 0.0, &mut scratch);
        let work: Real = state.positions.iter().zip(&scratch.forces).map(|(r, f)| r.z * f.z).sum();
        let found = -0.5 * work / (area * curvature * curvature * stiffness);
        worst = worst.max((found / oracle - 1.0).abs());
    }
    record.set("U12.plate", worst, "1");
}

/// A strip in z = 0 along x with its first rows held; linear for small heights.
struct Strip {
    model: MembraneModel,
    scratch: MembraneScratch,
    is_free: Vec<bool>,
    is_tip: Vec<bool>,
}

/// Heights at which forces are evaluated, relative to the thickness: small compared with the edge,
/// large compared with rounding.
const SMALL: Real = 1e-6;

impl Strip {
    /// `n_long` edges along x and `n_wide` rows across.
    fn new(scene: &LawsScene, n_long: usize, n_wide: usize) -> Self {
        let edge = scene.membrane.edge;
        let columns = n_long + 1;
        let mut positions = Vec::new();
        for row in 0..=n_wide {
            let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
            for column in 0..columns {
                let (x, y) = (real(column) + shift, 0.75_f64.sqrt() * real(row));
                positions.push(Vec3::new(x, y, 0.0) * edge);
            }
        }
        let id = |row: usize, column: usize| {
            u32::try_from(row * columns + column).expect("a strip is small")
        };
        let mut triangles = Vec::new();
        for row in 0..n_wide {
            for k in 0..n_long {
                let (a, b) = (id(row, k), id(row, k + 1));
                let (c, d) = (id(row + 1, k), id(row + 1, k + 1));
                if row % 2 == 0 {
                    triangles.extend([[a, b, c], [b, d, c]]);
                } else {
                    triangles.extend([[a, b, d], [a, d, c]]);
                }
            }
        }
        let end = edge * (real(n_long) - 0.25);
        let is_free = positions.iter().map(|p| p.x > 1.25 * edge).collect();
        let is_tip = positions.iter().map(|p| p.x > end).collect();
        let mesh = Mesh::new(positions, triangles).expect("a strip is a surface");
        let model = MembraneModel::new(mesh, bending_only(scene));
        Self { scratch: MembraneScratch::new(&model), model, is_free, is_tip }
    }

    /// Upward forces that hold the heights `z`: the stiffness matrix times z.
    fn stiffness(&mut self, z: &[Real]) -> Vec<Real> {
        let largest = z.iter().fold(0.0, |a: Real, b| a.max(b.abs()));
        if largest == 0.0 {
            return vec![0.0; z.len()];
        }
        let scale = SMALL * self.model.material.thickness / largest;
        let mut state = MembraneState::at_rest(&self.model.mesh);
        for (position, z) in state.positions.iter_mut().zip(z) {
            position.z = scale * z;
        }
        forces(&self.model, &state, 0.0, &mut self.scratch);
        let held = |(force, &is_free): (&Vec3, &bool)| if is_free { -force.z / scale } else { 0.0 };
        self.scratch.forces.iter().zip(&self.is_free).map(held).collect()
    }

    /// Heights under an upward `load` (N), by conjugate gradients.
    fn deflection(&mut self, load: &[Real]) -> Vec<Real> {
        let dot = |a: &[Real], b: &[Real]| a.iter().zip(b).map(|(a, b)| a * b).sum::<Real>();
        let mut z = vec![0.0; load.len()];
        let mut residual: Vec<Real> = load.to_vec();
        let mut direction = residual.clone();
        let (first, mut square) = (dot(&residual, &residual), dot(&residual, &residual));
        for _ in 0..20 * load.len() {
            if square < 1e-18 * first {
                break;
            }
            let held = self.stiffness(&direction);
            let step = square / dot(&direction, &held);
            for i in 0..z.len() {
                z[i] += step * direction[i];
                residual[i] -= step * held[i];
            }
            let next = dot(&residual, &residual);
            for (direction, residual) in direction.iter_mut().zip(&residual) {
                *direction = residual + next / square * *direction;
            }
            square = next;
        }
        z
    }

    /// Mean height of the tip under a force of 1 N distributed over it.
    fn tip_under_unit_force(&mut self) -> Real {
        let n = real(self.is_tip.iter().filter(|&&it| it).count());
        let load: Vec<Real> =
            self.is_tip.iter().map(|&it| if it { 1.0 / n } else { 0.0 }).collect();
        let z = self.deflection(&load);
        z.iter().zip(&load).map(|(z, share)| z * share).sum()
    }
}

/// E I (N m²) of a strip from the deflection of its tip at two lengths: the cube root of F L³/(3 E
/// I) grows by (F/(3 E I))^(1/3) per length, independent of the clamped position.
fn bending_stiffness(scene: &LawsScene, lengths: [usize; 2], n_wide: usize) -> Real {
    let [short, long] = lengths.map(|n| Strip::new(scene, n, n_wide).tip_under_unit_force().cbrt());
    let grown = real(lengths[1] - lengths[0]) * scene.membrane.edge;
    ((long - short) / grown).powi(-3) / 3.0
}

/// First natural frequency of a narrow strip, from its measured stiffness and length.
fn natural_frequency(scene: &LawsScene, record: &mut Record) {
    let (n_long, n_wide) = (64, 8);
    let mut strip = Strip::new(scene, n_long, n_wide);
    let masses = strip.model.masses.clone();
    let mut mode: Vec<Real> = strip.model.mesh.positions.iter().map(|p| p.x * p.x).collect();
    let mut square = 0.0;
    for _ in 0..4 {
        let weighted = |(z, mass): (&Real, &Real)| z * mass;
        let load: Vec<Real> = (mode.iter().zip(&masses).map(weighted))
            .zip(&strip.is_free)
            .map(|(load, &is_free)| if is_free { load } else { 0.0 })
            .collect();
        let next = strip.deflection(&load);
        let work: Real = next.iter().zip(&load).map(|(z, f)| z * f).sum();
        let weight: Real = next.iter().zip(&masses).map(|(z, mass)| z * z * mass).sum();
        square = work / weight;
        let largest = next.iter().fold(0.0, |a: Real, b| a.max(b.abs()));
        mode = next.iter().map(|z| z / largest).collect();
    }
    // The effective length: that of F L³/(3 E I) for the measured deflection of the tip.
    let stiffness = bending_stiffness(scene, [n_long, n_long + 32], n_wide);
    let length = (3.0 * stiffness * strip.tip_under_unit_force()).cbrt();
    let per_length = masses.iter().sum::<Real>() / (real(n_long) * scene.membrane.edge);
    let oracle = 3.516_015 / (length * length) * (stiffness / per_length).sqrt();
    record.set("U12.frequency", square.sqrt() / oracle, "1");
}

const ROWS: &[RowSpec] = &[
    (
        "U12.plate",
        "largest relative error of the bending energy: cylinders, sphere, saddles",
        "plate with D = k_el/4, ν = −1/3 (Seung & Nelson 1988); Götz (2024) eqs. 17–20",
        Expected::at_most(1e-5),
        "1e-5: hinges see uniform curvature exactly; rounding over heights of 1e-7 m",
    ),
    (
        "U12.narrow_strip",
        "growth of E I with the width of a narrow clamped strip, divided by D",
        "beam with free edges: 1 − ν_b² = 8/9",
        Expected::within(8.0 / 9.0, 0.02 * 8.0 / 9.0),
        "2 %: lengths of 64 and 96 edges at widths of 7 and 14 are not infinitely slender",
    ),
    (
        "U12.wide_strip",
        "growth of E I with the width of a wide clamped strip, divided by D",
        "plate that cannot bend transversely: 1",
        Expected::within(1.0, 0.02),
        "2 %: lengths of 8 and 12 edges; the free edges cancel in the difference",
    ),
    (
        "U12.frequency",
        "first natural frequency of a clamped strip divided by that of a beam with its stiffness",
        "Euler and Bernoulli: ω_1 = 3.516 √(E I/(ρ d b)) / L²",
        Expected::within(1.0, 0.01),
        "1 %: the length of a lattice strip is known to a fraction of an edge out of 64",
    ),
];
