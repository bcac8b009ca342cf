//! Scratch: what can be recomputed. Never saved.

use super::{
    Model, State,
    boundary::body::BodyMotion,
    membrane::MembraneScratch,
    state::{N_PATCHES, Place},
};
use crate::base::{Real, Vec3, real::Wrench};

/// Working memory of the substep.
#[derive(Clone)]
pub struct Scratch {
    /// Who may touch whom. Written by `neighbours`.
    pub neighbours: Neighbours,
    /// What pairs need of the grains. Written by `contact::grains`.
    pub grain_rows: Vec<GrainRow>,
    /// Force of each pair of grains. Written by `contact::grains`.
    pub pair_forces: Vec<PairForce>,
    /// Whether each pair is in contact. Written by `contact::grains`.
    pub pair_flags: Vec<ContactFlags>,
    /// Closest points of candidate triangles. Written by `contact::membrane`.
    pub candidates: CandidateScratch,
    /// What the membrane does to each grain. Written by `contact::membrane`.
    pub patch_forces: Vec<PatchForces>,
    /// Force of each listed vertex sphere on its grain. Written by `contact::spheres`.
    pub sphere_forces: Vec<SphereForce>,
    /// What walls do to grains, in the order of `Springs::walls`. Written by `contact::walls`.
    pub wall_forces: Vec<WallForce>,
    /// What walls of triangles and bodies do to grains, in the order of `PlaceLists::ids`. Written by
    /// `contact::places`.
    pub places: Vec<Vec<PlaceContact>>,
    /// What bodies do to samples of the membrane, body by body: all vertices, then all facets; none but the
    /// listed ones touch. Written by `contact::bodies`.
    pub sample_forces: Vec<SampleForce>,
    /// Contact force on each vertex of the membrane (N). Written by `contact::on_membrane`.
    pub vertex_forces: Vec<Vec3>,
    /// Internal forces and pressure. Written by `membrane::forces`.
    pub membrane: MembraneScratch,
    /// Wrench of membrane and grains on each body about its center of mass, this substep (N), (N m).
    /// Written by `contact::on_membrane` and `contact::places`.
    pub body_wrenches: Vec<Wrench>,
    /// Wrench of membrane, grains and air on each wall about its origin, world axes, this substep
    /// (N), (N m). Written by `contact::on_walls` and `contact::places`.
    pub wall_wrenches: Vec<Wrench>,
    /// Grains whose center left the bag, if any. Written by `contact::on_membrane` and, if grains
    /// touch vertex spheres, by `neighbours`.
    pub leaked: Option<usize>,
}

impl Scratch {
    /// Working memory for `model`.
    pub fn new(model: &Model) -> Self {
        Self {
            neighbours: Neighbours::default(),
            grain_rows: Vec::new(),
            pair_forces: Vec::new(),
            pair_flags: Vec::new(),
            candidates: CandidateScratch::default(),
            patch_forces: Vec::new(),
            sphere_forces: Vec::new(),
            wall_forces: Vec::new(),
            places: Vec::new(),
            sample_forces: Vec::new(),
            vertex_forces: vec![Vec3::zeros(); model.membrane.mesh.n_vertices()],
            membrane: MembraneScratch::new(&model.membrane),
            body_wrenches: Vec::new(),
            wall_wrenches: vec![Wrench::zero(); model.walls.len()],
            leaked: None,
        }
    }

    /// Forces and ids of the pairs of grains that were in contact in the last substep, in the order of the
    /// list.
    pub fn touching_pairs<'a>(
        &'a self,
        state: &'a State,
    ) -> impl Iterator<Item = (&'a PairForce, &'a [u32; 2])> {
        let pairs = self.pair_forces.iter().zip(&state.pair_ids).zip(&self.pair_flags);
        pairs.filter(|(_, flags)| flags.touches()).map(|(pair, _)| pair)
    }

    /// Number of pairs of grains that slid in the last substep.
    pub fn n_sliding_pairs(&self) -> usize {
        self.pair_flags.iter().filter(|flags| flags.slides()).count()
    }

    /// Forces of the walls on the grains that were pressed on them in the last substep, with wall and
    /// grain, in the order of the lists. Contacts with walls of triangles and with bodies follow the others;
    /// these have the numbers of `Model::surface`.
    pub fn touching_walls<'a>(
        &'a self,
        state: &'a State,
    ) -> impl Iterator<Item = (&'a WallForce, [usize; 2])> {
        let contacts = self.wall_forces.iter().zip(&state.springs.walls.ids);
        let places = self.place_contacts().map(|(contact, ids)| (&contact.force, ids));
        contacts
            .chain(places)
            .filter(|(contact, _)| contact.flags.touches())
            .map(|(contact, ids)| (contact, ids.map(|id| id as usize)))
    }

    /// Contacts with walls of triangles and with bodies in the last substep, each with its surface, as in
    /// `Model::surface`, and its grain.
    pub fn place_contacts(&self) -> impl Iterator<Item = (&PlaceContact, &[u32; 2])> {
        let of_grains = self.places.iter().zip(&self.neighbours.places.ids);
        of_grains.flat_map(|(contacts, ids)| contacts.iter().map(move |contact| (contact, ids)))
    }
}

/// What became of a contact in the last substep.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(transparent)]
pub struct ContactFlags(u8);

impl ContactFlags {
    /// No contact.
    pub const NONE: Self = Self(0);
    /// The bit of contacts.
    pub(super) const TOUCHES: u8 = 1;
    /// The bit of contacts that slide.
    pub(super) const SLIDES: u8 = 2;

    /// A contact that sticks or slides.
    #[inline(always)]
    pub const fn contact(slides: bool) -> Self {
        Self(if slides { Self::TOUCHES | Self::SLIDES } else { Self::TOUCHES })
    }

    /// True if the two are in contact: they touch, or a force acts between them.
    #[inline(always)]
    pub const fn touches(self) -> bool {
        self.0 & Self::TOUCHES != 0
    }

    /// True if the contact has reached Coulomb's limit.
    #[inline(always)]
    pub const fn slides(self) -> bool {
        self.0 & Self::SLIDES != 0
    }
}

/// Lists of possible contacts, valid until something has moved by half the skin.
#[derive(Clone, Default)]
pub struct Neighbours {
    /// False before the first build.
    pub is_built: bool,
    /// Distance beyond contact and the range of the law within which grains were listed at the last build (m).
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
    /// Where the pairs in which grain i is second begin in `second_pairs`.
    pub second_starts: Vec<u32>,
    /// Indices of pairs, by their second grain.
    pub second_pairs: Vec<u32>,
    /// Where the candidate triangles of grain i begin in `triangles`.
    pub triangle_starts: Vec<u32>,
    /// Triangles that a grain may touch, by grain.
    pub triangles: Vec<u32>,
    /// Whose candidate each one is.
    pub candidate_grains: Vec<u32>,
    /// Grains with candidates, ascending.
    pub membrane_grains: Vec<u32>,
    /// The travel at which each candidate must be looked at again (m).
    pub wake_at: Vec<Real>,
    /// Sum of the largest steps of any grain and any vertex since the last build, relative to the
    /// carrier (m). Written by `integrate`.
    pub travel: Real,
    /// Sum of the largest steps of any vertex, relative to the carrier (m). Written by `integrate`.
    pub vertex_travel: Real,
    /// Samples of the membrane near bodies; they are listed at times of their own.
    pub bodies: BodyLists,
    /// Contacts of grain i with vertex spheres are `sphere_starts[i] .. sphere_starts[i + 1]`.
    pub sphere_starts: Vec<u32>,
    /// Where the contacts of grain i with walls begin in `wall_contacts`.
    pub wall_starts: Vec<u32>,
    /// Indices of listed contacts with walls, by grain.
    pub wall_contacts: Vec<u32>,
    /// Grains that walls of triangles and bodies may touch.
    pub places: PlaceLists,
    /// The walls at the last build.
    pub walls_at_build: Vec<BodyMotion>,
    /// How much nearer each wall may come to the grains, beside the skin, before it can touch one (m).
    pub wall_gaps: Vec<Real>,
    /// No grain was further than this, and the skin, from the origin of each wall (m).
    pub wall_extents: Vec<Real>,
    /// Radii of the grains at the last build (m).
    pub radii: Vec<Real>,
    /// The most that a radius has grown since the last build (m).
    pub growth_max: Real,
    /// Largest squared displacement since the last build, relative to the carrier (m²).
    pub displacement_squared_max: Real,
    /// How often the lists were built.
    pub n_builds: u64,
}

/// Grains that a surface may touch in several places.
#[derive(Clone, Default)]
pub struct PlaceLists {
    /// Surface, as in `Model::surface`, and grain of each; ascending.
    pub ids: Vec<[u32; 2]>,
    /// Where the triangles of each begin in `triangles`.
    pub triangle_starts: Vec<u32>,
    /// Triangles that the grain may touch, ascending for each.
    pub triangles: Vec<u32>,
    /// Where those of grain i begin in `by_grain`.
    pub grain_starts: Vec<u32>,
    /// Indices in `ids`, by grain.
    pub by_grain: Vec<u32>,
    /// The bodies at the last build.
    pub bodies_at_build: Vec<BodyMotion>,
    /// Of each body: no grain or no part of the body was further than this from its origin (m).
    pub extents: Vec<Real>,
    /// How much nearer each body may come to the grains, beside the skin, before it can touch one (m).
    pub gaps: Vec<Real>,
}

/// Samples of the membrane that bodies may touch, valid until one of both has moved by the skin.
#[derive(Clone, Default)]
pub struct BodyLists {
    /// False before the first build.
    pub is_built: bool,
    /// By body.
    pub near: Vec<NearSamples>,
    /// The bodies at the last build.
    pub bodies_at_build: Vec<BodyMotion>,
    /// No near sample was further than this from the origin of each body (m).
    pub extents: Vec<Real>,
    /// Position of the carrier at the last build (m).
    pub carrier_position: Vec3,
    /// `Neighbours::vertex_travel` at the last build (m).
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

/// Closest points of the candidate triangles that are awake.
#[derive(Clone, Default)]
pub struct CandidateScratch {
    /// Candidates that are awake, ascending: their places in `Neighbours::triangles`.
    pub awake: Vec<u32>,
    /// Where those of each grain of `Neighbours::membrane_grains` begin.
    pub awake_starts: Vec<usize>,
    /// Of each: squared distance (m²), weights of the closest point, the vector from there to the
    /// grain's center (m), the number of the feature.
    pub found: Vec<[Real; 8]>,
}

/// What pairs need of a grain.
#[derive(Clone, Copy, Default)]
#[repr(C, align(32))]
pub struct GrainRow {
    /// Position and radius (m).
    pub place: [Real; 4],
    /// Velocity (m/s), and nothing.
    pub velocity: [Real; 4],
    /// Angular velocity (rad/s), and nothing.
    pub angular_velocity: [Real; 4],
}

/// Force between two grains.
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
// A row in one line of the cache.
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
    /// How many contacts.
    pub n: usize,
    /// Torque on the grain (N m).
    pub torque: Vec3,
    /// The contacts.
    pub contacts: [PatchForce; N_PATCHES],
    /// True if the center of the grain is outside the bag.
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
    /// Vertex that carries the sphere.
    pub vertex: u32,
    /// Force on the grain (N).
    pub force: Vec3,
    /// Torque on the grain (N m).
    pub torque: Vec3,
    /// Overlap (m), zero without contact.
    pub overlap: Real,
    /// Normal force (N).
    pub normal: Real,
    /// Whether they touch.
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
    /// Whether a force acts. A grain that leaves so fast that nothing presses it does not touch.
    pub flags: ContactFlags,
}

/// A contact of a grain with a surface that it may touch in several places.
#[derive(Clone, Debug)]
pub struct PlaceContact {
    /// What it remembers.
    pub place: Place,
    /// Its force on the grain.
    pub force: WallForce,
    /// Share of the force of a single contact that is in `force`, see `boundary::touching`.
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
    /// Overlap (m); without contact a lower bound.
    pub overlap: Real,
    /// Whether they touch.
    pub flags: ContactFlags,
}

impl SampleForce {
    /// Out of reach.
    pub const NONE: Self = Self {
        force: Vec3::new(0.0, 0.0, 0.0),
        normal: Vec3::new(0.0, 0.0, 0.0),
        point: Vec3::new(0.0, 0.0, 0.0),
        overlap: Real::NEG_INFINITY,
        flags: ContactFlags::NONE,
    };
}
