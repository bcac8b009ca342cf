//! The membrane under pressure: Laplace's law for sphere, cylinder and taut disk, zero resultant on
//! a closed surface, and the work of the pressure (Götz 2024, eqs. 30, 31).
//!
//! ```text
//! sphere    ΔR/R = ε,  ε = s (1 + ε)²,   s = p R (1 − ν)/(2 E d)
//! cylinder  ε_θ = p R/(E d) (1 − ν/2),  ε_z = p R/(E d) (1/2 − ν)
//! disk      w = p a²/(4 T),             T = √3 k ε of edges stretched by ε
//! ```
//!
//! The factor (1 + ε)² of the sphere is Laplace's law at the current radius, with springs that are
//! linear in it: the last 0.7 % at a strain of 0.36 %.

use std::collections::BTreeSet;

use super::{
    Law, RowSpec,
    measure::{push, worst},
    scene::LawsScene,
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
        real::real,
    },
    experiments::{
        findings::{Expected, Kind, Plot, Series},
        record::Record,
    },
    physics::membrane::{
        MembraneMaterial, MembraneModel, MembraneScratch, MembraneState,
        critical_step::critical_step, forces, mesh::Mesh, pressure, stretch,
    },
};

/// Force on a vertex, relative to the air's load on it, that counts as zero.
const REST: Real = 1e-4;
/// Substeps between two measurements of the kinetic energy.
const STOP_EVERY: usize = 20;
/// Largest number of substeps; the membranes of the scene need a few thousand.
const N_STEPS_MAX: usize = 100_000;

pub(super) struct Inflation;

impl Law for Inflation {
    fn name(&self) -> &'static str {
        "inflation"
    }

    fn n_points(&self, scene: &LawsScene) -> usize {
        scene.laplace.n_pressures + 3
    }

    fn measure(&self, scene: &LawsScene, point: usize, record: &mut Record) {
        let n = scene.laplace.n_pressures;
        if point < n {
            sphere(scene, real(point + 1) / real(n), record);
        } else if point == n {
            cylinder(scene, record);
        } else if point == n + 1 {
            disk(scene, record);
        } else {
            closed_surface(scene, record);
        }
    }

    fn rows(&self) -> &'static [RowSpec] {
        ROWS
    }

    fn table(&self) -> Option<&'static str> {
        Some("laws_laplace")
    }

    fn plot(&self, _: &LawsScene, record: &Record) -> Option<Plot> {
        Some(plot(record))
    }
}

/// The scene's membrane without bending, well damped.
fn stretch_only(scene: &LawsScene) -> MembraneMaterial {
    let material = scene.membrane.material;
    MembraneMaterial {
        bending_stiffness: 0.0,
        bending_damping: 0.0,
        spring_damping: 0.5,
        ..material
    }
}

/// Lets the free vertices come to rest under `pressure` (Pa) and the `pull` on each vertex (N).
///
/// Kinetic damping (Cundall 1976): all vertices are stopped after each peak of the kinetic energy,
/// until the remaining forces are negligible compared with the air's.
fn settle(
    model: &MembraneModel,
    state: &mut MembraneState,
    pressure: Real,
    (pull, is_free): (&[Vec3], &dyn Fn(usize) -> bool),
) {
    let dt = 0.5 * critical_step(model, 0.0);
    let mut scratch = MembraneScratch::new(model);
    let free: Vec<usize> = (0..state.positions.len()).filter(|&v| is_free(v)).collect();
    let areas = model.mesh.vertex_areas();
    let load = pressure * areas.iter().copied().fold(Real::INFINITY, Real::min);
    let mut last = 0.0;
    for step in 0..N_STEPS_MAX {
        forces(model, state, pressure, &mut scratch);
        let (mut energy, mut unbalanced) = (0.0, 0.0_f64);
        for &v in &free {
            let force = scratch.forces[v] + pull[v];
            unbalanced = unbalanced.max(force.norm());
            state.velocities[v] += force * (dt / model.masses[v]);
            state.positions[v] += state.velocities[v] * dt;
            energy += model.masses[v] * state.velocities[v].norm_squared();
        }
        if unbalanced < REST * load {
            return;
        }
        // Not in every substep: the peaks of fast modes differ from those of slow
        // modes.
        if step % STOP_EVERY == 0 {
            if energy < last {
                state.velocities.fill(Vec3::zeros());
                energy = 0.0;
            }
            last = energy;
        }
    }
}

fn sphere(scene: &LawsScene, share: Real, record: &mut Record) {
    let radius = scene.membrane.radius;
    let mesh = Mesh::icosphere(radius, scene.laplace.frequency).expect("a frequency above zero");
    let model = MembraneModel::new(mesh, stretch_only(scene));
    let mut state = MembraneState::at_rest(&model.mesh);
    let overpressure = share * scene.laplace.pressure_max;
    let pull = vec![Vec3::zeros(); model.masses.len()];
    settle(&model, &mut state, overpressure, (&pull, &|_| true));
    let volume = |positions: &[Vec3]| pressure::volume(&model.mesh, positions);
    let found = (volume(&state.positions) / volume(&model.mesh.positions)).cbrt() - 1.0;
    let in_plane = model.material.youngs_modulus * model.material.thickness;
    let small = overpressure * radius / (3.0 * in_plane);
    let oracle = (1.0 - 2.0 * small - (1.0 - 4.0 * small).sqrt()) / (2.0 * small);
    push(record, "pressure", "Pa", overpressure);
    push(record, "strain", "1", found);
    push(record, "strain_laplace", "1", oracle);
    worst(record, "U13.sphere", found / oracle - 1.0);
}

/// A tube of rows of triangles; its ends carry the load of a lid.
fn cylinder(scene: &LawsScene, record: &mut Record) {
    let (radius, n_around, n_rows) = (scene.membrane.radius, 48, 24);
    let (model, height) = tube(scene, n_around, n_rows);
    let overpressure = scene.laplace.pressure_max;
    let lid = overpressure * std::f64::consts::PI * radius * radius / real(n_around);
    let row_height = |row: usize| height * (real(row) - 0.5 * real(n_rows));
    let in_row =
        |v: usize, row: usize| (model.mesh.positions[v].z - row_height(row)).abs() < 0.5 * height;
    let pull: Vec<Vec3> = (0..model.masses.len())
        .map(|v| {
            let end = f64::from(u8::from(in_row(v, n_rows))) - f64::from(u8::from(in_row(v, 0)));
            Vec3::z() * (lid * end)
        })
        .collect();
    let mut state = MembraneState::at_rest(&model.mesh);
    settle(&model, &mut state, overpressure, (&pull, &|_| true));
    let row_mean = |row: usize, of: &dyn Fn(&Vec3) -> Real| {
        let vertices = (0..state.positions.len()).filter(|&v| in_row(v, row));
        vertices.map(|v| of(&state.positions[v])).sum::<Real>() / real(n_around)
    };
    let (below, above) = (n_rows / 3, 2 * n_rows / 3);
    let hoop = row_mean(n_rows / 2, &|p| p.xy().norm()) / radius - 1.0;
    let between = row_mean(above, &|p| p.z) - row_mean(below, &|p| p.z);
    let axial = between / (real(above - below) * height) - 1.0;
    let unit = overpressure * radius / (model.material.youngs_modulus * model.material.thickness);
    record.set("U13.cylinder_hoop", hoop / (unit * 5.0 / 6.0), "1");
    record.set("U13.cylinder_axial", axial / (unit / 6.0), "1");
}

/// The tube, and the height of its rows (m).
fn tube(scene: &LawsScene, n_around: usize, n_rows: usize) -> (MembraneModel, Real) {
    let radius = scene.membrane.radius;
    let half_turn = std::f64::consts::PI / real(n_around);
    let edge = 2.0 * radius * half_turn.sin();
    // Rows are shifted by half an edge; this height makes all edges equal.
    let sagitta = radius * (1.0 - half_turn.cos());
    let height = (0.75 * edge * edge - sagitta * sagitta).sqrt();
    let mesh = Mesh::tube(radius, height * real(n_rows), n_around, n_rows + 1);
    (MembraneModel::new(mesh.expect("a tube is a surface"), stretch_only(scene)), height)
}

/// Rings of the disk's mesh.
const N_RINGS: usize = 24;
/// Stretch of its edges relative to their rest length.
const TAUT: Real = 0.05;
/// Rise of the middle relative to the disk's radius; the slope adds a thousandth to the stretch.
const RISE: Real = 0.01;

/// A flat membrane that is stretched and held on a circle bulges as a paraboloid.
fn disk(scene: &LawsScene, record: &mut Record) {
    let mesh = Mesh::hexagonal_patch(scene.membrane.edge, N_RINGS).expect("it has rings");
    let mut model = MembraneModel::new(mesh, stretch_only(scene));
    model.scale_rest_lengths(1.0 / (1.0 + TAUT));
    let inside = 0.75_f64.sqrt() * real(N_RINGS) * scene.membrane.edge;
    let is_free = |p: &Vec3| p.norm() < inside;
    // The radius of the circle is that of the held vertices next to free ones.
    let at = |v: u32| &model.mesh.positions[v as usize];
    let bordering = model.mesh.edges.iter().filter(|[a, b]| is_free(at(*a)) != is_free(at(*b)));
    let held: BTreeSet<u32> = bordering.map(|&[a, b]| if is_free(at(a)) { b } else { a }).collect();
    let radius = held.iter().map(|&v| at(v).norm()).sum::<Real>() / real(held.len());
    let spring = stretch::stiffness(model.material.youngs_modulus, model.material.thickness);
    let tension = 3.0_f64.sqrt() * spring * TAUT / (1.0 + TAUT);
    let overpressure = 4.0 * tension * RISE / radius;
    let mut state = MembraneState::at_rest(&model.mesh);
    let pull = vec![Vec3::zeros(); model.masses.len()];
    let first = &model.mesh.positions;
    settle(&model, &mut state, overpressure, (&pull, &|v| is_free(&first[v])));
    let middle = state.positions.iter().map(|p| p.z).fold(0.0, Real::max);
    record.set("U13.disc", middle / (RISE * radius), "1");
}

/// Force, torque and power of the air on a dented, moving sphere away from the origin.
fn closed_surface(scene: &LawsScene, record: &mut Record) {
    let radius = scene.membrane.radius;
    let mesh = Mesh::icosphere(radius, scene.laplace.frequency).expect("a frequency above zero");
    let slack = MembraneMaterial { youngs_modulus: 0.0, ..stretch_only(scene) };
    let model = MembraneModel::new(mesh, slack);
    let mut random = Random::new(1, Stream::Position);
    let mut draw = |size: Real| Vec3::from_fn(|_, _| random.between(-size, size));
    let mut state = MembraneState::at_rest(&model.mesh);
    for (position, velocity) in state.positions.iter_mut().zip(&mut state.velocities) {
        *position += draw(0.02 * radius) + Vec3::new(0.3, -0.2, 0.5);
        *velocity = draw(0.1);
    }
    let gauge = -90e3;
    let mut scratch = MembraneScratch::new(&model);
    forces(&model, &state, gauge, &mut scratch);
    let loads = &scratch.forces;
    let size: Real = loads.iter().map(|f| f.norm()).sum();
    let force: Vec3 = loads.iter().sum();
    let torque: Vec3 = state.positions.iter().zip(loads).map(|(r, f)| r.cross(f)).sum();
    record.set("C5.force", force.norm() / size, "1");
    record.set("C5.torque", torque.norm() / (size * radius), "1");
    let power: Real = loads.iter().zip(&state.velocities).map(|(f, v)| f.dot(v)).sum();
    let volume_at = |time: Real| {
        let moved = state.positions.iter().zip(&state.velocities).map(|(r, v)| r + v * time);
        pressure::volume(&model.mesh, &moved.collect::<Vec<_>>())
    };
    let rate = (volume_at(1e-5) - volume_at(-1e-5)) / 2e-5;
    record.set("C5.power", power / (gauge * rate), "1");
    let inward = loads
        .iter()
        .zip(&state.positions)
        .all(|(f, r)| f.dot(&(r - Vec3::new(0.3, -0.2, 0.5))) < 0.0);
    record.set("C5.sign", if inward { 1.0 } else { 0.0 }, "1");
}

const ROWS: &[RowSpec] = &[
    (
        "U13.sphere",
        "largest relative error of ΔR/R of a sphere under internal pressure",
        "Laplace at the current radius: ε = s (1 + ε)², s = p R (1 − ν)/(2 E d)",
        Expected::at_most(0.01),
        "1 %: edges of an icosphere differ by 15 %",
    ),
    (
        "U13.cylinder_hoop",
        "hoop strain of a closed cylinder divided by theory",
        "p R/(E d) (1 − ν/2)",
        Expected::within(1.0, 0.02),
        "2 %: strains of 0.9 % at the highest pressure enlarge the radius",
    ),
    (
        "U13.cylinder_axial",
        "axial strain of a closed cylinder divided by theory",
        "p R/(E d) (1/2 − ν)",
        Expected::within(1.0, 0.05),
        "5 %: it is the small difference of two strains five times as large",
    ),
    (
        "U13.disc",
        "rise of a taut disk in the middle divided by theory",
        "p a²/(4 T)",
        Expected::within(1.0, 0.02),
        "2 %: the radius at which a lattice is held on a circle is known to a third of an edge of \
        1/20 radius",
    ),
    (
        "C5.force",
        "net force of the air on a closed surface divided by the sum of all loads",
        "closed surface, uniform pressure; Götz (2024) eq. 30",
        Expected::at_most(1e-12),
        "rounding of a few thousand terms",
    ),
    (
        "C5.torque",
        "net torque of the air on a closed surface divided by loads times radius",
        "closed surface, uniform pressure; Götz (2024) eq. 31",
        Expected::at_most(1e-10),
        "rounding of a few thousand terms, with a lever arm of 15 radii",
    ),
    (
        "C5.power",
        "power of the air's load divided by gauge pressure times rate of volume",
        "virtual work",
        Expected::within(1.0, 1e-6),
        "central difference of a cubic",
    ),
    (
        "C5.sign",
        "1 if vacuum pushes every vertex inward",
        "gauge pressure is negative under vacuum",
        Expected::within(1.0, 0.0),
        "exact",
    ),
];

fn plot(record: &Record) -> Plot {
    let laplace = record.points("pressure", "strain_laplace");
    Plot::new(
        "A sphere under internal pressure",
        "no figure; Götz (2024) eqs. 14 and 30 give a membrane under pressure",
        ["gauge pressure [Pa]", "strain ΔR/R [-]"],
        vec![
            Series::new("measured", Kind::Points, record.points("pressure", "strain")),
            Series::new("Laplace", Kind::Analytic, laplace),
        ],
    )
}
