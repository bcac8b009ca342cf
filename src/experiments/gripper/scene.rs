//! The gripper's scene: the gripper itself, the protocol of a grip, allowed accelerations, and what
//! is varied.

use crate::{
    base::{Real, Vec3},
    scene::{
        self, Scene, Shape,
        quantity::{LENGTH, PRESSURE, SPEED, TIME},
        schema,
        text::Keys,
        unset,
        visit::{Quantity, Range, Visitor},
    },
};

/// All that the scene says.
#[derive(Clone, Debug)]
pub(super) struct GripperScene {
    /// Gripper and object; without table, motion limits and outputs, which nobody reads here.
    pub(super) gripper: Scene,
    /// What is done in a grip.
    pub(super) protocol: Protocol,
    /// What is done faster than in the source.
    pub(super) accelerations: Accelerations,
    /// What is varied.
    pub(super) sweep: Sweep,
}

/// What is done in a grip.
#[derive(Clone, Debug)]
pub(super) struct Protocol {
    /// Gap between the object and the settled bag at the start (m).
    pub(super) clearance: Real,
    /// Speed of the object on its way in (m/s).
    pub(super) insert_speed: Real,
    /// How far its top goes beyond the lowest point of the settled bag (m).
    pub(super) penetration: Real,
    /// Time to relax with the object inside (s).
    pub(super) relax_time: Real,
    /// Gauge pressure of the grip (Pa).
    pub(super) pressure: Real,
    /// Number of steps in which it is reached.
    pub(super) n_pressure_steps: usize,
    /// Length of each of them (s).
    pub(super) step_time: Real,
    /// Time at full vacuum before the object is pulled (s).
    pub(super) hold_time: Real,
    /// Speed of the object on its way out (m/s).
    pub(super) withdraw_speed: Real,
    /// Time in which the object reaches a speed, and in which it stops (s).
    pub(super) ramp_time: Real,
}

/// What is done faster than in the source.
#[derive(Clone, Debug)]
pub(super) struct Accelerations {
    /// Speed of the way in over the protocol's.
    pub(super) insert_speed_factor: Real,
    /// Speed of the way out over the protocol's.
    pub(super) withdraw_speed_factor: Real,
    /// Share of the largest force at which a grip ends; at 0 it ends when the object is free.
    pub(super) withdraw_until: Real,
    /// Harder grains are filled in with this modulus and hardened in the closed bag (Pa).
    pub(super) filling_modulus: Option<Real>,
    /// True if friction, damping and slowness are varied from the relaxed state on, instead of
    /// from the settled bag.
    pub(super) is_varied_relaxed: bool,
}

/// What is varied, one at a time; the values of the other sections are the common reference.
#[derive(Clone, Debug)]
pub(super) struct Sweep {
    /// Fillings of each modulus; the seeds count on from the scene's.
    pub(super) n_fillings: usize,
    /// Moduli of the grains (Pa).
    pub(super) moduli: Vec<Real>,
    /// Gauge pressures of the grip (Pa).
    pub(super) pressures: Vec<Real>,
    /// Friction of the object.
    pub(super) frictions: Vec<Real>,
    /// Radii of the object (m).
    pub(super) radii: Vec<Real>,
    /// Numbers of grains.
    pub(super) counts: Vec<Real>,
    /// Damping ratios of the membrane's springs.
    pub(super) spring_dampings: Vec<Real>,
    /// Speeds of both ways over those of the other grips.
    pub(super) slowdowns: Vec<Real>,
}

impl GripperScene {
    /// A scene before it is read.
    pub(super) fn blank() -> Self {
        let nan = Real::NAN;
        let mut gripper = unset::scene();
        gripper.table = scene::Table { height: nan, friction: 0.0 };
        "object".clone_into(&mut gripper.objects[0].name);
        gripper.objects[0].shape = Shape::Sphere { radius: nan };
        gripper.objects[0].drive_timeout = 1.0;
        Self {
            gripper,
            protocol: Protocol {
                clearance: nan,
                insert_speed: nan,
                penetration: nan,
                relax_time: nan,
                pressure: nan,
                n_pressure_steps: 0,
                step_time: nan,
                hold_time: nan,
                withdraw_speed: nan,
                ramp_time: nan,
            },
            accelerations: Accelerations {
                insert_speed_factor: nan,
                withdraw_speed_factor: nan,
                withdraw_until: nan,
                filling_modulus: None,
                is_varied_relaxed: false,
            },
            sweep: Sweep {
                n_fillings: 0,
                moduli: Vec::new(),
                pressures: Vec::new(),
                frictions: Vec::new(),
                radii: Vec::new(),
                counts: Vec::new(),
                spring_dampings: Vec::new(),
                slowdowns: Vec::new(),
            },
        }
    }

    /// Radius of the object (m).
    pub(super) fn object_radius(&self) -> Real {
        match self.gripper.objects[0].shape {
            Shape::Sphere { radius } => radius,
            _ => Real::NAN,
        }
    }

    /// Makes the object a sphere of `radius` (m) far below the bag, where nothing touches it.
    pub(super) fn set_object_radius(&mut self, radius: Real) {
        let gripper = &mut self.gripper;
        gripper.objects[0].shape = Shape::Sphere { radius };
        let below = 10.0 * (gripper.membrane.radius + radius);
        gripper.objects[0].pose.translation.vector = Vec3::new(0.0, 0.0, -below);
        gripper.table.height = -2.0 * below;
    }
}

impl Keys for GripperScene {
    fn walk(&mut self, walk: &mut impl Visitor) {
        let gripper = &mut self.gripper;
        walk.text("name", &mut gripper.name);
        walk.whole("seed", 0, u64::MAX, &mut gripper.seed);
        walk.vector("gravity", Quantity::any(&scene::quantity::ACCELERATION), &mut gripper.gravity);
        walk.section("time", |walk| schema::time(walk, &mut gripper.time));
        walk.section("grains", |walk| schema::grains(walk, &mut gripper.grains));
        walk.section("membrane", |walk| schema::membrane(walk, &mut gripper.membrane));
        walk.section("chamber", |walk| schema::chamber(walk, &mut gripper.chamber));
        let mut radius = self.object_radius();
        let object = &mut self.gripper.objects[0];
        walk.section("object", |walk| {
            walk.quantity("radius", LENGTHS, &mut radius);
            schema::material(walk, &mut object.material);
            walk.number("friction", Range::AtLeast(0.0), &mut object.friction);
        });
        self.set_object_radius(radius);
        walk.section("protocol", |walk| protocol(walk, &mut self.protocol));
        walk.section("accelerations", |walk| accelerations(walk, &mut self.accelerations));
        walk.section("sweep", |walk| sweep(walk, &mut self.sweep));
    }

    fn unfit(&self) -> Vec<(&'static str, String, &'static str)> {
        let mut unfit = Vec::new();
        let gripper = &self.gripper;
        let bag = gripper.membrane.radius;
        if gripper.grains.radius_max < gripper.grains.radius_min {
            let reason = "is above grains.radius_max".to_owned();
            unfit.push(("grains.radius_min", reason, "swap them or write equal values"));
        }
        if bag <= self.protocol.penetration {
            let reason = "is deeper than the bag".to_owned();
            unfit.push(("protocol.penetration", reason, "stay below membrane.radius"));
        }
        let largest = self.sweep.radii.iter().copied().fold(self.object_radius(), Real::max);
        if bag <= largest {
            let reason = "has an object larger than the bag".to_owned();
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

const LENGTHS: Quantity = Quantity { dimension: &LENGTH, range: Range::AboveUpTo(0.0, 10.0) };
const VACUUM: Quantity = Quantity { dimension: &PRESSURE, range: Range::AtMost(0.0) };

fn protocol(walk: &mut impl Visitor, it: &mut Protocol) {
    let (speed, time) = (Quantity::above_zero(&SPEED), Quantity::at_least_zero(&TIME));
    walk.quantity("clearance", LENGTHS, &mut it.clearance);
    walk.quantity("insert_speed", speed, &mut it.insert_speed);
    walk.quantity("penetration", LENGTHS, &mut it.penetration);
    walk.quantity("relax_time", time, &mut it.relax_time);
    walk.quantity("pressure", VACUUM, &mut it.pressure);
    schema::whole_usize(walk, "pressure_steps", (1, 1000), &mut it.n_pressure_steps);
    walk.quantity("step_time", time, &mut it.step_time);
    walk.quantity("hold_time", time, &mut it.hold_time);
    walk.quantity("withdraw_speed", speed, &mut it.withdraw_speed);
    walk.quantity("ramp_time", Quantity::above_zero(&TIME), &mut it.ramp_time);
}

fn accelerations(walk: &mut impl Visitor, it: &mut Accelerations) {
    walk.number("insert_speed_factor", Range::Above(0.0), &mut it.insert_speed_factor);
    walk.number("withdraw_speed_factor", Range::Above(0.0), &mut it.withdraw_speed_factor);
    walk.number("withdraw_until", Range::Between(0.0, 0.95), &mut it.withdraw_until);
    let modulus = Quantity::above_zero(&PRESSURE);
    walk.quantity_or("filling_modulus", "own", modulus, &mut it.filling_modulus);
    walk.flag("vary_relaxed", &mut it.is_varied_relaxed);
}

fn sweep(walk: &mut impl Visitor, it: &mut Sweep) {
    schema::whole_usize(walk, "fillings", (1, 1000), &mut it.n_fillings);
    walk.quantities("moduli", Quantity::above_zero(&PRESSURE), &mut it.moduli);
    walk.quantities("pressures", VACUUM, &mut it.pressures);
    walk.plain_numbers("frictions", Range::AtLeast(0.0), &mut it.frictions);
    walk.quantities("radii", LENGTHS, &mut it.radii);
    walk.plain_numbers("counts", Range::Between(1.0, 200_000.0), &mut it.counts);
    walk.plain_numbers("spring_dampings", Range::AtLeast(0.0), &mut it.spring_dampings);
    walk.plain_numbers("slowdowns", Range::AboveUpTo(0.0, 1.0), &mut it.slowdowns);
}
