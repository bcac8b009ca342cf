//! Fills a scene from a tree and collects all errors.

use super::{
    error::{Diagnostic, DiagnosticKind, near_matches},
    quantity::Dimension,
    tree::{Node, Value},
    visit::{Quantity, Range, Visitor},
};
use crate::base::{Real, Vec3};

/// Reads a tree of values.
pub(super) struct Reader<'a> {
    open: Vec<Section<'a>>,
    /// Values that messages show as examples.
    examples: &'a Node,
    diagnostics: Vec<Diagnostic>,
}

struct Section<'a> {
    key: &'static str,
    /// `None` if the section is missing or not a map: then its keys cause no errors.
    node: Option<&'a Node>,
    known: Vec<&'static str>,
}

impl<'a> Reader<'a> {
    /// A reader at the root of `tree`. `examples` is a tree of valid values.
    pub(super) fn new(tree: &'a Node, examples: &'a Node) -> Self {
        let root = Section { key: "", node: Some(tree), known: Vec::new() };
        let mut reader = Self { open: vec![root], examples, diagnostics: Vec::new() };
        if !matches!(tree.value, Value::Map(_)) {
            reader.open[0].node = None;
            reader.report(
                tree,
                String::new(),
                DiagnosticKind::WrongType {
                    expected: "a map of keys and values",
                    found: tree.describe(),
                    example: "name: my_scene".to_owned(),
                },
            );
        }
        reader
    }

    /// All errors, in the order of the text. Call this after all keys have been visited.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        while !self.open.is_empty() {
            self.close_section();
        }
        self.diagnostics
    }

    fn path(&self, key: &str) -> String {
        let above = self.open.iter().map(|section| section.key).filter(|key| !key.is_empty());
        above.chain([key]).collect::<Vec<_>>().join(".")
    }

    /// The node of a key of the open section. Reports an error if the key is missing.
    fn take(&mut self, key: &'static str) -> Option<&'a Node> {
        let section = self.open.last_mut().expect("the root stays open until the end");
        section.known.push(key);
        let here = section.node?;
        if let Some(found) = here.get(key) {
            return Some(found);
        }
        let path = self.path(key);
        let example = self.example(&path, "");
        let is_default = here.location.source == self.examples.location.source;
        let root = self.open[0].node.filter(|_| is_default);
        self.report(root.unwrap_or(here), path, DiagnosticKind::Missing { example });
        None
    }

    fn report(&mut self, at: &Node, key: String, kind: DiagnosticKind) {
        self.diagnostics.push(Diagnostic { location: at.location.clone(), key, kind });
    }

    fn wrong_type(&mut self, at: &Node, key: &str, expected: &'static str, fallback: &str) {
        let path = self.path(key);
        let example = self.example(&path, fallback);
        self.report(
            at,
            path,
            DiagnosticKind::WrongType { expected, found: at.describe(), example },
        );
    }

    /// A valid value: the default, or the example for a key without a default.
    fn example(&self, path: &str, fallback: &str) -> String {
        let known = EXAMPLES.iter().find(|(key, _)| *key == path).map(|(_, text)| *text);
        let default = self.examples.at(path).filter(|it| !matches!(it.value, Value::Map(_)));
        let default = default.and_then(plain);
        default.unwrap_or_else(|| known.unwrap_or(fallback).to_owned())
    }

    fn close_section(&mut self) {
        let section = self.open.pop().expect("every section is closed once");
        let Some(Node { value: Value::Map(entries), .. }) = section.node else { return };
        for entry in entries {
            if section.known.contains(&entry.key.as_str()) {
                continue;
            }
            let mut key = self.path(section.key);
            if !key.is_empty() {
                key.push('.');
            }
            self.diagnostics.push(Diagnostic {
                location: entry.location.clone(),
                key: key + &entry.key,
                kind: DiagnosticKind::UnknownKey {
                    near: near_matches(&entry.key, section.known.iter().copied()),
                    known: section.known.iter().map(|&key| key.to_owned()).collect(),
                },
            });
        }
    }

    fn parse_quantity(&mut self, node: &Node, key: &str, kind: Quantity) -> Option<Real> {
        let path = self.path(key);
        let text = match &node.value {
            Value::Text(text) => text.clone(),
            Value::Integer(number) => number.to_string(),
            Value::Real(number) => number.to_string(),
            _ => {
                self.wrong_type(node, key, "a number with a unit", &unit_example(kind.dimension));
                return None;
            }
        };
        match kind.dimension.parse(&text) {
            Err(error) => self.report(node, path, error.into()),
            Ok(value) if kind.range.contains(value) => return Some(value),
            Ok(_) => {
                let example = self.example(&path, &unit_example(kind.dimension));
                let limit = kind.range.describe(|number| kind.dimension.print(number));
                let found = node.describe();
                self.report(node, path, DiagnosticKind::OutOfRange { found, limit, example });
            }
        }
        None
    }

    fn parse_number(&mut self, node: &Node, key: &str, range: Range) -> Option<Real> {
        #[expect(clippy::cast_precision_loss, reason = "a scene's numbers are far below 2^53")]
        let value = match node.value {
            Value::Real(number) => number,
            Value::Integer(number) => number as Real,
            _ => {
                self.wrong_type(node, key, "a number without a unit", "0.5");
                return None;
            }
        };
        if range.contains(value) {
            return Some(value);
        }
        let path = self.path(key);
        let example = self.example(&path, "0.5");
        let limit = range.describe(|number| number.to_string());
        self.report(
            node,
            path,
            DiagnosticKind::OutOfRange { found: node.describe(), limit, example },
        );
        None
    }

    fn parse_integer(&mut self, node: &Node, key: &str, (min, max): (u64, u64)) -> Option<u64> {
        let Value::Integer(number) = node.value else {
            self.wrong_type(node, key, "an integer", "1");
            return None;
        };
        let inside = u64::try_from(number).ok().filter(|number| (min..=max).contains(number));
        if inside.is_none() {
            let path = self.path(key);
            let example = self.example(&path, "1");
            let limit = format!("from {min} to {max}");
            self.report(
                node,
                path,
                DiagnosticKind::OutOfRange { found: node.describe(), limit, example },
            );
        }
        inside
    }

    fn parse_vector(&mut self, node: &Node, key: &str, kind: Quantity) -> Option<Vec3> {
        if let Value::List(items) = &node.value
            && let [x, y, z] = items.as_slice()
        {
            let x = self.parse_quantity(x, key, kind);
            let y = self.parse_quantity(y, key, kind);
            let z = self.parse_quantity(z, key, kind);
            return Some(Vec3::new(x?, y?, z?));
        }
        let one = unit_example(kind.dimension);
        let example = format!("[{one}, {one}, {one}]");
        self.wrong_type(node, key, "three numbers with units, [x, y, z]", &example);
        None
    }

    fn not_one_of(&mut self, at: &Node, key: &str, found: String, known: &[&'static str]) {
        let near = near_matches(found.trim_matches('`'), known.iter().copied());
        let path = self.path(key);
        let known = known.join(", ");
        self.report(at, path, DiagnosticKind::NotOneOf { found, known, near });
    }
}

/// Examples for keys without a default.
const EXAMPLES: &[(&str, &str)] = &[
    ("name", "my_scene"),
    ("object", "object: { shape: { sphere: { radius: 10 mm } }, position: [0 m, 0 m, 10 mm] }"),
    ("object.shape", "shape: { sphere: { radius: 10 mm } }"),
    ("object.position", "[0 m, 0 m, 10 mm]"),
    ("object.shape.box.size", "[20 mm, 20 mm, 60 mm]"),
    ("object.shape.mesh.file", "meshes/blob.stl"),
    ("object.shape.mesh.unit", "1 mm"),
    ("object.shape.convex_hull.points", "[[0 mm, 0 mm, 0 mm], [20 mm, 0 mm, 0 mm], …]"),
];

fn unit_example(dimension: &Dimension) -> String {
    let everyday = if dimension.name == "length" { "10 mm" } else { "" };
    if everyday.is_empty() { format!("1 {}", dimension.units[0].name) } else { everyday.to_owned() }
}

/// A scalar or a list of scalars, as written.
pub(super) fn plain(node: &Node) -> Option<String> {
    match &node.value {
        Value::List(items) => {
            let items: Option<Vec<String>> = items.iter().map(plain).collect();
            items.map(|items| format!("[{}]", items.join(", ")))
        }
        Value::Null | Value::Map(_) => None,
        _ => Some(node.describe().trim_matches('`').to_owned()),
    }
}

/// The first key of a map with its value.
fn first_entry(map: &Node) -> Option<String> {
    let Value::Map(entries) = &map.value else { return None };
    let entry = entries.first()?;
    Some(format!("{{ {}: {} }}", entry.key, plain(&entry.node)?))
}

/// True if `node` is `word`.
fn is_word(node: &Node, word: &str) -> bool {
    matches!(&node.value, Value::Text(text) if text == word)
}

impl Visitor for Reader<'_> {
    fn section(&mut self, key: &'static str, inside: impl FnOnce(&mut Self)) {
        let node = self.take(key).and_then(|node| {
            let is_map = matches!(node.value, Value::Map(_));
            if !is_map {
                let path = self.path(key);
                let first = self.examples.at(&path).and_then(first_entry).unwrap_or_default();
                self.wrong_type(node, key, "a map of keys and values", &first);
            }
            is_map.then_some(node)
        });
        self.open.push(Section { key, node, known: Vec::new() });
        inside(self);
        self.close_section();
    }

    fn quantity(&mut self, key: &'static str, kind: Quantity, value: &mut Real) {
        let found = self.take(key).and_then(|node| self.parse_quantity(node, key, kind));
        *value = found.unwrap_or(Real::NAN);
    }

    fn quantity_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        kind: Quantity,
        value: &mut Option<Real>,
    ) {
        let node = self.take(key).filter(|node| !is_word(node, word));
        *value = node.and_then(|node| self.parse_quantity(node, key, kind));
    }

    fn vector(&mut self, key: &'static str, kind: Quantity, value: &mut Vec3) {
        let found = self.take(key).and_then(|node| self.parse_vector(node, key, kind));
        *value = found.unwrap_or_else(|| Vec3::repeat(Real::NAN));
    }

    fn vectors(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Vec3>) {
        let Some(node) = self.take(key) else { return };
        let Value::List(items) = &node.value else {
            self.wrong_type(node, key, "a list of points", "");
            return;
        };
        *value = items.iter().filter_map(|item| self.parse_vector(item, key, kind)).collect();
    }

    fn number(&mut self, key: &'static str, range: Range, value: &mut Real) {
        let found = self.take(key).and_then(|node| self.parse_number(node, key, range));
        *value = found.unwrap_or(Real::NAN);
    }

    fn numbers<const N: usize>(&mut self, key: &'static str, value: &mut [Real; N]) {
        let Some(node) = self.take(key) else { return };
        match &node.value {
            Value::List(items) if items.len() == N => {
                for (item, value) in items.iter().zip(value) {
                    *value = self.parse_number(item, key, Range::Any).unwrap_or(Real::NAN);
                }
            }
            _ => self.wrong_type(node, key, "a list of numbers", "[0, 0, 0, 1]"),
        }
    }

    fn quantities(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Real>) {
        let Some(node) = self.take(key) else { return };
        let Value::List(items) = &node.value else {
            let one = unit_example(kind.dimension);
            self.wrong_type(node, key, "a list of numbers with units", &format!("[{one}, {one}]"));
            return;
        };
        *value = items.iter().filter_map(|item| self.parse_quantity(item, key, kind)).collect();
    }

    fn plain_numbers(&mut self, key: &'static str, range: Range, value: &mut Vec<Real>) {
        let Some(node) = self.take(key) else { return };
        let Value::List(items) = &node.value else {
            self.wrong_type(node, key, "a list of numbers", "[0.5, 1]");
            return;
        };
        *value = items.iter().filter_map(|item| self.parse_number(item, key, range)).collect();
    }

    fn integer(&mut self, key: &'static str, min: u64, max: u64, value: &mut u64) {
        let found = self.take(key).and_then(|node| self.parse_integer(node, key, (min, max)));
        *value = found.unwrap_or(0);
    }

    fn integer_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        max: u64,
        value: &mut Option<u64>,
    ) {
        let node = self.take(key).filter(|node| !is_word(node, word));
        *value = node.and_then(|node| self.parse_integer(node, key, (0, max)));
    }

    fn flag(&mut self, key: &'static str, value: &mut bool) {
        let Some(node) = self.take(key) else { return };
        match node.value {
            Value::Flag(flag) => *value = flag,
            _ => self.wrong_type(node, key, "true or false", "true"),
        }
    }

    fn text(&mut self, key: &'static str, value: &mut String) {
        let Some(node) = self.take(key) else { return };
        match &node.value {
            Value::Text(text) => value.clone_from(text),
            _ => self.wrong_type(node, key, "a string", "text"),
        }
    }

    fn text_or(&mut self, key: &'static str, word: &'static str, value: &mut Option<String>) {
        let mut text = String::new();
        self.text(key, &mut text);
        *value = (text != word && !text.is_empty()).then_some(text);
    }

    fn choice(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        current: &'static str,
    ) -> &'static str {
        let Some(node) = self.take(key) else { return current };
        let chosen = match &node.value {
            Value::Text(text) => known.iter().find(|name| *name == text),
            _ => None,
        };
        if chosen.is_none() {
            self.not_one_of(node, key, node.describe(), known);
        }
        chosen.copied().unwrap_or(current)
    }

    fn alternative(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        _current: &'static str,
    ) -> Option<&'static str> {
        let node = self.take(key)?;
        let Value::Map(entries) = &node.value else {
            self.not_one_of(node, key, node.describe(), known);
            return None;
        };
        let [entry] = entries.as_slice() else {
            self.not_one_of(node, key, format!("a map of {} keys", entries.len()), known);
            return None;
        };
        let chosen = known.iter().find(|name| **name == entry.key).copied();
        if chosen.is_none() {
            let at = Node { location: entry.location.clone(), value: Value::Null };
            self.not_one_of(&at, key, format!("`{}`", entry.key), known);
        }
        chosen
    }

    fn is_reading(&self) -> bool {
        true
    }
}
