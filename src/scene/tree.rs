//! YAML as a tree in which every node has its location in the source.
//!
//! Scenes are read through this tree, not directly into structs: deserialization into a struct stops
//! at the first error, but users want to see all of them. Defaults and `--set` are merged here without
//! losing the locations.

use std::{fmt, sync::Arc};

use crate::base::Real;

/// A location in a source text.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Location {
    /// The file or the override.
    pub source: Arc<str>,
    /// Line, from 1; 0 means the whole source.
    pub line: u64,
    /// Column, from 1.
    pub column: u64,
}

impl Location {
    /// The whole source.
    pub fn of_source(source: &str) -> Self {
        Self { source: Arc::from(source), line: 0, column: 0 }
    }
}

impl fmt::Display for Location {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}", self.source),
            _ => write!(f, "{}:{}:{}", self.source, self.line, self.column),
        }
    }
}

/// A value and its location.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Node {
    /// Location of the value.
    pub location: Location,
    /// The value.
    pub value: Value,
}

/// A YAML value.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    /// Null.
    Null,
    /// `true` or `false`.
    Flag(bool),
    /// An integer.
    Integer(i128),
    /// A real number.
    Real(Real),
    /// A string; quantities are strings.
    Text(String),
    /// A list.
    List(Vec<Node>),
    /// Keys and values, in the order written.
    Map(Vec<Entry>),
}

/// A key with its value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    /// The key.
    pub key: String,
    /// Location of the key.
    pub location: Location,
    /// Its value.
    pub node: Node,
}

/// Keys whose value is one of several alternatives, `shape: { sphere: … }`. Another alternative
/// replaces the earlier one instead of being merged with it.
const ALTERNATIVES: &[&str] = &["shape", "orientation"];

impl Node {
    /// An empty map.
    pub(super) fn empty(location: Location) -> Self {
        Self { location, value: Value::Map(Vec::new()) }
    }

    /// The node under a key.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        match &self.value {
            Value::Map(entries) => entries.iter().find(|it| it.key == key).map(|it| &it.node),
            _ => None,
        }
    }

    /// The node at a dotted path.
    pub(super) fn at(&self, path: &str) -> Option<&Self> {
        path.split('.').try_fold(self, |node, key| node.get(key))
    }

    /// Merges `over` into this tree: maps are merged key by key, all other values are replaced.
    pub(super) fn merge(&mut self, over: Self) {
        let Value::Map(entries) = over.value else {
            *self = over;
            return;
        };
        let Value::Map(mine) = &mut self.value else {
            *self = Self { location: over.location, value: Value::Map(entries) };
            return;
        };
        self.location = over.location;
        for entry in entries {
            match mine.iter_mut().find(|it| it.key == entry.key) {
                Some(below) if is_other_alternative(&below.node, &entry) => *below = entry,
                Some(below) => {
                    below.location = entry.location;
                    below.node.merge(entry.node);
                }
                None => mine.push(entry),
            }
        }
    }

    /// The value as written, for messages.
    pub(super) fn describe(&self) -> String {
        match &self.value {
            Value::Null => "nothing".to_owned(),
            Value::Flag(flag) => format!("`{flag}`"),
            Value::Integer(number) => format!("`{number}`"),
            Value::Real(number) => format!("`{number}`"),
            Value::Text(text) => format!("`{text}`"),
            Value::List(items) => {
                let items: Vec<String> = items.iter().map(Self::describe).collect();
                format!("`[{}]`", items.join(", ").replace('`', ""))
            }
            Value::Map(_) => "a map".to_owned(),
        }
    }
}

/// True if `over` names an alternative that `below` does not have.
fn is_other_alternative(below: &Node, over: &Entry) -> bool {
    let (Value::Map(below), Value::Map(over_entries)) = (&below.value, &over.node.value) else {
        return false;
    };
    let is_known = |it: &Entry| below.iter().any(|below| below.key == it.key);
    ALTERNATIVES.contains(&over.key.as_str()) && !over_entries.iter().all(is_known)
}

#[cfg(test)]
mod tests {
    use super::super::yaml;

    /// Oracle: the merged tree, worked out by hand.
    #[test]
    fn merging_joins_maps_and_replaces_the_rest() {
        let mut below = yaml::parse("a: { b: 1, c: [1, 2] }\nd: x", "below").unwrap();
        below.merge(yaml::parse("a: { c: [3], e: 2 }", "over").unwrap());
        assert_eq!(below.at("a.b").unwrap().describe(), "`1`");
        assert_eq!(below.at("a.e").unwrap().describe(), "`2`");
        assert_eq!(below.at("a.c").unwrap().location.source.as_ref(), "over");
        assert_eq!(below.at("d").unwrap().describe(), "`x`");
    }

    #[test]
    fn another_shape_replaces_the_shape_below() {
        let mut below = yaml::parse("shape: { sphere: { radius: 1 mm } }", "below").unwrap();
        below.merge(yaml::parse("shape: { box: { size: 1 } }", "over").unwrap());
        assert!(below.at("shape.sphere").is_none(), "the sphere is gone");
        assert!(below.at("shape.box.size").is_some(), "the box is there");
    }
}
