//! The beam of the source's bending test under vacuum: 18 500 grains of 50 MPa in a closed bar of
//! latex.
//!
//! Grains grow inside the held membrane up to their final size; then the membrane is released and
//! evacuated, and everything comes to rest.

use crate::{
    base::{
        Real,
        random::{Random, Stream},
    },
    physics::{
        System, SystemBuilder,
        builder::{BuildError, Membrane, Vertices, Wall},
        critical_step::{critical_step, stiffness_at_vertex},
        law::{PairLaw, Surface},
        membrane::{
            CARRIER_ID, FREE, MembraneMaterial, MembraneModel,
            bar::Bar,
            mesh::{Mesh, MeshError},
            pressure,
        },
        model::ChamberModel,
        packing::{
            Grown, Growth, Recipe, Room, first_scale, numbering::along_curve, scatter,
            scatter::NoRoom, sphere_volume,
        },
        state::{Grains, State},
    },
    scene::Material,
};

/// Size and mesh of the membrane; the source gives 8 cm, 40 cm, rounded edges and 1792 vertices.
const BAR: Bar = Bar { width: 0.08, length: 0.4, edge_radius: 0.01, n_side: 8, n_rows: 53 };
/// Number of grains, for a solid fraction of 0.6; the source does not give it.
const N_GRAINS: usize = 18_500;
/// Smallest and largest radius (m).
const RADII: [Real; 2] = [2.5e-3, 2.9e-3];
/// Mean radius (m).
const MEAN_RADIUS: Real = 0.5 * (RADII[0] + RADII[1]);
/// The grains' material, from the middle of the source's range.
const GRAIN: Material = Material { youngs_modulus: 5e7, poisson_ratio: 0.245, density: 2000.0 };
/// Latex, from the lower end of the source's range; as dense as the grains.
const LATEX: Material = Material { youngs_modulus: 1e7, poisson_ratio: 1.0 / 3.0, density: 2000.0 };
const BETWEEN_GRAINS: Surface =
    Surface { friction: 0.25, dissipation_time: 4.3e-6, tangential_damping: 0.3 };
const ON_LATEX: Surface = Surface { friction: 1.2, ..BETWEEN_GRAINS };
/// Bending constants of the source's other membranes; those of the beam are not given.
const MEMBRANE: MembraneMaterial = MembraneMaterial {
    thickness: 3e-4,
    youngs_modulus: LATEX.youngs_modulus,
    density: LATEX.density,
    spring_damping: 0.15,
    bending_stiffness: 1e-3,
    bending_damping: 5e-6,
};
/// Vacuum (Pa), from the middle of the source's range.
const VACUUM: Real = 50e3;
/// Pressure at which growth ends (Pa).
const PRESSURE: Real = 10e3;
/// Solid fraction of the scattered grains.
const THIN: Real = 0.25;
/// Share of the longest stable substep.
const SAFETY: Real = 0.8;
/// Skin of the neighbor lists, as a share of the largest radius.
const SKIN_SHARE: Real = 0.2;
/// Substeps of the evacuation.
const N_DRAWN: Real = 1000.0;
/// Substeps after the release, and the share of the velocities that remains after each: first while
/// the packing collapses, then while it comes to rest.
const N_REST: [(u64, Real); 2] = [(2000, 0.99), (1000, 0.999)];

/// Key of the state in the cache.
pub(super) const KEY: &str = "beam 1";

/// Why the beam cannot be prepared.
#[derive(Debug, thiserror::Error)]
pub enum BeamError {
    /// There is no room for the grains.
    #[error(transparent)]
    NoRoom(#[from] NoRoom),
    /// The parts do not fit each other.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The membrane cannot be meshed.
    #[error(transparent)]
    Mesh(#[from] MeshError),
}

/// The beam from its saved state, under vacuum.
///
/// # Errors
/// Those of `grow`.
pub(super) fn system(state: State) -> Result<System, BeamError> {
    let mut system = held(membrane()?, state.grains.clone())?;
    system.model.membrane.holders.fill(FREE);
    system.controls.gauge_setpoint = -VACUUM;
    system.state = state;
    Ok(system)
}

/// Prepares the beam at rest under vacuum.
///
/// # Errors
/// If there is no room for the grains, or the membrane cannot be meshed.
pub(super) fn grow() -> Result<State, BeamError> {
    let membrane = membrane()?;
    let volume = pressure::volume(&membrane.mesh, &membrane.mesh.positions);
    let mut random = Random::new(1, Stream::Radius);
    let last: Vec<Real> = (0..N_GRAINS).map(|_| random.between(RADII[0], RADII[1])).collect();
    let half = nalgebra::Vector3::new(BAR.width, BAR.width, BAR.length) / 2.0;
    let room = Room::Box { low: -half, high: half };
    let scale = first_scale(&last, THIN, volume);
    let small: Vec<Real> = last.iter().map(|r| scale * r).collect();
    let mut random = Random::new(1, Stream::Position);
    // With this margin, corners of the square section are inside the rounded edges.
    let places = scatter(&small, None, &mut random, |it| room.place(1.5 * RADII[1], it))?;
    let order = along_curve(&places, 2.0 * RADII[1]);
    let ordered = |radii: &[Real]| order.iter().map(|&i| radii[i]).collect::<Vec<_>>();
    let (last, small) = (ordered(&last), ordered(&small));
    let places = order.iter().map(|&i| places[i]).collect();
    let masses = last.iter().map(|&r| GRAIN.density * sphere_volume(r)).collect();
    let mut system = held(membrane, Grains::at_rest(places, small, masses))?;
    let mean = system.model.radius_mean;
    let mass = GRAIN.density * sphere_volume(mean);
    let recipe = Recipe::new(&system.model, volume, PRESSURE, mass, mean);
    let mut growth = Growth::new(recipe, last, scale);
    while growth.step(&mut system) == Grown::Growing {
        drag(&mut system, N_REST[0].1);
    }
    system.model.membrane.holders.fill(FREE);
    system.controls.gauge_setpoint = -VACUUM;
    for (n, share) in N_REST {
        for _ in 0..n {
            system.step();
            drag(&mut system, share);
        }
    }
    Ok(system.state)
}

fn membrane() -> Result<MembraneModel, MeshError> {
    Ok(MembraneModel::new(Mesh::bar(&BAR)?, MEMBRANE))
}

/// Grains in the membrane, which is held all over.
fn held(mut membrane: MembraneModel, grains: Grains) -> Result<System, BuildError> {
    let on_membrane = PairLaw::between(&GRAIN, &LATEX, ON_LATEX);
    membrane.holders.fill(CARRIER_ID);
    let on_vertex = stiffness_at_vertex(&membrane, &on_membrane, RADII[1], VACUUM);
    let mut builder = SystemBuilder::new(PairLaw::between(&GRAIN, &GRAIN, BETWEEN_GRAINS));
    builder
        .membrane_law(on_membrane)
        .substep(SAFETY * critical_step(RADII[0], &GRAIN, &membrane, on_vertex))
        .radii_up_to(grains.radii.iter().copied().fold(RADII[1], Real::max), MEAN_RADIUS)
        .skin(SKIN_SHARE * RADII[1])
        .chamber(ChamberModel { lag_factor: 0.0, change_max: VACUUM / N_DRAWN })
        .grains(grains);
    let frame = builder.wall(Wall::frame());
    builder.membrane(Membrane::of(membrane).hold(Vertices::All, frame));
    builder.build()
}

/// Reduces all velocities to a share.
fn drag(system: &mut System, share: Real) {
    let State { grains, membrane, .. } = &mut system.state;
    let all = grains
        .velocities
        .iter_mut()
        .chain(&mut grains.angular_velocities)
        .chain(&mut membrane.velocities);
    all.for_each(|it| *it *= share);
}
