//! The specimen: grains in a tubular membrane between two plates, and what changes of it between
//! the phases of the test.
//!
//! A frame holds the membrane straight while the grains grow; afterward its end rings are fixed to
//! the plates and the rest is free. Grains touch the plates and the membrane. They are softer while
//! they grow; stiffness and dissipation rise to their true values by equal factors.

use super::{
    cases::{Choice, Kind},
    scene::{MeshSize, Size, TriaxialScene},
};
use crate::{
    base::{
        Real, Vec3,
        random::{Random, Stream},
    },
    experiments::StartError,
    physics::{
        Model, System, SystemBuilder,
        builder::{BuildError, Membrane, Vertices, Wall},
        critical_step::{RAYLEIGH_SHARE, rayleigh_time, stiffness_at_vertex},
        law::{PairLaw, Surface},
        membrane::{
            FREE, MembraneContact, MembraneModel,
            critical_step::critical_step_at,
            mesh::{Mesh, MeshError},
        },
        packing::{Room, first_scale, scatter, sphere_volume},
        state::Grains,
    },
    scene::Material,
};

/// The wall that holds the membrane while grains grow. It is the first one, so that the neighbor
/// lists are kept relative to the middle of the specimen.
pub(super) const FRAME: u32 = 0;
/// The lower plate.
pub(super) const BOTTOM: u32 = 1;
/// The upper plate.
pub(super) const TOP: u32 = 2;
/// Skin of the neighbor lists, as a share of the largest radius.
const SKIN_SHARE: Real = 0.2;

/// How the specimen is made, independent of its state.
#[derive(Clone)]
pub(super) struct Recipe {
    pub(super) scene: TriaxialScene,
    pub(super) choice: Choice,
    pub(super) final_radii: Vec<Real>,
    /// Common factor of the radii at the start of growth.
    pub(super) first_scale: Real,
    /// Substep while grains grow (s).
    pub(super) growth_step: Real,
    /// Substep of the free, undeformed membrane (s).
    pub(super) first_step: Real,
    /// Stiffness of the grains at a vertex (N/m) for the substep of the membrane.
    contact_stiffness: Real,
}

impl Recipe {
    /// The recipe of a specimen, and its system before the grains grow.
    ///
    /// # Errors
    /// If the membrane cannot be meshed, or the parts do not fit each other.
    pub(super) fn new(scene: &TriaxialScene, choice: Choice) -> Result<(Self, System), StartError> {
        let Size { radius, height, .. } = scene.cases[choice.size];
        let membrane = membrane(scene, choice)?;
        let [_, _, law] = laws(scene, 0.0);
        let mut random = Random::new(scene.seeds[choice.initial], Stream::Radius);
        let (low, high) = (scene.grains.radius_min, scene.grains.radius_max);
        let n_grains = net(scene, choice).n_grains[choice.initial];
        let final_radii: Vec<Real> = (0..n_grains).map(|_| random.between(low, high)).collect();
        let room = Room::Tube { radius, bottom: -0.5 * height, top: 0.5 * height };
        let thin = scene.growth.first_solid_fraction;
        let pressure = scene.confining.pressure;
        let mut recipe = Self {
            scene: scene.clone(),
            choice,
            first_scale: first_scale(&final_radii, thin, room.volume()),
            final_radii,
            growth_step: growth_step(scene),
            first_step: Real::NAN,
            contact_stiffness: stiffness_at_vertex(&membrane, &law, high, pressure),
        };
        // With its rims held, as it is sheared.
        recipe.first_step = recipe.step(&membrane, &membrane.mesh.positions);
        let system = recipe.system(membrane, &room)?;
        Ok((recipe, system))
    }

    /// Initial size of the specimen.
    pub(super) fn size(&self) -> &Size {
        &self.scene.cases[self.choice.size]
    }

    /// Small grains at rest in the straight membrane, which the frame holds.
    fn system(&self, membrane: MembraneModel, room: &Room) -> Result<System, BuildError> {
        let grains = &self.scene.grains;
        let [plates, among_grains, on_membrane] = laws(&self.scene, 0.0);
        let mut builder = SystemBuilder::new(among_grains);
        builder
            .wall_law(plates)
            .membrane_law(on_membrane)
            .substep(self.growth_step)
            .radii_up_to(grains.radius_max, 0.5 * (grains.radius_min + grains.radius_max))
            .skin(SKIN_SHARE * grains.radius_max)
            .grains(self.scattered(room));
        let frame = builder.wall(Wall::frame());
        let half = 0.5 * self.size().height;
        let plate = |z: Real, up: Real| Wall::plane(Vec3::new(0.0, 0.0, z), Vec3::z() * up);
        builder.walls([plate(-half, 1.0), plate(half, -1.0)]);
        builder.membrane(Membrane::of(membrane).hold(Vertices::All, frame));
        builder.build()
    }

    /// Small grains at random positions.
    fn scattered(&self, room: &Room) -> Grains {
        let grains = &self.scene.grains;
        let small: Vec<Real> = self.final_radii.iter().map(|r| self.first_scale * r).collect();
        let mut random = Random::new(self.scene.seeds[self.choice.initial], Stream::Position);
        let margin = grains.radius_max;
        let positions = scatter(&small, None, &mut random, |it| room.place(margin, it))
            .expect("the first solid fraction is limited so that every grain finds a position");
        let density = grains.material.density;
        let masses = self.final_radii.iter().map(|&r| sphere_volume(r) * density).collect();
        Grains::at_rest(positions, small, masses)
    }

    /// Lets the frame hold the membrane, and makes the grains soft.
    pub(super) fn hold(&self, model: &mut Model) {
        model.membrane.holders.fill(FRAME);
        model.held_positions.clone_from(&model.membrane.mesh.positions);
        model.substep = self.growth_step;
        self.soften(model, 1.0);
    }

    /// Fixes the end rings to the plates, releases the rest of the membrane, and makes the grains
    /// stiff.
    pub(super) fn release(&self, model: &mut Model) {
        fix_rings(model);
        model.substep = self.first_step;
        self.soften(model, 0.0);
    }

    /// Substep of the free membrane (s) with its vertices at `positions`.
    ///
    /// The damping of hinges with initial areas grows with the cube of their edge lengths: a
    /// membrane that is stretched by a third is stable with half the substep of the straight one.
    ///
    /// A packing becomes unstable as ω dt approaches 2, and ω² ~ √(ξ/R): at 0.4 of the Rayleigh
    /// time for overlaps of a tenth of a diameter, and far later for those of stiff grains.
    pub(super) fn step(&self, membrane: &MembraneModel, positions: &[Vec3]) -> Real {
        let TriaxialScene { grains, time, .. } = &self.scene;
        let packing = time.rayleigh_share * rayleigh_time(grains.radius_min, &grains.material);
        let membrane_step = critical_step_at(membrane, positions, self.contact_stiffness);
        time.safety * packing.min(membrane_step)
    }

    /// Sets the contact laws of softer grains: `share` 1 as during growth, 0 for the true ones.
    pub(super) fn soften(&self, model: &mut Model, share: Real) {
        set_laws(&self.scene, model, share);
    }
}

/// Mesh and numbers of grains of a specimen.
fn net(scene: &TriaxialScene, choice: Choice) -> MeshSize {
    let size = &scene.cases[choice.size];
    match choice.kind {
        Kind::Triangles => size.triangles,
        Kind::Spheres => size.spheres,
    }
}

/// The membrane in its straight shape.
fn membrane(scene: &TriaxialScene, choice: Choice) -> Result<MembraneModel, MeshError> {
    let size = &scene.cases[choice.size];
    let net = net(scene, choice);
    let mesh = Mesh::tube(size.radius, size.height, net.n_around, net.n_rows)?;
    let damping = match choice.kind {
        Kind::Triangles => scene.membrane.bending_damping,
        Kind::Spheres => scene.membrane.bending_damping_spheres,
    };
    let mut membrane = MembraneModel::new(mesh, scene.membrane.material(damping));
    if scene.membrane.bends_by_first_areas {
        membrane.bend_by_first_areas();
    }
    if choice.kind == Kind::Spheres {
        membrane.contact = MembraneContact::Spheres { radius: size.sphere_radius };
    }
    Ok(membrane)
}

/// Lets the plates hold the membrane's end rings; the rest is free.
fn fix_rings(model: &mut Model) {
    let mesh = &model.membrane.mesh;
    model.membrane.holders.fill(FREE);
    model.held_positions.clone_from(&mesh.positions);
    for &v in mesh.rims.iter().flatten() {
        let position = &mut model.held_positions[v as usize];
        model.membrane.holders[v as usize] = if position.z < 0.0 { BOTTOM } else { TOP };
        position.z = 0.0;
    }
}

/// Laws of grains with plates, grains and membrane; `softness` 1 as during growth, 0 for the true
/// ones.
fn laws(scene: &TriaxialScene, softness: Real) -> [PairLaw; 3] {
    let TriaxialScene { grains, growth, membrane, .. } = scene;
    let between = |hard: Real, soft: Real| hard * (soft / hard).powf(softness);
    let material = Material {
        youngs_modulus: between(grains.material.youngs_modulus, growth.youngs_modulus),
        ..grains.material
    };
    let surface = |friction: Real| Surface {
        friction,
        dissipation_time: between(grains.dissipation_time, growth.dissipation_time),
        tangential_damping: grains.tangential_damping,
    };
    let on_membrane = Surface {
        friction: membrane.friction,
        dissipation_time: membrane.dissipation_time,
        tangential_damping: membrane.tangential_damping,
    };
    [
        PairLaw::against_rigid(&material, surface(scene.plates.friction)),
        PairLaw::between(&material, &material, surface(grains.friction)),
        PairLaw::between(&material, &membrane.material, on_membrane),
    ]
}

fn set_laws(scene: &TriaxialScene, model: &mut Model, softness: Real) {
    let [plates, grains, membrane] = laws(scene, softness);
    model.walls.iter_mut().for_each(|wall| wall.law = plates);
    (model.grain_law, model.membrane_law) = (grains, membrane);
}

/// Substep while grains grow in the held membrane (s).
fn growth_step(scene: &TriaxialScene) -> Real {
    let TriaxialScene { grains, growth, time, .. } = scene;
    let soft = Material { youngs_modulus: growth.youngs_modulus, ..grains.material };
    time.safety * RAYLEIGH_SHARE * rayleigh_time(grains.radius_min, &soft)
}
