//! The hollow sphere as a system: object, two membranes, grains between them.

use super::{
    cases::{Case, Kind},
    scene::HollowSphereScene,
};
use crate::{
    base::{
        Pose, Real,
        random::{Random, Stream},
        real::Twist,
    },
    experiments::StartError,
    physics::{
        Model, System, SystemBuilder,
        boundary::{body::BodyMotion, shape::Surface as BodyShape},
        builder::{Membrane, Vertices, Wall},
        critical_step::{critical_step, stiffness_at_vertex},
        law::{PairLaw, Surface},
        membrane::{CARRIER_ID, FREE, MembraneMaterial, MembraneModel, mesh::Mesh},
        model::{BodyModel, BodySurface},
        packing::{Growth, Recipe, Room, first_scale, scatter, sphere_volume},
        state::Grains,
    },
    scene::Material,
};

/// Solid fraction at which grains are scattered before they grow.
const FIRST_SOLID_FRACTION: Real = 0.15;
/// Skin of the neighbor lists, as a share of the largest radius.
const SKIN_SHARE: Real = 0.25;
/// Pressure of the grains at which growth ends (Pa).
const GROWTH_PRESSURE: Real = 1e3;

/// Parameters of a case that the system does not hold.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Number of vertices of the outer membrane, which come before those of the inner one.
    pub(super) n_outer: usize,
    /// Final radii of the grains (m).
    pub(super) final_radii: Vec<Real>,
    /// Parameters of growth.
    pub(super) recipe: Recipe,
    /// Common factor of the radii at the start of growth.
    pub(super) first_scale: Real,
}

/// The system of `case` at its start: small scattered grains, and the outer membrane held
/// stretched.
pub(super) fn system(
    scene: &HollowSphereScene,
    case: &Case,
) -> Result<(System, Parts), StartError> {
    let outer = Mesh::icosphere(scene.membrane.radius, scene.membrane.frequency)?;
    let n_outer = outer.n_vertices();
    let inner_radius = scene.object.radius + scene.inner.clearance;
    let inner = Mesh::icosphere(inner_radius, scene.inner.frequency)?;
    let material = MembraneMaterial::of(&scene.membrane);
    let mut outer = MembraneModel::new(outer, material);
    outer.scale_rest_lengths(scene.membrane.fill_stretch);
    let membranes = [outer, MembraneModel::new(inner.inside_out()?, material)];

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
    let small: Vec<Real> = final_radii.iter().map(|r| first * r).collect();
    let mut random = Random::new(seed, Stream::Position);
    // One final diameter away from the membranes, which growing grains reach later.
    let margin = 2.0 * grains.radius_max;
    let positions = scatter(&small, None, &mut random, |random| room.place(margin, random))?;
    let masses = final_radii.iter().map(|&r| sphere_volume(r) * density).collect();
    let grains = Grains::at_rest(positions, small, masses);
    let system = assembled(scene, case, membranes, grains)?;

    let radius = system.model.radius_mean;
    let mass = sphere_volume(radius) * density;
    let recipe = Recipe::new(&system.model, room.volume(), GROWTH_PRESSURE, mass, radius);
    Ok((system, Parts { n_outer, final_radii, recipe, first_scale: first }))
}

/// Holds the membranes by the frame, or releases them.
pub(super) fn hold(model: &mut Model, is_held: bool) {
    model.membrane.holders.fill(if is_held { CARRIER_ID } else { FREE });
}

/// Growth at its start.
pub(super) fn growth(parts: &Parts) -> Growth {
    Growth::new(parts.recipe, parts.final_radii.clone(), parts.first_scale)
}

/// Grains between both membranes, which a frame holds, with the object in the middle.
fn assembled(
    scene: &HollowSphereScene,
    case: &Case,
    [outer, inner]: [MembraneModel; 2],
    grains: Grains,
) -> Result<System, StartError> {
    let laws = Laws::new(scene, case);
    let (low, high) = (scene.grains.radius_min, scene.grains.radius_max);
    let mut builder = SystemBuilder::new(laws.grains);
    builder
        .wall_law(laws.membrane)
        .membrane_law(laws.membrane)
        .substep(substep(scene, &laws, outer.clone().joined(&inner)?))
        .radii_up_to(high, (low + high) / 2.0)
        .skin(SKIN_SHARE * high)
        .grains(grains);
    let frame = builder.wall(Wall::frame());
    let stretch = scene.membrane.fill_stretch;
    let stretched = outer.mesh.positions.iter().map(|p| p * stretch).collect();
    let outer = Membrane::of(outer).starting_at(stretched);
    builder.membrane(outer.hold(Vertices::All, frame));
    builder.membrane(Membrane::of(inner).hold(Vertices::All, frame));
    let object = BodyModel {
        surface: BodySurface::Shape(Box::new(BodyShape::Sphere { radius: scene.object.radius })),
        law: laws.object,
        contact_radius: scene.object.radius,
        bounding_radius: scene.object.radius,
        of_grains: None,
    };
    builder.body(object, BodyMotion { pose: Pose::identity(), twist: Twist::zero() });
    Ok(builder.build()?)
}

/// The contact laws.
struct Laws {
    material: Material,
    grains: PairLaw,
    membrane: PairLaw,
    object: PairLaw,
}

impl Laws {
    fn new(scene: &HollowSphereScene, case: &Case) -> Self {
        let material = Material {
            youngs_modulus: case.modulus,
            density: scene.grains.material.density * case.mass_factor,
            ..scene.grains.material
        };
        let (mut among_grains, mut on_membrane) = (
            Surface::of_grains(&scene.grains),
            Surface::of_membrane(&scene.membrane, scene.membrane.friction),
        );
        if case.kind == Kind::Frictionless {
            (among_grains.friction, on_membrane.friction) = (0.0, 0.0);
        }
        let touched = match case.kind {
            Kind::StiffContacts => {
                Material { youngs_modulus: case.modulus, ..scene.membrane.material }
            }
            _ => scene.membrane.material,
        };
        let on_object = Surface::of_membrane(&scene.membrane, scene.object.friction);
        Self {
            material,
            grains: PairLaw::between(&material, &material, among_grains),
            membrane: PairLaw::between(&material, &touched, on_membrane),
            object: PairLaw::between(&scene.membrane.material, &scene.object.material, on_object),
        }
    }
}

/// The substep: a share of the critical step of both membranes (s). Under full vacuum a grain
/// carries the pressure on its square of the membrane, and a sample that on its share of the
/// membrane, as in the gripper.
fn substep(scene: &HollowSphereScene, laws: &Laws, mut membrane: MembraneModel) -> Real {
    let vacuum = scene.protocol.vacuum;
    let area = membrane.mesh.vertex_areas().into_iter().fold(0.0, Real::max);
    let radius = scene.grains.radius_max;
    let pressed = stiffness_at_vertex(&membrane, &laws.membrane, radius, vacuum)
        + laws.object.stiffness(scene.object.radius, vacuum * area);
    // Held vertices do not count for the critical step, and none is held under vacuum.
    membrane.holders.fill(FREE);
    let smallest = scene.grains.radius_min;
    scene.protocol.safety * critical_step(smallest, &laws.material, &membrane, pressed)
}
