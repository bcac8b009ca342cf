//! The rigid world: objects on a table. The only file that knows rapier.
//!
//! Rapier's defaults are made for bodies of metres: contacts are not recycled here and the length
//! unit is that of the objects. Bodies never sleep, because a sleeping body would ignore the
//! membrane.

use nalgebra::Isometry3;
use rapier3d_f64::{
    parry::shape::TriMeshFlags,
    prelude::{
        CoefficientCombineRule, ColliderBuilder, MassProperties, PhysicsWorld, Pose as RapierPose,
        RigidBodyBuilder, RigidBodyHandle, RigidBodyType, Vector,
    },
};

use crate::{
    base::{
        Mat3, Pose, Real, Vec3,
        digest::Digest,
        real::{Twist, Wrench},
    },
    physics::boundary::body::BodyMotion,
    scene::{Scene, Shape},
};

/// Half the edge of the table's slab, and half its thickness [m].
const TABLE_HALF: [Real; 2] = [2.0, 0.1];
/// Length that rapier takes as typical of the bodies [m].
const LENGTH_UNIT: Real = 0.02;

/// Mass, centre of mass and inertia of an object.
#[derive(Clone, Copy, Debug)]
pub struct Inertia {
    /// Mass [kg].
    pub mass: Real,
    /// Centre of mass in the shape's frame [m].
    pub centre: Vec3,
    /// Inertia about the centre of mass, shape's axes [kg m²].
    pub tensor: Mat3,
}

/// Objects and table.
pub struct RapierWorld {
    world: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
    inertias: Vec<Inertia>,
}

impl RapierWorld {
    /// Puts the objects of `scene` into a fresh world; `inertias` are in their order.
    pub fn new(scene: &Scene, inertias: Vec<Inertia>, step: Real) -> Self {
        let mut world = PhysicsWorld { gravity: vector(&scene.gravity), ..Default::default() };
        let parameters = &mut world.integration_parameters;
        parameters.dt = step;
        parameters.contact_recycling = false;
        parameters.length_unit = LENGTH_UNIT;
        let [edge, thickness] = TABLE_HALF;
        let top = Vector::new(0.0, 0.0, scene.table.height - thickness);
        let slab = ColliderBuilder::cuboid(edge, edge, thickness)
            .friction(scene.table.friction)
            .friction_combine_rule(CoefficientCombineRule::Max);
        world.insert(RigidBodyBuilder::fixed().translation(top), slab);
        let bodies = scene
            .objects
            .iter()
            .zip(&inertias)
            .map(|(object, inertia)| {
                let mut pose = object.pose;
                pose.translation.vector += object.pose.rotation * inertia.centre;
                let properties =
                    MassProperties::with_inertia_matrix(Vector::ZERO, inertia.mass, matrix(inertia));
                let body = RigidBodyBuilder::dynamic()
                    .pose(RapierPose::from(pose))
                    .additional_mass_properties(properties)
                    .can_sleep(false);
                let collider = collider(&object.shape, inertia)
                    .density(0.0)
                    .friction(0.0)
                    .friction_combine_rule(CoefficientCombineRule::Max);
                world.insert(body, collider).0
            })
            .collect();
        Self { world, bodies, inertias }
    }

    /// How object `i` moves now.
    pub fn motion(&self, i: usize) -> BodyMotion {
        let body = &self.world.bodies[self.bodies[i]];
        let pose: Isometry3<Real> = (*body.position()).into();
        let twist = Twist { linear: body.linvel().into(), angular: body.angvel().into() };
        BodyMotion { pose, twist }
    }

    /// Mass of object `i` [kg].
    pub fn mass(&self, i: usize) -> Real {
        self.inertias[i].mass
    }

    /// Momentum [kg m/s] and angular momentum about the centre of mass [kg m²/s] of object `i`.
    pub fn momentum(&self, i: usize) -> (Vec3, Vec3) {
        let motion = self.motion(i);
        let axes = motion.pose.rotation.to_rotation_matrix();
        let tensor = axes * self.inertias[i].tensor * axes.transpose();
        (motion.twist.linear * self.inertias[i].mass, tensor * motion.twist.angular)
    }

    /// Drives object `i` with `twist`, or gives it back to dynamics with its present velocity.
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

    /// One step of the rigid world under the membrane's mean wrenches, about centres of mass.
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

    /// Adds poses and velocities of all objects.
    pub fn digest(&self, digest: &mut Digest) {
        for i in 0..self.bodies.len() {
            let motion = self.motion(i);
            digest.reals(motion.pose.translation.vector.as_slice());
            digest.reals(motion.pose.rotation.coords.as_slice());
            digest.vectors(&[motion.twist.linear, motion.twist.angular]);
        }
    }
}

/// The shape for contacts with the table, about the centre of mass.
fn collider(shape: &Shape, inertia: &Inertia) -> ColliderBuilder {
    let shift = |points: &[Vec3]| -> Vec<Vector> {
        points.iter().map(|point| vector(&(point - inertia.centre))).collect()
    };
    // Rapier's cylinders and capsules stand along y, ours along z.
    let upright = Pose::rotation(Vec3::x() * std::f64::consts::FRAC_PI_2);
    match shape {
        Shape::Sphere { radius } => ColliderBuilder::ball(*radius),
        Shape::Box { size } => ColliderBuilder::cuboid(size.x / 2.0, size.y / 2.0, size.z / 2.0),
        Shape::Cylinder { radius, height } => {
            ColliderBuilder::cylinder(height / 2.0, *radius).position(upright.into())
        }
        Shape::Capsule { radius, height } => {
            ColliderBuilder::capsule_z(height / 2.0 - radius, *radius)
        }
        Shape::ConvexHull { points } => ColliderBuilder::convex_hull(&shift(points))
            .expect("the scene's check has built this hull"),
        Shape::Mesh { vertices, triangles, .. } => ColliderBuilder::trimesh_with_flags(
            shift(vertices),
            triangles.clone(),
            TriMeshFlags::ORIENTED,
        )
        .expect("the scene's check has built this mesh"),
    }
}

fn vector(v: &Vec3) -> Vector {
    Vector::new(v.x, v.y, v.z)
}

fn matrix(inertia: &Inertia) -> rapier3d_f64::math::Matrix {
    let t = &inertia.tensor;
    rapier3d_f64::math::Matrix::from_cols(
        vector(&t.column(0).into_owned()),
        vector(&t.column(1).into_owned()),
        vector(&t.column(2).into_owned()),
    )
}
