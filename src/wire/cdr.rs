//! CDR of any type that serde knows: what services and actions carry.

use byteorder::{BigEndian, LittleEndian};
use serde::{Serialize, de::DeserializeOwned};

/// A message's body with its byte order, without the four bytes that name the encoding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cdr {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// True for the byte order of networks.
    pub is_big_endian: bool,
}

impl Cdr {
    /// `value`, little endian.
    pub fn of<T: Serialize>(value: &T) -> Self {
        let bytes = cdr_encoding::to_vec_with_size_hint::<T, LittleEndian>(value, 64)
            .expect("message types have only fields that CDR can carry");
        Self { bytes, is_big_endian: false }
    }

    /// Reads a value. Bytes behind it are left alone.
    ///
    /// # Errors
    /// If the bytes end early or hold something that the type cannot.
    pub fn read<T: DeserializeOwned>(&self) -> Result<T, cdr_encoding::Error> {
        let read = if self.is_big_endian {
            cdr_encoding::from_bytes::<T, BigEndian>(&self.bytes)
        } else {
            cdr_encoding::from_bytes::<T, LittleEndian>(&self.bytes)
        };
        read.map(|(value, _)| value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::wire::messages::simulation_interfaces::SpawnEntityRequest;

    /// Oracle: the contract. What is cut off is an error, whatever the byte order, and never a panic.
    #[test]
    fn cut_messages_are_errors() {
        let mut request = SpawnEntityRequest { name: "ball".to_owned(), ..Default::default() };
        request.initial_pose.pose.orientation.w = 1.0;
        let whole = Cdr::of(&request);
        assert_eq!(whole.read::<SpawnEntityRequest>().unwrap(), request);
        for n in 0..whole.bytes.len() {
            for is_big_endian in [false, true] {
                let cut = Cdr { bytes: whole.bytes[..n].to_vec(), is_big_endian };
                assert!(cut.read::<SpawnEntityRequest>().is_err(), "{n} bytes");
            }
        }
    }
}
