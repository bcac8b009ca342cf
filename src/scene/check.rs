//! Rules that join several keys of a scene. All faults are found, none stops the search.
//!
//! Values that could not be read are NaN here, and every comparison is written so that NaN
//! raises no second fault.

use super::{
    Controller, Object, PickAndLift, Scene, Shape,
    error::{Fault, Problem},
    extent,
    quantity::{Dimension, FREQUENCY, LENGTH, PRESSURE, SPEED, TIME},
    text::DEFAULTS_FILE,
    tree::{Node, Place},
};
use crate::base::{Pose, Real};

/// Penetration at the start that round-off in a scene file may cause (m).
const TOUCHING: Real = 1e-6;
/// Loosest packing that grains fall into by themselves.
const SOLID_FRACTION_LOOSE: Real = 0.55;

/// All faults of a scene that was read from `tree`.
pub(super) fn faults(scene: &Scene, tree: &Node) -> Vec<Fault> {
    let mut check = Check { tree, faults: Vec::new() };
    check.names(scene);
    check.times(scene);
    check.grains_and_membrane(scene);
    check.chamber(scene);
    for object in &scene.objects {
        check.object(scene, object);
    }
    if let Controller::Builtin(parameters) = &scene.controller {
        check.pick_and_lift(scene, parameters);
    }
    check.faults
}

struct Check<'a> {
    tree: &'a Node,
    faults: Vec<Fault>,
}

/// A key with its value, and the key that limits it.
struct Pair {
    key: &'static str,
    value: Real,
    relation: &'static str,
    limit_key: &'static str,
    limit: Real,
    dimension: &'static Dimension,
    remedy: &'static str,
}

impl Check<'_> {
    fn place(&self, key: &str) -> Place {
        self.tree.at(key).unwrap_or(self.tree).place.clone()
    }

    /// Of two keys that do not fit each other, the one that is not a default is at fault.
    fn conflict(&mut self, pair: &Pair) {
        let print = |value| pair.dimension.print(value);
        let is_default = |key: &str| self.place(key).source.as_ref() == DEFAULTS_FILE;
        let is_limit_at_fault = is_default(pair.key) && !is_default(pair.limit_key);
        self.faults.push(Fault {
            place: self.place(if is_limit_at_fault { pair.limit_key } else { pair.key }),
            key: pair.key.to_owned(),
            problem: Problem::Conflict {
                value: print(pair.value),
                relation: pair.relation,
                limit: print(pair.limit),
                limit_key: pair.limit_key,
                remedy: pair.remedy,
            },
        });
    }

    fn above(&mut self, pair: Pair) {
        if pair.limit < pair.value {
            self.conflict(&pair);
        }
    }

    fn below(&mut self, pair: Pair) {
        if pair.value < pair.limit {
            self.conflict(&pair);
        }
    }

    fn unfit(&mut self, key: &str, value: String, reason: String, remedy: &'static str) {
        let problem = Problem::Unfit { value, reason, remedy };
        self.faults.push(Fault { place: self.place(key), key: key.to_owned(), problem });
    }

    fn names(&mut self, scene: &Scene) {
        let is_file_name = |it: char| it.is_ascii_alphanumeric() || "_-".contains(it);
        let name = &scene.name;
        let is_written = |key: &str| self.tree.at(key).is_some();
        if is_written("name") && (name.is_empty() || name.contains(|it| !is_file_name(it))) {
            let reason = "is no name for files".to_owned();
            self.unfit("name", name.clone(), reason, "use letters, digits, _ and -");
        }
        for object in &scene.objects {
            if !is_ros_name(&object.name) {
                self.unfit(
                    "object.name",
                    object.name.clone(),
                    "is no name for ROS 2 topics and frames".to_owned(),
                    "begin with a letter, then letters, digits and single _, and not one of \
                     world, gripper_flange, membrane",
                );
            }
        }
    }

    fn times(&mut self, scene: &Scene) {
        #[expect(clippy::cast_precision_loss, reason = "a tick is far below 2^53 ns")]
        let tick = scene.time.tick_ns as Real / 1e9;
        if tick <= 0.0 {
            return;
        }
        self.above(Pair {
            key: "time.substep",
            value: scene.time.substep.unwrap_or(0.0),
            relation: "longer than",
            limit_key: "time.tick",
            limit: tick,
            dimension: &TIME,
            remedy: "shorten it, or write `derived`",
        });
        let outputs = &scene.outputs;
        let rates = [
            ("outputs.state_rate", outputs.state_rate),
            ("outputs.pressure_rate", outputs.pressure_rate),
            ("outputs.membrane_rate", outputs.membrane_rate),
            ("outputs.grains_rate", outputs.grains_rate),
            ("outputs.contacts_rate", outputs.contacts_rate),
            ("outputs.statistics_rate", outputs.statistics_rate),
        ];
        for (key, value) in rates {
            self.above(Pair {
                key,
                value,
                relation: "faster than once in a tick, that is",
                limit_key: "time.tick",
                limit: 1.0 / tick,
                dimension: &FREQUENCY,
                remedy: "lower the rate or shorten the tick",
            });
        }
    }

    fn grains_and_membrane(&mut self, scene: &Scene) {
        let (grains, membrane) = (&scene.grains, &scene.membrane);
        self.above(Pair {
            key: "grains.radius_min",
            value: grains.radius_min,
            relation: "above",
            limit_key: "grains.radius_max",
            limit: grains.radius_max,
            dimension: &LENGTH,
            remedy: "swap them or write equal values",
        });
        self.above(Pair {
            key: "grains.radius_max",
            value: grains.radius_max,
            relation: "above a quarter of the bag's radius,",
            limit_key: "membrane.radius",
            limit: membrane.radius / 4.0,
            dimension: &LENGTH,
            remedy: "use smaller grains or a larger bag",
        });
        if membrane.frequency % 2 == 1 {
            let value = membrane.frequency.to_string();
            let reason = "is odd, but only an even icosphere can be cut at its equator";
            self.unfit("membrane.frequency", value, reason.to_owned(), "write for example 16");
        }
        let third = |r: Real| r * r * r * std::f64::consts::PI / 3.0;
        let radius_mean = f64::midpoint(grains.radius_min, grains.radius_max);
        let bowl = 2.0 * third(membrane.radius * membrane.fill_stretch);
        let most = SOLID_FRACTION_LOOSE * bowl / (4.0 * third(radius_mean));
        #[expect(clippy::cast_precision_loss, reason = "grain numbers are far below 2^53")]
        if most < grains.count as Real {
            let reason = format!("grains do not fit into the bag, it holds about {most:.0}");
            let remedy = "use fewer or smaller grains, or a larger bag";
            self.unfit("grains.count", grains.count.to_string(), reason, remedy);
        }
    }

    fn chamber(&mut self, scene: &Scene) {
        let chamber = &scene.chamber;
        self.below(Pair {
            key: "chamber.gauge_min",
            value: chamber.gauge_min,
            relation: "below a perfect vacuum,",
            limit_key: "chamber.ambient",
            limit: -chamber.ambient,
            dimension: &PRESSURE,
            remedy: "raise it: an absolute pressure is never negative",
        });
    }

    fn object(&mut self, scene: &Scene, object: &Object) {
        self.poses([
            ("flange.orientation", &scene.flange.pose),
            ("object.orientation", &object.pose),
        ]);
        match &object.shape {
            Shape::Capsule { radius, height } => self.below(Pair {
                key: "object.shape.capsule.height",
                value: *height,
                relation: "below twice the radius,",
                limit_key: "object.shape.capsule.radius",
                limit: 2.0 * radius,
                dimension: &LENGTH,
                remedy: "a capsule's height includes its half spheres",
            }),
            Shape::ConvexHull { points } if points.len() < 4 => {
                let key = "object.shape.convex_hull.points";
                let value = format!("{} points", points.len());
                let reason = "do not span a volume".to_owned();
                self.unfit(key, value, reason, "give at least 4 points that are not in a plane");
            }
            _ => {}
        }
        self.room_at_start(scene, object);
    }

    fn poses(&mut self, poses: [(&'static str, &Pose); 2]) {
        for (key, pose) in poses {
            let length = pose.rotation.coords.norm();
            if 1e-9 < (length - 1.0).abs() {
                let value = format!("length {length}");
                let reason = "is not that of a rotation".to_owned();
                self.unfit(key, value, reason, "normalise the quaternion to length 1");
            }
        }
    }

    /// The object stands on the table, not in it, and not in the bag.
    fn room_at_start(&mut self, scene: &Scene, object: &Object) {
        let (low, high) = extent::heights(&object.shape, &object.pose);
        if low + TOUCHING < scene.table.height {
            self.conflict(&Pair {
                key: "object.position",
                value: to_micrometres(low),
                relation: "the height of its lowest point, inside the table, below",
                limit_key: "table.height",
                limit: scene.table.height,
                dimension: &LENGTH,
                remedy: "raise the object",
            });
        }
        let bag = scene.membrane.radius * scene.membrane.fill_stretch;
        let flange = scene.flange.pose.translation.vector;
        let offset = flange - object.pose.translation.vector;
        let is_under = offset.x.hypot(offset.y) < bag + extent::radius_across(&object.shape);
        let is_upright = scene.flange.pose.rotation.angle() < 1e-3;
        if is_under && is_upright {
            self.below(Pair {
                key: "flange.position",
                value: flange.z,
                relation: "too low: the hanging bag would start inside the object; the least is",
                limit_key: "object.position",
                limit: to_micrometres(high + bag),
                dimension: &LENGTH,
                remedy: "raise the flange",
            });
        }
    }

    fn pick_and_lift(&mut self, scene: &Scene, it: &PickAndLift) {
        let speeds = [
            ("pick_and_lift.approach_speed", it.approach_speed),
            ("pick_and_lift.push_speed", it.push_speed),
            ("pick_and_lift.lift_speed", it.lift_speed),
        ];
        for (key, value) in speeds {
            self.above(Pair {
                key,
                value,
                relation: "above",
                limit_key: "flange.speed_max",
                limit: scene.flange.speed_max,
                dimension: &SPEED,
                remedy: "move slower or allow the flange more",
            });
        }
        self.below(Pair {
            key: "pick_and_lift.grip_pressure",
            value: it.grip_pressure,
            relation: "beyond the pump,",
            limit_key: "chamber.gauge_min",
            limit: scene.chamber.gauge_min,
            dimension: &PRESSURE,
            remedy: "use a weaker vacuum",
        });
        self.above(Pair {
            key: "pick_and_lift.vent_pressure",
            value: it.vent_pressure,
            relation: "beyond the pump,",
            limit_key: "chamber.gauge_max",
            limit: scene.chamber.gauge_max,
            dimension: &PRESSURE,
            remedy: "use less overpressure",
        });
        self.above(Pair {
            key: "pick_and_lift.push_depth",
            value: it.push_depth,
            relation: "deeper than the bag,",
            limit_key: "membrane.radius",
            limit: scene.membrane.radius,
            dimension: &LENGTH,
            remedy: "push less deep",
        });
    }
}

/// Heights in messages need no more digits.
fn to_micrometres(length: Real) -> Real {
    (length * 1e6).round() / 1e6
}

/// True for names that may stand in a topic and as a frame of their own.
fn is_ros_name(name: &str) -> bool {
    let is_letter = |it: char| it.is_ascii_alphanumeric() || it == '_';
    name.starts_with(|it: char| it.is_ascii_alphabetic())
        && name.chars().all(is_letter)
        && !name.contains("__")
        && !name.ends_with('_')
        && !["world", "gripper_flange", "membrane"].contains(&name)
}
