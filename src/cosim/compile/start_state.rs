//! A settled start state as bytes: what a cache keeps between two starts of the same scene.

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::xxh3_64;

use super::Compiled;
use crate::{
    base::{Real, Vec3, real::Twist},
    physics::{
        State,
        membrane::MembraneState,
        state::{Grains, N_PATCHES, Patch, Patches, Springs},
    },
};

/// Why bytes are not a start state of a scene.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
pub enum StartStateError {
    /// The digest at the end does not match the bytes before it.
    #[error("start state: {n_bytes} bytes are truncated or corrupt; it is settled anew")]
    Corrupt {
        /// How many bytes there are.
        n_bytes: usize,
    },
    /// The bytes are whole, but of another scene.
    #[error("start state: {found} {what}, the scene has {expected}; it is settled anew")]
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
pub struct StartState {
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
    plate_springs: Vec<[Real; 3]>,
}

const DIGEST_BYTES: usize = 8;

impl StartState {
    /// The bytes of a state that has settled and whose flange has not moved.
    pub fn write(state: &State) -> Vec<u8> {
        let numbers = Self {
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
            plate_springs: arrays(&state.springs.plate),
        };
        let mut bytes = postcard::to_stdvec(&numbers).expect("a list of numbers always serialises");
        bytes.extend_from_slice(&xxh3_64(&bytes).to_le_bytes());
        bytes
    }

    /// The state in `bytes`.
    ///
    /// # Errors
    /// If they are damaged or of another scene.
    pub fn read(compiled: &Compiled, bytes: &[u8]) -> Result<State, StartStateError> {
        let corrupt = StartStateError::Corrupt { n_bytes: bytes.len() };
        let Some(n) = bytes.len().checked_sub(DIGEST_BYTES) else { return Err(corrupt) };
        let (body, digest) = bytes.split_at(n);
        if xxh3_64(body).to_le_bytes() != digest {
            return Err(corrupt);
        }
        let numbers: Self = postcard::from_bytes(body).map_err(|_| corrupt)?;
        numbers.check(compiled)?;
        let flange = compiled.scene.flange.pose;
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
                plate: vectors(&numbers.plate_springs),
                bodies: Vec::new(),
            },
            pair_ids: numbers.pair_ids,
            gauge: 0.0,
            flange,
            flange_twist: Twist::zero(),
        })
    }

    fn check(&self, compiled: &Compiled) -> Result<(), StartStateError> {
        let n_grains = compiled.scene.grains.count;
        let n_vertices = compiled.model.membrane.mesh.n_vertices();
        let counts = [
            ("grains", self.grain_positions.len(), n_grains),
            ("velocities", self.grain_velocities.len(), n_grains),
            ("spins", self.grain_spins.len(), n_grains),
            ("radii", self.radii.len(), n_grains),
            ("masses", self.masses.len(), n_grains),
            ("patches", self.patches.len(), n_grains),
            ("plate springs", self.plate_springs.len(), n_grains),
            ("vertices", self.vertex_positions.len(), n_vertices),
            ("vertex velocities", self.vertex_velocities.len(), n_vertices),
            ("pair springs", self.pair_springs.len(), self.pair_ids.len()),
        ];
        match counts.into_iter().find(|(_, found, expected)| found != expected) {
            Some((what, found, expected)) => {
                Err(StartStateError::OtherScene { what, found, expected })
            }
            None => Ok(()),
        }
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
