//! The rigid-body world: objects on a table, simulated by rapier.
//!
//! The defaults of rapier are made for bodies of meters: here contacts are not recycled, and the length
//! unit is the size of the objects. Bodies never sleep, because a sleeping body would ignore the
//! membrane.

use nalgebra::Isometry3;
use rapier3d_f64::{
    parry::{query::contact, shape::TriMeshFlags},
    prelude::{
        CoefficientCombineRule, Collider, ColliderBuilder, MassProperties, PhysicsWorld,
        Pose as RapierPose, RigidBodyAdditionalMassProps, RigidBodyBuilder, RigidBodyHandle,
        RigidBodyType, SpringCoefficients, Vector,
    },
};

use super::saved_state::{SavedStateError, check_counts};
use crate::{
    base::{
        Pose, Real, Vec3,
        digest::Digest,
        real::{Twist, Wrench},
    },
    physics::{
        Model,
        boundary::{
            body::BodyMotion,
            shape::{Bulk, Surface},
        },
        model::{BodyModel, BodySurface},
    },
    scene::{Object, Scene},
};

/// Half the edge and half the thickness of the table's slab (m).
pub const TABLE_HALF: [Real; 2] = [2.0, 0.1];
/// Typical size of a body, for rapier (m).
const LENGTH_UNIT: Real = 0.02;

/// Natural frequency of contacts with the table (Hz): an object of 30 g under 40 N sinks by
/// F/(m ω²) = 30 µm. At rapier's own 60 Hz it would be 10 mm.
const TABLE_FREQUENCY: Real = 1000.0;
/// Damping ratio of these contacts, rapier's own.
const TABLE_DAMPING: Real = 10.0;

/// Objects and table.
pub struct RapierWorld {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    bulks: Vec<Bulk>,
}

impl RapierWorld {
    /// A world with the objects of `scene`; `model` and `bulks` have the same order. `step` (s) is the
    /// time step.
    pub fn new(scene: &Scene, model: &Model, bulks: Vec<Bulk>, step: Real) -> Self {
        let mut world = PhysicsWorld { gravity: vector(&scene.gravity), ..Default::default() };
        let parameters = &mut world.integration_parameters;
        parameters.dt = step;
        parameters.contact_recycling = false;
        parameters.length_unit = LENGTH_UNIT;
        let stiff = SpringCoefficients::new(TABLE_FREQUENCY, TABLE_DAMPING);
        parameters.static_contact_softness = stiff;
        let [edge, thickness] = TABLE_HALF;
        let center = Vector::new(0.0, 0.0, scene.table.height - thickness);
        let slab = ColliderBuilder::cuboid(edge, edge, thickness)
            .friction(scene.table.friction)
            .friction_combine_rule(CoefficientCombineRule::Max);
        world.insert(RigidBodyBuilder::fixed().translation(center), slab);
        let mut this = Self { world, bodies: Vec::new(), bulks: Vec::new() };
        for ((object, body), bulk) in scene.objects.iter().zip(&model.bodies).zip(bulks) {
            this.insert(object, body, bulk);
        }
        this
    }

    /// Adds an object after all others, at rest in its initial pose.
    pub fn insert(&mut self, object: &Object, body: &BodyModel, bulk: Bulk) {
        let BodySurface::Shape(surface) = &body.surface else { return };
        let properties = MassProperties::with_principal_inertia_frame(
            Vector::ZERO,
            bulk.mass,
            vector(&bulk.principal_inertia),
            bulk.principal_axes.into(),
        );
        let rigid = RigidBodyBuilder::dynamic()
            .pose(RapierPose::from(center_pose(object, &bulk)))
            .additional_mass_properties(properties)
            .can_sleep(false);
        let collider = collider(surface)
            .density(0.0)
            .friction(0.0)
            .friction_combine_rule(CoefficientCombineRule::Max);
        self.bodies.push(self.world.insert(rigid, collider).0);
        self.bulks.push(bulk);
    }

    /// Removes object `i`.
    pub fn remove(&mut self, i: usize) {
        self.world.remove_body(self.bodies.remove(i));
        self.bulks.remove(i);
    }

    /// Sets the motion of object `i`, which is no longer driven.
    pub fn place(&mut self, i: usize, motion: &BodyMotion) {
        let body = &mut self.world.bodies[self.bodies[i]];
        body.set_body_type(RigidBodyType::Dynamic, true);
        body.set_position(RapierPose::from(motion.pose), true);
        body.set_linvel(vector(&motion.twist.linear), true);
        body.set_angvel(vector(&motion.twist.angular), true);
    }

    /// Finds an obstacle that a body with this surface at `pose` would overlap by more than `tolerance`
    /// (m): `Some(None)` for the table, `Some(Some(i))` for object `i`. Ignores object `except`.
    pub fn overlap(
        &self,
        surface: &Surface,
        pose: &Pose,
        except: Option<usize>,
        tolerance: Real,
    ) -> Option<Option<usize>> {
        let shape = collider(surface).build();
        let offset: Isometry3<Real> = shape.position_wrt_parent().map_or_else(
            Isometry3::identity, // no offset
            |it| (*it).into(),
        );
        let placed = RapierPose::from(pose * offset);
        for (_, other) in self.world.colliders.iter() {
            let owner = other.parent().and_then(|it| self.bodies.iter().position(|b| *b == it));
            if owner.is_some() && owner == except {
                continue;
            }
            let found = contact(&placed, shape.shape(), other.position(), other.shape(), 0.0);
            if found.is_ok_and(|it| it.is_some_and(|it| it.dist < -tolerance)) {
                return Some(owner);
            }
        }
        None
    }

    /// Current pose and velocity of object `i`.
    pub fn motion(&self, i: usize) -> BodyMotion {
        let body = &self.world.bodies[self.bodies[i]];
        let pose: Isometry3<Real> = (*body.position()).into();
        let twist = Twist { linear: body.linvel().into(), angular: body.angvel().into() };
        BodyMotion { pose, twist }
    }

    /// Mass of object `i` (kg).
    pub fn mass(&self, i: usize) -> Real {
        self.bulks[i].mass
    }

    /// Momentum (kg m/s) and angular momentum about the center of mass (kg m²/s) of object `i`.
    pub fn momentum(&self, i: usize) -> (Vec3, Vec3) {
        let motion = self.motion(i);
        let bulk = &self.bulks[i];
        let axes = motion.pose.rotation * bulk.principal_axes;
        let spin = axes.inverse_transform_vector(&motion.twist.angular);
        let angular_momentum = axes * bulk.principal_inertia.component_mul(&spin);
        (motion.twist.linear * bulk.mass, angular_momentum)
    }

    /// Drives object `i` with `twist`; with `None` it moves freely from its current velocity.
    pub fn drive(&mut self, i: usize, twist: Option<&Twist>) {
        let body = &mut self.world.bodies[self.bodies[i]];
        let kind = match twist {
            Some(_) => RigidBodyType::KinematicVelocityBased,
            None => RigidBodyType::Dynamic,
        };
        if body.body_type() != kind {
            let (linear, angular) = (body.linvel(), body.angvel());
            body.set_body_type(kind, true);
            body.set_linvel(linear, true);
            body.set_angvel(angular, true);
        }
        if let Some(twist) = twist {
            body.set_linvel(vector(&twist.linear), true);
            body.set_angvel(vector(&twist.angular), true);
        }
    }

    /// One step under the mean wrenches of the membrane about the centers of mass.
    pub fn step(&mut self, wrenches: &[Wrench]) {
        for (&handle, wrench) in self.bodies.iter().zip(wrenches) {
            let body = &mut self.world.bodies[handle];
            body.reset_forces(true);
            body.reset_torques(true);
            body.add_force(vector(&wrench.force), true);
            body.add_torque(vector(&wrench.torque), true);
        }
        self.world.step();
    }

    /// Serializes the whole world: bodies, contacts with their cached impulses, and the broad-phase
    /// trees. A world restored from poses and velocities alone would not continue bit for bit.
    pub fn save(&self) -> Vec<u8> {
        postcard::to_stdvec(&self.world).expect("the world of rapier can always be serialized")
    }

    /// Replaces this world, which was built for the current scene, by a saved one. Gravity, masses and
    /// friction stay those of the current scene; everything else is from the saved world.
    ///
    /// # Errors
    /// If the bytes are not a world, or one with other objects.
    pub fn restore(&mut self, bytes: &[u8]) -> Result<(), SavedStateError> {
        let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
        let mut saved: PhysicsWorld = postcard::from_bytes(bytes).map_err(|_| corrupt)?;
        check_counts(&[("rigid bodies", saved.bodies.len(), self.world.bodies.len())])?;
        saved.gravity = self.world.gravity;
        saved.integration_parameters = self.world.integration_parameters;
        // Only change what differs: mutable access to a body alone marks it as modified.
        for (handle, body) in self.world.bodies.iter() {
            let Some(kept) = saved.bodies.get(handle) else {
                let what = "rigid bodies with the same handle";
                return Err(SavedStateError::OtherScene { what, found: 0, expected: 1 });
            };
            let expected = &body.mass_properties().additional_local_mprops;
            if kept.mass_properties().additional_local_mprops != *expected
                && let Some(RigidBodyAdditionalMassProps::MassProps(expected)) = expected.as_deref()
            {
                saved.bodies[handle].set_additional_mass_properties(*expected, true);
            }
        }
        for (handle, collider) in self.world.colliders.iter() {
            let differs =
                |kept: &Collider| kept.friction().to_bits() != collider.friction().to_bits();
            if saved.colliders.get(handle).is_some_and(differs) {
                saved.colliders[handle].set_friction(collider.friction());
            }
        }
        self.world = saved;
        Ok(())
    }

    /// Adds poses and velocities of all objects to `digest`.
    pub fn digest(&self, digest: &mut Digest) {
        for i in 0..self.bodies.len() {
            let motion = self.motion(i);
            digest.reals(motion.pose.translation.vector.as_slice());
            digest.reals(motion.pose.rotation.coords.as_slice());
            digest.vectors(&[motion.twist.linear, motion.twist.angular]);
        }
    }
}

/// Initial pose of an object, with its center of mass as origin.
pub fn center_pose(object: &Object, bulk: &Bulk) -> Pose {
    let mut pose = object.pose;
    pose.translation.vector += object.pose.rotation * bulk.center_of_mass;
    pose
}

/// The shape for contacts with the table, about the center of mass.
fn collider(surface: &Surface) -> ColliderBuilder {
    // The axis of a cylinder is y in rapier, z here.
    let upright = Pose::rotation(Vec3::x() * std::f64::consts::FRAC_PI_2);
    match surface {
        Surface::Sphere { radius } => ColliderBuilder::ball(*radius),
        Surface::Cuboid { half } => ColliderBuilder::cuboid(half.x, half.y, half.z),
        Surface::Cylinder { radius, half_height } => {
            ColliderBuilder::cylinder(*half_height, *radius).position(upright.into())
        }
        Surface::Capsule { radius, half_length } => {
            ColliderBuilder::capsule_z(*half_length, *radius)
        }
        Surface::Polyhedron(solid) => {
            let vertices: Vec<Vector> = solid.vertices().map(|v| vector(&v)).collect();
            let triangles = solid.triangles().to_vec();
            ColliderBuilder::trimesh_with_flags(vertices, triangles, TriMeshFlags::ORIENTED)
                .expect("a polyhedron is closed and oriented")
        }
    }
}

fn vector(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}
