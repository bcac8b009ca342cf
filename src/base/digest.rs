//! A 64-bit digest of states and texts: XXH3 over the bytes in a fixed order.
//!
//! Two runs are equal when their digests are: the digest covers the exact bits of every number.

use xxhash_rust::xxh3::Xxh3;

use super::{Real, Vec3};

/// Collects numbers in the order they are given.
#[derive(Default)]
pub struct Digest(Xxh3);

impl Digest {
    /// An empty digest.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds raw bytes.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Adds a whole number.
    pub fn integer(&mut self, value: u64) {
        self.0.update(&value.to_le_bytes());
    }

    /// Adds the bits of a real number.
    pub fn real(&mut self, value: Real) {
        self.0.update(&value.to_bits().to_le_bytes());
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

    /// The digest of all that was added.
    pub fn finish(&self) -> u64 {
        self.0.digest()
    }
}
