//! The messages that every action hides behind its goal, result and feedback.

use serde::{Deserialize, Serialize};

use super::messages::{builtin_interfaces::Time, unique_identifier_msgs::UUID};

/// The hidden request of every action that sends a goal.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SendGoalRequest<G> {
    /// Chosen by the client.
    pub goal_id: UUID,
    /// What is to be done.
    pub goal: G,
}

/// Its answer.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct SendGoalResponse {
    /// False if the goal is not taken.
    pub accepted: bool,
    /// When it was.
    pub stamp: Time,
}

/// The hidden request of every action that waits for a result.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GetResultRequest {
    /// Which goal.
    pub goal_id: UUID,
}

/// Its answer, once the goal has ended.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GetResultResponse<R> {
    /// How it ended.
    pub status: i8,
    /// What came of it.
    pub result: R,
}

/// Feedback of every action.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FeedbackMessage<F> {
    /// Of which goal.
    pub goal_id: UUID,
    /// How far it is.
    pub feedback: F,
}
