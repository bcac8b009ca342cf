//! The hollow sphere as a system: object, two membranes, grains between them.

use super::{
    cases::{Case, Kind},
    scene::Scene,
};
use crate::{
    base::{
        Pose, Real, Vec3,
        random::{Random, Stream},
        real::Twist,
    },
    experiments::StartError,
    physics::{
        Controls, Model, State, System,
        boundary::{
            body::BodyMotion,
            shape::Surface as BodyShape,
            wall::{WallModel, WallShape},
        },
        critical_step::{critical_step, stiffness_at_vertex},
        law::{PairLaw, Surface},
        membrane::{CARRIER_ID, FREE, MembraneModel, MembraneState, Sheet, mesh::Mesh},
        model::{BodyModel, BodySurface, ChamberModel},
        packing::{Growth, Recipe, Room, first_scale, scatter, sphere_volume},
        state::{Grains, Springs},
    },
    scene::Material,
};

/// Solid fraction at which grains are scattered before they grow.
const FIRST_SOLID_FRACTION: Real = 0.15;
/// Neighbours are listed this share of the largest radius beyond contact.
const SKIN_SHARE: Real = 0.25;
/// Pressure that the growing grains may exert on each other [Pa].
const GROWTH_PRESSURE: Real = 1e3;

/// What a case is made of and cannot be read off the system.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Vertices of the outer membrane; the inner one's follow.
    pub(super) n_outer: usize,
    /// What the grains grow to [m].
    pub(super) final_radii: Vec<Real>,
    /// How they grow.
    pub(super) recipe: Recipe,
    /// Common factor at which they are scattered.
    pub(super) first_scale: Real,
}

/// The system of `case` at its start: grains scattered thinly, the outer membrane held stretched.
pub(super) fn system(scene: &Scene, case: &Case) -> Result<(System, Parts), StartError> {
    let outer = Mesh::icosphere(scene.membrane.radius, scene.membrane.frequency)?;
    let n_outer = outer.n_vertices();
    let inner_radius = scene.object.radius + scene.inner_clearance;
    let inner = Mesh::icosphere(inner_radius, scene.inner_frequency)?;
    let mesh = outer.joined(&inner.inside_out()?)?;
    let membrane = MembraneModel::new(mesh, Sheet::of(&scene.membrane));
    let model = model(scene, case, membrane, n_outer);

    let seed = scene.seed + case.filling as u64;
    let mut random = Random::new(seed, Stream::Radius);
    let grains = &scene.grains;
    let final_radii: Vec<Real> =
        (0..grains.count).map(|_| random.between(grains.radius_min, grains.radius_max)).collect();
    let room = Room::Shell {
        inner: inner_radius,
        outer: scene.membrane.fill_stretch * scene.membrane.radius,
    };
    let first = first_scale(&final_radii, FIRST_SOLID_FRACTION, room.volume());
    let density = scene.grains.material.density * case.mass_factor;
    let state = scattered(&model, &room, (&final_radii, first), density, seed)?;
    let mass = sphere_volume(model.radius_mean) * density;
    let recipe = Recipe::new(&model, room.volume(), GROWTH_PRESSURE, mass, model.radius_mean);
    let still = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
    let controls = Controls { gauge_setpoint: 0.0, walls: vec![still], bodies: vec![still] };
    let parts = Parts { n_outer, final_radii, recipe, first_scale: first };
    Ok((System::new(model, controls, state), parts))
}

/// Which wall holds the membranes' vertices while the grains are placed, and afterwards.
pub(super) fn hold(model: &mut Model, is_held: bool) {
    model.membrane.holders.fill(if is_held { CARRIER_ID } else { FREE });
}

/// Growth from the start.
pub(super) fn growth(parts: &Parts) -> Growth {
    Growth::new(parts.recipe, parts.final_radii.clone(), parts.first_scale)
}

fn model(scene: &Scene, case: &Case, mut membrane: MembraneModel, n_outer: usize) -> Model {
    let material = Material {
        youngs_modulus: case.modulus,
        density: scene.grains.material.density * case.mass_factor,
        ..scene.grains.material
    };
    let (mut among_grains, mut on_sheet) = (
        Surface::of_grains(&scene.grains),
        Surface::of_membrane(&scene.membrane, scene.membrane.friction),
    );
    if case.kind == Kind::Frictionless {
        (among_grains.friction, on_sheet.friction) = (0.0, 0.0);
    }
    let touched = match case.kind {
        Kind::StiffContacts => Material { youngs_modulus: case.modulus, ..scene.membrane.material },
        _ => scene.membrane.material,
    };
    let sheet_law = PairLaw::between(&material, &touched, on_sheet);
    let object_law = PairLaw::between(
        &scene.membrane.material,
        &scene.object.material,
        Surface::of_membrane(&scene.membrane, scene.object.friction),
    );
    let stretch = |v: usize| if v < n_outer { scene.membrane.fill_stretch } else { 1.0 };
    let held = membrane.mesh.positions.iter().enumerate().map(|(v, p)| p * stretch(v));
    let held_positions: Vec<Vec3> = held.collect();
    membrane.scale_rest_lengths_of(0..n_outer, scene.membrane.fill_stretch);
    let object = BodyModel {
        surface: BodySurface::Shape(Box::new(BodyShape::Sphere { radius: scene.object.radius })),
        law: object_law,
        contact_radius: scene.object.radius,
        bounding_radius: scene.object.radius,
    };
    // Under full vacuum a grain carries the pressure on its square of sheet, a sample that on its
    // share of the sheet, as in the gripper.
    let radius = scene.grains.radius_max;
    let vacuum = scene.protocol.vacuum;
    let area = membrane.mesh.vertex_areas().into_iter().fold(0.0, Real::max);
    let pressed = stiffness_at_vertex(&membrane, &sheet_law, radius, vacuum)
        + object_law.stiffness(scene.object.radius, vacuum * area);
    // Before the vertices are held: those that are do not count.
    membrane.holders.fill(FREE);
    let critical = critical_step(scene.grains.radius_min, &material, &membrane, pressed);
    membrane.holders.fill(CARRIER_ID);
    Model {
        gravity: Vec3::zeros(),
        substep: scene.protocol.safety * critical,
        radius_max: scene.grains.radius_max,
        radius_mean: (scene.grains.radius_min + scene.grains.radius_max) / 2.0,
        skin: SKIN_SHARE * scene.grains.radius_max,
        period: None,
        density_scaling: 1.0,
        grain_law: PairLaw::between(&material, &material, among_grains),
        membrane_law: sheet_law,
        held_positions,
        walls: vec![WallModel { shape: WallShape::Frame, law: sheet_law }],
        chamber: ChamberModel { lag_factor: 0.0, change_max: Real::INFINITY },
        table: Pose::identity(),
        bodies: vec![object],
        membrane,
    }
}

/// Grains at random places in `room`, at `first` times their final radii and with their final masses.
fn scattered(
    model: &Model,
    room: &Room,
    (final_radii, first): (&[Real], Real),
    density: Real,
    seed: u64,
) -> Result<State, StartError> {
    let radii: Vec<Real> = final_radii.iter().map(|r| first * r).collect();
    let mut random = Random::new(seed, Stream::Position);
    // One final diameter away from the membranes: the growing grains reach them later.
    let margin = 2.0 * model.radius_max;
    let positions = scatter(&radii, None, &mut random, |random| room.place(margin, random))?;
    let n = radii.len();
    let mesh = &model.membrane.mesh;
    let n_samples = mesh.n_vertices() + mesh.triangles.len();
    let mut membrane = MembraneState::at_rest(mesh);
    membrane.positions.clone_from(&model.held_positions);
    Ok(State {
        grains: Grains {
            positions,
            velocities: vec![Vec3::zeros(); n],
            angular_velocities: vec![Vec3::zeros(); n],
            masses: final_radii.iter().map(|&r| sphere_volume(r) * density).collect(),
            radii,
        },
        membrane,
        springs: Springs::none(n, n_samples),
        pair_ids: Vec::new(),
        gauge: 0.0,
        walls: vec![BodyMotion { pose: Pose::identity(), twist: Twist::zero() }],
    })
}
