//! State: all that must be known to go on. One `Vec` per quantity, index = id.

use super::{
    Model,
    boundary::{body::BodyMotion, motion::WallMemory, wall::CARRIER},
    membrane::MembraneState,
};
use crate::base::{Real, Vec3, digest::Digest};

/// Membrane patches that one grain can touch at the same time: the six faces around a vertex that
/// the vacuum has drawn over it like a cup, and two more, for example in a fold. If one of them were
/// left out, which one would change from substep to substep, and the membrane would ring.
pub const N_PATCHES: usize = 8;

/// Everything that evolves.
#[derive(Clone, Debug)]
pub struct State {
    /// The grains.
    pub grains: Grains,
    /// Positions and velocities of the membrane's vertices.
    pub membrane: MembraneState,
    /// Friction springs of all contacts.
    pub springs: Springs,
    /// Which pairs of grains the pair springs belong to. Written by `neighbours`.
    pub pair_ids: Vec<[u32; 2]>,
    /// Gauge pressure in the chamber, negative under vacuum (Pa). Written by `chamber`.
    pub gauge: Real,
    /// Where the walls are and how they move. Written by `integrate` from the controls.
    pub walls: Vec<BodyMotion>,
    /// What the motions of the walls go on from, one for each wall; empty where no wall needs it.
    /// Written by `System::step`.
    pub wall_memory: Vec<WallMemory>,
}

/// The grains.
#[derive(Clone, Debug, Default)]
pub struct Grains {
    /// Positions of the centers (m). Written by `integrate`.
    pub positions: Vec<Vec3>,
    /// Velocities (m/s). Written by `integrate`.
    pub velocities: Vec<Vec3>,
    /// Angular velocities (rad/s). Written by `integrate`.
    pub angular_velocities: Vec<Vec3>,
    /// Radii (m); they change only while grains grow. Written by `fill`.
    pub radii: Vec<Real>,
    /// Masses (kg). Written by `fill`.
    pub masses: Vec<Real>,
}

impl Grains {
    /// At rest at `positions` (m).
    pub fn at_rest(positions: Vec<Vec3>, radii: Vec<Real>, masses: Vec<Real>) -> Self {
        let velocities = vec![Vec3::zeros(); positions.len()];
        let angular_velocities = velocities.clone();
        Self { positions, velocities, angular_velocities, radii, masses }
    }

    /// Mean radius (m), 0 without grains.
    pub fn mean_radius(&self) -> Real {
        self.radii.iter().sum::<Real>() / self.len().max(1) as Real
    }

    /// Number of grains.
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// True without any grain.
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// What all contacts remember: their tangential springs, the history of friction, and whatever else
/// their law asks for.
#[derive(Clone, Debug, Default)]
pub struct Springs {
    /// Of each listed pair of grains, zero without contact (m). Written by `contact::grains`.
    pub pairs: Vec<Vec3>,
    /// What else each listed pair of grains remembers; nothing under a law without cohesion. Written by
    /// `contact::grains`.
    pub pair_memories: Vec<Real>,
    /// Membrane contacts of each grain. Written by `contact::membrane`.
    pub patches: Vec<Patches>,
    /// Contacts of grains with the membrane's vertex spheres.
    pub spheres: ListedSprings,
    /// Contacts of walls with grains. Written by `contact::walls`.
    pub walls: ListedSprings,
    /// Contacts of grains with walls of triangles and with bodies. Written by `contact::places`.
    pub places: PlaceSprings,
    /// Of membrane samples with bodies (m), body by body: all vertices, then all facets. Written
    /// by `contact::bodies`.
    pub bodies: Vec<Vec3>,
}

impl Springs {
    /// No contact yet, for `n_grains` grains and `n_samples` samples of the membrane on all bodies.
    pub fn none(n_grains: usize, n_samples: usize) -> Self {
        Self {
            pairs: Vec::new(),
            pair_memories: Vec::new(),
            patches: vec![Patches::NONE; n_grains],
            spheres: ListedSprings::default(),
            walls: ListedSprings::default(),
            places: PlaceSprings::default(),
            bodies: vec![Vec3::zeros(); n_samples],
        }
    }
}

/// Springs of listed contacts: of grains with vertex spheres, or of walls with grains.
#[derive(Clone, Debug, Default)]
pub struct ListedSprings {
    /// Grain and vertex of each, or wall and grain; ascending. Written by `neighbours`.
    pub ids: Vec<[u32; 2]>,
    /// Zero without contact (m).
    pub springs: Vec<Vec3>,
    /// What else each contact remembers; nothing under a law without cohesion.
    pub memories: Vec<Real>,
}

impl ListedSprings {
    /// The springs of contacts of walls with grains, wall by wall, zero for those that are not listed.
    pub fn dense(&self, n_walls: usize, n_grains: usize) -> impl Iterator<Item = Vec3> {
        let mut listed = self.ids.iter().zip(&self.springs).peekable();
        let all = (0..n_walls).flat_map(move |wall| (0..n_grains).map(move |grain| [wall, grain]));
        all.map(move |at| {
            let here = listed.next_if(|(ids, _)| ids.map(|id| id as usize) == at);
            here.map_or_else(Vec3::zeros, |(_, spring)| *spring)
        })
    }
}

/// Contacts of grains with surfaces that they may touch in several places: one entry for each place.
#[derive(Clone, Debug, Default)]
pub struct PlaceSprings {
    /// Surface, as in `Model::surface`, and grain of each; ascending.
    pub ids: Vec<[u32; 2]>,
    /// What each contact remembers.
    pub places: Vec<Place>,
}

/// One place where a grain touches a surface: the contact persists while the grain slides or rolls from
/// triangle to triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    /// Tangential spring (m).
    pub spring: Vec3,
    /// Normal at the last substep, from the surface to the grain.
    pub normal: Vec3,
    /// What else the contact remembers; nothing under a law without cohesion.
    pub memory: Vec<Real>,
}

/// One patch of membrane that a grain touches: the contact lives on while the grain slides from
/// triangle to triangle.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Tangential spring (m).
    pub spring: Vec3,
    /// Normal at the last substep, from membrane to grain.
    pub normal: Vec3,
}

/// The membrane contacts of one grain.
#[derive(Clone, Copy, Debug)]
pub struct Patches {
    /// How many of the slots are in use.
    pub n: usize,
    /// The contacts.
    pub slots: [Patch; N_PATCHES],
}

impl Patches {
    /// No contact.
    pub const NONE: Self = Self {
        n: 0,
        slots: [Patch { spring: Vec3::new(0.0, 0.0, 0.0), normal: Vec3::new(0.0, 0.0, 0.0) };
            N_PATCHES],
    };
}

impl State {
    /// Grains at rest in `model` without any contact, its membrane in its reference shape, walls at
    /// `walls`, air at atmospheric pressure.
    pub fn at_rest(model: &Model, walls: Vec<BodyMotion>, grains: Grains) -> Self {
        let n_samples = model.n_samples() * model.bodies.len();
        Self {
            springs: Springs::none(grains.len(), n_samples),
            grains,
            membrane: MembraneState::at_rest(&model.membrane.mesh),
            pair_ids: Vec::new(),
            gauge: 0.0,
            walls,
            wall_memory: Vec::new(),
        }
    }

    /// Position of the carrier, the first wall (m); zero without walls.
    pub fn carrier_position(&self) -> Vec3 {
        self.walls.get(CARRIER).map_or_else(Vec3::zeros, |it| it.pose.translation.vector)
    }

    /// Adds every number of the state in a fixed order.
    pub fn digest(&self, digest: &mut Digest) {
        digest.vectors(&self.grains.positions);
        digest.vectors(&self.grains.velocities);
        digest.vectors(&self.grains.angular_velocities);
        digest.reals(&self.grains.radii);
        digest.vectors(&self.membrane.positions);
        digest.vectors(&self.membrane.velocities);
        self.digest_springs(digest);
        digest.real(self.gauge);
        for wall in &self.walls {
            digest.reals(wall.pose.translation.vector.as_slice());
            digest.reals(wall.pose.rotation.coords.as_slice());
            digest.vectors(&[wall.twist.linear, wall.twist.angular]);
        }
        for memory in &self.wall_memory {
            digest.reals(&[memory.time, memory.force]);
        }
    }

    /// Only loaded springs count: which empty pairs are listed is not part of the physics.
    fn digest_springs(&self, digest: &mut Digest) {
        let Springs { pairs, pair_memories, spheres, walls, .. } = &self.springs;
        let id = |ids: &[u32; 2]| u64::from(ids[0]) << 32 | u64::from(ids[1]);
        let mut loaded = |ids: &[[u32; 2]], springs: &[Vec3]| {
            for (ids, spring) in ids.iter().zip(springs) {
                if *spring != Vec3::zeros() {
                    digest.integer(id(ids));
                    digest.reals(spring.as_slice());
                }
            }
        };
        loaded(&self.pair_ids, pairs);
        loaded(&spheres.ids, &spheres.springs);
        for patches in &self.springs.patches {
            digest.integer(patches.n as u64);
            for patch in &patches.slots[..patches.n] {
                digest.vectors(&[patch.spring, patch.normal]);
            }
        }
        // As if every grain were listed with every wall: what is listed is not part of the physics.
        for spring in walls.dense(self.walls.len(), self.grains.len()) {
            digest.reals(spring.as_slice());
        }
        digest.vectors(&self.springs.bodies);
        for (ids, memories) in [(&self.pair_ids, pair_memories), (&walls.ids, &walls.memories)] {
            let width = memories.len() / ids.len().max(1);
            for (ids, memory) in ids.iter().zip(memories.chunks_exact(width.max(1))) {
                if memory.iter().any(|it| *it != 0.0) {
                    digest.integer(id(ids));
                    digest.reals(memory);
                }
            }
        }
        let places = &self.springs.places;
        for (ids, place) in places.ids.iter().zip(&places.places) {
            digest.integer(id(ids));
            digest.vectors(&[place.spring, place.normal]);
            digest.reals(&place.memory);
        }
    }
}
