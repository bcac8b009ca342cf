//! Rules that involve several keys of a scene. All errors are reported, not only the first.
//!
//! Values that could not be read are NaN here. Every comparison is written so that NaN causes no
//! further error.

use super::{
    Controller, Object, PickAndLift, Scene, Shape,
    error::{Diagnostic, DiagnosticKind},
    extent,
    quantity::{Dimension, FREQUENCY, LENGTH, PRESSURE, SPEED, TIME},
    text::DEFAULTS_FILE,
    tree::{Location, Node},
};
use crate::base::{Pose, Real};

/// Initial penetration that round-off in a scene file may cause (m).
const PENETRATION_TOLERANCE: Real = 1e-6;
/// Solid fraction of the loosest packing that poured grains form.
const SOLID_FRACTION_LOOSE: Real = 0.55;

/// All errors of a scene that was read from `tree`.
pub(super) fn diagnostics(scene: &Scene, tree: &Node) -> Vec<Diagnostic> {
    let mut check = Check { tree, diagnostics: Vec::new() };
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
    check.diagnostics
}

struct Check<'a> {
    tree: &'a Node,
    diagnostics: Vec<Diagnostic>,
}

/// A key, its value, and the key that limits it.
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
    fn location(&self, key: &str) -> Location {
        self.tree.at(key).unwrap_or(self.tree).location.clone()
    }

    /// Reports two keys that conflict, at the one that is not a default.
    fn conflict(&mut self, pair: &Pair) {
        let print = |value| pair.dimension.print(value);
        let is_default = |key: &str| self.location(key).source.as_ref() == DEFAULTS_FILE;
        let is_limit_to_blame = is_default(pair.key) && !is_default(pair.limit_key);
        self.diagnostics.push(Diagnostic {
            location: self.location(if is_limit_to_blame { pair.limit_key } else { pair.key }),
            key: pair.key.to_owned(),
            kind: DiagnosticKind::Conflict {
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

    fn invalid(&mut self, key: &str, value: String, reason: String, remedy: &'static str) {
        let kind = DiagnosticKind::Invalid { value, reason, remedy };
        self.diagnostics.push(Diagnostic {
            location: self.location(key),
            key: key.to_owned(),
            kind,
        });
    }

    fn names(&mut self, scene: &Scene) {
        let is_file_name = |it: char| it.is_ascii_alphanumeric() || "_-".contains(it);
        let name = &scene.name;
        let is_written = |key: &str| self.tree.at(key).is_some();
        if is_written("name") && (name.is_empty() || name.contains(|it| !is_file_name(it))) {
            let reason = "is not a valid file name".to_owned();
            self.invalid("name", name.clone(), reason, "use letters, digits, _ and -");
        }
        for object in &scene.objects {
            if !is_ros_name(&object.name) {
                self.invalid(
                    "object.name",
                    object.name.clone(),
                    "is not a valid name for ROS 2 topics and frames".to_owned(),
                    "start with a letter, use letters, digits and single _, and none of the \
                     reserved names world, gripper_flange, membrane",
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
                relation: "faster than once per tick, which is",
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
            relation: "above a quarter of the membrane's radius,",
            limit_key: "membrane.radius",
            limit: membrane.radius / 4.0,
            dimension: &LENGTH,
            remedy: "use smaller grains or a larger membrane",
        });
        if membrane.frequency % 2 == 1 {
            let value = membrane.frequency.to_string();
            let reason = "is odd, but only an even icosphere can be cut at its equator";
            self.invalid("membrane.frequency", value, reason.to_owned(), "for example, write 16");
        }
        let third = |r: Real| r * r * r * std::f64::consts::PI / 3.0;
        let radius_mean = f64::midpoint(grains.radius_min, grains.radius_max);
        let bowl = 2.0 * third(membrane.radius * membrane.fill_stretch);
        let most = SOLID_FRACTION_LOOSE * bowl / (4.0 * third(radius_mean));
        #[expect(clippy::cast_precision_loss, reason = "grain numbers are far below 2^53")]
        if most < grains.count as Real {
            let reason =
                format!("grains do not fit into the membrane, which holds about {most:.0}");
            let remedy = "use fewer or smaller grains, or a larger membrane";
            self.invalid("grains.count", grains.count.to_string(), reason, remedy);
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
            remedy: "raise it: absolute pressure cannot be negative",
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
                self.invalid(
                    key,
                    value,
                    reason,
                    "give at least 4 points that are not in one plane",
                );
            }
            _ => {}
        }
        self.overlaps_at_start(scene, object);
    }

    fn poses(&mut self, poses: [(&'static str, &Pose); 2]) {
        for (key, pose) in poses {
            let length = pose.rotation.coords.norm();
            if 1e-9 < (length - 1.0).abs() {
                let reason = "is the length of the quaternion, which must be 1".to_owned();
                self.invalid(key, length.to_string(), reason, "normalize the quaternion");
            }
        }
    }

    /// The object must not start inside the table or inside the membrane.
    fn overlaps_at_start(&mut self, scene: &Scene, object: &Object) {
        let (low, high) = extent::heights(&object.shape, &object.pose);
        if low + PENETRATION_TOLERANCE < scene.table.height {
            self.conflict(&Pair {
                key: "object.position",
                value: to_micrometers(low),
                relation: "the height of its lowest point, below the table top at",
                limit_key: "table.height",
                limit: scene.table.height,
                dimension: &LENGTH,
                remedy: "raise the object",
            });
        }
        let reach = scene.membrane.radius * scene.membrane.fill_stretch;
        let flange = scene.flange.pose.translation.vector;
        let offset = flange - object.pose.translation.vector;
        let is_under = offset.x.hypot(offset.y) < reach + extent::radius_across(&object.shape);
        let is_upright = scene.flange.pose.rotation.angle() < 1e-3;
        if is_under && is_upright {
            self.below(Pair {
                key: "flange.position",
                value: flange.z,
                relation: "too low: the membrane would start inside the object; the minimum is",
                limit_key: "object.position",
                limit: to_micrometers(high + reach),
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
                remedy: "lower it or raise flange.speed_max",
            });
        }
        self.below(Pair {
            key: "pick_and_lift.grip_pressure",
            value: it.grip_pressure,
            relation: "below the minimum of the pump,",
            limit_key: "chamber.gauge_min",
            limit: scene.chamber.gauge_min,
            dimension: &PRESSURE,
            remedy: "use a weaker vacuum",
        });
        self.above(Pair {
            key: "pick_and_lift.vent_pressure",
            value: it.vent_pressure,
            relation: "above the maximum of the pump,",
            limit_key: "chamber.gauge_max",
            limit: scene.chamber.gauge_max,
            dimension: &PRESSURE,
            remedy: "reduce the overpressure",
        });
        self.above(Pair {
            key: "pick_and_lift.push_depth",
            value: it.push_depth,
            relation: "deeper than the membrane,",
            limit_key: "membrane.radius",
            limit: scene.membrane.radius,
            dimension: &LENGTH,
            remedy: "reduce the depth",
        });
    }
}

/// Rounds a height (m) for messages.
fn to_micrometers(length: Real) -> Real {
    (length * 1e6).round() / 1e6
}

/// True if `name` is valid in a topic name and as the name of a frame.
fn is_ros_name(name: &str) -> bool {
    let is_letter = |it: char| it.is_ascii_alphanumeric() || it == '_';
    name.starts_with(|it: char| it.is_ascii_alphabetic())
        && name.chars().all(is_letter)
        && !name.contains("__")
        && !name.ends_with('_')
        && !["world", "gripper_flange", "membrane"].contains(&name)
}
