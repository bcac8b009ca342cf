//! A 64-bit digest of states and texts: XXH3 over the bytes in a fixed order.
//!
//! The digest covers the exact bits of every number: equal digests mean equal runs.

use xxhash_rust::xxh3::Xxh3;

use super::{Real, Vec3};

/// Number of bytes buffered before they are hashed.
const BLOCK: usize = 16 * 1024;

/// Hashes numbers in the order in which they are added.
#[derive(Default)]
pub struct Digest {
    hasher: Xxh3,
    block: Vec<u8>,
}

impl Digest {
    /// An empty digest.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds raw bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.block.extend_from_slice(bytes);
        if self.block.len() >= BLOCK {
            self.hasher.update(&self.block);
            self.block.clear();
        }
    }

    /// Adds an integer.
    pub fn integer(&mut self, value: u64) {
        self.bytes(&value.to_le_bytes());
    }

    /// Adds the bits of a real number.
    pub fn real(&mut self, value: Real) {
        self.bytes(&value.to_bits().to_le_bytes());
    }

    /// Adds the bits of real numbers.
    pub fn reals(&mut self, values: &[Real]) {
        for &value in values {
            self.real(value);
        }
    }

    /// Adds the bits of vectors.
    pub fn vectors(&mut self, vectors: &[Vec3]) {
        for vector in vectors {
            self.reals(vector.as_slice());
        }
    }

    /// The digest of everything added.
    pub fn finish(mut self) -> u64 {
        self.hasher.update(&self.block);
        self.hasher.digest()
    }
}
