//! A run as bytes, to be resumed later.

use serde::{Serialize, de::DeserializeOwned};

use super::ResumeError;
use crate::{base::digest::Digest, cosim::saved_state, physics::State};

/// Encodes a run of `case`: its `progress` and its physical states.
pub(super) fn pack<'a>(
    case: &str,
    progress: &impl Serialize,
    states: impl IntoIterator<Item = &'a State>,
) -> Vec<u8> {
    let states: Vec<Vec<u8>> = states.into_iter().map(saved_state::write).collect();
    postcard::to_stdvec(&(case, progress, states)).expect("numbers and names always serialize")
}

/// Decodes a run of `case`: its progress and its `N` states.
///
/// # Errors
/// If the bytes are damaged, belong to another case, or hold another number of states.
pub(super) fn unpack<T: DeserializeOwned, const N: usize>(
    case: &str,
    bytes: &[u8],
) -> Result<(T, [State; N]), ResumeError> {
    let (progress, states) = unpack_any(case, bytes)?;
    let n = states.len();
    let states = states.try_into().map_err(|_| error(format!("it holds {n} states, not {N}")))?;
    Ok((progress, states))
}

/// Decodes a run of `case` with any number of states.
///
/// # Errors
/// If the bytes are damaged or belong to another case.
pub(super) fn unpack_any<T: DeserializeOwned>(
    case: &str,
    bytes: &[u8],
) -> Result<(T, Vec<State>), ResumeError> {
    // The name comes first: the rest of another case may have another layout.
    let damaged = |reason: postcard::Error| error(format!("it is damaged: {reason}"));
    let (name, rest): (String, &[u8]) = postcard::take_from_bytes(bytes).map_err(damaged)?;
    if name != case {
        return Err(error(format!("it is of case `{name}`")));
    }
    let (progress, states): (T, Vec<Vec<u8>>) = postcard::from_bytes(rest).map_err(damaged)?;
    let read = |bytes: &Vec<u8>| {
        saved_state::read(bytes).map_err(|it| error(format!("it is damaged: {it}")))
    };
    Ok((progress, states.iter().map(read).collect::<Result<_, _>>()?))
}

/// Checks that a state has as many grains, vertices and walls as that of this run.
///
/// # Errors
/// If the numbers differ.
pub(super) fn check_scene(state: &State, own: &State) -> Result<(), ResumeError> {
    let counts = |it: &State| [it.grains.len(), it.membrane.positions.len(), it.walls.len()];
    let (found, expected) = (counts(state), counts(own));
    if found == expected {
        return Ok(());
    }
    Err(error(format!(
        "it is of another scene: its numbers of grains, vertices and walls are {found:?}, not {expected:?}"
    )))
}

/// Digest of a state alone.
pub(super) fn digest(state: &State) -> u64 {
    let mut digest = Digest::new();
    state.digest(&mut digest);
    digest.finish()
}

/// The error with this reason.
pub(super) fn error(reason: String) -> ResumeError {
    ResumeError { reason }
}
