//! Surfaces of rigid objects: signed distance, outward normal, mass properties.
//!
//! The origin is the center of mass. Sphere, box, cylinder and capsule have closed forms, with their
//! axes along z: exact signed distances inside and outside, and a normal that is the gradient of the
//! distance, accurate at any distance. Convex hulls and meshes are closed polyhedra.

use std::f64::consts::PI;

use thiserror::Error;

pub use super::polyhedron::Polyhedron;
use crate::base::{Quat, Real, Vec3};

/// A closed surface, with the origin at its center of mass.
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
    /// All points at the same distance from a segment of the z axis.
    Capsule {
        /// Radius (m).
        radius: Real,
        /// Half the length of the straight part (m).
        half_length: Real,
    },
    /// A convex hull or a mesh.
    Polyhedron(Box<Polyhedron>),
}

/// A signed distance and its gradient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedDistance {
    /// Distance from the surface (m), negative inside.
    pub distance: Real,
    /// Gradient of the distance: a unit vector, outward.
    pub normal: Vec3,
}

impl SignedDistance {
    /// The point of the surface closest to `p`, if this is the distance of `p`.
    #[inline]
    pub fn surface_point(&self, p: &Vec3) -> Vec3 {
        p - self.normal * self.distance
    }
}

/// Mass properties of the solid inside a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bulk {
    /// Volume (m³).
    pub volume: Real,
    /// Mass (kg).
    pub mass: Real,
    /// Center of mass in the original frame of the shape (m).
    pub center_of_mass: Vec3,
    /// Principal moments of inertia about the center of mass (kg m²).
    pub principal_inertia: Vec3,
    /// Rotation from the principal axes to the axes of the shape.
    pub principal_axes: Quat,
}

/// An axis-aligned box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest coordinates (m).
    pub min: Vec3,
    /// Largest coordinates (m).
    pub max: Vec3,
}

/// Why points or triangles do not form a solid.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// Coplanar points, or too few points.
    #[error("{n_points} points span no volume; a convex hull needs at least 4 that do")]
    NoHull {
        /// Number of points.
        n_points: usize,
    },
    /// A vertex index that does not exist.
    #[error(
        "triangle {triangle} refers to vertex {vertex}, but there are only {n_vertices} vertices"
    )]
    NoSuchVertex {
        /// The triangle.
        triangle: usize,
        /// The invalid index.
        vertex: u32,
        /// Number of vertices.
        n_vertices: usize,
    },
    /// A coordinate that is not finite.
    #[error("vertex {vertex} has a coordinate that is not finite")]
    NotFinite {
        /// The vertex.
        vertex: usize,
    },
    /// A surface with holes, or with inconsistently oriented triangles.
    #[error(
        "{n_open} of {n_edges} directed edges have no partner in the opposite direction; close the \
         holes of the mesh and orient its triangles consistently"
    )]
    NotClosed {
        /// Number of directed edges without partner.
        n_open: usize,
        /// Number of all directed edges.
        n_edges: usize,
    },
    /// A surface with inward normals, or without volume.
    #[error(
        "the mesh encloses no positive volume; flip its triangles so that normals point outward"
    )]
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
    /// If the points do not span a volume.
    pub fn convex_hull(points: &[Vec3]) -> Result<Self, ShapeError> {
        Ok(Self::Polyhedron(Box::new(Polyhedron::hull(points)?)))
    }

    /// A closed mesh with outward normals, moved to its center of mass.
    ///
    /// # Errors
    /// If the mesh is open, inconsistently oriented or inside out.
    pub fn mesh(vertices: &[Vec3], triangles: &[[u32; 3]]) -> Result<Self, ShapeError> {
        Ok(Self::Polyhedron(Box::new(Polyhedron::new(vertices, triangles)?)))
    }

    /// Signed distance of `p` (m) from the surface.
    #[inline]
    pub fn distance(&self, p: &Vec3) -> SignedDistance {
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

    /// Radius of a sphere around the center of mass that contains the surface (m).
    pub fn bounding_radius(&self) -> Real {
        match self {
            Self::Sphere { radius } => *radius,
            Self::Cuboid { half } => half.norm(),
            Self::Cylinder { radius, half_height } => radius.hypot(*half_height),
            Self::Capsule { radius, half_length } => radius + half_length,
            Self::Polyhedron(polyhedron) => polyhedron.bounding_radius(),
        }
    }

    /// Box along the local axes that contains the surface.
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

/// Volume (m³) and inertia divided by mass (m²) of a capsule: a cylinder between two half balls.
fn capsule_bulk(radius: Real, half_length: Real) -> (Real, Vec3) {
    let (r, l) = (radius, half_length);
    let (straight, round) = (2.0 * PI * r * r * l, 4.0 / 3.0 * PI * r * r * r);
    let tilt = straight * (r * r / 4.0 + l * l / 3.0)
        // Half balls about their own centers of mass, at l + 3/8 r.
        + round * (0.4 * r * r + l * l + 0.75 * l * r);
    let axial = straight * r * r / 2.0 + round * 0.4 * r * r;
    let volume = straight + round;
    (volume, Vec3::new(tilt, tilt, axial) / volume)
}

#[inline]
fn ball(p: &Vec3, radius: Real) -> SignedDistance {
    let length = p.norm();
    // At the center every direction is outward.
    let normal = if length > 0.0 { p / length } else { Vec3::x() };
    SignedDistance { distance: length - radius, normal }
}

#[inline]
fn cuboid(p: &Vec3, half: &Vec3) -> SignedDistance {
    let beyond = p.abs() - half;
    let outside = beyond.sup(&Vec3::zeros());
    let n_outside = (0..3).filter(|&k| beyond[k] > 0.0).count();
    let (distance, along) = if n_outside > 1 {
        let distance = outside.norm();
        (distance, outside / distance)
    } else {
        // A face is closest, both inside and outside.
        let face = beyond.imax();
        (beyond[face], Vec3::ith(face, 1.0))
    };
    SignedDistance { distance, normal: along.zip_map(p, |a, p| a * 1.0_f64.copysign(p)) }
}

#[inline]
fn cylinder(p: &Vec3, radius: Real, half_height: Real) -> SignedDistance {
    let from_axis = (p.x * p.x + p.y * p.y).sqrt();
    let radial =
        if from_axis > 0.0 { Vec3::new(p.x / from_axis, p.y / from_axis, 0.0) } else { Vec3::x() };
    let axial = Vec3::new(0.0, 0.0, 1.0_f64.copysign(p.z));
    let (beyond_side, beyond_end) = (from_axis - radius, p.z.abs() - half_height);
    if beyond_side > 0.0 && beyond_end > 0.0 {
        let distance = (beyond_side * beyond_side + beyond_end * beyond_end).sqrt();
        let normal = radial * (beyond_side / distance) + axial * (beyond_end / distance);
        SignedDistance { distance, normal }
    } else if beyond_side > beyond_end {
        SignedDistance { distance: beyond_side, normal: radial }
    } else {
        SignedDistance { distance: beyond_end, normal: axial }
    }
}
