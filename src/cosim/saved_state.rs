//! Serialized states: the settled start state of a scene, and checkpoints of a run.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use crate::{
    base::{Pose, Quat, Real, Vec3, real::Twist},
    physics::{
        State,
        boundary::{body::BodyMotion, motion::WallMemory},
        membrane::MembraneState,
        state::{
            Grains, ListedSprings, N_PATCHES, Patch, Patches, Springs, SurfaceHistories,
            SurfaceHistory,
        },
    },
};

/// Why a saved state cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SavedStateError {
    /// The digest at the end does not match the bytes before it.
    #[error("saved state: {n_bytes} bytes are truncated or corrupt; the state is recomputed")]
    Corrupt {
        /// Number of bytes.
        n_bytes: usize,
    },
    /// The state belongs to another scene.
    #[error("saved state: {found} {what}, but the scene has {expected}; the state is recomputed")]
    OtherScene {
        /// What differs.
        what: &'static str,
        /// Number in the saved state.
        found: usize,
        /// Number in the scene.
        expected: usize,
    },
}

/// The numbers of a state, in the order in which they are written.
#[derive(Serialize, Deserialize)]
struct Numbers {
    grain_positions: Vec<[Real; 3]>,
    grain_velocities: Vec<[Real; 3]>,
    grain_spins: Vec<[Real; 3]>,
    radii: Vec<Real>,
    masses: Vec<Real>,
    vertex_positions: Vec<[Real; 3]>,
    vertex_velocities: Vec<[Real; 3]>,
    pair_ids: Vec<[u32; 2]>,
    pair_springs: Vec<[Real; 3]>,
    patches: Vec<Vec<[Real; 6]>>,
    wall_springs: Vec<[Real; 3]>,
    body_springs: Vec<[Real; 3]>,
    gauge: Real,
    walls: Vec<[Real; 13]>,
    sphere_ids: Vec<[u32; 2]>,
    sphere_springs: Vec<[Real; 3]>,
}

/// History variables of contacts besides their springs. Written after the numbers, if there are any.
#[derive(Default, Serialize, Deserialize)]
struct Memories {
    pairs: Vec<Real>,
    /// Listed contacts of walls with grains.
    wall_ids: Vec<[u32; 2]>,
    walls: Vec<Real>,
}

/// History of contacts of grains with walls of triangles and with bodies. It follows the memories of walls.
#[derive(Default, Serialize, Deserialize)]
struct Surfaces {
    ids: Vec<[u32; 2]>,
    /// Springs and normals.
    histories: Vec<[Real; 6]>,
    memories: Vec<Vec<Real>>,
}

const DIGEST_BYTES: usize = 8;

/// Serializes the complete `state`.
pub fn write(state: &State) -> Vec<u8> {
    let numbers = Numbers {
        grain_positions: arrays(&state.grains.positions),
        grain_velocities: arrays(&state.grains.velocities),
        grain_spins: arrays(&state.grains.angular_velocities),
        radii: state.grains.radii.clone(),
        masses: state.grains.masses.clone(),
        vertex_positions: arrays(&state.membrane.positions),
        vertex_velocities: arrays(&state.membrane.velocities),
        pair_ids: state.pair_ids.clone(),
        pair_springs: arrays(&state.springs.pairs),
        patches: state.springs.patches.iter().map(patch_rows).collect(),
        wall_springs: wall_springs(state),
        body_springs: arrays(&state.springs.bodies),
        gauge: state.gauge,
        walls: state.walls.iter().map(motion_row).collect(),
        sphere_ids: state.springs.spheres.ids.clone(),
        sphere_springs: arrays(&state.springs.spheres.springs),
    };
    let mut bytes =
        postcard::to_stdvec(&numbers).expect("a list of numbers can always be serialized");
    let memories = Memories {
        pairs: state.springs.pair_memories.clone(),
        wall_ids: state.springs.walls.ids.clone(),
        walls: state.springs.walls.memories.clone(),
    };
    let is_cohesive = !memories.pairs.is_empty() || !memories.walls.is_empty();
    let has_wall_memory = !state.wall_memory.is_empty();
    let has_surfaces = !state.springs.surfaces.ids.is_empty();
    // Only cohesive laws, walls whose motion depends on time or load, walls of triangles and bodies that
    // grains touch have history variables. Without them, the bytes equal those of earlier versions.
    if is_cohesive || has_wall_memory || has_surfaces {
        let memories = if is_cohesive { memories } else { Memories::default() };
        bytes = postcard::to_extend(&memories, bytes)
            .expect("a list of numbers can always be serialized");
    }
    if has_wall_memory || has_surfaces {
        let walls: Vec<[Real; 2]> =
            state.wall_memory.iter().map(|it| [it.time, it.force]).collect();
        bytes =
            postcard::to_extend(&walls, bytes).expect("a list of numbers can always be serialized");
    }
    if has_surfaces {
        let surfaces = Surfaces::of(&state.springs.surfaces);
        bytes = postcard::to_extend(&surfaces, bytes)
            .expect("a list of numbers can always be serialized");
    }
    with_digest(bytes)
}

/// The data after a state: history variables of contacts, of walls, and of contacts with surfaces.
type Rest = (Memories, Vec<WallMemory>, Surfaces);

/// Reads the history variables. Data missing at the end is empty.
fn read_rest(rest: &[u8]) -> Result<Rest, postcard::Error> {
    let (memories, rest) = take_or_default(rest)?;
    let (walls, rest): (Vec<[Real; 2]>, _) = take_or_default(rest)?;
    let (surfaces, _) = take_or_default(rest)?;
    let walls = walls.into_iter().map(|[time, force]| WallMemory { time, force }).collect();
    Ok((memories, walls, surfaces))
}

fn take_or_default<'a, T: Default + Deserialize<'a>>(
    rest: &'a [u8],
) -> Result<(T, &'a [u8]), postcard::Error> {
    if rest.is_empty() { Ok((T::default(), rest)) } else { postcard::take_from_bytes(rest) }
}

impl Surfaces {
    fn of(springs: &SurfaceHistories) -> Self {
        let row = |it: &SurfaceHistory| {
            let (spring, normal) = (it.spring, it.normal);
            [spring.x, spring.y, spring.z, normal.x, normal.y, normal.z]
        };
        Self {
            ids: springs.ids.clone(),
            histories: springs.histories.iter().map(row).collect(),
            memories: springs.histories.iter().map(|it| it.memory.clone()).collect(),
        }
    }

    fn springs(self) -> Result<SurfaceHistories, SavedStateError> {
        check_counts(&[
            ("springs on surfaces", self.histories.len(), self.ids.len()),
            ("memories on surfaces", self.memories.len(), self.ids.len()),
        ])?;
        let history = |(row, memory): (&[Real; 6], Vec<Real>)| {
            let &[sx, sy, sz, nx, ny, nz] = row;
            SurfaceHistory { spring: Vec3::new(sx, sy, sz), normal: Vec3::new(nx, ny, nz), memory }
        };
        let histories = self.histories.iter().zip(self.memories).map(history).collect();
        Ok(SurfaceHistories { ids: self.ids, histories })
    }
}

/// True if both states are equal to the bit. As in the digest, only loaded springs count: which
/// unloaded pairs are listed depends on when the neighbor lists were built.
pub(crate) fn is_same(one: State, other: State) -> bool {
    let bytes = |mut state: State| {
        let Springs { pairs, pair_memories, spheres, walls, .. } = &mut state.springs;
        keep_loaded(&mut state.pair_ids, pairs, pair_memories);
        keep_loaded(&mut spheres.ids, &mut spheres.springs, &mut spheres.memories);
        keep_loaded(&mut walls.ids, &mut walls.springs, &mut walls.memories);
        write(&state)
    };
    bytes(one) == bytes(other)
}

/// Drops entries without load and without history.
fn keep_loaded(ids: &mut Vec<[u32; 2]>, springs: &mut Vec<Vec3>, memories: &mut Vec<Real>) {
    let width = memories.len() / ids.len().max(1);
    let remembers = |k: usize| memories[k * width..(k + 1) * width].iter().any(|it| *it != 0.0);
    let is_loaded: Vec<bool> = (springs.iter().enumerate())
        .map(|(k, spring)| *spring != Vec3::zeros() || remembers(k))
        .collect();
    let mut of_ids = is_loaded.iter();
    ids.retain(|_| of_ids.next() == Some(&true));
    let mut of_springs = is_loaded.iter();
    springs.retain(|_| of_springs.next() == Some(&true));
    let mut of_memories = is_loaded.iter().flat_map(|it| std::iter::repeat_n(*it, width));
    memories.retain(|_| of_memories.next() == Some(true));
}

/// Springs of all walls with all grains, wall by wall; zero if not listed.
fn wall_springs(state: &State) -> Vec<[Real; 3]> {
    let springs = state.springs.walls.dense(state.walls.len(), state.grains.len());
    springs.map(Into::into).collect()
}

/// The listed contacts of walls with grains: `ids` with their `memories` if given, otherwise all contacts
/// whose springs are not zero to the bit.
fn listed_walls(numbers: &Numbers, ids: Vec<[u32; 2]>, memories: Vec<Real>) -> ListedSprings {
    let n_grains = numbers.grain_positions.len();
    let at = |[wall, grain]: [u32; 2]| {
        let index = wall as usize * n_grains + grain as usize;
        numbers.wall_springs.get(index).map_or_else(Vec3::zeros, |&it| Vec3::from(it))
    };
    let is_loaded = |ids: &[u32; 2]| at(*ids).iter().any(|it| it.to_bits() != 0);
    let ids = if ids.is_empty() {
        let all = (0..numbers.walls.len()).flat_map(|w| (0..n_grains).map(move |i| [w, i].map(id)));
        all.filter(is_loaded).collect()
    } else {
        ids
    };
    ListedSprings { springs: ids.iter().map(|&ids| at(ids)).collect(), ids, memories }
}

/// An index as a 32-bit id.
#[expect(clippy::cast_possible_truncation, reason = "the scene allows far fewer grains than 2^32")]
fn id(index: usize) -> u32 {
    index as u32
}

/// Appends a digest to bytes.
pub(crate) fn with_digest(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend_from_slice(&xxh3_64(&bytes).to_le_bytes());
    bytes
}

/// Verifies the digest at the end of `bytes` and returns the bytes before it.
///
/// # Errors
/// If the bytes are truncated or corrupt.
pub(crate) fn verify_digest(bytes: &[u8]) -> Result<&[u8], SavedStateError> {
    let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
    let Some((body, digest)) = bytes.split_last_chunk::<DIGEST_BYTES>() else {
        return Err(corrupt);
    };
    if xxh3_64(body).to_le_bytes() == *digest { Ok(body) } else { Err(corrupt) }
}

/// Reads a state, bit for bit.
///
/// # Errors
/// If the bytes are corrupt, or the lengths of their lists are inconsistent.
pub fn read(bytes: &[u8]) -> Result<State, SavedStateError> {
    let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
    let (numbers, rest): (Numbers, _) =
        postcard::take_from_bytes(verify_digest(bytes)?).map_err(|_| corrupt.clone())?;
    numbers.check()?;
    let (memories, wall_memory, surfaces) = read_rest(rest).map_err(|_| corrupt)?;
    let walls = listed_walls(&numbers, memories.wall_ids, memories.walls);
    if !wall_memory.is_empty() {
        check_counts(&[("walls' motions", wall_memory.len(), numbers.walls.len())])?;
    }
    Ok(State {
        grains: Grains {
            positions: vectors(&numbers.grain_positions),
            velocities: vectors(&numbers.grain_velocities),
            angular_velocities: vectors(&numbers.grain_spins),
            radii: numbers.radii,
            masses: numbers.masses,
        },
        membrane: MembraneState {
            positions: vectors(&numbers.vertex_positions),
            velocities: vectors(&numbers.vertex_velocities),
        },
        springs: Springs {
            pairs: vectors(&numbers.pair_springs),
            pair_memories: memories.pairs,
            patches: numbers.patches.iter().map(|rows| patches(rows)).collect(),
            spheres: ListedSprings {
                ids: numbers.sphere_ids,
                springs: vectors(&numbers.sphere_springs),
                memories: Vec::new(),
            },
            walls,
            surfaces: surfaces.springs()?,
            bodies: vectors(&numbers.body_springs),
        },
        pair_ids: numbers.pair_ids,
        gauge: numbers.gauge,
        walls: numbers.walls.iter().map(motion).collect(),
        wall_memory,
    })
}

/// Checks that counts are equal: name, found, expected.
///
/// # Errors
/// If a count differs; the first one is reported.
pub(crate) fn check_counts(counts: &[(&'static str, usize, usize)]) -> Result<(), SavedStateError> {
    match counts.iter().find(|(_, found, expected)| found != expected) {
        Some(&(what, found, expected)) => {
            Err(SavedStateError::OtherScene { what, found, expected })
        }
        None => Ok(()),
    }
}

impl Numbers {
    fn check(&self) -> Result<(), SavedStateError> {
        let n_grains = self.grain_positions.len();
        let n_vertices = self.vertex_positions.len();
        check_counts(&[
            ("velocities", self.grain_velocities.len(), n_grains),
            ("spins", self.grain_spins.len(), n_grains),
            ("radii", self.radii.len(), n_grains),
            ("masses", self.masses.len(), n_grains),
            ("patches", self.patches.len(), n_grains),
            ("wall springs", self.wall_springs.len(), n_grains * self.walls.len()),
            ("vertex velocities", self.vertex_velocities.len(), n_vertices),
            ("pair springs", self.pair_springs.len(), self.pair_ids.len()),
            ("sphere springs", self.sphere_springs.len(), self.sphere_ids.len()),
        ])
    }
}

fn arrays(vectors: &[Vec3]) -> Vec<[Real; 3]> {
    vectors.iter().map(|v| [v.x, v.y, v.z]).collect()
}

fn vectors(arrays: &[[Real; 3]]) -> Vec<Vec3> {
    arrays.iter().map(|&a| Vec3::from(a)).collect()
}

fn patch_rows(patches: &Patches) -> Vec<[Real; 6]> {
    let row = |p: &Patch| [p.spring.x, p.spring.y, p.spring.z, p.normal.x, p.normal.y, p.normal.z];
    patches.slots[..patches.n].iter().map(row).collect()
}

fn patches(rows: &[[Real; 6]]) -> Patches {
    let mut patches = Patches::NONE;
    for &[sx, sy, sz, nx, ny, nz] in rows.iter().take(N_PATCHES) {
        patches.slots[patches.n] =
            Patch { spring: Vec3::new(sx, sy, sz), normal: Vec3::new(nx, ny, nz) };
        patches.n += 1;
    }
    patches
}

/// Position and quaternion x, y, z, w.
pub(crate) fn pose_row(pose: &Pose) -> [Real; 7] {
    let (p, q) = (pose.translation.vector, pose.rotation.coords);
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w]
}

/// The pose of such a row.
pub(crate) fn pose(&[px, py, pz, qx, qy, qz, qw]: &[Real; 7]) -> Pose {
    // Not normalized again, so that the bits are the same.
    let rotation = Quat::new_unchecked(nalgebra::Quaternion::new(qw, qx, qy, qz));
    Pose::from_parts(Vec3::new(px, py, pz).into(), rotation)
}

/// Position, quaternion x, y, z, w, velocity, angular velocity.
fn motion_row(motion: &BodyMotion) -> [Real; 13] {
    let [px, py, pz, qx, qy, qz, qw] = pose_row(&motion.pose);
    let (v, w) = (motion.twist.linear, motion.twist.angular);
    [px, py, pz, qx, qy, qz, qw, v.x, v.y, v.z, w.x, w.y, w.z]
}

fn motion(row: &[Real; 13]) -> BodyMotion {
    let [px, py, pz, qx, qy, qz, qw, vx, vy, vz, wx, wy, wz] = *row;
    BodyMotion {
        pose: pose(&[px, py, pz, qx, qy, qz, qw]),
        twist: Twist { linear: Vec3::new(vx, vy, vz), angular: Vec3::new(wx, wy, wz) },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A state with three grains and two walls with some listed contacts, each with `width` history
    /// variables.
    fn state(width: usize) -> State {
        let at_rest = Grains::at_rest(vec![Vec3::zeros(); 3], vec![1e-3; 3], vec![1e-5; 3]);
        let motion = BodyMotion { pose: Pose::identity(), twist: Twist::zero() };
        let mut springs = Springs::none(3, 0);
        springs.pairs = vec![Vec3::zeros(), Vec3::new(1e-6, 0.0, -0.0)];
        springs.pair_memories = vec![1.0; 2 * width];
        springs.walls = ListedSprings {
            ids: vec![[0, 1], [1, 0], [1, 2]],
            springs: vec![Vec3::y() * 2e-6, Vec3::zeros(), Vec3::new(-0.0, 0.0, 0.0)],
            memories: vec![1.0; 3 * width],
        };
        let membrane = MembraneState { positions: Vec::new(), velocities: Vec::new() };
        State {
            grains: at_rest,
            membrane,
            springs,
            pair_ids: vec![[0, 1], [0, 2]],
            gauge: -1.0,
            walls: vec![motion; 2],
            wall_memory: Vec::new(),
        }
    }

    fn digest(state: &State) -> u64 {
        let mut digest = crate::base::digest::Digest::new();
        state.digest(&mut digest);
        digest.finish()
    }

    #[test]
    fn contacts_are_restored_with_their_history() {
        // Oracle: the original state.
        for width in [0, 1, 2] {
            let before = state(width);
            let after = read(&write(&before)).unwrap();
            assert_eq!(digest(&after), digest(&before), "{width}");
            assert_eq!(after.springs.pair_memories, before.springs.pair_memories);
            assert_eq!(after.springs.walls.memories, before.springs.walls.memories);
            assert!(is_same(after, before));
        }
    }

    #[test]
    fn the_memory_of_moving_walls_is_restored() {
        // Oracle: the state that was written.
        let mut before = state(0);
        before.wall_memory = vec![WallMemory::default(), WallMemory { time: 0.25, force: -1.5 }];
        let after = read(&write(&before)).unwrap();
        assert_eq!(after.wall_memory, before.wall_memory);
        assert_eq!(digest(&after), digest(&before));
    }

    #[test]
    fn contacts_with_surfaces_are_restored() {
        // Oracle: the state that was written.
        let history = |memory| SurfaceHistory {
            spring: Vec3::new(1e-6, -0.0, 2e-6),
            normal: Vec3::z(),
            memory,
        };
        let mut before = state(0);
        before.springs.surfaces = SurfaceHistories {
            ids: vec![[0, 2], [3, 0]],
            histories: vec![history(vec![]), history(vec![1.0, 0.5])],
        };
        let after = read(&write(&before)).unwrap();
        assert_eq!(after.springs.surfaces, before.springs.surfaces);
        assert_eq!(digest(&after), digest(&before));
        assert_ne!(digest(&after), digest(&state(0)));
    }

    #[test]
    fn springs_at_walls_are_written_and_digested_as_if_all_were_listed() {
        // Oracle: the array of all walls with all grains, as earlier versions wrote it.
        let state = state(0);
        let mut expected = vec![[0.0; 3]; 6];
        expected[1] = [0.0, 2e-6, 0.0];
        expected[5] = [-0.0, 0.0, 0.0];
        let bits = |rows: &[[Real; 3]]| -> Vec<u64> {
            rows.as_flattened().iter().map(|it| it.to_bits()).collect()
        };
        assert_eq!(bits(&wall_springs(&state)), bits(&expected));
        let mut sparser = state.clone();
        sparser.springs.walls.ids.remove(1);
        sparser.springs.walls.springs.remove(1);
        assert_eq!(digest(&sparser), digest(&state));
    }
}
