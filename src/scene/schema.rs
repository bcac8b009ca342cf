//! The scene file, key by key: each line is one key with its unit and its limits.
//!
//! Defaults are not here but in `launch_configs/defaults.yaml`; rules that join several keys are
//! in `check`.

use super::{
    Bag, BagCompression, Chamber, Controller, Flange, Grains, Lockstep, Material, Membrane, Object,
    OnError, OnFull, OnTimeout, Outputs, PickAndLift, Ros, Scene, Shape, Table, Time,
    quantity::{
        ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, DENSITY, FORCE, FREQUENCY,
        IMPULSE, LENGTH, PRESSURE, PRESSURE_RATE, SPEED, TIME, TORQUE,
    },
    visit::{Quantity, Range, Visitor},
};
use crate::base::{Pose, Quat, Real, Vec3};

/// Numbers below which a box or a thickness is surely a slip of the unit (m).
const LENGTH_MAX: Real = 10.0;
/// Density scaling beyond which nothing is quasi-static any more.
const DENSITY_SCALING_MAX: Real = 1000.0;

/// Walks all keys of a scene.
pub(crate) fn scene(walk: &mut impl Visitor, scene: &mut Scene) {
    walk.text("name", &mut scene.name);
    walk.whole("seed", 0, u64::MAX, &mut scene.seed);
    walk.vector("gravity", Quantity::any(&ACCELERATION), &mut scene.gravity);
    walk.section("time", |walk| time(walk, &mut scene.time));
    walk.section("grains", |walk| grains(walk, &mut scene.grains));
    walk.section("membrane", |walk| membrane(walk, &mut scene.membrane));
    walk.section("chamber", |walk| chamber(walk, &mut scene.chamber));
    walk.section("flange", |walk| flange(walk, &mut scene.flange));
    walk.section("table", |walk| table(walk, &mut scene.table));
    walk.section("object", |walk| object(walk, &mut scene.objects[0]));
    controller(walk, &mut scene.controller, &scene.objects[0].name);
    walk.section("outputs", |walk| outputs(walk, &mut scene.outputs));
}

pub(crate) fn time(walk: &mut impl Visitor, time: &mut Time) {
    #[expect(clippy::cast_precision_loss, reason = "a tick is far below 2^53 ns")]
    let mut tick = time.tick_ns as Real / 1e9;
    walk.quantity("tick", Quantity::between(&TIME, 1e-5, 0.02), &mut tick);
    #[expect(clippy::cast_possible_truncation, reason = "the range keeps it below 2e7 ns")]
    #[expect(clippy::cast_sign_loss, reason = "the range keeps it positive")]
    {
        time.tick_ns = (tick * 1e9).round() as u64;
    }
    walk.quantity_or("substep", "derived", Quantity::above_zero(&TIME), &mut time.substep);
    walk.number("safety", Range::AboveUpTo(0.0, 1.0), &mut time.safety);
    walk.number(
        "density_scaling",
        Range::Between(1.0, DENSITY_SCALING_MAX),
        &mut time.density_scaling,
    );
}

pub(crate) fn material(walk: &mut impl Visitor, material: &mut Material) {
    walk.quantity("youngs_modulus", Quantity::above_zero(&PRESSURE), &mut material.youngs_modulus);
    walk.number("poisson_ratio", Range::Between(0.0, 0.5), &mut material.poisson_ratio);
    walk.quantity("density", Quantity::above_zero(&DENSITY), &mut material.density);
}

pub(crate) fn grains(walk: &mut impl Visitor, grains: &mut Grains) {
    whole_usize(walk, "count", (1, 200_000), &mut grains.count);
    let radius = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.quantity("radius_min", radius, &mut grains.radius_min);
    walk.quantity("radius_max", radius, &mut grains.radius_max);
    material(walk, &mut grains.material);
    walk.number("friction", Range::AtLeast(0.0), &mut grains.friction);
    walk.quantity("dissipation_time", Quantity::at_least_zero(&TIME), &mut grains.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut grains.tangential_damping);
}

pub(crate) fn membrane(walk: &mut impl Visitor, membrane: &mut Membrane) {
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.quantity("radius", length, &mut membrane.radius);
    whole_usize(walk, "frequency", (2, 64), &mut membrane.frequency);
    walk.quantity("thickness", length, &mut membrane.thickness);
    material(walk, &mut membrane.material);
    walk.number("friction", Range::AtLeast(0.0), &mut membrane.friction);
    walk.number("spring_damping", Range::AtLeast(0.0), &mut membrane.spring_damping);
    let stiffness = Quantity::at_least_zero(&TORQUE);
    walk.quantity("bending_stiffness", stiffness, &mut membrane.bending_stiffness);
    let damping = Quantity::at_least_zero(&IMPULSE);
    walk.quantity("bending_damping", damping, &mut membrane.bending_damping);
    walk.number("rest_length_shrink", Range::Between(0.0, 0.5), &mut membrane.rest_length_shrink);
    walk.number("fill_stretch", Range::Between(1.0, 2.0), &mut membrane.fill_stretch);
    let dissipation = Quantity::at_least_zero(&TIME);
    walk.quantity("dissipation_time", dissipation, &mut membrane.dissipation_time);
    walk.number("tangential_damping", Range::AtLeast(0.0), &mut membrane.tangential_damping);
}

pub(crate) fn chamber(walk: &mut impl Visitor, chamber: &mut Chamber) {
    walk.quantity("ambient", Quantity::above_zero(&PRESSURE), &mut chamber.ambient);
    let vacuum = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };
    walk.quantity("gauge_min", vacuum, &mut chamber.gauge_min);
    walk.quantity("gauge_max", Quantity::at_least_zero(&PRESSURE), &mut chamber.gauge_max);
    walk.quantity("lag", Quantity::at_least_zero(&TIME), &mut chamber.lag);
    walk.quantity("rate_max", Quantity::above_zero(&PRESSURE_RATE), &mut chamber.rate_max);
}

pub(crate) fn flange(walk: &mut impl Visitor, flange: &mut Flange) {
    pose(walk, &mut flange.pose);
    walk.quantity("speed_max", Quantity::above_zero(&SPEED), &mut flange.speed_max);
    let acceleration = Quantity::above_zero(&ACCELERATION);
    walk.quantity("acceleration_max", acceleration, &mut flange.acceleration_max);
    let angular_speed = Quantity::above_zero(&ANGULAR_SPEED);
    walk.quantity("angular_speed_max", angular_speed, &mut flange.angular_speed_max);
    let angular_acceleration = Quantity::above_zero(&ANGULAR_ACCELERATION);
    walk.quantity(
        "angular_acceleration_max",
        angular_acceleration,
        &mut flange.angular_acceleration_max,
    );
}

fn table(walk: &mut impl Visitor, table: &mut Table) {
    walk.quantity("height", Quantity::any(&LENGTH), &mut table.height);
    walk.number("friction", Range::AtLeast(0.0), &mut table.friction);
}

pub(crate) fn object(walk: &mut impl Visitor, object: &mut Object) {
    walk.text("name", &mut object.name);
    shape(walk, &mut object.shape);
    material(walk, &mut object.material);
    walk.number("friction", Range::AtLeast(0.0), &mut object.friction);
    pose(walk, &mut object.pose);
    walk.quantity("drive_timeout", Quantity::above_zero(&TIME), &mut object.drive_timeout);
}

/// Position and orientation. The orientation is written as roll, pitch, yaw about the fixed axes
/// x, y, z, or as a unit quaternion x, y, z, w.
pub(crate) fn pose(walk: &mut impl Visitor, pose: &mut Pose) {
    walk.vector("position", Quantity::any(&LENGTH), &mut pose.translation.vector);
    let is_identity = pose.rotation == Quat::identity();
    let current = if is_identity { "roll_pitch_yaw" } else { "quaternion" };
    let known = ["roll_pitch_yaw", "quaternion"];
    let Some(chosen) = walk.alternative("orientation", &known, current) else { return };
    walk.section("orientation", |walk| {
        if chosen == "roll_pitch_yaw" {
            let mut angles = Vec3::zeros();
            walk.vector("roll_pitch_yaw", Quantity::any(&ANGLE), &mut angles);
            pose.rotation = Quat::from_euler_angles(angles.x, angles.y, angles.z);
        } else {
            let q = pose.rotation.coords;
            let mut parts = [q.x, q.y, q.z, q.w];
            walk.numbers("quaternion", &mut parts);
            let [x, y, z, w] = parts;
            // Kept as written: `check` refuses one whose length is not 1.
            pose.rotation = Quat::new_unchecked(nalgebra::Quaternion::new(w, x, y, z));
        }
    });
}

const SHAPES: [&str; 6] = ["sphere", "box", "cylinder", "capsule", "convex_hull", "mesh"];

pub(crate) fn shape(walk: &mut impl Visitor, shape: &mut Shape) {
    let Some(chosen) = walk.alternative("shape", &SHAPES, shape_name(shape)) else { return };
    if walk.is_reading() {
        *shape = blank_shape(chosen);
    }
    let length = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, LENGTH_MAX) };
    walk.section("shape", |walk| {
        walk.section(chosen, |walk| shape_keys(walk, length, shape));
    });
}

fn shape_keys(walk: &mut impl Visitor, length: Quantity, shape: &mut Shape) {
    match shape {
        Shape::Sphere { radius } => walk.quantity("radius", length, radius),
        Shape::Box { size } => walk.vector("size", length, size),
        Shape::Cylinder { radius, height } | Shape::Capsule { radius, height } => {
            walk.quantity("radius", length, radius);
            walk.quantity("height", length, height);
        }
        Shape::ConvexHull { points } => walk.vectors("points", Quantity::any(&LENGTH), points),
        Shape::Mesh { file, unit, .. } => {
            let mut text = file.to_string_lossy().into_owned();
            walk.text("file", &mut text);
            *file = text.into();
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

fn blank_shape(name: &str) -> Shape {
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
    let chosen = walk.choice("controller", &["builtin", "topics"], current);
    let (mut parameters, mut duration, mut in_step) = match controller {
        Controller::Builtin(parameters) => (parameters.clone(), None, Lockstep::OFF),
        Controller::Topics { duration, lockstep } => (blank_pick_and_lift(), *duration, *lockstep),
    };
    if walk.is_reading() || chosen == "builtin" {
        walk.section("pick_and_lift", |walk| pick_and_lift(walk, &mut parameters));
        object.clone_into(&mut parameters.object);
    }
    if walk.is_reading() || chosen == "topics" {
        walk.section("topics", |walk| {
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
    let chosen = walk.choice("lockstep", &known, current);
    (it.is_on, it.follows_clock) = (chosen == "wait_command", chosen == "external_clock");
    walk.whole("steps_per_command", 1, 1_000_000, &mut it.steps_per_command);
    let wall = Quantity::above_zero(&TIME);
    walk.quantity_or("command_timeout", "unlimited", wall, &mut it.timeout);
    let current = match it.on_timeout {
        OnTimeout::Hold => "hold",
        OnTimeout::Pause => "pause",
        OnTimeout::End => "end",
    };
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
    walk.quantity("approach_speed", speed, &mut it.approach_speed);
    walk.quantity("touch_force", force, &mut it.touch_force);
    walk.quantity("push_speed", speed, &mut it.push_speed);
    walk.quantity("push_depth", length, &mut it.push_depth);
    walk.quantity("push_force_max", force, &mut it.push_force_max);
    walk.quantity("settle_time", pause, &mut it.settle_time);
    let vacuum = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };
    walk.quantity("grip_pressure", vacuum, &mut it.grip_pressure);
    walk.number("grip_pressure_reached", Range::Between(0.0, 1.0), &mut it.grip_pressure_reached);
    walk.quantity("lift_speed", speed, &mut it.lift_speed);
    walk.quantity("lift_height", length, &mut it.lift_height);
    walk.quantity("hold_time", pause, &mut it.hold_time);
    walk.quantity("vent_pressure", Quantity::at_least_zero(&PRESSURE), &mut it.vent_pressure);
    walk.quantity("vent_time", pause, &mut it.vent_time);
    walk.quantity("retreat_height", Quantity::at_least_zero(&LENGTH), &mut it.retreat_height);
}

fn outputs(walk: &mut impl Visitor, outputs: &mut Outputs) {
    let rate = Quantity::above_zero(&FREQUENCY);
    walk.quantity("state_rate", rate, &mut outputs.state_rate);
    walk.quantity("pressure_rate", rate, &mut outputs.pressure_rate);
    walk.quantity("membrane_rate", rate, &mut outputs.membrane_rate);
    walk.quantity("grains_rate", rate, &mut outputs.grains_rate);
    walk.quantity("contacts_rate", rate, &mut outputs.contacts_rate);
    walk.quantity("statistics_rate", rate, &mut outputs.statistics_rate);
    whole_usize(walk, "grains_count_max", (1, 1_000_000), &mut outputs.grains_count_max);
    walk.section("ros", |walk| ros(walk, &mut outputs.ros));
    walk.flag("stream", &mut outputs.stream);
    walk.section("bag", |walk| bag(walk, &mut outputs.bag));
    walk.flag("real_time", &mut outputs.real_time);
}

fn ros(walk: &mut impl Visitor, ros: &mut Ros) {
    walk.flag("enabled", &mut ros.enabled);
    let mut domain = ros.domain_id.map(u64::from);
    // DDS derives UDP ports from the domain; above 232 they do not fit.
    walk.whole_or("domain_id", "auto", 232, &mut domain);
    ros.domain_id = domain.and_then(|it| u16::try_from(it).ok());
    walk.flag("lan", &mut ros.lan);
    walk.text("node", &mut ros.node);
    let mut version = ros.interfaces_version.map(u64::from);
    walk.whole_or("interfaces_version", "auto", 2, &mut version);
    ros.interfaces_version = version.and_then(|it| u8::try_from(it).ok());
    walk.text_or("interfaces_prefix", "none", &mut ros.interfaces_prefix);
    walk.flag("monotonic_clock", &mut ros.monotonic_clock);
}

fn bag(walk: &mut impl Visitor, bag: &mut Bag) {
    walk.flag("enabled", &mut bag.enabled);
    let mut folder = bag.folder.as_ref().map(|it| it.to_string_lossy().into_owned());
    walk.text_or("folder", "auto", &mut folder);
    bag.folder = folder.map(Into::into);
    let on_full = match bag.on_full {
        OnFull::Wait => "wait",
        OnFull::DropOldest => "drop_oldest",
    };
    bag.on_full = match walk.choice("on_full", &["wait", "drop_oldest"], on_full) {
        "wait" => OnFull::Wait,
        _ => OnFull::DropOldest,
    };
    let on_error = match bag.on_error {
        OnError::Continue => "continue",
        OnError::Stop => "stop",
    };
    bag.on_error = match walk.choice("on_error", &["continue", "stop"], on_error) {
        "stop" => OnError::Stop,
        _ => OnError::Continue,
    };
    let rate = Quantity { dimension: &FREQUENCY, range: Range::AboveUpTo(0.0, 1e6) };
    walk.quantity_or("checkpoint_rate", "never", rate, &mut bag.checkpoint_rate);
    let compression = match bag.compression {
        BagCompression::Zstd => "zstd",
        BagCompression::Lz4 => "lz4",
        BagCompression::Uncompressed => "none",
    };
    bag.compression = match walk.choice("compression", &["zstd", "lz4", "none"], compression) {
        "lz4" => BagCompression::Lz4,
        "none" => BagCompression::Uncompressed,
        _ => BagCompression::Zstd,
    };
    walk.whole_or("split_mebibytes", "never", 1 << 30, &mut bag.split_size);
    let time = Quantity::above_zero(&TIME);
    walk.quantity_or("split_duration", "never", time, &mut bag.split_duration);
}

/// A whole number that counts things in memory.
pub(crate) fn whole_usize(
    walk: &mut impl Visitor,
    key: &'static str,
    (min, max): (u64, u64),
    value: &mut usize,
) {
    let mut wide = *value as u64;
    walk.whole(key, min, max, &mut wide);
    *value = usize::try_from(wide).unwrap_or(usize::MAX);
}

/// A pick-and-lift before it is read.
fn blank_pick_and_lift() -> PickAndLift {
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
