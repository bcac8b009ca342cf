//! What can be wrong with a scene. Every fault says place, value, limit and remedy.

use std::fmt;

use super::{quantity::QuantityError, tree::Place, yaml::SyntaxError};

/// A scene could not be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {reason}; check the path")]
    Unreadable {
        /// The file.
        file: String,
        /// What the operating system said.
        reason: String,
    },
    /// The text is not YAML.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// An override is not `key=value`.
    #[error("override `{text}`: not of the form key=value; write for example `object.friction=0`")]
    NotAnOverride {
        /// As given.
        text: String,
    },
    /// All that is wrong with the values.
    #[error("{}", one_per_line(.0))]
    Faults(Vec<Fault>),
}

/// One thing wrong with a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {}{problem}", prefix(.key))]
pub struct Fault {
    /// Where.
    pub place: Place,
    /// Dotted path of the key.
    pub key: String,
    /// What.
    pub problem: Problem,
}

/// What is wrong, with limit and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// Nobody knows the key.
    #[error("unknown key; {}", suggestion(.near, .known))]
    UnknownKey {
        /// Keys spelled alike.
        near: Vec<String>,
        /// All keys of the section.
        known: Vec<String>,
    },
    /// A key without a default is not there.
    #[error("is missing; write for example `{example}`")]
    Missing {
        /// A value that would do.
        example: String,
    },
    /// A value of another kind.
    #[error("expected {expected}, found {found}; write for example `{example}`")]
    WrongKind {
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
        /// A value that would do.
        example: String,
    },
    /// Number or unit are wrong.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// Beyond a limit.
    #[error("{found} is out of range, it must be {limit}; write for example `{example}`")]
    OutOfRange {
        /// What was found.
        found: String,
        /// The limit.
        limit: String,
        /// A value that would do.
        example: String,
    },
    /// Not one of a closed list.
    #[error("{found} is not known; write one of: {known}{}", did_you_mean(.near))]
    NotOneOf {
        /// What was found.
        found: String,
        /// What there is.
        known: String,
        /// Names spelled alike.
        near: Vec<String>,
    },
    /// Two values that do not fit each other.
    #[error("{value} is {relation} {limit} ({limit_key}); {remedy}")]
    Conflict {
        /// The value.
        value: String,
        /// How it stands to the limit.
        relation: &'static str,
        /// The limit.
        limit: String,
        /// The key that sets the limit.
        limit_key: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A value that no choice of other values makes right.
    #[error("`{value}` {reason}; {remedy}")]
    Unfit {
        /// The value.
        value: String,
        /// Why not.
        reason: String,
        /// What to do.
        remedy: &'static str,
    },
}

fn prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

fn one_per_line(faults: &[Fault]) -> String {
    faults.iter().map(Fault::to_string).collect::<Vec<_>>().join("\n")
}

fn suggestion(near: &[String], known: &[String]) -> impl fmt::Display {
    if near.is_empty() {
        format!("known keys here: {}", known.join(", "))
    } else {
        format!("did you mean {}?", quoted(near))
    }
}

fn did_you_mean(near: &[String]) -> String {
    if near.is_empty() { String::new() } else { format!("; did you mean {}?", quoted(near)) }
}

fn quoted(names: &[String]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(" or ")
}

/// The names that are spelled like `name`, nearest first, at most three.
pub fn near_matches<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut found: Vec<(usize, &str)> = known
        .map(|candidate| (edit_distance(name, candidate), candidate))
        .filter(|(distance, candidate)| {
            *distance <= 1 + candidate.len() / 4 || is_part(name, candidate)
        })
        .collect();
    found.sort_unstable();
    found.into_iter().take(3).map(|(_, candidate)| candidate.to_owned()).collect()
}

/// True if one name holds the other: `modulus` for `youngs_modulus`.
fn is_part(name: &str, candidate: &str) -> bool {
    3 < name.len() && (candidate.contains(name) || name.contains(candidate))
}

/// Insertions, deletions and substitutions between two words (Levenshtein 1966).
fn edit_distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, letter) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for j in 0..b.len() {
            let substituted = diagonal + usize::from(letter != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = substituted.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: counted by hand.
    #[test]
    fn edit_distances() {
        assert_eq!(edit_distance("friction", "friction"), 0);
        assert_eq!(edit_distance("fricton", "friction"), 1);
        assert_eq!(edit_distance("kitten", "sitting"), 3);
        assert_eq!(edit_distance("", "abc"), 3);
    }

    #[test]
    fn near_matches_come_nearest_first() {
        let known = ["friction", "density", "youngs_modulus"];
        assert_eq!(near_matches("fricton", known.into_iter()), ["friction"]);
        assert_eq!(near_matches("modulus", known.into_iter()), ["youngs_modulus"]);
        assert!(near_matches("colour", known.into_iter()).is_empty());
    }
}
