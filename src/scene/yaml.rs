//! Parses YAML into a tree of values with locations. The only file that uses the YAML crate.

use std::{fmt, sync::Arc};

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_saphyr::Spanned;

use super::tree::{Entry, Location, Node, Value};

/// The text is not YAML.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{location}: not valid YAML: {message}; correct the syntax")]
pub struct SyntaxError {
    /// Where parsing stopped.
    pub location: Location,
    /// The message of the parser.
    pub message: String,
}

/// Parses one YAML document. `source` is its name in locations.
///
/// # Errors
/// If the text is not YAML, has a duplicate key, or expands beyond the limits of the parser.
pub(super) fn parse(text: &str, source: &str) -> Result<Node, SyntaxError> {
    let document = Location::of_source(source);
    let options = serde_saphyr::options! { with_snippet: false, strict_booleans: true };
    let bare: Spanned<Bare> =
        serde_saphyr::from_str_with_options(text, options).map_err(|error| {
            let location =
                error.location().map_or_else(|| document.clone(), |at| location(&document, at));
            SyntaxError { location, message: plain_message(&error.without_snippet().to_string()) }
        })?;
    match bare.value {
        // Only comments.
        Bare::Scalar(Value::Null) => Ok(Node::empty(document)),
        _ => Ok(name_source(bare, &document)),
    }
}

/// A value as the YAML crate returns it, without the name of its source.
enum Bare {
    Scalar(Value),
    List(Vec<Spanned<Bare>>),
    Map(Vec<(Spanned<String>, Spanned<Bare>)>),
}

fn name_source(bare: Spanned<Bare>, document: &Location) -> Node {
    let value = match bare.value {
        Bare::Scalar(value) => value,
        Bare::List(items) => {
            Value::List(items.into_iter().map(|it| name_source(it, document)).collect())
        }
        Bare::Map(entries) => Value::Map(
            entries
                .into_iter()
                .map(|(key, node)| Entry {
                    location: location(document, key.referenced),
                    key: key.value,
                    node: name_source(node, document),
                })
                .collect(),
        ),
    };
    Node { location: location(document, bare.referenced), value }
}

fn location(document: &Location, at: serde_saphyr::Location) -> Location {
    Location { source: Arc::clone(&document.source), line: at.line(), column: at.column() }
}

/// The message of the crate without the location, which we print ourselves, and without hints for
/// programmers.
fn plain_message(message: &str) -> String {
    let line = message.split_whitespace().collect::<Vec<_>>().join(" ");
    let before = |text: String, end: &str| match text.rfind(end) {
        Some(at) => text[..at].to_owned(),
        None => text,
    };
    before(before(line, " at line "), ", set DuplicateKeyPolicy")
}

impl<'de> Deserialize<'de> for Bare {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(BareVisitor)
    }
}

struct BareVisitor;

impl<'de> Visitor<'de> for BareVisitor {
    type Value = Bare;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a YAML value")
    }

    fn visit_unit<E>(self) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Null))
    }

    fn visit_none<E>(self) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Null))
    }

    fn visit_bool<E>(self, flag: bool) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Flag(flag)))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Integer(number.into())))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Integer(number.into())))
    }

    fn visit_f64<E>(self, number: f64) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Real(number)))
    }

    fn visit_str<E>(self, text: &str) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Text(text.to_owned())))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Bare, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element()? {
            items.push(item);
        }
        Ok(Bare::List(items))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Bare, A::Error> {
        let mut entries = Vec::new();
        while let Some(entry) = map.next_entry()? {
            entries.push(entry);
        }
        Ok(Bare::Map(entries))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: line and column counted by hand.
    #[test]
    fn every_node_has_its_location() {
        assert_eq!(parse("# only a comment", "x").unwrap(), parse("", "x").unwrap());
        let tree = parse("grains:\n  count: 3\n  list: [1 mm, 2 mm]\n", "x.yaml").unwrap();
        let count = tree.at("grains.count").unwrap();
        assert_eq!(count.location.to_string(), "x.yaml:2:10");
        assert_eq!(count.value, Value::Integer(3));
        let Value::List(items) = &tree.at("grains.list").unwrap().value else { panic!("a list") };
        assert_eq!(items[1].location.to_string(), "x.yaml:3:16");
        assert_eq!(items[1].value, Value::Text("2 mm".to_owned()));
    }

    #[test]
    fn syntax_errors_have_a_location() {
        let error = parse("a: 1\na: 2\n", "x.yaml").unwrap_err();
        assert!(error.to_string().starts_with("x.yaml:2:1: not valid YAML"), "{error}");
        assert!(parse("a: [1, 2\nb: 3", "x.yaml").is_err(), "an unclosed list is rejected");
    }
}
