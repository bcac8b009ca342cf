//! A run as bytes, between the two halves of a run that is broken off.

use serde::{Serialize, de::DeserializeOwned};

use super::ResumeError;
use crate::{base::digest::Digest, cosim::saved_state, physics::State};

/// The bytes of a run of `case`: what `now` holds, and the states it goes on from.
pub(super) fn pack<'a>(
    case: &str,
    now: &impl Serialize,
    states: impl IntoIterator<Item = &'a State>,
) -> Vec<u8> {
    let states: Vec<Vec<u8>> = states.into_iter().map(saved_state::write).collect();
    postcard::to_stdvec(&(case, now, states)).expect("numbers and names always serialise")
}

/// What was packed of a run of `case`.
///
/// # Errors
/// If the bytes are damaged, of another case, or hold another number of states than `N`.
pub(super) fn unpack<T: DeserializeOwned, const N: usize>(
    case: &str,
    bytes: &[u8],
) -> Result<(T, [State; N]), ResumeError> {
    let (now, states) = unpack_any(case, bytes)?;
    let n = states.len();
    let states = states.try_into().map_err(|_| refusal(format!("it holds {n} states, not {N}")))?;
    Ok((now, states))
}

/// The same with as many states as there are.
///
/// # Errors
/// If the bytes are damaged or of another case.
pub(super) fn unpack_any<T: DeserializeOwned>(
    case: &str,
    bytes: &[u8],
) -> Result<(T, Vec<State>), ResumeError> {
    // The name first: of another case the rest may have another form.
    let damaged = |error: postcard::Error| refusal(format!("it is damaged: {error}"));
    let (name, rest): (String, &[u8]) = postcard::take_from_bytes(bytes).map_err(damaged)?;
    if name != case {
        return Err(refusal(format!("it is of case `{name}`")));
    }
    let (now, states): (T, Vec<Vec<u8>>) = postcard::from_bytes(rest).map_err(damaged)?;
    let read = |bytes: &Vec<u8>| {
        saved_state::read(bytes).map_err(|it| refusal(format!("it is damaged: {it}")))
    };
    Ok((now, states.iter().map(read).collect::<Result<_, _>>()?))
}

/// Refuses a state with other numbers of grains, vertices and walls than `now`.
///
/// # Errors
/// If they differ.
pub(super) fn of_one_scene(state: &State, now: &State) -> Result<(), ResumeError> {
    let counts = |it: &State| [it.grains.len(), it.membrane.positions.len(), it.walls.len()];
    let (found, expected) = (counts(state), counts(now));
    if found == expected {
        return Ok(());
    }
    Err(refusal(format!(
        "it is of another scene: its numbers of grains, vertices and walls are {found:?}, not {expected:?}"
    )))
}

/// Digest of a state alone.
pub(super) fn digest(state: &State) -> u64 {
    let mut digest = Digest::new();
    state.digest(&mut digest);
    digest.finish()
}

/// Why bytes are not taken.
pub(super) fn refusal(reason: String) -> ResumeError {
    ResumeError { reason }
}
