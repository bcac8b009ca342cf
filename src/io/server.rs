//! The interface of service servers: requests in, responses and action topics out.
//!
//! A server only transports. Requests wait here until the next tick is over. A flood of them
//! displaces no waiting request, does not slow the physics, and is counted. Responses are sent in
//! order, each after the messages of its tick.

use std::time::Duration;

use crate::wire::{cdr::Cdr, messages::ServiceType};

/// Name and type of a service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServiceSpec {
    /// Full name, such as `/jamgrip/step_simulation`.
    pub name: String,
    /// The type of the service.
    pub service_type: ServiceType,
}

/// A topic of an action, in addition to the topics of the scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicSpec {
    /// Full name, such as `/jamgrip/gripper_cmd/_action/feedback`.
    pub name: String,
    /// Name of its type in DDS.
    pub dds_name: String,
    /// Transient local: late joiners receive the last message.
    pub is_latched: bool,
}

/// Identifies a request, so that its response can be addressed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RequestId {
    /// Index of the service.
    pub service: usize,
    /// GUID of the client's writer.
    pub writer: [u8; 16],
    /// Sequence number of the request.
    pub number: i64,
    /// The header before the body, for clients with Cyclone's mapping.
    pub header: Option<[u8; 16]>,
}

/// A request to a service.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServiceRequest {
    /// Identity of the request.
    pub id: RequestId,
    /// The encoded request.
    pub body: Cdr,
}

/// A message to send.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outgoing {
    /// The response to a request.
    Response(RequestId, Cdr),
    /// A message on the topic with this index.
    Message(usize, Cdr),
}

/// Request counters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ServerCounters {
    /// Requests that arrived.
    pub n_received: u64,
    /// Requests that were dropped because the queue was full.
    pub n_rejected: u64,
    /// Requests that could not be decoded.
    pub n_malformed: u64,
}

/// Receives requests and sends responses.
pub trait ServiceServer: Send {
    /// Takes at most `n_max` waiting requests, oldest first. Never blocks.
    fn take(&mut self, n_max: usize) -> Vec<ServiceRequest>;

    /// Waits until a request arrives, at most `timeout`.
    fn wait(&mut self, timeout: Duration);

    /// Sends a message once packet `after_packet` has been published, or has timed out.
    fn send(&mut self, outgoing: Outgoing, after_packet: u64);

    /// Counts a request that could not be decoded; its error is logged from time to time.
    fn report_malformed(&mut self, error: String);

    /// The counters so far.
    fn counters(&self) -> ServerCounters;
}
