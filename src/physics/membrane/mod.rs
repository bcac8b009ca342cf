//! Flexible membranes: meshes of springs and hinges under pressure. `forces` computes their forces.

pub mod mesh;
mod icosphere;
mod parts;
mod tube;
pub mod bar;
mod disc;
pub mod shape; // all shapes of membranes
pub mod stretch;
pub mod bridson_2003;
pub mod pressure;
pub mod critical_step;
pub mod contact_geometry;
mod forces;
#[cfg(test)]
mod tests;

use std::ops::Range;

use bridson_2003::Fold;
pub use forces::forces;
use mesh::{Mesh, area_normal};
use stretch::Spring;

use crate::{
    base::{
        Real, Vec3,
        lanes::{Lanes, Vector},
    },
    scene,
};

/// Material of a membrane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MembraneMaterial {
    /// Thickness d (m).
    pub thickness: Real,
    /// Young's modulus E (Pa).
    pub youngs_modulus: Real,
    /// Density ρ (kg/m³).
    pub density: Real,
    /// Damping ratio γ of the springs.
    pub spring_damping: Real,
    /// Elastic bending constant k_el of the hinges (N m); the plate stiffness is k_el/4.
    pub bending_stiffness: Real,
    /// Dissipative bending constant k_diss of the hinges (N s).
    pub bending_damping: Real,
}

/// Contact geometry of the membrane for grains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MembraneContact {
    /// Its triangles: a surface without gaps or thickness.
    Triangles,
    /// Spheres around its vertices: the classic mass–spring membrane. They do not touch each other.
    Spheres {
        /// Radius of each sphere (m).
        radius: Real,
    },
}

/// Holder of a vertex that no wall holds.
pub const FREE: u32 = u32::MAX;
/// The carrier, which is the first wall, as a holder.
pub const CARRIER_ID: u32 = 0;

impl MembraneMaterial {
    /// The material of a scene's membrane.
    pub fn of(membrane: &scene::Membrane) -> Self {
        Self {
            thickness: membrane.thickness,
            youngs_modulus: membrane.material.youngs_modulus,
            density: membrane.material.density,
            spring_damping: membrane.spring_damping,
            bending_stiffness: membrane.bending_stiffness,
            bending_damping: membrane.bending_damping,
        }
    }
}

/// Parameters of the membrane, which do not change during a run.
#[derive(Clone, Debug)]
pub struct MembraneModel {
    /// Connectivity and reference shape.
    pub mesh: Mesh,
    /// Material of the membrane; of its first part if there are several.
    pub material: MembraneMaterial,
    /// Mass of each vertex (kg): ρ d times a third of the area of the adjacent triangles.
    pub masses: Vec<Real>,
    /// Wall that holds each vertex, or `FREE`. Forces on held vertices are computed like all others; the membrane
    /// exerts them on the wall.
    pub holders: Vec<u32>,
    /// Contact geometry for grains.
    pub contact: MembraneContact,
    /// Springs and hinges, in the order of the edges.
    links: Vec<Link>,
    /// Twice the reference areas of the triangles at each hinge (m²) if hinges use them; else empty.
    reference_areas: [Vec<Real>; 2],
    /// Elastic (N m) and dissipative (N s) bending constant of each hinge if parts differ; else empty.
    bending: [Vec<Real>; 2],
}

/// An edge with all parameters of its forces, contiguous in memory.
#[derive(Clone, Copy, Debug)]
struct Link {
    /// Vertices r1 to r4. On the boundary, r1 and r2 repeat r3 and r4.
    vertices: [u32; 4],
    /// Triangles 1 and 2. On the boundary, both are 0.
    triangles: [u32; 2],
    law: LinkLaw,
}

/// Parameters of the forces of a link.
#[derive(Clone, Copy, Debug, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct LinkLaw {
    spring: Spring,
    /// sin θ⁰/2.
    rest_half_sine: Real,
}

/// Motion of the membrane.
#[derive(Clone, Debug, PartialEq)]
pub struct MembraneState {
    /// Position of each vertex (m). Written by `integrate`.
    pub positions: Vec<Vec3>,
    /// Velocity of each vertex (m/s). Written by `integrate`.
    pub velocities: Vec<Vec3>,
}

/// Area and orientation of a triangle at one instant.
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Facet {
    /// Outward normal; its length is twice the area (m²).
    pub area_normal: Vec3,
    /// Inverse of that length (1/m²).
    pub inverse_norm: Real,
}

impl Facet {
    /// Computes the facet of a triangle with the vertices at `positions`.
    #[inline(always)]
    fn new(positions: &[Vec3], triangle: &[u32; 3]) -> Self {
        let area_normal = area_normal(positions, triangle);
        Self { area_normal, inverse_norm: 1.0 / area_normal.norm() }
    }

    /// Outward unit normal.
    #[inline(always)]
    pub fn normal(&self) -> Vec3 {
        self.area_normal * self.inverse_norm
    }
}

/// Area and orientation of one triangle in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Side<L> {
    /// Outward normal; its length is twice the area (m²).
    pub area_normal: Vector<L>,
    /// Inverse of that length (1/m²).
    pub inverse_norm: L,
}

impl<L: Lanes> Side<L> {
    /// Computes the side from the corners of its triangle.
    #[inline(always)]
    fn new([a, b, c]: [Vector<L>; 3]) -> Self {
        let area_normal = (b - a).cross(c - a);
        Self { area_normal, inverse_norm: L::splat(1.0) / area_normal.dot(area_normal).sqrt() }
    }
}

impl From<&Facet> for Side<Real> {
    fn from(facet: &Facet) -> Self {
        Self { area_normal: facet.area_normal.into(), inverse_norm: facet.inverse_norm }
    }
}

/// Position (m) and velocity (m/s) of a vertex; the fourth numbers are unused.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub struct VertexRow {
    /// Position (m).
    pub position: [Real; 4],
    /// Velocity (m/s).
    pub velocity: [Real; 4],
}

/// Working memory of `forces`.
#[derive(Clone, Debug)]
pub struct MembraneScratch {
    /// Area and orientation of each triangle. Written by `forces`.
    pub facets: Vec<Facet>,
    /// Position and velocity of each vertex, contiguous in memory. Written by `forces`.
    pub vertices: Vec<VertexRow>,
    /// Forces of each link on r1 and r2 (N), four numbers each. Written by `forces`.
    wing_forces: Vec<[Real; 8]>,
    /// Forces of each link on r3 and r4, the ends of its edge (N), four numbers each. Written by `forces`.
    end_forces: Vec<[Real; 8]>,
    /// Force of springs, hinges and pressure on each vertex (N). Written by `forces`.
    pub forces: Vec<Vec3>,
}

impl MembraneModel {
    /// No membrane.
    pub fn none() -> Self {
        let mesh = Mesh::new(Vec::new(), Vec::new()).expect("an empty mesh is valid");
        let material = MembraneMaterial {
            thickness: 0.0,
            youngs_modulus: 0.0,
            density: 0.0,
            spring_damping: 0.0,
            bending_stiffness: 0.0,
            bending_damping: 0.0,
        };
        Self::new(mesh, material)
    }

    /// A membrane of `material`, stress-free in the shape of `mesh`. The carrier holds its rims, and grains touch
    /// its triangles.
    pub fn new(mesh: Mesh, material: MembraneMaterial) -> Self {
        let mass_per_area = material.density * material.thickness;
        let masses: Vec<Real> = mesh.vertex_areas().iter().map(|a| a * mass_per_area).collect();
        let inner = stretch::stiffness(material.youngs_modulus, material.thickness);
        let mut links = Vec::with_capacity(mesh.edges.len());
        for (e, ends) in mesh.edges.iter().enumerate() {
            let [a, b] = ends.map(|v| v as usize);
            let length = (mesh.positions[b] - mesh.positions[a]).norm();
            let stiffness = if mesh.is_boundary(e) { 0.5 * inner } else { inner };
            let masses = [masses[a], masses[b]];
            let mut link = Link {
                vertices: [ends[0], ends[1], ends[0], ends[1]],
                triangles: [0; 2],
                law: LinkLaw {
                    spring: Spring::new(length, stiffness, material.spring_damping, masses),
                    rest_half_sine: 0.0,
                },
            };
            if let Some(hinge) = mesh.hinges.get(e) {
                link.vertices = hinge.vertices;
                link.triangles = hinge.triangles;
                let facets = hinge
                    .triangles
                    .map(|t| Facet::new(&mesh.positions, &mesh.triangles[t as usize]));
                let fold = link.fold(&mesh.positions, [&facets[0], &facets[1]]);
                link.law.rest_half_sine = fold.half_sine;
            }
            links.push(link);
        }
        let holder = |&is_on_rim: &bool| if is_on_rim { CARRIER_ID } else { FREE };
        let holders = mesh.is_on_rim.iter().map(holder).collect();
        Self {
            masses,
            holders,
            contact: MembraneContact::Triangles,
            links,
            reference_areas: [Vec::new(), Vec::new()],
            bending: [Vec::new(), Vec::new()],
            material,
            mesh,
        }
    }

    /// Makes hinges use the areas of the reference shape, as in Götz (2024), section 3.3.1.
    pub fn bend_by_first_areas(&mut self) {
        let mesh = &self.mesh;
        let twice = |t: u32| area_normal(&mesh.positions, &mesh.triangles[t as usize]).norm();
        self.reference_areas =
            [0, 1].map(|side| mesh.hinges.iter().map(|it| twice(it.triangles[side])).collect());
    }

    /// Sets the rest length of every spring to `scale` times its length in the reference shape.
    pub fn scale_rest_lengths(&mut self, scale: Real) {
        self.scale_rest_lengths_of(0..self.mesh.n_vertices(), scale);
    }

    /// Like `scale_rest_lengths`, for the springs between the vertices of one part.
    pub fn scale_rest_lengths_of(&mut self, part: Range<usize>, scale: Real) {
        for (link, ends) in self.links.iter_mut().zip(&self.mesh.edges) {
            if ends.iter().all(|&v| part.contains(&(v as usize))) {
                let [a, b] = ends.map(|v| self.mesh.positions[v as usize]);
                link.law.spring.rest_length = scale * (b - a).norm();
            }
        }
    }

    /// Sets the rest angles of all hinges to their angles at `positions` (m).
    pub fn rest_angles_from(&mut self, positions: &[Vec3]) {
        for link in &mut self.links[..self.mesh.hinges.len()] {
            let facets =
                link.triangles.map(|t| Facet::new(positions, &self.mesh.triangles[t as usize]));
            link.law.rest_half_sine = link.fold(positions, [&facets[0], &facets[1]]).half_sine;
        }
    }

    /// Total mass (kg).
    pub fn mass(&self) -> Real {
        self.masses.iter().sum()
    }
}

impl Link {
    /// False on the boundary.
    fn is_hinge(&self) -> bool {
        self.triangles[0] != self.triangles[1]
    }

    /// The vectors at r1 to r4.
    #[inline(always)]
    fn corners<'a>(&self, vectors: &'a [Vec3]) -> [&'a Vec3; 4] {
        self.vertices.map(|v| &vectors[v as usize])
    }

    fn fold(&self, positions: &[Vec3], facets: [&Facet; 2]) -> Fold<Real> {
        let r = self.corners(positions);
        let edge = r[3] - r[2];
        let lengths = [edge.norm(), 1.0 / edge.norm()];
        let corners = r.map(|corner| Vector::from(*corner));
        Fold::new(corners, facets.map(Side::from), edge.into(), lengths)
    }
}

impl MembraneState {
    /// At rest in the reference shape.
    pub fn at_rest(mesh: &Mesh) -> Self {
        Self {
            positions: mesh.positions.clone(),
            velocities: vec![Vec3::zeros(); mesh.n_vertices()],
        }
    }
}

impl MembraneScratch {
    /// Working memory for `model`.
    pub fn new(model: &MembraneModel) -> Self {
        let facet = Facet { area_normal: Vec3::zeros(), inverse_norm: 0.0 };
        Self {
            facets: vec![facet; model.mesh.triangles.len()],
            vertices: vec![VertexRow::default(); model.mesh.n_vertices()],
            wing_forces: vec![[0.0; 8]; model.links.len()],
            end_forces: vec![[0.0; 8]; model.links.len()],
            forces: vec![Vec3::zeros(); model.mesh.n_vertices()],
        }
    }
}
