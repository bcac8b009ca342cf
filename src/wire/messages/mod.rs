//! The ROS 2 message types as Rust types, generated from `msgs/`, and their ROS 2 metadata.

#[rustfmt::skip]
mod generated;

pub use generated::*;

use byteorder::LittleEndian;
use serde::{Serialize, de::DeserializeOwned};

/// Metadata of a message type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MessageType {
    /// Name in ROS 2, such as `geometry_msgs/msg/WrenchStamped`.
    pub name: &'static str,
    /// Name in DDS, such as `geometry_msgs::msg::dds_::WrenchStamped_`.
    pub dds_name: &'static str,
    /// Hash of the type description, such as `RIHS01_8dc3…`.
    pub type_hash: &'static str,
    /// Text of the definition, followed by those of all nested types.
    pub definition: &'static str,
}

/// Metadata of a service type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ServiceType {
    /// Name in ROS 2, such as `std_srvs/srv/SetBool`.
    pub name: &'static str,
    /// Name of the request in DDS.
    pub request_dds_name: &'static str,
    /// Name of the response in DDS.
    pub response_dds_name: &'static str,
}

/// A ROS 2 service.
pub trait RosService {
    /// The request.
    type Request: Serialize + DeserializeOwned;
    /// The response.
    type Response: Serialize + DeserializeOwned;
    /// Metadata of the type.
    const TYPE: ServiceType;
}

/// Metadata of an action type. Canceling and the list of goals have the same types for all actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActionType {
    /// Name in ROS 2, such as `control_msgs/action/GripperCommand`.
    pub name: &'static str,
    /// The hidden service that receives goals.
    pub send_goal: ServiceType,
    /// The hidden service that returns results.
    pub get_result: ServiceType,
    /// Name of the feedback type in DDS.
    pub feedback_dds_name: &'static str,
}

/// A ROS 2 action.
pub trait RosAction {
    /// The goal.
    type Goal: Serialize + DeserializeOwned;
    /// The result.
    type Result: Serialize + DeserializeOwned;
    /// The feedback.
    type Feedback: Serialize + DeserializeOwned;
    /// Metadata of the type.
    const TYPE: ActionType;
}

/// A ROS 2 message.
pub trait RosMessage: Serialize + DeserializeOwned {
    /// Metadata of the type.
    const TYPE: MessageType;

    /// Encodes the message as CDR, little endian, without the encapsulation header of four bytes.
    fn to_cdr(&self) -> Vec<u8> {
        self.to_cdr_sized(256)
    }

    /// As [`RosMessage::to_cdr`], with an estimate of the length (bytes).
    fn to_cdr_sized(&self, n_bytes: usize) -> Vec<u8> {
        cdr_encoding::to_vec_with_size_hint::<Self, LittleEndian>(self, n_bytes)
            .expect("message types have only fields that CDR can encode")
    }

    /// Decodes a message from CDR, little endian, without the encapsulation header of four bytes.
    ///
    /// # Errors
    /// If the bytes end early or are invalid for the type.
    fn from_cdr(cdr: &[u8]) -> Result<Self, cdr_encoding::Error> {
        cdr_encoding::from_bytes::<Self, LittleEndian>(cdr).map(|(message, _)| message)
    }
}
