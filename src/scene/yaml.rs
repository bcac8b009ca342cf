//! YAML text to a tree of values with places. The only file that knows the YAML crate.

use std::{fmt, sync::Arc};

use serde::de::{Deserialize, Deserializer, MapAccess, SeqAccess, Visitor};
use serde_saphyr::{Location, Spanned};

use super::tree::{Entry, Node, Place, Value};

/// The text is not YAML.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: not valid YAML: {message}; correct the text there")]
pub struct SyntaxError {
    /// Where reading stopped.
    pub place: Place,
    /// What the reader said.
    pub message: String,
}

/// Reads one YAML document. `source` names it in places.
///
/// # Errors
/// If the text is not YAML, has a key twice, or expands beyond the reader's limits.
pub(super) fn parse(text: &str, source: &str) -> Result<Node, SyntaxError> {
    let whole = Place::whole(source);
    let options = serde_saphyr::options! { with_snippet: false, strict_booleans: true };
    let bare: Spanned<Bare> =
        serde_saphyr::from_str_with_options(text, options).map_err(|error| {
            let place = error.location().map_or_else(|| whole.clone(), |at| place(&whole, at));
            SyntaxError { place, message: plain_message(&error.without_snippet().to_string()) }
        })?;
    match bare.value {
        // Nothing but comments.
        Bare::Scalar(Value::Null) => Ok(Node::empty(whole)),
        _ => Ok(name_source(bare, &whole)),
    }
}

/// A value as the YAML crate gives it, before it knows its source.
enum Bare {
    Scalar(Value),
    List(Vec<Spanned<Bare>>),
    Map(Vec<(Spanned<String>, Spanned<Bare>)>),
}

fn name_source(bare: Spanned<Bare>, whole: &Place) -> Node {
    let value = match bare.value {
        Bare::Scalar(value) => value,
        Bare::List(items) => {
            Value::List(items.into_iter().map(|it| name_source(it, whole)).collect())
        }
        Bare::Map(entries) => Value::Map(
            entries
                .into_iter()
                .map(|(key, node)| Entry {
                    place: place(whole, key.referenced),
                    key: key.value,
                    node: name_source(node, whole),
                })
                .collect(),
        ),
    };
    Node { place: place(whole, bare.referenced), value }
}

fn place(whole: &Place, at: Location) -> Place {
    Place { source: Arc::clone(&whole.source), line: at.line(), column: at.column() }
}

/// What the crate says, without the place, which we say ourselves, and without advice to callers.
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
        Ok(Bare::Scalar(Value::Whole(number.into())))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Bare, E> {
        Ok(Bare::Scalar(Value::Whole(number.into())))
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
    fn every_node_knows_its_place() {
        assert_eq!(parse("# only a comment", "x").unwrap(), parse("", "x").unwrap());
        let tree = parse("grains:\n  count: 3\n  list: [1 mm, 2 mm]\n", "x.yaml").unwrap();
        let count = tree.at("grains.count").unwrap();
        assert_eq!(count.place.to_string(), "x.yaml:2:10");
        assert_eq!(count.value, Value::Whole(3));
        let Value::List(items) = &tree.at("grains.list").unwrap().value else { panic!("a list") };
        assert_eq!(items[1].place.to_string(), "x.yaml:3:16");
        assert_eq!(items[1].value, Value::Text("2 mm".to_owned()));
    }

    #[test]
    fn faults_of_the_text_have_a_place() {
        let error = parse("a: 1\na: 2\n", "x.yaml").unwrap_err();
        assert!(error.to_string().starts_with("x.yaml:2:1: not valid YAML"), "{error}");
        assert!(parse("a: [1, 2\nb: 3", "x.yaml").is_err(), "an unclosed list is refused");
    }
}
