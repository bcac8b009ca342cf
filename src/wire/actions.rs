//! The hidden messages that every action adds to its goal, result and feedback.

use serde::{Deserialize, Serialize};

use super::messages::{builtin_interfaces::Time, unique_identifier_msgs::UUID};

/// The hidden request that sends a goal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SendGoalRequest<G> {
    /// Chosen by the client.
    pub goal_id: UUID,
    /// The goal.
    pub goal: G,
}

/// The response to a goal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SendGoalResponse {
    /// False if the goal is rejected.
    pub accepted: bool,
    /// Time of acceptance.
    pub stamp: Time,
}

/// The hidden request that waits for a result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GetResultRequest {
    /// ID of the goal.
    pub goal_id: UUID,
}

/// The response with the result, once the goal has ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GetResultResponse<R> {
    /// The final status of the goal.
    pub status: i8,
    /// The result.
    pub result: R,
}

/// Feedback about a goal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FeedbackMessage<F> {
    /// ID of the goal.
    pub goal_id: UUID,
    /// The feedback.
    pub feedback: F,
}
