//! Why a discontinuous change is rejected.

/// Why a change was rejected. The world is as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ChangeError {
    /// There is no such object.
    #[error("there is no object `{object}`: use one of {known}")]
    UnknownObject {
        /// The requested name.
        object: String,
        /// The names that exist.
        known: String,
    },
    /// The name is taken.
    #[error("the name `{object}` is taken: choose another one")]
    NameTaken {
        /// The requested name.
        object: String,
    },
    /// The object would overlap something else.
    #[error("`{what}` would overlap {with} there: choose a free place")]
    Overlap {
        /// The object to be placed.
        what: String,
        /// What it would overlap.
        with: String,
    },
    /// The object cannot be simulated.
    #[error("{0}")]
    Unusable(String),
    /// The run was resumed in the middle, and its initial state is unknown.
    #[error(
        "this run was resumed in the middle and does not know its initial state: reset time only"
    )]
    StartUnknown,
    /// No scene is loaded.
    #[error("no world is loaded: load one first")]
    NoScene,
    /// This world does not support the change.
    #[error("this world does not support such a change")]
    Unchangeable,
}
