//! Containers of the cells: a box, walls, a closed triangulated surface.
//!
//! A surface need not be convex. A cell C is clipped exactly, with an arbitrary point O:
//!
//! ```text
//! V(C ∩ M) = w V(C) − Σ_f s_f V(C ∩ K_f ∩ B_f)
//!
//! w    winding number of the surface M about O: 1 inside, 0 outside
//! K_f  infinite cone from O over facet f
//! B_f  half-space beyond the plane of facet f, seen from O
//! s_f  1 if O sees the inner side of the facet, −1 if the outer one
//! ```
//!
//! The cones over all facets, with their signs, cover space w times, and their parts beyond the
//! facets cover the outside. Each part is convex. Only facets no farther from O than the cell's
//! farthest vertex contribute. Areas of faces are clipped by the same sum.

use std::{collections::BTreeMap, f64::consts::PI};

use super::{
    Face, Neighbor,
    polyhedron::{Cutter, Polyhedron},
};
use crate::{
    base::{Real, Vec3},
    measure::search::PointSearch,
};

/// A plane wall: the cells are on the side of `normal`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// A point of the plane, world frame (m).
    pub point: Vec3,
    /// Unit normal, into the container.
    pub normal: Vec3,
}

/// The surface is not closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the surface is open or inconsistently oriented at the edge of vertices {0} and {1}; close its rims \
     with triangles"
)]
pub struct OpenSurface(pub u32, pub u32);

/// The region that the cells fill.
pub struct Container<'a> {
    corners: [Vec3; 2],
    period: Option<Vec3>,
    planes: &'a [Plane],
    surface: Option<Surface<'a>>,
}

/// A closed surface with a search structure for its facets.
struct Surface<'a> {
    positions: &'a [Vec3],
    triangles: &'a [[u32; 3]],
    /// Centroids of the facets.
    points: PointSearch<'static>,
    /// Largest distance of a vertex from the centroid of its facet (m).
    radius_max: Real,
    /// Planes with the entire surface below them: unit normal and height (m). They close the outer cells
    /// much tighter than the box.
    hull: Vec<(Vec3, Real)>,
}

impl<'a> Container<'a> {
    /// The box from `low` to `high` (m), world axes.
    pub fn cuboid(low: Vec3, high: Vec3) -> Self {
        Self { corners: [low, high], period: None, planes: &[], surface: None }
    }

    /// The box from the origin to `period` (m), periodic along all axes.
    pub fn periodic(period: Vec3) -> Self {
        Self { period: Some(period), ..Self::cuboid(Vec3::zeros(), period) }
    }

    /// The inside of the closed surface of `triangles`, counterclockwise seen from outside, with vertices
    /// at `positions` (m). It may be concave and have several parts; `with_lids` closes a surface
    /// with rims. For a membrane, the bound is its mid-surface, not the side that grains touch.
    ///
    /// # Errors
    /// If an edge does not have exactly one triangle on either side.
    pub fn surface(positions: &'a [Vec3], triangles: &'a [[u32; 3]]) -> Result<Self, OpenSurface> {
        check_closed(triangles)?;
        let none = [Vec3::repeat(Real::INFINITY), Vec3::repeat(Real::NEG_INFINITY)];
        let [low, high] = positions.iter().fold(none, |[low, high], v| [low.inf(v), high.sup(v)]);
        // A box that does not touch the surface, so that only facets bound the cells.
        let margin = 0.01 * (high - low).norm();
        let corners = [low.add_scalar(-margin), high.add_scalar(margin)];
        let mut radius_max: Real = 0.0;
        let mut centroids = Vec::with_capacity(triangles.len());
        for triangle in triangles {
            let vertices = triangle.map(|v| positions[v as usize]);
            let centroid = (vertices[0] + vertices[1] + vertices[2]) / 3.0;
            for vertex in vertices {
                radius_max = radius_max.max((vertex - centroid).norm());
            }
            centroids.push(centroid);
        }
        let points = PointSearch::new(&centroids, radius_max, None);
        let hull = diagonals().map(|normal| {
            let highest =
                positions.iter().map(|v| normal.dot(v)).fold(Real::NEG_INFINITY, Real::max);
            (normal, highest + margin)
        });
        let hull = hull.collect();
        let surface = Some(Surface { positions, triangles, points, radius_max, hull });
        Ok(Self { corners, period: None, planes: &[], surface })
    }

    /// The part of the container on the inner side of all `planes`.
    #[must_use]
    pub fn with_planes(self, planes: &'a [Plane]) -> Self {
        Self { planes, ..self }
    }

    /// Lowest and highest corner of the bounding box (m).
    pub(super) fn corners(&self) -> [Vec3; 2] {
        self.corners
    }

    pub(super) fn period(&self) -> Option<&Vec3> {
        self.period.as_ref()
    }

    /// The initial cell of sphere `i` at `center` (m): the box cut by the walls, relative to its center.
    pub(super) fn start(&self, i: usize, center: &Vec3, cutter: &mut Cutter) -> Polyhedron {
        let (bounds, neighbors) = match self.period {
            // Its own images are half a period away.
            Some(period) => ([period * -0.5, period * 0.5], [Neighbor::Sphere(i); 6]),
            None => (self.corners.map(|it| it - center), [0, 1, 2, 3, 4, 5].map(Neighbor::Side)),
        };
        let mut cell = Polyhedron::cuboid(&bounds, neighbors);
        for (k, plane) in self.planes.iter().enumerate() {
            let offset = (center - plane.point).dot(&plane.normal);
            cell.cut(&-plane.normal, offset, Some(Neighbor::Plane(k)), cutter);
        }
        cell
    }

    /// Cuts off some of what lies outside the surface, if there is one.
    pub(super) fn close(&self, cell: &mut Polyhedron, center: &Vec3, cutter: &mut Cutter) {
        for (normal, height) in self.surface.iter().flat_map(|surface| &surface.hull) {
            cell.cut(normal, height - normal.dot(center), None, cutter);
        }
    }

    /// Volume (m³) of the part of `cell` inside the surface. Adds its faces to `faces`.
    pub(super) fn clip(
        &self,
        cell: &Polyhedron,
        center: &Vec3,
        cutter: &mut Cutter,
        faces: &mut Faces,
    ) -> Real {
        let Some(surface) = self.surface.as_ref().filter(|_| !cell.is_empty()) else {
            faces.add(cell, 1.0);
            return cell.volume();
        };
        faces.is_clipped = true;
        // Any point can be the apex of the cones. A point next to the center is in no facet's plane.
        let apex = Vec3::new(0.61, 0.35, 0.71) * (1e-3 * surface.radius_max);
        let reach = cell.reach() + apex.norm();
        let mut facets = Vec::new();
        surface.points.visit(center, reach + surface.radius_max, |f, _| facets.push(f));
        facets.retain(|&f| surface.is_within(f, center, reach));
        facets.sort_unstable();
        let winding = surface.winding(&(center + apex), &self.corners);
        let mut volume = winding * cell.volume();
        faces.add(cell, winding);
        for f in facets {
            let corners = surface.corners(f).map(|it| it - center);
            if let Some((sign, part)) = beyond(cell, &apex, &corners, f, cutter) {
                volume -= sign * part.volume();
                faces.subtract(&part, sign);
            }
        }
        volume.max(0.0)
    }
}

/// The part of `cell` beyond facet `f` with `corners`, seen from `apex`, and its sign; all relative to the
/// cell's center.
fn beyond(
    cell: &Polyhedron,
    apex: &Vec3,
    corners: &[Vec3; 3],
    f: usize,
    cutter: &mut Cutter,
) -> Option<(Real, Polyhedron)> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let height = normal.dot(a);
    let sign = (height - normal.dot(apex)).signum();
    let mut cuts = [(-sign * normal, -sign * height); 4];
    for (cut, [p, q]) in cuts[1..].iter_mut().zip([[a, b], [b, c], [c, a]]) {
        // An apex collinear with an edge has no cone.
        let side = (p - apex).cross(&(q - apex)).try_normalize(0.0)? * -sign;
        *cut = (side, side.dot(apex));
    }
    if cuts.iter().any(|(side, offset)| !cell.has_part_below(side, *offset)) {
        return None;
    }
    let mut part = cell.clone();
    for (k, (side, offset)) in cuts.iter().enumerate() {
        part.cut(side, *offset, (k == 0).then_some(Neighbor::Facet(f)), cutter);
    }
    (!part.is_empty()).then_some((sign, part))
}

/// Unit vectors to the edges and corners of a cube.
fn diagonals() -> impl Iterator<Item = Vec3> {
    let steps = [-1.0, 0.0, 1.0];
    let all = (0..27).map(move |k| Vec3::new(steps[k % 3], steps[k / 3 % 3], steps[k / 9]));
    all.filter(|it| it.norm_squared() > 1.5).map(|it| it.normalize())
}

/// Each directed edge must have its reverse, once.
fn check_closed(triangles: &[[u32; 3]]) -> Result<(), OpenSurface> {
    let directed = |[a, b, c]: &[u32; 3]| [[*a, *b], [*b, *c], [*c, *a]];
    let mut edges: Vec<[u32; 2]> = triangles.iter().flat_map(directed).collect();
    edges.sort_unstable();
    let twice = edges.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0]);
    let open = || edges.iter().find(|[a, b]| edges.binary_search(&[*b, *a]).is_err()).copied();
    twice.or_else(open).map_or(Ok(()), |[a, b]| Err(OpenSurface(a, b)))
}

impl Surface<'_> {
    fn corners(&self, f: usize) -> [Vec3; 3] {
        self.triangles[f].map(|v| self.positions[v as usize])
    }

    /// True unless the facet is certainly farther than `reach` (m) from `center`.
    fn is_within(&self, f: usize, center: &Vec3, reach: Real) -> bool {
        let [a, b, c] = self.corners(f);
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let outside = (low - center).sup(&(center - high)).sup(&Vec3::zeros());
        outside.norm_squared() <= reach * reach
    }

    /// Winding number of the surface about `point` (m): outward minus inward crossings of the ray from
    /// there along x.
    fn winding(&self, point: &Vec3, corners: &[Vec3; 2]) -> Real {
        let length = (corners[1].x - point.x).max(0.0);
        let middle = point + Vec3::x() * (0.5 * length);
        let half = Vec3::new(0.5 * length, 0.0, 0.0).add_scalar(self.radius_max);
        let mut turns = 0.0;
        let mut is_clear = true;
        self.points.visit_box(&(middle - half), &(middle + half), |f| {
            let [a, b, c] = self.corners(f).map(|it| it - point);
            // Twice the areas of the triangles of ray and edges, projected along x.
            let area = |p: &Vec3, q: &Vec3| p.y * q.z - p.z * q.y;
            let areas = [area(&b, &c), area(&c, &a), area(&a, &b)];
            let total: Real = areas.iter().sum();
            let rounding = 1e-9 * self.radius_max.powi(2);
            let is_hit = areas.iter().all(|it| it * total >= 0.0);
            let at = (a.x * areas[0] + b.x * areas[1] + c.x * areas[2]) / total;
            if is_hit && at > 0.0 {
                turns += total.signum();
            }
            // A ray through an edge or a vertex, or along a facet, has no reliable crossing.
            let is_beside = areas.iter().any(|it| it * total < 0.0 && it.abs() > rounding);
            is_clear &= is_beside || areas.iter().all(|it| it.abs() > rounding);
        });
        if is_clear { turns } else { self.solid_angle(point) / (4.0 * PI) }.round()
    }

    /// Solid angle of all facets seen from `point` (m) (van Oosterom & Strackee 1983).
    fn solid_angle(&self, point: &Vec3) -> Real {
        let mut halves = 0.0;
        for f in 0..self.triangles.len() {
            let [a, b, c] = self.corners(f).map(|it| it - point);
            let [x, y, z] = [a, b, c].map(|it| it.norm());
            let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
            halves += a.dot(&b.cross(&c)).atan2(below);
        }
        2.0 * halves
    }
}

/// Faces of a cell composed of parts: the area of each neighbor's face (m²).
#[derive(Default)]
pub(super) struct Faces {
    original: Vec<Face>,
    /// Areas to subtract, and facets.
    changes: BTreeMap<Neighbor, Real>,
    /// True if the surface may have removed faces.
    is_clipped: bool,
}

impl Faces {
    fn add(&mut self, part: &Polyhedron, times: Real) {
        let scaled = |(neighbor, area)| Face { neighbor, area: times * area };
        self.original.extend(part.faces().map(scaled));
    }

    /// Subtracts the faces of `part`. Its face on a facet of the surface becomes a face of the cell.
    fn subtract(&mut self, part: &Polyhedron, sign: Real) {
        for (neighbor, area) in part.faces() {
            let is_facet = matches!(neighbor, Neighbor::Facet(_));
            let change = if is_facet { area } else { -sign * area };
            *self.changes.entry(neighbor).or_insert(0.0) += change;
        }
    }

    /// The faces with a positive area.
    pub(super) fn into_list(mut self) -> Vec<Face> {
        if !self.is_clipped {
            return self.original;
        }
        for face in &mut self.original {
            face.area += self.changes.remove(&face.neighbor).unwrap_or(0.0);
        }
        let rest = self.changes.into_iter().map(|(neighbor, area)| Face { neighbor, area });
        let mut faces: Vec<Face> = self.original.into_iter().chain(rest).collect();
        let size = faces.iter().map(|face| face.area).fold(0.0, Real::max);
        // A face that was removed may have a remainder from rounding.
        faces.retain(|face| face.area.abs() > 1e-12 * size);
        faces
    }
}
