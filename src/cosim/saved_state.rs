//! A state as bytes: what is kept between two starts of a scene, or between two halves of a run.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use crate::{
    base::{Pose, Quat, Real, Vec3, real::Twist},
    physics::{
        State,
        boundary::{body::BodyMotion, motion::WallMemory},
        membrane::MembraneState,
        state::{Grains, N_PATCHES, Patch, Patches, SphereSprings, Springs},
    },
};

/// Why bytes are not a state that can be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SavedStateError {
    /// The digest at the end does not match the bytes before it.
    #[error("saved state: {n_bytes} bytes are truncated or corrupt; it is computed anew")]
    Corrupt {
        /// How many bytes there are.
        n_bytes: usize,
    },
    /// The bytes are whole, but of another scene.
    #[error("saved state: {found} {what}, the scene has {expected}; it is computed anew")]
    OtherScene {
        /// What differs.
        what: &'static str,
        /// In the bytes.
        found: usize,
        /// In the scene.
        expected: usize,
    },
}

/// The numbers of a state in the order they are written.
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

const DIGEST_BYTES: usize = 8;

/// The bytes of `state`, all of it.
pub fn write(state: &State) -> Vec<u8> {
    let numbers = Numbers {
        grain_positions: arrays(&state.grains.positions),
        grain_velocities: arrays(&state.grains.velocities),
        grain_spins: arrays(&state.grains.spins),
        radii: state.grains.radii.clone(),
        masses: state.grains.masses.clone(),
        vertex_positions: arrays(&state.membrane.positions),
        vertex_velocities: arrays(&state.membrane.velocities),
        pair_ids: state.pair_ids.clone(),
        pair_springs: arrays(&state.springs.pairs),
        patches: state.springs.patches.iter().map(patch_rows).collect(),
        wall_springs: arrays(&state.springs.walls),
        body_springs: arrays(&state.springs.bodies),
        gauge: state.gauge,
        walls: state.walls.iter().map(motion_row).collect(),
        sphere_ids: state.springs.spheres.ids.clone(),
        sphere_springs: arrays(&state.springs.spheres.springs),
    };
    let mut bytes = postcard::to_stdvec(&numbers).expect("a list of numbers always serialises");
    // Left out where no wall needs it, which is what versions before it wrote.
    if !state.wall_memory.is_empty() {
        let memory: Vec<[Real; 2]> =
            state.wall_memory.iter().map(|it| [it.time, it.force]).collect();
        let memory = postcard::to_stdvec(&memory).expect("a list of numbers always serialises");
        bytes.extend(memory);
    }
    sealed(bytes)
}

/// What follows the numbers of a state: the memory of the walls, if any wall has one.
fn wall_memory(rest: &[u8]) -> Option<Vec<WallMemory>> {
    if rest.is_empty() {
        return Some(Vec::new());
    }
    let memory: Vec<[Real; 2]> = postcard::from_bytes(rest).ok()?;
    Some(memory.into_iter().map(|[time, force]| WallMemory { time, force }).collect())
}

/// True if both are the same to the bit. As in the digest, only loaded springs count: which empty
/// pairs are listed depends on when the lists were made.
pub(crate) fn is_same(one: State, other: State) -> bool {
    let bytes = |mut state: State| {
        let Springs { pairs, spheres, .. } = &mut state.springs;
        keep_loaded(&mut state.pair_ids, pairs);
        keep_loaded(&mut spheres.ids, &mut spheres.springs);
        write(&state)
    };
    bytes(one) == bytes(other)
}

fn keep_loaded(ids: &mut Vec<[u32; 2]>, springs: &mut Vec<Vec3>) {
    let mut is_loaded = springs.iter().map(|spring| *spring != Vec3::zeros());
    ids.retain(|_| is_loaded.next() == Some(true));
    springs.retain(|spring| *spring != Vec3::zeros());
}

/// Bytes followed by their digest.
pub(crate) fn sealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend_from_slice(&xxh3_64(&bytes).to_le_bytes());
    bytes
}

/// What was sealed.
///
/// # Errors
/// If the bytes are cut off or changed.
pub(crate) fn unsealed(bytes: &[u8]) -> Result<&[u8], SavedStateError> {
    let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
    let Some((body, digest)) = bytes.split_last_chunk::<DIGEST_BYTES>() else {
        return Err(corrupt);
    };
    if xxh3_64(body).to_le_bytes() == *digest { Ok(body) } else { Err(corrupt) }
}

/// The state in `bytes`, with the same bits.
///
/// # Errors
/// If they are damaged, or their lists do not fit each other.
pub fn read(bytes: &[u8]) -> Result<State, SavedStateError> {
    let corrupt = SavedStateError::Corrupt { n_bytes: bytes.len() };
    let (numbers, rest): (Numbers, _) =
        postcard::take_from_bytes(unsealed(bytes)?).map_err(|_| corrupt.clone())?;
    numbers.check()?;
    let wall_memory = wall_memory(rest).ok_or(corrupt)?;
    if !wall_memory.is_empty() {
        same_counts(&[("walls' motions", wall_memory.len(), numbers.walls.len())])?;
    }
    Ok(State {
        grains: Grains {
            positions: vectors(&numbers.grain_positions),
            velocities: vectors(&numbers.grain_velocities),
            spins: vectors(&numbers.grain_spins),
            radii: numbers.radii,
            masses: numbers.masses,
        },
        membrane: MembraneState {
            positions: vectors(&numbers.vertex_positions),
            velocities: vectors(&numbers.vertex_velocities),
        },
        springs: Springs {
            pairs: vectors(&numbers.pair_springs),
            patches: numbers.patches.iter().map(|rows| patches(rows)).collect(),
            spheres: SphereSprings {
                ids: numbers.sphere_ids,
                springs: vectors(&numbers.sphere_springs),
            },
            walls: vectors(&numbers.wall_springs),
            bodies: vectors(&numbers.body_springs),
        },
        pair_ids: numbers.pair_ids,
        gauge: numbers.gauge,
        walls: numbers.walls.iter().map(motion).collect(),
        wall_memory,
    })
}

/// Refuses counts that differ: what, found, expected.
///
/// # Errors
/// The first that differs.
pub(crate) fn same_counts(counts: &[(&'static str, usize, usize)]) -> Result<(), SavedStateError> {
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
        same_counts(&[
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

/// Position and quaternion x y z w.
pub(crate) fn pose_row(pose: &Pose) -> [Real; 7] {
    let (p, q) = (pose.translation.vector, pose.rotation.coords);
    [p.x, p.y, p.z, q.x, q.y, q.z, q.w]
}

/// The pose of a row.
pub(crate) fn pose(&[px, py, pz, qx, qy, qz, qw]: &[Real; 7]) -> Pose {
    // Not normalised again: the bits must come back.
    let rotation = Quat::new_unchecked(nalgebra::Quaternion::new(qw, qx, qy, qz));
    Pose::from_parts(Vec3::new(px, py, pz).into(), rotation)
}

/// Position, quaternion x y z w, velocity, angular velocity.
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
