//! The surface of a rigid object: how far a point is from it, which way is out, what it weighs.
//!
//! Every surface stands in the frame of its center of mass. Sphere, box, cylinder and capsule are
//! closed forms, axes along z: exact signed distances inside and outside, with a normal that is
//! the gradient of the distance and does not depend on how small the distance is. Convex hulls
//! and meshes are one thing here, a closed polyhedron.

use std::f64::consts::PI;

use thiserror::Error;

pub use super::polyhedron::Polyhedron;
use crate::base::{Quat, Real, Vec3};

/// A closed surface around its center of mass.
#[derive(Clone, Debug)]
pub enum Surface {
    /// A sphere.
    Sphere {
        /// Radius (m).
        radius: Real,
    },
    /// A box.
    Cuboid {
        /// Half of each edge length (m).
        half: Vec3,
    },
    /// A cylinder along z.
    Cylinder {
        /// Radius (m).
        radius: Real,
        /// Half of the height (m).
        half_height: Real,
    },
    /// All points at one distance from a piece of the z axis.
    Capsule {
        /// Radius (m).
        radius: Real,
        /// Half the length of the straight part (m).
        half_length: Real,
    },
    /// Flat triangles: a convex hull or a mesh.
    Polyhedron(Box<Polyhedron>),
}

/// A signed distance and the way out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signed {
    /// Distance from the surface (m), negative inside.
    pub distance: Real,
    /// Gradient of the distance: outward, length 1.
    pub normal: Vec3,
}

impl Signed {
    /// The point of the surface closest to `p`, whose distance this is.
    #[inline]
    pub fn surface_point(&self, p: &Vec3) -> Vec3 {
        p - self.normal * self.distance
    }
}

/// What a surface encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bulk {
    /// Volume (m³).
    pub volume: Real,
    /// Mass (kg).
    pub mass: Real,
    /// Center of mass in the frame in which the shape was given (m).
    pub center_of_mass: Vec3,
    /// Principal moments of inertia about the center of mass (kg m²).
    pub principal_inertia: Vec3,
    /// Turns principal axes into the axes of the shape.
    pub principal_axes: Quat,
}

/// Corners of a box along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates (m).
    pub min: Vec3,
    /// Largest coordinates (m).
    pub max: Vec3,
}

/// Why points or triangles are no solid.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// Points in one plane, or too few.
    #[error("{n_points} points span no volume; a convex hull needs at least 4 that do")]
    NoHull {
        /// How many points there are.
        n_points: usize,
    },
    /// A list of triangles that cannot be read.
    #[error("triangle {triangle} names vertex {vertex}, but there are only {n_vertices}")]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The index it names.
        vertex: u32,
        /// How many vertices there are.
        n_vertices: usize,
    },
    /// A coordinate that is not a number.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A surface with holes or with triangles that disagree about outside.
    #[error(
        "{n_open} of {n_edges} edges have no partner running the other way: close the holes of the \
         mesh and orient its triangles alike"
    )]
    NotClosed {
        /// Edges without partner.
        n_open: usize,
        /// All directed edges.
        n_edges: usize,
    },
    /// A surface whose normals point inward, or without volume.
    #[error("the mesh encloses no positive volume: turn its triangles over, outward normals")]
    InsideOut,
}

impl Surface {
    /// A box with edges `size` (m).
    pub fn cuboid(size: &Vec3) -> Self {
        Self::Cuboid { half: size * 0.5 }
    }

    /// A cylinder of total `height` (m).
    pub fn cylinder(radius: Real, height: Real) -> Self {
        Self::Cylinder { radius, half_height: 0.5 * height }
    }

    /// A capsule of total `height` (m), at least twice the radius.
    pub fn capsule(radius: Real, height: Real) -> Self {
        Self::Capsule { radius, half_length: (0.5 * height - radius).max(0.0) }
    }

    /// The convex hull of `points` (m), moved to its center of mass.
    ///
    /// # Errors
    /// If the points span no volume.
    pub fn convex_hull(points: &[Vec3]) -> Result<Self, ShapeError> {
        Ok(Self::Polyhedron(Box::new(Polyhedron::hull(points)?)))
    }

    /// A closed mesh with outward normals, moved to its center of mass.
    ///
    /// # Errors
    /// If the mesh is open, inconsistent or inside out.
    pub fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, ShapeError> {
        Ok(Self::Polyhedron(Box::new(Polyhedron::new(vertices, triangles)?)))
    }

    /// Signed distance of `p` (m) from the surface.
    #[inline]
    pub fn distance(&self, p: &Vec3) -> Signed {
        match self {
            Self::Sphere { radius } => ball(p, *radius),
            Self::Cuboid { half } => cuboid(p, half),
            Self::Cylinder { radius, half_height } => cylinder(p, *radius, *half_height),
            Self::Capsule { radius, half_length } => {
                ball(&Vec3::new(p.x, p.y, p.z - p.z.clamp(-half_length, *half_length)), *radius)
            }
            Self::Polyhedron(polyhedron) => polyhedron.distance(p),
        }
    }

    /// Radius of a sphere about the center of mass that holds the surface (m).
    pub fn bounding_radius(&self) -> Real {
        match self {
            Self::Sphere { radius } => *radius,
            Self::Cuboid { half } => half.norm(),
            Self::Cylinder { radius, half_height } => radius.hypot(*half_height),
            Self::Capsule { radius, half_length } => radius + half_length,
            Self::Polyhedron(polyhedron) => polyhedron.bounding_radius(),
        }
    }

    /// Box along the local axes that holds the surface.
    pub fn aabb(&self) -> Aabb {
        let half = match self {
            Self::Sphere { radius } => Vec3::repeat(*radius),
            Self::Cuboid { half } => *half,
            Self::Cylinder { radius, half_height } => Vec3::new(*radius, *radius, *half_height),
            Self::Capsule { radius, half_length } => {
                Vec3::new(*radius, *radius, radius + half_length)
            }
            Self::Polyhedron(polyhedron) => return polyhedron.aabb(),
        };
        Aabb { min: -half, max: half }
    }

    /// Volume, mass and inertia at `density` (kg/m³).
    pub fn bulk(&self, density: Real) -> Bulk {
        let (volume, per_mass) = match self {
            Self::Sphere { radius } => {
                (4.0 / 3.0 * PI * radius.powi(3), Vec3::repeat(0.4 * radius * radius))
            }
            Self::Cuboid { half } => {
                let square = half.component_mul(half) / 3.0;
                let around = Vec3::repeat(square.sum()) - square;
                (8.0 * half.product(), around)
            }
            Self::Cylinder { radius, half_height } => {
                let tilt = radius * radius / 4.0 + half_height * half_height / 3.0;
                let volume = 2.0 * PI * radius * radius * half_height;
                (volume, Vec3::new(tilt, tilt, radius * radius / 2.0))
            }
            Self::Capsule { radius, half_length } => capsule_bulk(*radius, *half_length),
            Self::Polyhedron(polyhedron) => return polyhedron.bulk(density),
        };
        let mass = density * volume;
        Bulk {
            volume,
            mass,
            center_of_mass: Vec3::zeros(),
            principal_inertia: per_mass * mass,
            principal_axes: Quat::identity(),
        }
    }
}

/// Volume, and inertia over mass, of a cylinder between two half balls.
fn capsule_bulk(radius: Real, half_length: Real) -> (Real, Vec3) {
    let (r, l) = (radius, half_length);
    let (straight, round) = (2.0 * PI * r * r * l, 4.0 / 3.0 * PI * r * r * r);
    let tilt = straight * (r * r / 4.0 + l * l / 3.0)
        // Half balls about their own centers of mass, moved out to l + 3/8 r.
        + round * (0.4 * r * r + l * l + 0.75 * l * r);
    let spin = straight * r * r / 2.0 + round * 0.4 * r * r;
    let volume = straight + round;
    (volume, Vec3::new(tilt, tilt, spin) / volume)
}

#[inline]
fn ball(p: &Vec3, radius: Real) -> Signed {
    let length = p.norm();
    // At the very center every way is out.
    let normal = if length > 0.0 { p / length } else { Vec3::x() };
    Signed { distance: length - radius, normal }
}

#[inline]
fn cuboid(p: &Vec3, half: &Vec3) -> Signed {
    let beyond = p.abs() - half;
    let outside = beyond.sup(&Vec3::zeros());
    let n_outside = (0..3).filter(|&k| beyond[k] > 0.0).count();
    let (distance, along) = if n_outside > 1 {
        let distance = outside.norm();
        (distance, outside / distance)
    } else {
        // One face is the nearest, inside and outside alike.
        let face = beyond.imax();
        (beyond[face], Vec3::ith(face, 1.0))
    };
    Signed { distance, normal: along.zip_map(p, |a, p| a * 1.0_f64.copysign(p)) }
}

#[inline]
fn cylinder(p: &Vec3, radius: Real, half_height: Real) -> Signed {
    let from_axis = (p.x * p.x + p.y * p.y).sqrt();
    let radial =
        if from_axis > 0.0 { Vec3::new(p.x / from_axis, p.y / from_axis, 0.0) } else { Vec3::x() };
    let axial = Vec3::new(0.0, 0.0, 1.0_f64.copysign(p.z));
    let (beyond_side, beyond_end) = (from_axis - radius, p.z.abs() - half_height);
    if beyond_side > 0.0 && beyond_end > 0.0 {
        let distance = (beyond_side * beyond_side + beyond_end * beyond_end).sqrt();
        let normal = radial * (beyond_side / distance) + axial * (beyond_end / distance);
        Signed { distance, normal }
    } else if beyond_side > beyond_end {
        Signed { distance: beyond_side, normal: radial }
    } else {
        Signed { distance: beyond_end, normal: axial }
    }
}
