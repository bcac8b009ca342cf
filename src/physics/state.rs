//! State: everything needed to continue a run. There is one `Vec` per quantity; the index is the id.

use super::{
    Model,
    boundary::{body::BodyMotion, motion::WallMemory, wall::CARRIER},
    membrane::MembraneState,
};
use crate::base::{Real, Vec3, digest::Digest};

/// Largest number of membrane patches that one grain can touch at the same time: the six faces around a
/// vertex that the vacuum has wrapped around it, and two more, for example in a fold. With a smaller limit, the
/// omitted patch would change from substep to substep, and the membrane would oscillate.
pub const N_PATCHES: usize = 8;

/// Everything that changes during a run.
#[derive(Clone, Debug)]
pub struct State {
    /// The grains.
    pub grains: Grains,
    /// Positions and velocities of the membrane's vertices.
    pub membrane: MembraneState,
    /// Friction springs of all contacts.
    pub springs: Springs,
    /// Pairs of grains that the pair springs belong to. Written by `neighbors`.
    pub pair_ids: Vec<[u32; 2]>,
    /// Gauge pressure in the chamber, negative under vacuum (Pa). Written by `chamber`.
    pub gauge: Real,
    /// Pose and velocity of each wall. Written by `integrate` from the controls.
    pub walls: Vec<BodyMotion>,
    /// What each wall's motion needs to continue; empty if no wall needs it. Written by `System::step`.
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

/// History of all contacts: tangential springs, which are the history of friction, and what else the law
/// stores.
#[derive(Clone, Debug, Default)]
pub struct Springs {
    /// Spring of each listed pair of grains (m), zero without contact. Written by `contact::grains`.
    pub pairs: Vec<Vec3>,
    /// Other history of each listed pair of grains, a number in the units of the law; empty for a law
    /// without cohesion. Written by
    /// `contact::grains`.
    pub pair_memories: Vec<Real>,
    /// Membrane contacts of each grain. Written by `contact::membrane`.
    pub patches: Vec<Patches>,
    /// Contacts of grains with the membrane's vertex spheres. Written by `contact::spheres`.
    pub spheres: ListedSprings,
    /// Contacts of walls with grains. Written by `contact::walls`.
    pub walls: ListedSprings,
    /// Contacts of grains with walls of triangles and with bodies. Written by `contact::surfaces`.
    pub surfaces: SurfaceHistories,
    /// Springs between membrane samples and bodies (m), body by body: all vertices, then all facets. Written
    /// by `contact::bodies`.
    pub bodies: Vec<Vec3>,
}

impl Springs {
    /// No contacts, for `n_grains` grains and `n_samples` samples of the membrane on all bodies.
    pub fn none(n_grains: usize, n_samples: usize) -> Self {
        Self {
            pairs: Vec::new(),
            pair_memories: Vec::new(),
            patches: vec![Patches::NONE; n_grains],
            spheres: ListedSprings::default(),
            walls: ListedSprings::default(),
            surfaces: SurfaceHistories::default(),
            bodies: vec![Vec3::zeros(); n_samples],
        }
    }
}

/// Springs of listed contacts, between grains and vertex spheres or between walls and grains.
#[derive(Clone, Debug, Default)]
pub struct ListedSprings {
    /// Ids of grain and vertex, or of wall and grain; ascending. Written by `neighbors`.
    pub ids: Vec<[u32; 2]>,
    /// Spring of each contact (m), zero without contact.
    pub springs: Vec<Vec3>,
    /// Other history of each contact, a number in the units of the law; empty for a law without cohesion.
    pub memories: Vec<Real>,
}

impl ListedSprings {
    /// Springs between walls and grains for all grains, wall by wall; zero for contacts that are not listed.
    pub fn dense(&self, n_walls: usize, n_grains: usize) -> impl Iterator<Item = Vec3> {
        let mut listed = self.ids.iter().zip(&self.springs).peekable();
        let all = (0..n_walls).flat_map(move |wall| (0..n_grains).map(move |grain| [wall, grain]));
        all.map(move |at| {
            let here = listed.next_if(|(ids, _)| ids.map(|id| id as usize) == at);
            here.map_or_else(Vec3::zeros, |(_, spring)| *spring)
        })
    }
}

/// History of contacts of grains with walls of triangles and with bodies. A grain may have several contacts with
/// the same surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceHistories {
    /// Surface, as in `Model::surface`, and grain of each contact; ascending.
    pub ids: Vec<[u32; 2]>,
    /// History of each contact.
    pub histories: Vec<SurfaceHistory>,
}

/// History of one contact of a grain with a surface. The contact persists while the grain slides or rolls from
/// triangle to triangle.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceHistory {
    /// Tangential spring (m).
    pub spring: Vec3,
    /// Unit normal in the last substep, from the surface to the grain.
    pub normal: Vec3,
    /// Other history, numbers in the units of the law; empty for a law without cohesion.
    pub memory: Vec<Real>,
}

/// One patch of membrane that a grain touches. The contact persists while the grain slides from triangle to
/// triangle.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Tangential spring (m).
    pub spring: Vec3,
    /// Unit normal in the last substep, from membrane to grain.
    pub normal: Vec3,
}

/// The membrane contacts of one grain.
#[derive(Clone, Copy, Debug)]
pub struct Patches {
    /// Number of slots in use.
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
    /// A state of `model` at rest without contacts: the membrane in its reference shape, the walls at
    /// `walls`, the air at atmospheric pressure.
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

    /// Position of the carrier, which is the first wall (m); zero without walls.
    pub fn carrier_position(&self) -> Vec3 {
        self.walls.get(CARRIER).map_or_else(Vec3::zeros, |it| it.pose.translation.vector)
    }

    /// Adds every number of the state to `digest`, in a fixed order.
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

    /// Adds only loaded springs: which pairs without contact are listed is not part of the physics.
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
        // As if every grain were listed for every wall: which contacts are listed is not part of the physics.
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
        let surfaces = &self.springs.surfaces;
        for (ids, history) in surfaces.ids.iter().zip(&surfaces.histories) {
            digest.integer(id(ids));
            digest.vectors(&[history.spring, history.normal]);
            digest.reals(&history.memory);
        }
    }
}
