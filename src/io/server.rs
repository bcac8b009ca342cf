//! Where questions come in and answers go out: ROS 2 services, and the topics of actions.
//!
//! A bench only carries. Questions wait here for the time between two ticks; a flood of them pushes
//! out none of those that wait, costs the physics nothing, and is counted. Answers leave in order,
//! each behind the messages of the tick that it speaks of.

use std::time::Duration;

use crate::wire::{cdr::Cdr, messages::ServiceType};

/// A service that is offered.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServiceSpec {
    /// Full name, such as `/jamgrip/step_simulation`.
    pub name: String,
    /// Its type.
    pub service_type: ServiceType,
}

/// A topic that answers may be published on, besides those of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TopicSpec {
    /// Full name, such as `/jamgrip/gripper_cmd/_action/feedback`.
    pub name: String,
    /// Name of its type on the DDS wire.
    pub dds_name: String,
    /// Who comes late gets the last message.
    pub is_latched: bool,
}

/// Who asked, so that the answer finds back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RequestId {
    /// Which offer was used.
    pub offer: usize,
    /// The client's writer.
    pub writer: [u8; 16],
    /// Number of the question among the client's.
    pub number: i64,
    /// What clients of Cyclone's way put before the body.
    pub header: Option<[u8; 16]>,
}

/// A question.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ServiceRequest {
    /// Who asks.
    pub asker: RequestId,
    /// What is asked.
    pub body: Cdr,
}

/// Something on its way out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outgoing {
    /// An answer.
    Response(RequestId, Cdr),
    /// A message on one of the channels.
    Message(usize, Cdr),
}

/// What became of the questions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ServerCounters {
    /// Questions that arrived.
    pub n_received: u64,
    /// Questions that found the queue full and are left without an answer.
    pub n_rejected: u64,
    /// Questions that could not be read.
    pub n_malformed: u64,
}

/// A place where others ask.
pub trait ServiceServer: Send {
    /// At most `most` questions that wait, oldest first. Never waits.
    fn take(&mut self, most: usize) -> Vec<ServiceRequest>;

    /// Waits until a question is there, at most this long.
    fn wait(&mut self, at_most: Duration);

    /// Sends something out, once the packet of this number has been published or is lost.
    fn send(&mut self, outgoing: Outgoing, after_packet: u64);

    /// A question could not be read: it is counted, and now and then told.
    fn report_malformed(&mut self, fault: String);

    /// What became of the questions so far.
    fn counters(&self) -> ServerCounters;
}
