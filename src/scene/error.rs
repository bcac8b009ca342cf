//! Errors in scenes. Every message states the location, the value, the limit and a remedy.

use std::fmt;

use super::{quantity::QuantityError, tree::Location, yaml::SyntaxError};

/// Why a scene could not be read.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SceneError {
    /// The file could not be read.
    #[error("{file}: cannot be read: {reason}; check the path")]
    Unreadable {
        /// The file.
        file: String,
        /// The message of the operating system.
        reason: String,
    },
    /// The text is not YAML.
    #[error(transparent)]
    Syntax(#[from] SyntaxError),
    /// An override is not `key=value`.
    #[error("override `{text}`: not of the form key=value; for example, write `object.friction=0`")]
    NotAnOverride {
        /// The override as given.
        text: String,
    },
    /// Keys or values are invalid.
    #[error("{}", one_per_line(.0))]
    Invalid(Vec<Diagnostic>),
}

/// One error in a scene.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{location}: {}{kind}", prefix(.key))]
pub struct Diagnostic {
    /// Where the key or its value is written.
    pub location: Location,
    /// Dotted path of the key.
    pub key: String,
    /// The error.
    pub kind: DiagnosticKind,
}

/// The kind of an error, with limit and remedy.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DiagnosticKind {
    /// The key does not exist.
    #[error("unknown key; {}", suggestion(.near, .known))]
    UnknownKey {
        /// Keys with similar spelling.
        near: Vec<String>,
        /// All keys of the section.
        known: Vec<String>,
    },
    /// A key without a default is missing.
    #[error("is missing; for example, write `{example}`")]
    Missing {
        /// A valid value.
        example: String,
    },
    /// The value has the wrong type.
    #[error("expected {expected}, found {found}; for example, write `{example}`")]
    WrongType {
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: String,
        /// A valid value.
        example: String,
    },
    /// The number or the unit is wrong.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// The value is out of range.
    #[error("{found} is out of range: it must be {limit}; for example, write `{example}`")]
    OutOfRange {
        /// What was found.
        found: String,
        /// The limit.
        limit: String,
        /// A valid value.
        example: String,
    },
    /// The value is not one of a fixed list.
    #[error("expected one of {known}; found {found}{}", did_you_mean(.near))]
    NotOneOf {
        /// What was found.
        found: String,
        /// The valid values.
        known: String,
        /// Values with similar spelling.
        near: Vec<String>,
    },
    /// Two values conflict.
    #[error("{value} is {relation} {limit} ({limit_key}); {remedy}")]
    Conflict {
        /// The value.
        value: String,
        /// Its relation to the limit.
        relation: &'static str,
        /// The limit.
        limit: String,
        /// The key that sets the limit.
        limit_key: &'static str,
        /// The remedy.
        remedy: &'static str,
    },
    /// The value is invalid whatever the other values are.
    #[error("`{value}` {reason}; {remedy}")]
    Invalid {
        /// The value.
        value: String,
        /// Why it is invalid.
        reason: String,
        /// The remedy.
        remedy: &'static str,
    },
}

fn prefix(key: &str) -> String {
    if key.is_empty() { String::new() } else { format!("{key}: ") }
}

fn one_per_line(diagnostics: &[Diagnostic]) -> String {
    diagnostics.iter().map(Diagnostic::to_string).collect::<Vec<_>>().join("\n")
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

/// At most three names that are spelled like `name`, best match first.
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

/// True if one name contains the other: `modulus` for `youngs_modulus`.
fn is_part(name: &str, candidate: &str) -> bool {
    3 < name.len() && (candidate.contains(name) || name.contains(candidate))
}

/// Number of insertions, deletions and substitutions between two words (Levenshtein 1966).
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
    fn near_matches_are_sorted_by_distance() {
        let known = ["friction", "density", "youngs_modulus"];
        assert_eq!(near_matches("fricton", known.into_iter()), ["friction"]);
        assert_eq!(near_matches("modulus", known.into_iter()), ["youngs_modulus"]);
        assert!(near_matches("color", known.into_iter()).is_empty());
    }
}
