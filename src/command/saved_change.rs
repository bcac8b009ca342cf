//! Changes as bytes, so that a recorded run can be simulated again.
//!
//! All numbers keep their bits. Nothing is checked again.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::change::{Change, Scope, SettledScene, TunableParameter};
use crate::{
    base::{Pose, Real, Vec3, real::Twist},
    cosim::saved_state::{pose, pose_row},
    scene::{self, Controller, Material, Object, Scene, Shape},
};

/// The bytes are not a change supported by this version.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{n_bytes} bytes are not a change supported by this version")]
pub struct UnknownChange {
    n_bytes: usize,
}

/// The numbers of a change. New kinds go last, so that older recordings stay readable.
#[derive(Serialize, Deserialize)]
enum Saved {
    Reset { time: bool, state: bool, spawned: bool },
    PlaceObject { object: String, pose: [Real; 7], twist: [[Real; 3]; 2] },
    PlaceFlange { pose: [Real; 7] },
    Insert(SavedObject),
    Remove { object: String },
    ZeroForceSensor,
    SetParameter { parameter: TunableParameter, value: Real },
    LoadScene { text: String, objects: Vec<SavedObject>, start: Vec<u8>, keeps_time: bool },
}

#[derive(Serialize, Deserialize)]
struct SavedObject {
    name: String,
    shape: SavedShape,
    /// Young's modulus, Poisson's ratio, density.
    material: [Real; 3],
    friction: Real,
    pose: [Real; 7],
    drive_timeout: Real,
}

#[derive(Serialize, Deserialize)]
enum SavedShape {
    Sphere { radius: Real },
    Box { size: [Real; 3] },
    Cylinder { radius: Real, height: Real },
    Capsule { radius: Real, height: Real },
    ConvexHull { points: Vec<[Real; 3]> },
    Mesh { file: PathBuf, unit: Real, vertices: Vec<[Real; 3]>, triangles: Vec<[u32; 3]> },
}

impl Change {
    /// The bytes of this change.
    pub fn to_bytes(&self) -> Vec<u8> {
        let saved = match self {
            Self::Reset(Scope { time, state, spawned }) => {
                Saved::Reset { time: *time, state: *state, spawned: *spawned }
            }
            Self::PlaceObject { object, pose, twist } => Saved::PlaceObject {
                object: object.clone(),
                pose: pose_row(pose),
                twist: [twist.linear, twist.angular].map(Into::into),
            },
            Self::PlaceFlange { pose } => Saved::PlaceFlange { pose: pose_row(pose) },
            Self::Insert(object) => Saved::Insert(saved_object(object)),
            Self::Remove { object } => Saved::Remove { object: object.clone() },
            Self::ZeroForceSensor => Saved::ZeroForceSensor,
            Self::SetParameter { parameter, value } => {
                Saved::SetParameter { parameter: *parameter, value: *value }
            }
            Self::LoadScene(it) => Saved::LoadScene {
                text: scene::to_yaml(&without_files(&it.scene)),
                objects: it.scene.objects.iter().map(saved_object).collect(),
                start: it.start.clone(),
                keeps_time: it.keeps_time,
            },
        };
        postcard::to_stdvec(&saved).expect("numbers and names always serialize")
    }

    /// Reads the change in `bytes`, with the same bits.
    ///
    /// # Errors
    /// If the bytes are not a change.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, UnknownChange> {
        let unknown = || UnknownChange { n_bytes: bytes.len() };
        Ok(match postcard::from_bytes(bytes).map_err(|_| unknown())? {
            Saved::Reset { time, state, spawned } => Self::Reset(Scope { time, state, spawned }),
            Saved::PlaceObject { object, pose: row, twist } => {
                let [linear, angular] = twist.map(Vec3::from);
                Self::PlaceObject { object, pose: pose(&row), twist: Twist { linear, angular } }
            }
            Saved::PlaceFlange { pose: row } => Self::PlaceFlange { pose: pose(&row) },
            Saved::Insert(object) => Self::Insert(Box::new(read_object(object))),
            Saved::Remove { object } => Self::Remove { object },
            Saved::ZeroForceSensor => Self::ZeroForceSensor,
            Saved::SetParameter { parameter, value } => Self::SetParameter { parameter, value },
            Saved::LoadScene { text, objects, start, keeps_time } => {
                let scene = scene::parse(&text, "a loaded scene", Path::new(""), &[]);
                let mut scene = scene.map_err(|_| unknown())?;
                scene.objects = objects.into_iter().map(read_object).collect();
                Self::LoadScene(Box::new(SettledScene { scene, start, keeps_time }))
            }
        })
    }
}

/// The scene with one distant ball instead of its objects. The objects are saved as numbers, because
/// their mesh files may be gone.
fn without_files(scene: &Scene) -> Scene {
    let name = match (&scene.controller, scene.objects.first()) {
        (Controller::Builtin(parameters), _) => parameters.object.clone(),
        (_, Some(own)) => own.name.clone(),
        _ => "object".to_owned(),
    };
    let flange = scene.flange.pose.translation.vector;
    let ball = Object {
        // The built-in controller refers to it.
        name,
        shape: Shape::Sphere { radius: 0.01 },
        material: scene.grains.material,
        friction: 0.0,
        pose: Pose::translation(flange.x + 100.0, flange.y, scene.table.height + 1.0),
        drive_timeout: 0.1,
    };
    Scene { objects: vec![ball], ..scene.clone() }
}

fn saved_object(object: &Object) -> SavedObject {
    let Material { youngs_modulus, poisson_ratio, density } = object.material;
    SavedObject {
        name: object.name.clone(),
        shape: saved_shape(&object.shape),
        material: [youngs_modulus, poisson_ratio, density],
        friction: object.friction,
        pose: pose_row(&object.pose),
        drive_timeout: object.drive_timeout,
    }
}

fn read_object(saved: SavedObject) -> Object {
    let [youngs_modulus, poisson_ratio, density] = saved.material;
    Object {
        name: saved.name,
        shape: read_shape(saved.shape),
        material: Material { youngs_modulus, poisson_ratio, density },
        friction: saved.friction,
        pose: pose(&saved.pose),
        drive_timeout: saved.drive_timeout,
    }
}

fn saved_shape(shape: &Shape) -> SavedShape {
    let rows = |points: &[Vec3]| points.iter().map(|&it| it.into()).collect();
    match shape {
        Shape::Sphere { radius } => SavedShape::Sphere { radius: *radius },
        Shape::Box { size } => SavedShape::Box { size: (*size).into() },
        Shape::Cylinder { radius, height } => {
            SavedShape::Cylinder { radius: *radius, height: *height }
        }
        Shape::Capsule { radius, height } => {
            SavedShape::Capsule { radius: *radius, height: *height }
        }
        Shape::ConvexHull { points } => SavedShape::ConvexHull { points: rows(points) },
        Shape::Mesh { file, unit, vertices, triangles } => SavedShape::Mesh {
            file: file.clone(),
            unit: *unit,
            vertices: rows(vertices),
            triangles: triangles.clone(),
        },
    }
}

fn read_shape(saved: SavedShape) -> Shape {
    let vectors = |rows: Vec<[Real; 3]>| rows.into_iter().map(Vec3::from).collect();
    match saved {
        SavedShape::Sphere { radius } => Shape::Sphere { radius },
        SavedShape::Box { size } => Shape::Box { size: size.into() },
        SavedShape::Cylinder { radius, height } => Shape::Cylinder { radius, height },
        SavedShape::Capsule { radius, height } => Shape::Capsule { radius, height },
        SavedShape::ConvexHull { points } => Shape::ConvexHull { points: vectors(points) },
        SavedShape::Mesh { file, unit, vertices, triangles } => {
            Shape::Mesh { file, unit, vertices: vectors(vertices), triangles }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::{Pose, Quat};

    /// Oracle: the identity, for numbers that no decimal has.
    #[test]
    fn changes_come_back_bit_for_bit() {
        let third = Vec3::new(1.0 / 3.0, -0.1, 2e-300);
        let pose = Pose::from_parts(third.into(), Quat::from_euler_angles(0.1, 0.2, 0.3));
        let twist = Twist { linear: third, angular: -third };
        let triangles = vec![[0, 1, 2]];
        let shapes = [
            Shape::Sphere { radius: 0.1 },
            Shape::Box { size: third },
            Shape::Cylinder { radius: 0.1, height: 0.3 },
            Shape::Capsule { radius: 0.1, height: 0.3 },
            Shape::ConvexHull { points: vec![third; 4] },
            Shape::Mesh { file: "x.stl".into(), unit: 1e-3, vertices: vec![third], triangles },
        ];
        let object = |shape: Shape| Object {
            name: "ball".to_owned(),
            shape,
            material: Material { youngs_modulus: 1e6 / 3.0, poisson_ratio: 0.3, density: 1e3 },
            friction: 0.1 + 0.2,
            pose,
            drive_timeout: 0.1,
        };
        let mut changes: Vec<Change> =
            shapes.iter().map(|it| Change::Insert(Box::new(object(it.clone())))).collect();
        let name = || "ball".to_owned();
        changes.push(Change::PlaceObject { object: name(), pose, twist });
        changes.push(Change::PlaceFlange { pose });
        changes.push(Change::Remove { object: name() });
        changes.push(Change::ZeroForceSensor);
        changes.push(Change::SetParameter {
            parameter: TunableParameter::ObjectFriction,
            value: 0.1 + 0.2,
        });
        changes.push(Change::Reset(Scope { time: true, state: false, spawned: true }));
        let text = "name: x\nobject: { shape: { sphere: { radius: 10 mm } }, position: [0 m, 0 m, 10 mm] }";
        let mut scene = scene::parse(text, "x", Path::new(""), &["seed=7".to_owned()]).unwrap();
        for objects in [vec![object(shapes[5].clone()), object(shapes[0].clone())], vec![]] {
            scene.objects = objects;
            scene.grains.friction = 0.1 + 0.2;
            let (scene, start) = (scene.clone(), vec![0, 255, 7]);
            let settled = SettledScene { scene, start, keeps_time: true };
            changes.push(Change::LoadScene(Box::new(settled)));
        }
        for change in changes {
            let bytes = change.to_bytes();
            assert_eq!(Change::from_bytes(&bytes), Ok(change.clone()));
            let cut = Change::from_bytes(&bytes[..bytes.len() - 1]);
            assert!(cut.is_err(), "{change}, cut off");
        }
        assert!(Change::from_bytes(&[200]).is_err(), "a kind that there is not");
    }
}
