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

/// What ROS 2 knows about a service type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ServiceType {
    /// Name in ROS 2, such as `std_srvs/srv/SetBool`.
    pub name: &'static str,
    /// Name of the request on the DDS wire.
    pub request_dds_name: &'static str,
    /// Name of the response on the DDS wire.
    pub response_dds_name: &'static str,
}

/// A ROS 2 service.
pub trait RosService {
    /// What the client asks.
    type Request: Serialize + DeserializeOwned;
    /// What the server answers.
    type Response: Serialize + DeserializeOwned;
    /// What ROS 2 knows about it.
    const TYPE: ServiceType;
}

/// What ROS 2 knows about an action type. Cancelling and the list of goals have the same types for
/// all actions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActionType {
    /// Name in ROS 2, such as `control_msgs/action/GripperCommand`.
    pub name: &'static str,
    /// The hidden service that takes goals.
    pub send_goal: ServiceType,
    /// The hidden service that waits for a goal's result.
    pub get_result: ServiceType,
    /// Name of the feedback's type on the DDS wire.
    pub feedback_dds_name: &'static str,
}

/// A ROS 2 action.
pub trait RosAction {
    /// What is to be done.
    type Goal: Serialize + DeserializeOwned;
    /// What came of it.
    type Result: Serialize + DeserializeOwned;
    /// How far it is.
    type Feedback: Serialize + DeserializeOwned;
    /// What ROS 2 knows about it.
    const TYPE: ActionType;
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
