//! Scratch: everything that can be recomputed. It is never saved.

use super::{
    Model, State,
    boundary::body::BodyMotion,
    membrane::MembraneScratch,
    state::{N_PATCHES, SurfaceHistory},
};
use crate::base::{Real, Vec3, real::Wrench};

/// Working memory of the substep.
#[derive(Clone)]
pub struct Scratch {
    /// Lists of possible contacts. Written by `neighbors`.
    pub neighbors: Neighbors,
    /// Data of each grain that pairs read, contiguous in memory. Written by `contact::grains`.
    pub grain_rows: Vec<GrainRow>,
    /// Force of each pair of grains. Written by `contact::grains`.
    pub pair_forces: Vec<PairForce>,
    /// Whether each pair is in contact. Written by `contact::grains`.
    pub pair_flags: Vec<ContactFlags>,
    /// Closest points of candidate triangles. Written by `contact::membrane`.
    pub candidates: CandidateScratch,
    /// Forces of the membrane on each grain. Written by `contact::membrane`.
    pub patch_forces: Vec<PatchForces>,
    /// Force of each listed vertex sphere on its grain. Written by `contact::spheres`.
    pub sphere_forces: Vec<SphereForce>,
    /// Forces of walls on grains, in the order of `Springs::walls`. Written by `contact::walls`.
    pub wall_forces: Vec<WallForce>,
    /// Contacts of grains with walls of triangles and with bodies, in the order of `SurfaceLists::ids`. Written by
    /// `contact::surfaces`.
    pub surface_contacts: Vec<Vec<SurfaceContact>>,
    /// Forces of bodies on samples of the membrane, body by body: all vertices, then all facets. Only listed
    /// samples touch. Written by `contact::bodies`.
    pub sample_forces: Vec<SampleForce>,
    /// Contact force on each vertex of the membrane (N). Written by `contact::sums`.
    pub vertex_forces: Vec<Vec3>,
    /// Internal forces and pressure. Written by `membrane::forces`.
    pub membrane: MembraneScratch,
    /// Wrench of membrane and grains on each body about its center of mass in this substep (N), (N m), world
    /// axes. Written by `contact::sums` and `contact::surfaces`.
    pub body_wrenches: Vec<Wrench>,
    /// Wrench of membrane, grains and air on each wall about its origin in this substep (N), (N m), world axes.
    /// Written by `contact::sums` and `contact::surfaces`.
    pub wall_wrenches: Vec<Wrench>,
    /// A grain whose center has left the membrane, if any. Written by `contact::sums` and, if grains touch
    /// vertex spheres, by `neighbors`.
    pub leaked: Option<usize>,
}

impl Scratch {
    /// Working memory for `model`.
    pub fn new(model: &Model) -> Self {
        Self {
            neighbors: Neighbors::default(),
            grain_rows: Vec::new(),
            pair_forces: Vec::new(),
            pair_flags: Vec::new(),
            candidates: CandidateScratch::default(),
            patch_forces: Vec::new(),
            sphere_forces: Vec::new(),
            wall_forces: Vec::new(),
            surface_contacts: Vec::new(),
            sample_forces: Vec::new(),
            vertex_forces: vec![Vec3::zeros(); model.membrane.mesh.n_vertices()],
            membrane: MembraneScratch::new(&model.membrane),
            body_wrenches: Vec::new(),
            wall_wrenches: vec![Wrench::zero(); model.walls.len()],
            leaked: None,
        }
    }

    /// Forces and ids of the pairs of grains in contact in the last substep, in list order.
    pub fn touching_pairs<'a>(
        &'a self,
        state: &'a State,
    ) -> impl Iterator<Item = (&'a PairForce, &'a [u32; 2])> {
        let pairs = self.pair_forces.iter().zip(&state.pair_ids).zip(&self.pair_flags);
        pairs.filter(|(_, flags)| flags.touches()).map(|(pair, _)| pair)
    }

    /// Number of pairs of grains that slide in the last substep.
    pub fn n_sliding_pairs(&self) -> usize {
        self.pair_flags.iter().filter(|flags| flags.slides()).count()
    }

    /// Forces of walls and bodies on the grains that touch them in the last substep, with the indices of wall and
    /// grain, in list order. Contacts with walls of triangles and with bodies come last, with the indices of
    /// `Model::surface`.
    pub fn touching_walls<'a>(
        &'a self,
        state: &'a State,
    ) -> impl Iterator<Item = (&'a WallForce, [usize; 2])> {
        let contacts = self.wall_forces.iter().zip(&state.springs.walls.ids);
        let surfaces = self.surface_contacts_with_ids().map(|(contact, ids)| (&contact.force, ids));
        contacts
            .chain(surfaces)
            .filter(|(contact, _)| contact.flags.touches())
            .map(|(contact, ids)| (contact, ids.map(|id| id as usize)))
    }

    /// Contacts with walls of triangles and with bodies in the last substep, with the indices of surface, as in
    /// `Model::surface`, and grain.
    pub fn surface_contacts_with_ids(&self) -> impl Iterator<Item = (&SurfaceContact, &[u32; 2])> {
        let of_grains = self.surface_contacts.iter().zip(&self.neighbors.surfaces.ids);
        of_grains.flat_map(|(contacts, ids)| contacts.iter().map(move |contact| (contact, ids)))
    }
}

/// Status of a contact in the last substep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct ContactFlags(u8);

impl ContactFlags {
    /// No contact.
    pub const NONE: Self = Self(0);
    /// Bit that is set for a contact.
    pub(super) const TOUCHES: u8 = 1;
    /// Bit that is set for a contact that slides.
    pub(super) const SLIDES: u8 = 2;

    /// A contact that slides or sticks.
    #[inline(always)]
    pub const fn contact(slides: bool) -> Self {
        Self(if slides { Self::TOUCHES | Self::SLIDES } else { Self::TOUCHES })
    }

    /// True if the bodies are in contact: they touch, or a force acts between them.
    #[inline(always)]
    pub const fn touches(self) -> bool {
        self.0 & Self::TOUCHES != 0
    }

    /// True if the contact is at Coulomb's limit.
    #[inline(always)]
    pub const fn slides(self) -> bool {
        self.0 & Self::SLIDES != 0
    }
}

/// Lists of possible contacts. They are complete until something has moved by half the skin.
#[derive(Clone, Default)]
pub struct Neighbors {
    /// False before the first build.
    pub is_built: bool,
    /// The skin at the last build (m): pairs are listed within contact, plus the range of the law, plus the skin.
    pub skin: Real,
    /// Substeps since the last build.
    pub n_since_build: u64,
    /// Positions of the grains at the last build (m).
    pub grain_positions: Vec<Vec3>,
    /// Positions of the vertices at the last build (m).
    pub vertex_positions: Vec<Vec3>,
    /// Position of the carrier, the first wall, at the last build (m).
    pub carrier_position: Vec3,
    /// Effective radius R* of each pair (m).
    pub pair_radii: Vec<Real>,
    /// Effective mass m* of each pair (kg).
    pub pair_masses: Vec<Real>,
    /// Pairs in which grain i is first are `first_starts[i] .. first_starts[i + 1]`.
    pub first_starts: Vec<u32>,
    /// Pairs in which grain i is second are at `second_starts[i] .. second_starts[i + 1]` in `second_pairs`.
    pub second_starts: Vec<u32>,
    /// Indices of pairs, sorted by their second grain.
    pub second_pairs: Vec<u32>,
    /// Candidate triangles of grain i are at `triangle_starts[i] .. triangle_starts[i + 1]` in `triangles`.
    pub triangle_starts: Vec<u32>,
    /// Candidate triangles, which a grain may touch, sorted by grain.
    pub triangles: Vec<u32>,
    /// Grain of each candidate triangle.
    pub candidate_grains: Vec<u32>,
    /// Grains with candidates, ascending.
    pub membrane_grains: Vec<u32>,
    /// Value of `travel` at which each candidate must be evaluated again (m).
    pub wake_at: Vec<Real>,
    /// Sum over the substeps since the last build of the largest displacements of any grain and any vertex,
    /// relative to the carrier (m). Written by `integrate`.
    pub travel: Real,
    /// Sum over all substeps of the largest displacement of any vertex, relative to the carrier (m). Written by
    /// `integrate`.
    pub vertex_travel: Real,
    /// Samples of the membrane near bodies. These lists are rebuilt independently of the others.
    pub bodies: BodyLists,
    /// Contacts of grain i with vertex spheres are `sphere_starts[i] .. sphere_starts[i + 1]`.
    pub sphere_starts: Vec<u32>,
    /// Contacts of grain i with walls are at `wall_starts[i] .. wall_starts[i + 1]` in `wall_contacts`.
    pub wall_starts: Vec<u32>,
    /// Indices of listed contacts with walls, sorted by grain.
    pub wall_contacts: Vec<u32>,
    /// Grains that walls of triangles and bodies may touch.
    pub surfaces: SurfaceLists,
    /// Motion of each wall at the last build.
    pub walls_at_build: Vec<BodyMotion>,
    /// Distance by which each wall may approach the grains, in addition to the skin, before it can touch one (m).
    pub wall_gaps: Vec<Real>,
    /// Bound of the distance of grains from the origin of each wall at the last build, plus the skin (m).
    pub wall_extents: Vec<Real>,
    /// Radii of the grains at the last build (m).
    pub radii: Vec<Real>,
    /// Largest growth of a radius since the last build (m).
    pub growth_max: Real,
    /// Largest squared displacement since the last build, relative to the carrier (m²).
    pub displacement_squared_max: Real,
    /// Number of builds so far.
    pub n_builds: u64,
}

/// Grains that walls of triangles and bodies may touch.
#[derive(Clone, Default)]
pub struct SurfaceLists {
    /// Surface, as in `Model::surface`, and grain of each entry; ascending.
    pub ids: Vec<[u32; 2]>,
    /// Candidate triangles of entry k are at `triangle_starts[k] .. triangle_starts[k + 1]` in `triangles`.
    pub triangle_starts: Vec<u32>,
    /// Triangles that the grain may touch, ascending for each entry.
    pub triangles: Vec<u32>,
    /// Entries of grain i are at `grain_starts[i] .. grain_starts[i + 1]` in `by_grain`.
    pub grain_starts: Vec<u32>,
    /// Indices of entries, sorted by grain.
    pub by_grain: Vec<u32>,
    /// The bodies at the last build.
    pub bodies_at_build: Vec<BodyMotion>,
    /// For each body, a bound of the distance of its own points or of all grains from its origin (m).
    pub extents: Vec<Real>,
    /// Distance by which each body may approach the grains, in addition to the skin, before it can touch one (m).
    pub gaps: Vec<Real>,
}

/// Samples of the membrane that bodies may touch. The lists are complete until samples and bodies have
/// approached each other by the skin.
#[derive(Clone, Default)]
pub struct BodyLists {
    /// False before the first build.
    pub is_built: bool,
    /// Samples near each body.
    pub near: Vec<NearSamples>,
    /// Motion of each body at the last build.
    pub bodies_at_build: Vec<BodyMotion>,
    /// Bound of the distance of near samples from the origin of each body (m).
    pub extents: Vec<Real>,
    /// Position of the carrier at the last build (m).
    pub carrier_position: Vec3,
    /// `Neighbors::vertex_travel` at the last build (m).
    pub travel_at_build: Real,
}

/// Samples of the membrane near one body.
#[derive(Clone, Default)]
pub struct NearSamples {
    /// Vertices, ascending.
    pub vertices: Vec<u32>,
    /// Facets, ascending.
    pub facets: Vec<u32>,
}

/// Closest points of the awake candidate triangles, see `contact::candidates`.
#[derive(Clone, Default)]
pub struct CandidateScratch {
    /// Indices of the awake candidates in `Neighbors::triangles`, ascending.
    pub awake: Vec<u32>,
    /// Awake candidates of the s-th grain of `Neighbors::membrane_grains` are at
    /// `awake_starts[s] .. awake_starts[s + 1]`.
    pub awake_starts: Vec<usize>,
    /// For each awake candidate: squared distance (m²), weights of the closest point, vector from the closest
    /// point to the grain's center (m), number of the feature.
    pub found: Vec<[Real; 8]>,
}

/// Data of a grain that pairs read.
#[derive(Clone, Copy, Default)]
#[repr(C, align(32))]
pub struct GrainRow {
    /// Position and radius (m).
    pub position_radius: [Real; 4],
    /// Velocity (m/s); the fourth number is unused.
    pub velocity: [Real; 4],
    /// Angular velocity (rad/s); the fourth number is unused.
    pub angular_velocity: [Real; 4],
}

/// Force between two grains.
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
// One row fills one cache line.
#[repr(C, align(64))]
pub struct PairForce {
    /// Force on the first grain (N).
    pub force: Vec3,
    /// Normal × tangential force (N): the torque per lever arm on both grains, negated.
    pub couple: Vec3,
    /// Overlap (m), zero without contact, negative where the grains attract each other from a distance.
    pub overlap: Real,
    /// Normal force (N), negative where the grains attract each other.
    pub normal: Real,
}

/// Forces of the membrane on one grain.
#[derive(Clone, Copy)]
pub struct PatchForces {
    /// Number of contacts.
    pub n: usize,
    /// Torque on the grain (N m).
    pub torque: Vec3,
    /// The contacts; the first `n` are in use.
    pub contacts: [PatchForce; N_PATCHES],
    /// True if the center of the grain is outside the membrane.
    pub is_outside: bool,
}

/// Force of one membrane patch on a grain.
#[derive(Clone, Copy)]
pub struct PatchForce {
    /// Triangle that carries the contact point.
    pub triangle: u32,
    /// Barycentric weights of the contact point.
    pub weights: [Real; 3],
    /// Force on the grain (N).
    pub force: Vec3,
    /// Overlap (m).
    pub overlap: Real,
    /// Normal force (N).
    pub normal: Real,
    /// Whether the contact slides.
    pub flags: ContactFlags,
}

impl PatchForces {
    /// No contact.
    pub const NONE: Self = Self {
        n: 0,
        torque: Vec3::new(0.0, 0.0, 0.0),
        contacts: [PatchForce {
            triangle: 0,
            weights: [0.0; 3],
            force: Vec3::new(0.0, 0.0, 0.0),
            overlap: 0.0,
            normal: 0.0,
            flags: ContactFlags::NONE,
        }; N_PATCHES],
        is_outside: false,
    };
}

/// Force of a vertex sphere of the membrane on a grain.
#[derive(Clone, Copy, Default)]
pub struct SphereForce {
    /// Vertex at the center of the sphere.
    pub vertex: u32,
    /// Force on the grain (N).
    pub force: Vec3,
    /// Torque on the grain (N m).
    pub torque: Vec3,
    /// Overlap (m), zero without contact.
    pub overlap: Real,
    /// Normal force (N).
    pub normal: Real,
    /// Whether grain and sphere touch.
    pub flags: ContactFlags,
}

/// Force of a wall on one grain.
#[derive(Clone, Copy, Debug, Default)]
pub struct WallForce {
    /// Force on the grain (N).
    pub force: Vec3,
    /// Contact point relative to the grain's center (m).
    pub arm: Vec3,
    /// Overlap (m), zero without contact, negative where the wall attracts the grain from a distance.
    pub overlap: Real,
    /// Normal force (N), negative where the wall attracts the grain, zero without contact.
    pub normal: Real,
    /// Whether a force acts. A grain that separates so fast that the normal force is zero does not count as
    /// touching.
    pub flags: ContactFlags,
}

/// A contact of a grain with a wall of triangles or a body.
#[derive(Clone, Debug)]
pub struct SurfaceContact {
    /// Its history.
    pub history: SurfaceHistory,
    /// Its force on the grain.
    pub force: WallForce,
    /// Share of the force of a single contact, see `boundary::touching`; included in `force`.
    pub share: Real,
}

/// Force of a body on a sample of the membrane.
#[derive(Clone, Copy)]
pub struct SampleForce {
    /// Force on the membrane (N).
    pub force: Vec3,
    /// Unit normal, from body to membrane.
    pub normal: Vec3,
    /// Position of the sample (m).
    pub point: Vec3,
    /// Overlap (m), negative without contact; then only the sign is meaningful.
    pub overlap: Real,
    /// Whether body and sample touch.
    pub flags: ContactFlags,
}

impl SampleForce {
    /// No contact.
    pub const NONE: Self = Self {
        force: Vec3::new(0.0, 0.0, 0.0),
        normal: Vec3::new(0.0, 0.0, 0.0),
        point: Vec3::new(0.0, 0.0, 0.0),
        overlap: Real::NEG_INFINITY,
        flags: ContactFlags::NONE,
    };
}
