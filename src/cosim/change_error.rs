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
    /// The name is already used.
    #[error("the name `{object}` is already used: choose another one")]
    NameTaken {
        /// The requested name.
        object: String,
    },
    /// The object would overlap something else.
    #[error("`{what}` would overlap {with}: choose a free position")]
    Overlap {
        /// The object to be placed.
        what: String,
        /// What it would overlap.
        with: String,
    },
    /// The object cannot be simulated.
    #[error("{0}")]
    Unusable(String),
    /// The run was resumed, and its initial state is unknown.
    #[error("this run was resumed and its initial state is unknown: reset only the time")]
    StartUnknown,
    /// No scene is loaded.
    #[error("no world is loaded: load one first")]
    NoScene,
    /// The world does not support the change.
    #[error("this world does not support this change")]
    Unchangeable,
}
