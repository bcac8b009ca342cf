//! Compiles a scene to a model: laws, meshes, surfaces, and a stable substep.
//!
//! The substep is a fraction of the critical one (`physics::critical_step`) under the contacts that
//! press on a vertex at full vacuum.

mod density_scaling;

pub use density_scaling::ScaledScene;

use super::{
    FLANGE, Plan,
    flange::Limits,
    saved_state::{self, SavedStateError, check_counts},
};
use crate::{
    base::{
        Pose, Real, Vec3,
        digest::Digest,
        parallel::ThreadPool,
        real::{Twist, count, real},
    },
    physics::{
        Model, State, SystemBuilder,
        boundary::{
            body::BodyMotion,
            motion::WallMotion,
            shape::{Bulk, ShapeError, Surface},
            wall::WallShape,
        },
        builder::{BuildError, Membrane, Vertices, Wall},
        critical_step,
        law::{self, PairLaw},
        membrane::{MembraneMaterial, MembraneModel, mesh::Mesh},
        model::{BodyModel, BodySurface, ChamberModel},
    },
    scene::{Object, Scene, Shape},
};

/// Increment this whenever the same scene would settle differently. Part of every cache key.
pub const PHYSICS_VERSION: u64 = 6;
/// Skin of the neighbor lists, relative to the largest radius.
const SKIN_SHARE: Real = 0.25;
/// Longest time between two steps of the rigid-body world (s).
const EXCHANGE_MAX: Real = 1e-4;
/// Effective radius R* of a contact point of the membrane on the table: the object's in the source (m).
const TABLE_CONTACT_RADIUS: Real = 0.01;

/// Why a scene cannot be compiled.
#[derive(Debug, thiserror::Error)]
pub enum CompileError {
    /// The substep of the scene is unstable.
    #[error(
        "time.substep: {given_s:.3e} s exceeds the critical step {critical_s:.3e} s; \
         use at most {advised_s:.3e} s, omit it, or use softer materials or a coarser mesh"
    )]
    SubstepTooLong {
        /// The substep of the scene (s).
        given_s: Real,
        /// The critical step (s).
        critical_s: Real,
        /// The substep that would be derived (s).
        advised_s: Real,
    },
    /// The membrane cannot be meshed.
    #[error("membrane: {0}")]
    Membrane(#[from] crate::physics::membrane::mesh::MeshError),
    /// An object's shape cannot be used.
    #[error("object `{name}`: {error}")]
    Object {
        /// Its name.
        name: String,
        /// The error.
        error: ShapeError,
    },
    /// The parts of the gripper are inconsistent.
    #[error("gripper: {0}")]
    Build(#[from] BuildError),
}

/// A compiled scene.
pub struct Compiled {
    /// The scene.
    pub scene: Scene,
    /// Grains, membrane and chamber.
    pub model: Model,
    /// How a tick is divided.
    pub plan: Plan,
    /// Mass properties of the objects.
    pub bulks: Vec<Bulk>,
    /// Limits of the flange's motion.
    pub limits: Limits,
    /// Threads of the solver.
    pub pool: ThreadPool,
}

/// A compiled scene without its thread pool.
pub struct Gripper {
    /// Grains, membrane and chamber.
    pub model: Model,
    /// How a tick is divided.
    pub plan: Plan,
    /// Mass properties of the objects.
    pub bulks: Vec<Bulk>,
}

/// Compiles the model of a scene.
///
/// # Errors
/// If the substep is too long or a shape is unusable.
pub fn gripper(scene: &Scene) -> Result<Gripper, CompileError> {
    let mesh = Mesh::half_icosphere(scene.membrane.radius, scene.membrane.frequency)?;
    let scaled = ScaledScene::new(scene);
    let mut membrane = MembraneModel::new(mesh, MembraneMaterial::of(&scaled.membrane));
    membrane.scale_rest_lengths(1.0 - scene.membrane.rest_length_shrink);
    let (mut bodies, bulks) = bodies(&scaled)?;
    bodies.push(table(&scaled));
    let laws = Laws::new(&scaled);
    let plan = plan(&scaled, &membrane, &laws, &bodies)?;
    let dt = plan.tick / real(plan.n_substeps);
    let grains = &scene.grains;
    let mut builder = SystemBuilder::new(laws.grain);
    builder
        .membrane_law(laws.membrane)
        .density_scaling(scene.time.density_scaling)
        .gravity(scene.gravity / scene.time.density_scaling)
        .substep(dt)
        .radii_up_to(grains.radius_max, (grains.radius_min + grains.radius_max) / 2.0)
        .skin(SKIN_SHARE * grains.radius_max)
        .chamber(ChamberModel::new(&scene.chamber, dt))
        .table(Pose::translation(0.0, 0.0, scene.table.height));
    let plate = Wall::new(WallShape::Plane { normal: -Vec3::z() })
        .moving(WallMotion::External)
        .law(laws.plate);
    let flange = builder.wall(plate);
    builder.membrane(Membrane::of(membrane).hold(Vertices::Rims, flange));
    for body in bodies {
        builder.body(body, BodyMotion { pose: Pose::identity(), twist: Twist::zero() });
    }
    Ok(Gripper { model: builder.build_model()?, plan, bulks })
}

impl Compiled {
    /// Compiles `scene`, to be run on the threads of `pool`. No result depends on their number.
    ///
    /// # Errors
    /// If the substep is too long or a shape is unusable.
    pub fn new(scene: &Scene, pool: &ThreadPool) -> Result<Self, CompileError> {
        let Gripper { model, plan, bulks } = gripper(scene)?;
        let limits = Limits::new(&scene.flange);
        Ok(Self { scene: scene.clone(), model, plan, bulks, limits, pool: pool.clone() })
    }

    /// Cache key of the settled start state: exactly what the filling depends on.
    pub fn start_digest(&self) -> u64 {
        let Scene { seed, grains, membrane, flange, .. } = &self.scene;
        let gravity = &self.model.gravity;
        let mut digest = Digest::new();
        digest.integer(PHYSICS_VERSION);
        digest.integer(*seed);
        digest.real(self.model.substep);
        digest.bytes(format!("{gravity:?} {grains:?} {membrane:?} {:?}", flange.pose).as_bytes());
        digest.finish()
    }
}

impl Compiled {
    /// Reads a settled start state: the flange is at its initial pose, the gauge pressure is zero.
    ///
    /// # Errors
    /// If the bytes are corrupt or of another scene.
    pub fn read_start_state(&self, bytes: &[u8]) -> Result<State, SavedStateError> {
        let mut state = self.checked_state(bytes)?;
        state.gauge = 0.0;
        state.walls[FLANGE] = BodyMotion { pose: self.scene.flange.pose, twist: Twist::zero() };
        Ok(state)
    }

    /// Reads the state of a running simulation.
    ///
    /// # Errors
    /// If the bytes are corrupt or of another scene.
    pub fn read_state(&self, bytes: &[u8]) -> Result<State, SavedStateError> {
        let state = self.checked_state(bytes)?;
        check_counts(&[("body springs", state.springs.bodies.len(), self.n_samples())])?;
        Ok(state)
    }

    fn checked_state(&self, bytes: &[u8]) -> Result<State, SavedStateError> {
        let state = saved_state::read(bytes)?;
        let n_vertices = self.model.membrane.mesh.n_vertices();
        check_counts(&[
            ("grains", state.grains.len(), self.scene.grains.count),
            ("vertices", state.membrane.positions.len(), n_vertices),
            ("walls", state.walls.len(), self.model.walls.len()),
        ])?;
        Ok(state)
    }

    /// Number of contact points of the membrane with all bodies.
    pub fn n_samples(&self) -> usize {
        self.model.n_samples() * self.model.bodies.len()
    }
}

struct Laws {
    grain: PairLaw,
    plate: PairLaw,
    membrane: PairLaw,
}

impl Laws {
    fn new(scene: &ScaledScene) -> Self {
        let grains = &scene.grains;
        let among_grains = law::Surface::of_grains(grains);
        let on_membrane = law::Surface::of_membrane(&scene.membrane, scene.membrane.friction);
        Self {
            grain: PairLaw::between(&grains.material, &grains.material, among_grains),
            plate: PairLaw::against_rigid(&grains.material, among_grains),
            membrane: PairLaw::between(&grains.material, &scene.membrane.material, on_membrane),
        }
    }
}

fn bodies(scene: &ScaledScene) -> Result<(Vec<BodyModel>, Vec<Bulk>), CompileError> {
    let bodies = scene.objects.iter().map(|object| scaled_body(scene, object));
    Ok(bodies.collect::<Result<Vec<_>, _>>()?.into_iter().unzip())
}

/// The body of an object that is inserted during a run, and its mass properties. The damping of its
/// contacts is that of the scene without density scaling.
///
/// # Errors
/// If its shape cannot be used.
pub fn body(scene: &Scene, object: &Object) -> Result<(BodyModel, Bulk), CompileError> {
    scaled_body(&ScaledScene::unscaled(scene), object)
}

fn scaled_body(scene: &ScaledScene, object: &Object) -> Result<(BodyModel, Bulk), CompileError> {
    let surface = surface(&object.shape)
        .map_err(|error| CompileError::Object { name: object.name.clone(), error })?;
    let bulk = surface.bulk(object.material.density);
    let on_object = law::Surface::of_membrane(&scene.membrane, object.friction);
    let model = BodyModel {
        law: PairLaw::between(&scene.membrane.material, &object.material, on_object),
        contact_radius: contact_radius(&object.shape, bulk.volume),
        bounding_radius: surface.bounding_radius(),
        of_grains: None,
        surface: BodySurface::Shape(Box::new(surface)),
    };
    Ok((model, bulk))
}

/// Updates materials and pump from `scene`; shapes and steps stay.
pub fn retune(scene: &Scene, model: &mut Model) {
    let scene = &ScaledScene::new(scene);
    let laws = Laws::new(scene);
    (model.grain_law, model.membrane_law) = (laws.grain, laws.membrane);
    model.walls[FLANGE].law = laws.plate;
    model.chamber = ChamberModel::new(&scene.chamber, model.substep);
    for (object, body) in scene.objects.iter().zip(&mut model.bodies) {
        let on_object = law::Surface::of_membrane(&scene.membrane, object.friction);
        body.law = PairLaw::between(&scene.membrane.material, &object.material, on_object);
    }
}

/// The critical step of `scene` with an additional object (s).
pub fn critical_step_with(scene: &Scene, model: &Model, body: &BodyModel) -> Real {
    let scene = &ScaledScene::new(scene);
    critical_step(scene, &model.membrane, &Laws::new(scene), std::slice::from_ref(body))
}

fn surface(shape: &Shape) -> Result<Surface, ShapeError> {
    Ok(match shape {
        Shape::Sphere { radius } => Surface::Sphere { radius: *radius },
        Shape::Box { size } => Surface::cuboid(size),
        Shape::Cylinder { radius, height } => Surface::cylinder(*radius, *height),
        Shape::Capsule { radius, height } => Surface::capsule(*radius, *height),
        Shape::ConvexHull { points } => Surface::convex_hull(points)?,
        Shape::Mesh { vertices, triangles, .. } => Surface::mesh(vertices, triangles)?,
    })
}

/// Effective radius R* of a contact of the membrane with an object: for spheres, cylinders and capsules
/// their radius, as in the source; for other shapes the radius of a sphere of the same volume.
fn contact_radius(shape: &Shape, volume: Real) -> Real {
    match shape {
        Shape::Sphere { radius }
        | Shape::Cylinder { radius, .. }
        | Shape::Capsule { radius, .. } => *radius,
        Shape::Box { .. } | Shape::ConvexHull { .. } | Shape::Mesh { .. } => {
            (volume * 0.75 / std::f64::consts::PI).cbrt()
        }
    }
}

fn table(scene: &ScaledScene) -> BodyModel {
    let on_table = law::Surface::of_membrane(&scene.membrane, scene.table.friction);
    BodyModel {
        surface: BodySurface::HalfSpace,
        law: PairLaw::against_rigid(&scene.membrane.material, on_table),
        contact_radius: TABLE_CONTACT_RADIUS,
        bounding_radius: Real::INFINITY,
        of_grains: None,
    }
}

fn plan(
    scene: &ScaledScene,
    membrane: &MembraneModel,
    laws: &Laws,
    bodies: &[BodyModel],
) -> Result<Plan, CompileError> {
    let critical = critical_step(scene, membrane, laws, bodies);
    let advised = scene.time.safety * critical;
    let requested = match scene.time.substep {
        Some(given) if given > critical => {
            return Err(CompileError::SubstepTooLong {
                given_s: given,
                critical_s: critical,
                advised_s: advised,
            });
        }
        Some(given) => given,
        None => advised,
    };
    let tick = std::time::Duration::from_nanos(scene.time.tick_ns).as_secs_f64();
    // A substep that divides the tick must not become shorter by rounding.
    let n_first = count(tick / requested - 1e-9);
    let n_per_exchange = count((EXCHANGE_MAX * real(n_first) / tick).floor()).max(1);
    let n_substeps = n_first.div_ceil(n_per_exchange) * n_per_exchange;
    Ok(Plan { tick, n_substeps, n_per_exchange })
}

fn critical_step(
    scene: &ScaledScene,
    membrane: &MembraneModel,
    laws: &Laws,
    bodies: &[BodyModel],
) -> Real {
    let grains = &scene.grains;
    // Under the strongest vacuum, a grain carries the pressure on its square of the membrane, a contact
    // point with a body that on its share of the membrane.
    let pressure = scene.chamber.gauge_min.abs().max(scene.chamber.gauge_max);
    let on_vertex =
        critical_step::stiffness_at_vertex(membrane, &laws.membrane, grains.radius_max, pressure)
            + critical_step::stiffness_of_bodies(membrane, bodies, pressure);
    critical_step::critical_step(grains.radius_min, &grains.material, membrane, on_vertex)
}
