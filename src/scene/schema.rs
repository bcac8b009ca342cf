//! The keys of a scene file. Two lines per key: its description, and its unit with its limits.
//!
//! Defaults are in `launch_configs/defaults.yaml`, rules that involve several keys in `check`.
//! `reference` turns this file into `docs/scene_keys.md` and `launch_configs/scene.schema.json`.

use super::{
    Chamber, Controller, Flange, Grains, Lockstep, Material, Membrane, Object, OnTimeout,
    PickAndLift, Scene, Shape, Table, Time,
    quantity::{
        ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, DENSITY, FORCE, IMPULSE, LENGTH,
        PRESSURE, PRESSURE_RATE, SPEED, TIME, TORQUE,
    },
    schema_outputs,
    visit::{Quantity, Range, Visitor},
};
use crate::base::{Pose, Quat, Real, Vec3};

/// Largest length; a larger one is a wrong unit (m).
const LENGTH_MAX: Real = 10.0;
/// Largest density scaling; beyond it no grip is quasi-static.
const DENSITY_SCALING_MAX: Real = 1000.0;

/// Visits all keys of a scene.
pub(crate) fn scene(walk: &mut impl Visitor, scene: &mut Scene) {
    walk.doc("Name of the scene; part of the name of its recordings.");
    walk.text("name", &mut scene.name);
    walk.doc("Seed of all random numbers. The same scene, seed and commands give the same bits.");
    walk.integer("seed", 0, u64::MAX, &mut scene.seed);
    walk.doc("Gravitational acceleration, in the world frame.");
    walk.vector("gravity", Quantity::any(&ACCELERATION), &mut scene.gravity);
    walk.doc("Time stepping.");
    walk.section("time", |walk| time(walk, &mut scene.time));
    walk.doc("The granular material.");
    walk.section("grains", |walk| grains(walk, &mut scene.grains));
    walk.doc("The membrane: the lower half of an icosphere, clamped to the flange at its rim.");
    walk.section("membrane", |walk| membrane(walk, &mut scene.membrane));
    walk.doc("The air inside the membrane, and the pump.");
    walk.section("chamber", |walk| chamber(walk, &mut scene.chamber));
    walk.doc(
        "The rigid plate from which the membrane hangs. The origin of its frame `gripper_flange` lies in \
         the plane of the rim.",
    );
    walk.section("flange", |walk| flange(walk, &mut scene.flange));
    walk.doc("A horizontal table under the object.");
    walk.section("table", |walk| table(walk, &mut scene.table));
    walk.doc("The rigid object to grip.");
    walk.section("object", |walk| object(walk, &mut scene.objects[0]));
    controller(walk, &mut scene.controller, &scene.objects[0].name);
    walk.doc("What is published and recorded. Rates are in simulated time.");
    walk.section("outputs", |walk| schema_outputs::outputs(walk, &mut scene.outputs));
}

pub(crate) fn time(walk: &mut impl Visitor, time: &mut Time) {
    #[expect(clippy::cast_precision_loss, reason = "a tick is far below 2^53 ns")]
    let mut tick = time.tick_ns as Real / 1e9;
    walk.doc("Length of a tick: commands are applied, and `/clock` is published, once per tick.");
    walk.quantity("tick", Quantity::between(&TIME, 1e-5, 0.02), &mut tick);
    #[expect(clippy::cast_possible_truncation, reason = "the range keeps it below 2e7 ns")]
    #[expect(clippy::cast_sign_loss, reason = "the range keeps it positive")]
    {
        time.tick_ns = (tick * 1e9).round() as u64;
    }
    walk.doc("Integration step. A step longer than the critical one is rejected.");
    walk.quantity_or("substep", "derived", Quantity::above_zero(&TIME), &mut time.substep);
    walk.doc("Fraction of the critical step that a derived substep takes.");
    walk.number("safety", Range::AboveUpTo(0.0, 1.0), &mut time.safety);
    walk.doc(
        "Factor on the inertia of grains and membrane, but not on their weight. The substep grows \
         with its square root.",
    );
    walk.number(
        "density_scaling",
        Range::Between(1.0, DENSITY_SCALING_MAX),
        &mut time.density_scaling,
    );
}

pub(crate) fn material(walk: &mut impl Visitor, material: &mut Material) {
    walk.doc("Young's modulus.");
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut material.youngs_modulus);
    walk.doc("Poisson's ratio.");
    walk.number("poisson_ratio", Range::Between(0.0, 0.5), &mut material.poisson_ratio);
    walk.doc("Mass density.");
    walk.quantity("density", Quantity::above_zero(&DENSITY), &mut material.density);
}

pub(crate) fn grains(walk: &mut impl Visitor, grains: &mut Grains) {
    walk.doc("Number of grains.");
    integer_usize(walk, "count", (1, 200_000), &mut grains.count);
    let radius = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.doc("Smallest radius; radii are uniformly distributed.");
    walk.quantity("radius_min", radius, &mut grains.radius_min);
    walk.doc("Largest radius.");
    walk.quantity("radius_max", radius, &mut grains.radius_max);
    material(walk, &mut grains.material);
    walk.doc(
        "Coulomb friction coefficient between grains, and of grains with the plate of the flange.",
    );
    walk.number("friction", Range::AtLeast(0.0), &mut grains.friction);
    walk.doc(
        "Dissipation time A of the viscoelastic normal force. It sets the coefficient of \
         restitution.",
    );
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut grains.dissipation_time);
    walk.doc("Damping ratio γ_t of the tangential spring.");
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut grains.tangential_damping);
}

pub(crate) fn membrane(walk: &mut impl Visitor, membrane: &mut Membrane) {
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.doc("Radius of the hemisphere.");
    walk.quantity("radius", length, &mut membrane.radius);
    walk.doc("Subdivision frequency of the icosphere; must be even. 16 gives 1321 vertices.");
    integer_usize(walk, "frequency", (2, 64), &mut membrane.frequency);
    walk.doc("Thickness.");
    walk.quantity("thickness", length, &mut membrane.thickness);
    material(walk, &mut membrane.material);
    walk.doc("Coulomb friction coefficient with grains.");
    walk.number("friction", Range::AtLeast(0.0), &mut membrane.friction);
    walk.doc("Damping ratio γ_sp of the springs.");
    walk.number("spring_damping", Range::AtLeast(0.0), &mut membrane.spring_damping);
    let stiffness = Quantity::at_least_zero(&TORQUE);
    walk.doc("Elastic bending constant k_el of the hinges.");
    walk.quantity("bending_stiffness", stiffness, &mut membrane.bending_stiffness);
    let damping = Quantity::at_least_zero(&IMPULSE);
    walk.doc("Viscous bending constant k_diss of the hinges.");
    walk.quantity("bending_damping", damping, &mut membrane.bending_damping);
    walk.doc("Fraction by which the rest lengths of the springs shrink after filling.");
    walk.number("rest_length_shrink", Range::Between(0.0, 0.5), &mut membrane.rest_length_shrink);
    walk.doc("Radius at which the membrane is held while it is filled, relative to `radius`.");
    walk.number("fill_stretch", Range::Between(1.0, 2.0), &mut membrane.fill_stretch);
    let dissipation = Quantity::at_least_zero(&TIME);
    walk.doc("Dissipation time A of contacts with the membrane.");
    walk.quantity("dissipation_time", dissipation, &mut membrane.dissipation_time);
    walk.doc("Damping ratio γ_t of the tangential spring in contacts with the membrane.");
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut membrane.tangential_damping);
}

pub(crate) fn chamber(walk: &mut impl Visitor, chamber: &mut Chamber) {
    walk.doc("Ambient pressure, absolute.");
    walk.quantity("ambient", Quantity::above_zero(&PRESSURE), &mut chamber.ambient);
    let vacuum = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };
    walk.doc("Strongest vacuum of the pump (gauge pressure).");
    walk.quantity("gauge_min", vacuum, &mut chamber.gauge_min);
    walk.doc("Strongest overpressure of the pump (gauge pressure).");
    walk.quantity("gauge_max", Quantity::at_least_zero(&PRESSURE), &mut chamber.gauge_max);
    walk.doc("Time constant of the first-order lag between command and pressure.");
    walk.quantity("lag", Quantity::at_least_zero(&TIME), &mut chamber.lag);
    walk.doc("Largest rate of change of the pressure.");
    walk.quantity("rate_max", Quantity::above_zero(&PRESSURE_RATE), &mut chamber.rate_max);
}

pub(crate) fn flange(walk: &mut impl Visitor, flange: &mut Flange) {
    pose(walk, &mut flange.pose);
    walk.doc("Largest linear speed.");
    walk.quantity("speed_max", Quantity::above_zero(&SPEED), &mut flange.speed_max);
    let acceleration = Quantity::above_zero(&ACCELERATION);
    walk.doc("Largest linear acceleration.");
    walk.quantity("acceleration_max", acceleration, &mut flange.acceleration_max);
    let angular_speed = Quantity::above_zero(&ANGULAR_SPEED);
    walk.doc("Largest angular speed.");
    walk.quantity("angular_speed_max", angular_speed, &mut flange.angular_speed_max);
    let angular_acceleration = Quantity::above_zero(&ANGULAR_ACCELERATION);
    walk.doc("Largest angular acceleration.");
    walk.quantity(
        "angular_acceleration_max",
        angular_acceleration,
        &mut flange.angular_acceleration_max,
    );
}

fn table(walk: &mut impl Visitor, table: &mut Table) {
    walk.doc("Height of the upper face.");
    walk.quantity("height", Quantity::any(&LENGTH), &mut table.height);
    walk.doc("Coulomb friction coefficient with the object.");
    walk.number("friction", Range::AtLeast(0.0), &mut table.friction);
}

pub(crate) fn object(walk: &mut impl Visitor, object: &mut Object) {
    walk.doc("Name; part of the names of its topics and of its frame.");
    walk.text("name", &mut object.name);
    shape(walk, &mut object.shape);
    material(walk, &mut object.material);
    walk.doc("Coulomb friction coefficient with the membrane.");
    walk.number("friction", Range::AtLeast(0.0), &mut object.friction);
    pose(walk, &mut object.pose);
    walk.doc(
        "Simulated time without pose commands after which a driven object moves freely again.",
    );
    walk.quantity("drive_timeout", Quantity::above_zero(&TIME), &mut object.drive_timeout);
}

/// Position and orientation. The orientation is given as roll, pitch, yaw about the fixed axes
/// x, y, z, or as a unit quaternion x, y, z, w.
pub(crate) fn pose(walk: &mut impl Visitor, pose: &mut Pose) {
    walk.doc("Position of the origin at the start, in the world frame.");
    walk.vector("position", Quantity::any(&LENGTH), &mut pose.translation.vector);
    let is_identity = pose.rotation == Quat::identity();
    let current = if is_identity { "roll_pitch_yaw" } else { "quaternion" };
    let known = ["roll_pitch_yaw", "quaternion"];
    walk.doc("Orientation at the start.");
    let Some(chosen) = walk.alternative("orientation", &known, current) else { return };
    walk.section("orientation", |walk| {
        if chosen == "roll_pitch_yaw" {
            let mut angles = Vec3::zeros();
            walk.doc("Rotations about the fixed axes x, y and z, in this order.");
            walk.vector("roll_pitch_yaw", Quantity::any(&ANGLE), &mut angles);
            pose.rotation = Quat::from_euler_angles(angles.x, angles.y, angles.z);
        } else {
            let q = pose.rotation.coords;
            let mut parts = [q.x, q.y, q.z, q.w];
            walk.doc("Unit quaternion x, y, z, w.");
            walk.numbers("quaternion", &mut parts);
            let [x, y, z, w] = parts;
            // Not normalized: `check` rejects a quaternion whose length is not 1.
            pose.rotation = Quat::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
        }
    });
}

const SHAPES: [&str; 6] = ["sphere", "box", "cylinder", "capsule", "convex_hull", "mesh"];

pub(crate) fn shape(walk: &mut impl Visitor, shape: &mut Shape) {
    walk.doc("Shape. The axis of a cylinder or capsule is z.");
    let Some(chosen) = walk.alternative("shape", &SHAPES, shape_name(shape)) else { return };
    if walk.is_reading() {
        *shape = unset_shape(chosen);
    }
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.section("shape", |walk| {
        walk.section(chosen, |walk| shape_keys(walk, length, shape));
    });
}

fn shape_keys(walk: &mut impl Visitor, length: Quantity, shape: &mut Shape) {
    match shape {
        Shape::Sphere { radius } => {
            walk.doc("Radius.");
            walk.quantity("radius", length, radius);
        }
        Shape::Box { size } => {
            walk.doc("Edge lengths along x, y and z.");
            walk.vector("size", length, size);
        }
        Shape::Cylinder { radius, height } | Shape::Capsule { radius, height } => {
            walk.doc("Radius.");
            walk.quantity("radius", length, radius);
            walk.doc("Total height.");
            walk.quantity("height", length, height);
        }
        Shape::ConvexHull { points } => {
            walk.doc("At least four points that are not in one plane; the shape is their hull.");
            walk.vectors("points", Quantity::any(&LENGTH), points);
        }
        Shape::Mesh { file, unit, .. } => {
            let mut text = file.to_string_lossy().into_owned();
            walk.doc("A closed STL or OBJ mesh. The path is relative to the scene file.");
            walk.text("file", &mut text);
            *file = text.into();
            walk.doc("Length of one unit of the file.");
            walk.quantity("unit", length, unit);
        }
    }
}

fn shape_name(shape: &Shape) -> &'static str {
    match shape {
        Shape::Sphere { .. } => "sphere",
        Shape::Box { .. } => "box",
        Shape::Cylinder { .. } => "cylinder",
        Shape::Capsule { .. } => "capsule",
        Shape::ConvexHull { .. } => "convex_hull",
        Shape::Mesh { .. } => "mesh",
    }
}

fn unset_shape(name: &str) -> Shape {
    let (radius, height) = (Real::NAN, Real::NAN);
    match name {
        "box" => Shape::Box { size: Vec3::repeat(Real::NAN) },
        "cylinder" => Shape::Cylinder { radius, height },
        "capsule" => Shape::Capsule { radius, height },
        "convex_hull" => Shape::ConvexHull { points: Vec::new() },
        "mesh" => {
            let (file, unit) = (std::path::PathBuf::new(), Real::NAN);
            Shape::Mesh { file, unit, vertices: Vec::new(), triangles: Vec::new() }
        }
        _ => Shape::Sphere { radius },
    }
}

fn controller(walk: &mut impl Visitor, controller: &mut Controller, object: &str) {
    let current = match controller {
        Controller::Builtin(_) => "builtin",
        Controller::Topics { .. } => "topics",
    };
    walk.doc("Source of commands: the built-in pick-and-lift controller, or ROS 2 topics.");
    let chosen = walk.choice("controller", &["builtin", "topics"], current);
    let (mut parameters, mut duration, mut in_step) = match controller {
        Controller::Builtin(parameters) => (parameters.clone(), None, Lockstep::OFF),
        Controller::Topics { duration, lockstep } => (unset_pick_and_lift(), *duration, *lockstep),
    };
    if walk.is_reading() || chosen == "builtin" {
        walk.doc("Parameters of the built-in controller. Used with `controller: builtin`.");
        walk.section("pick_and_lift", |walk| pick_and_lift(walk, &mut parameters));
        object.clone_into(&mut parameters.object);
    }
    if walk.is_reading() || chosen == "topics" {
        walk.doc("Control over ROS 2. Used with `controller: topics`.");
        walk.section("topics", |walk| {
            walk.doc("Simulated time after which the run ends.");
            walk.quantity_or("duration", "unlimited", Quantity::above_zero(&TIME), &mut duration);
            lockstep(walk, &mut in_step);
        });
    }
    *controller = match chosen {
        "topics" => Controller::Topics { duration, lockstep: in_step },
        _ => Controller::Builtin(parameters),
    };
}

fn lockstep(walk: &mut impl Visitor, it: &mut Lockstep) {
    let current = match (it.is_on, it.follows_clock) {
        (true, _) => "wait_command",
        (false, true) => "external_clock",
        (false, false) => "none",
    };
    let known = ["none", "wait_command", "external_clock"];
    walk.doc(
        "What advances time: nothing but the clock of the run (`none`), commands (`wait_command`), \
         or `/clock` of another simulator (`external_clock`).",
    );
    let chosen = walk.choice("lockstep", &known, current);
    (it.is_on, it.follows_clock) = (chosen == "wait_command", chosen == "external_clock");
    walk.doc("Ticks per command in lockstep.");
    walk.integer("steps_per_command", 1, 1_000_000, &mut it.steps_per_command);
    let wall = Quantity::above_zero(&TIME);
    walk.doc("Wall-clock time to wait for a command in lockstep.");
    walk.quantity_or("command_timeout", "unlimited", wall, &mut it.timeout);
    let current = match it.on_timeout {
        OnTimeout::Hold => "hold",
        OnTimeout::Pause => "pause",
        OnTimeout::End => "end",
    };
    walk.doc("What happens after `command_timeout`: keep waiting, pause, or end the run.");
    it.on_timeout = match walk.choice("on_timeout", &["hold", "pause", "end"], current) {
        "pause" => OnTimeout::Pause,
        "end" => OnTimeout::End,
        _ => OnTimeout::Hold,
    };
}

fn pick_and_lift(walk: &mut impl Visitor, it: &mut PickAndLift) {
    let speed = Quantity::above_zero(&SPEED);
    let force = Quantity::above_zero(&FORCE);
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    let pause = Quantity::at_least_zero(&TIME);
    walk.doc("Speed of the flange until it touches the object.");
    walk.quantity("approach_speed", speed, &mut it.approach_speed);
    walk.doc("Contact force that counts as touch.");
    walk.quantity("touch_force", force, &mut it.touch_force);
    walk.doc("Speed while it pushes onto the object.");
    walk.quantity("push_speed", speed, &mut it.push_speed);
    walk.doc("Distance to push after touch.");
    walk.quantity("push_depth", length, &mut it.push_depth);
    walk.doc("Force at which it stops pushing earlier.");
    walk.quantity("push_force_max", force, &mut it.push_force_max);
    walk.doc("Pause after pushing.");
    walk.quantity("settle_time", pause, &mut it.settle_time);
    let vacuum = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };
    walk.doc("Gauge pressure while it grips.");
    walk.quantity("grip_pressure", vacuum, &mut it.grip_pressure);
    walk.doc("Fraction of `grip_pressure` that must be reached before it lifts.");
    walk.number("grip_pressure_reached", Range::Between(0.0, 1.0), &mut it.grip_pressure_reached);
    walk.doc("Lifting speed.");
    walk.quantity("lift_speed", speed, &mut it.lift_speed);
    walk.doc("Lifting height.");
    walk.quantity("lift_height", length, &mut it.lift_height);
    walk.doc("Time to hold the object up.");
    walk.quantity("hold_time", pause, &mut it.hold_time);
    walk.doc("Gauge pressure to release the object.");
    walk.quantity("vent_pressure", Quantity::at_least_zero(&PRESSURE), &mut it.vent_pressure);
    walk.doc("Time to vent.");
    walk.quantity("vent_time", pause, &mut it.vent_time);
    walk.doc("Distance to retreat at the end.");
    walk.quantity("retreat_height", Quantity::at_least_zero(&LENGTH), &mut it.retreat_height);
}

/// An integer as `usize`.
pub(crate) fn integer_usize(
    walk: &mut impl Visitor,
    key: &'static str,
    (min, max): (u64, u64),
    value: &mut usize,
) {
    let mut wide = *value as u64;
    walk.integer(key, min, max, &mut wide);
    *value = usize::try_from(wide).unwrap_or(usize::MAX);
}

/// Pick-and-lift parameters before they are read.
fn unset_pick_and_lift() -> PickAndLift {
    let nan = Real::NAN;
    PickAndLift {
        object: String::new(),
        approach_speed: nan,
        touch_force: nan,
        push_speed: nan,
        push_depth: nan,
        push_force_max: nan,
        settle_time: nan,
        grip_pressure: nan,
        grip_pressure_reached: nan,
        lift_speed: nan,
        lift_height: nan,
        hold_time: nan,
        vent_pressure: nan,
        vent_time: nan,
        retreat_height: nan,
    }
}
