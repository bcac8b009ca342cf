//! Reads URDF with one rigid link: its collision geometry is the shape, its mass gives the density.
//!
//! The inertia follows from shape and density. Joints, several links, and rotated collision geometry
//! are rejected, because they would not be simulated as written.

use std::path::Path;

use urdf_rs::{Collision, Geometry, Robot};

use super::{
    Object, Shape, mesh_file,
    resource::{ResourceError, path},
};
use crate::base::{Real, Vec3};

/// Largest density of an object relative to water (-); a larger one means that the mass is wrong.
const DENSITY_RATIO_MAX: Real = 25.0;

/// Reads an object from URDF; `defaults` has the values that URDF lacks.
///
/// # Errors
/// If there is no object that can be simulated.
pub(super) fn read(text: &str, folder: &Path, defaults: &Object) -> Result<Object, ResourceError> {
    let robot: Robot =
        urdf_rs::read_from_string(text).map_err(|it| ResourceError::Malformed(it.to_string()))?;
    let unsupported =
        |why: &str| ResourceError::Unsupported(format!("URDF `{}`: {why}", robot.name));
    let [link] = robot.links.as_slice() else {
        return Err(unsupported("it must have exactly one link"));
    };
    let [collision] = link.collision.as_slice() else {
        return Err(unsupported("its link must have exactly one collision geometry"));
    };
    if collision.origin.rpy.iter().any(|angle| *angle != 0.0) {
        return Err(unsupported("its collision geometry must not be rotated relative to its link"));
    }
    let shape = shape(collision, folder)?;
    let mut object = Object { name: robot.name.clone(), shape, ..defaults.clone() };
    let mass = link.inertial.mass.value;
    if mass != 0.0 {
        let density = mass / volume(&object.shape);
        let is_plausible = 0.0 < density && density <= DENSITY_RATIO_MAX * 1000.0;
        if !is_plausible {
            let why = format!("its mass of {mass} kg means a density of {density} kg/m³");
            return Err(unsupported(&why));
        }
        object.material.density = density;
    }
    Ok(object)
}

fn shape(collision: &Collision, folder: &Path) -> Result<Shape, ResourceError> {
    let size = |value: Real| {
        let is_plausible = value.is_finite() && 0.0 < value;
        let why = || ResourceError::Malformed(format!("URDF: {value} is not a valid length"));
        if is_plausible { Ok(value) } else { Err(why()) }
    };
    Ok(match &collision.geometry {
        Geometry::Box { size: edges } => {
            Shape::Box { size: Vec3::new(size(edges[0])?, size(edges[1])?, size(edges[2])?) }
        }
        Geometry::Cylinder { radius, length } => {
            Shape::Cylinder { radius: size(*radius)?, height: size(*length)? }
        }
        Geometry::Capsule { radius, length } => {
            Shape::Capsule { radius: size(*radius)?, height: size(*length)? + 2.0 * radius }
        }
        Geometry::Sphere { radius } => Shape::Sphere { radius: size(*radius)? },
        Geometry::Mesh { filename, scale } => {
            let scale = scale.as_ref().map_or([1.0; 3], |it| it.0);
            let unit = size(scale[0])?;
            if scale.iter().any(|it| it.to_bits() != unit.to_bits()) {
                let why = "URDF: a mesh must have the same scale in all directions".to_owned();
                return Err(ResourceError::Unsupported(why));
            }
            mesh(filename, unit, folder)?
        }
    })
}

fn mesh(filename: &str, unit: Real, folder: &Path) -> Result<Shape, ResourceError> {
    let missing =
        || ResourceError::MissingAssets(format!("URDF: mesh `{filename}` does not exist"));
    let file = path(filename, folder).filter(|it| it.is_file()).ok_or_else(missing)?;
    let surface = mesh_file::read(&file, unit)
        .map_err(|error| ResourceError::Unsupported(format!("URDF: `{filename}` {error}")))?;
    let mesh_file::Surface { vertices, triangles } = surface;
    Ok(Shape::Mesh { file, unit, vertices, triangles })
}

/// Volume of a shape (m³).
fn volume(shape: &Shape) -> Real {
    use std::f64::consts::PI;
    match shape {
        Shape::Sphere { radius } => 4.0 / 3.0 * PI * radius.powi(3),
        Shape::Box { size } => size.x * size.y * size.z,
        Shape::Cylinder { radius, height } => PI * radius * radius * height,
        Shape::Capsule { radius, height } => {
            PI * radius * radius * (height - 2.0 * radius) + 4.0 / 3.0 * PI * radius.powi(3)
        }
        Shape::ConvexHull { .. } => Real::NAN,
        Shape::Mesh { vertices, triangles, .. } => {
            let of = |&[a, b, c]: &[u32; 3]| {
                let [a, b, c] = [a, b, c].map(|v| vertices[v as usize]);
                a.dot(&b.cross(&c)) / 6.0
            };
            triangles.iter().map(of).sum()
        }
    }
}
