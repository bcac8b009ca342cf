//! CDR encoding of any serde type, for services and actions.

use byteorder::{BigEndian, LittleEndian};
use serde::{Serialize, de::DeserializeOwned};

/// A message body with its byte order, without the encapsulation header of four bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cdr {
    /// The bytes.
    pub bytes: Vec<u8>,
    /// True for big endian.
    pub is_big_endian: bool,
}

impl Cdr {
    /// Encodes `value` as little endian.
    pub fn of<T: Serialize>(value: &T) -> Self {
        let bytes = cdr_encoding::to_vec_with_size_hint::<T, LittleEndian>(value, 64)
            .expect("message types have only fields that CDR can encode");
        Self { bytes, is_big_endian: false }
    }

    /// Decodes a value. Bytes after it are ignored.
    ///
    /// # Errors
    /// If the bytes end early or are invalid for the type.
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

    /// Oracle: a truncated message is an error in either byte order, and never a panic.
    #[test]
    fn truncated_messages_are_errors() {
        let mut request = SpawnEntityRequest { name: "ball".to_owned(), ..Default::default() };
        request.initial_pose.pose.orientation.w = 1.0;
        let complete = Cdr::of(&request);
        assert_eq!(complete.read::<SpawnEntityRequest>().unwrap(), request);
        for n in 0..complete.bytes.len() {
            for is_big_endian in [false, true] {
                let truncated = Cdr { bytes: complete.bytes[..n].to_vec(), is_big_endian };
                assert!(truncated.read::<SpawnEntityRequest>().is_err(), "{n} bytes");
            }
        }
    }
}
