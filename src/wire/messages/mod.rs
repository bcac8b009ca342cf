//! The ROS 2 messages as Rust types, generated from `msgs/`, and what ROS 2 knows about each.

#[rustfmt::skip]
mod generated;

pub use generated::*;

use byteorder::LittleEndian;
use serde::{Serialize, de::DeserializeOwned};

/// What ROS 2 knows about a message type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageType {
    /// Name in ROS 2, such as `geometry_msgs/msg/WrenchStamped`.
    pub name: &'static str,
    /// Name on the DDS wire, such as `geometry_msgs::msg::dds_::WrenchStamped_`.
    pub dds_name: &'static str,
    /// Hash of the type's description, such as `RIHS01_8dc3…`.
    pub type_hash: &'static str,
    /// Text of the definition, followed by those of all types it contains.
    pub definition: &'static str,
}

/// A ROS 2 message.
pub trait RosMessage: Serialize + DeserializeOwned {
    /// What ROS 2 knows about it.
    const TYPE: MessageType;

    /// The message in CDR, little endian, without the four bytes that name the encoding.
    fn to_cdr(&self) -> Vec<u8> {
        self.to_cdr_sized(256)
    }

    /// As `to_cdr`, with a guess of the length in bytes.
    fn to_cdr_sized(&self, n_bytes: usize) -> Vec<u8> {
        cdr_encoding::to_vec_with_size_hint::<Self, LittleEndian>(self, n_bytes)
            .expect("message types have only fields that CDR can carry, and memory does not fail")
    }

    /// Reads a message from CDR, little endian, without the four bytes that name the encoding.
    ///
    /// # Errors
    /// If the bytes end early or hold something that the type cannot.
    fn from_cdr(cdr: &[u8]) -> Result<Self, cdr_encoding::Error> {
        cdr_encoding::from_bytes::<Self, LittleEndian>(cdr).map(|(message, _)| message)
    }
}
