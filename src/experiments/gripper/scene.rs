//! The scene of the gripper experiment, key by key: the gripper itself, the protocol of a grip,
//! speedups of the protocol, and what is varied.

use crate::{
    base::{Real, Vec3},
    scene::{
        Chamber, Grains, Material, Membrane, Scene, Shape, Table, Time,
        keys::{Flag, Inline, Map, QuantityOr, Text, scene_keys},
        quantity::{ACCELERATION, LENGTH, PRESSURE, SPEED, TIME},
        text::Keys,
        unset,
        visit::{Quantity, Range},
    },
};

/// A length of a plausible magnitude, so that a wrong unit is detected.
const SOME_LENGTH: Quantity = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 10.0) };
const SOME_SPEED: Quantity = Quantity::above_zero(&SPEED);
const ANY_TIME: Quantity = Quantity::at_least_zero(&TIME);
const SOME_MODULUS: Quantity = Quantity::above_zero(&PRESSURE);
const VACUUM: Quantity = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };

scene_keys! {
    /// The whole scene.
    pub(super) struct GripperScene {
        /// Gripper and object.
        gripper: Gripper = Inline,
        /// What is done in a grip.
        protocol: Protocol = Map,
        /// What is done faster than in the source.
        accelerations: Accelerations = Map,
        /// What is varied.
        sweep: Sweep = Map,
    }

    /// Gripper and object: a scene without table, motion limits and outputs, which nothing uses
    /// here.
    pub(super) struct Gripper {
        /// Name of the scene.
        name: String = Text,
        /// Seed of the first filling.
        seed: u64 = 0..=u64::MAX,
        /// Gravity (m/s²).
        gravity: Vec3 = Quantity::any(&ACCELERATION),
        /// Ticks and substeps.
        time: Time = Map,
        /// The grains.
        grains: Grains = Map,
        /// The membrane.
        membrane: Membrane = Map,
        /// The air and its pump.
        chamber: Chamber = Map,
        /// The object that is gripped, a sphere.
        object: Object = Map,
    }

    /// The object that is gripped, a sphere.
    pub(super) struct Object {
        /// Radius (m).
        radius: Real = SOME_LENGTH,
        /// Its material.
        material: Material = Inline,
        /// Coulomb friction with the membrane.
        friction: Real = Range::AtLeast(0.0),
    }

    /// What is done in a grip.
    pub(super) struct Protocol {
        /// Gap between the object and the settled membrane at the start (m).
        clearance: Real = SOME_LENGTH,
        /// Speed of the object while it is inserted (m/s).
        insert_speed: Real = SOME_SPEED,
        /// How far the object's top goes beyond the lowest point of the settled membrane (m).
        penetration: Real = SOME_LENGTH,
        /// Time to relax with the object inside (s).
        relax_time: Real = ANY_TIME,
        /// Gauge pressure of the grip (Pa).
        pressure: Real = VACUUM,
        /// Number of steps in which it is reached.
        n_pressure_steps ("pressure_steps"): usize = 1..=1000,
        /// Duration of a step (s).
        step_time: Real = ANY_TIME,
        /// Time at full vacuum before the object is withdrawn (s).
        hold_time: Real = ANY_TIME,
        /// Speed of the object while it is withdrawn (m/s).
        withdraw_speed: Real = SOME_SPEED,
        /// Time in which the object reaches its speed, and in which it stops (s).
        ramp_time: Real = Quantity::above_zero(&TIME),
    }

    /// What is done faster than in the source.
    pub(super) struct Accelerations {
        /// Factor on the speed of insertion.
        insert_speed_factor: Real = Range::Above(0.0),
        /// Factor on the speed of withdrawal.
        withdraw_speed_factor: Real = Range::Above(0.0),
        /// Share of the largest force at which a grip ends; with 0 it ends when the object is free.
        withdraw_until: Real = Range::Between(0.0, 0.95),
        /// Modulus with which stiffer grains are filled in, before they stiffen at rest (Pa).
        filling_modulus: Option<Real> = QuantityOr("own", SOME_MODULUS),
        /// True varies friction, damping and speed from the relaxed state on, not from the settled
        /// one.
        is_varied_relaxed ("vary_relaxed"): bool = Flag,
    }

    /// What is varied, one parameter at a time; the values of the other sections are the reference.
    pub(super) struct Sweep {
        /// Fillings of each modulus; their seeds count up from the scene's.
        n_fillings ("fillings"): usize = 1..=1000,
        /// Moduli of the grains (Pa).
        moduli: Vec<Real> = SOME_MODULUS,
        /// Gauge pressures of the grip (Pa).
        pressures: Vec<Real> = VACUUM,
        /// Coulomb frictions of the object.
        frictions: Vec<Real> = Range::AtLeast(0.0),
        /// Radii of the object (m).
        radii: Vec<Real> = SOME_LENGTH,
        /// Numbers of grains.
        counts: Vec<Real> = Range::Between(1.0, 200_000.0),
        /// Damping ratios of the membrane's springs.
        spring_dampings: Vec<Real> = Range::AtLeast(0.0),
        /// Factors on both speeds of the object.
        slowdowns: Vec<Real> = Range::AboveUpTo(0.0, 1.0),
    }
}

impl Gripper {
    /// As a scene, with the object far below the membrane, where nothing touches it.
    pub(super) fn scene(&self) -> Scene {
        let mut scene = unset::scene();
        scene.name.clone_from(&self.name);
        (scene.seed, scene.gravity, scene.time) = (self.seed, self.gravity, self.time);
        (scene.grains, scene.membrane) = (self.grains, self.membrane);
        scene.chamber = self.chamber;
        let below = 10.0 * (self.membrane.radius + self.object.radius);
        scene.table = Table { height: -2.0 * below, friction: 0.0 };
        let object = &mut scene.objects[0];
        "object".clone_into(&mut object.name);
        object.shape = Shape::Sphere { radius: self.object.radius };
        (object.material, object.friction) = (self.object.material, self.object.friction);
        object.pose.translation.vector = Vec3::new(0.0, 0.0, -below);
        object.drive_timeout = 1.0;
        scene
    }
}

impl Keys for GripperScene {
    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let gripper = &self.gripper;
        let membrane = gripper.membrane.radius;
        if gripper.grains.radius_max < gripper.grains.radius_min {
            let reason = "is above grains.radius_max".to_owned();
            unfit.push(("grains.radius_min", reason, "swap them or write equal values"));
        }
        if membrane <= self.protocol.penetration {
            let reason = "is deeper than the membrane".to_owned();
            unfit.push(("protocol.penetration", reason, "stay below membrane.radius"));
        }
        let largest = self.sweep.radii.iter().copied().fold(gripper.object.radius, Real::max);
        if membrane <= largest {
            let reason = "has an object larger than the membrane".to_owned();
            unfit.push(("object.radius", reason, "stay below membrane.radius"));
        }
        let pump = gripper.chamber.gauge_min;
        let lowest = self.sweep.pressures.iter().copied().fold(self.protocol.pressure, Real::min);
        if lowest < pump {
            let reason = "is beyond the pump's chamber.gauge_min".to_owned();
            unfit.push(("protocol.pressure", reason, "use a weaker vacuum here and in sweep"));
        }
        unfit
    }
}
