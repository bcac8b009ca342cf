//! Describes all keys of a scene: as a page of the documentation, and as a JSON Schema with which
//! editors complete and check scene files.
//!
//! Both visit the keys of `schema`, as the reader does, so they always match what is accepted.

use std::fmt::Write;

use serde_json::{Map, Value as Json, json};

use super::{
    quantity::Dimension,
    read, schema,
    text::{DEFAULTS, DEFAULTS_FILE},
    tree::Node,
    unset,
    visit::{Quantity, Range, Visitor},
    yaml,
};
use crate::base::{Real, Vec3};

/// At least the largest number of alternatives of a key.
const N_WALKS: usize = 8;

/// The page `docs/scene_keys.md`.
pub fn markdown() -> String {
    let mut text = HEAD.to_owned();
    let keys = keys();
    text.push_str("\n## Units\n\n| quantity | units |\n|---|---|\n");
    let mut dimensions: Vec<&Dimension> = keys.iter().filter_map(|it| it.dimension()).collect();
    dimensions.sort_by_key(|it| it.name);
    dimensions.dedup_by_key(|it| it.name);
    for it in dimensions {
        line(&mut text, &format!("| {} | {} |", it.name, it.unit_names()));
    }
    line(&mut text, "\n## Top level\n");
    table(&mut text, &keys, "");
    for key in keys.iter().filter(|it| matches!(it.kind, Kind::Section) && it.is_heading()) {
        line(&mut text, &format!("\n## `{}`\n\n{}\n", key.path, key.doc));
        table(&mut text, &keys, &key.path);
    }
    text
}

const HEAD: &str = "\
<!-- Generated from `src/scene/schema.rs` and `launch_configs/defaults.yaml`.
     To regenerate: JAMGRIP_UPDATE=1 cargo test --release --test it book -->

# Scene keys

All keys of a scene file, with their ranges and defaults.
[Scenes](scene.md) explains how scene files work.
A key without a default is required; of a shape or an orientation, exactly one alternative is given.
";

/// The table of the keys below the heading of `section`.
fn table(text: &mut String, keys: &[Key], section: &str) {
    line(text, "| key | value | default | meaning |\n|---|---|---|---|");
    let defaults = defaults();
    let is_row = |it: &&Key| it.heading() == section && !matches!(it.kind, Kind::Section);
    for key in keys.iter().filter(is_row) {
        let name = key.path.strip_prefix(section).unwrap_or(&key.path).trim_start_matches('.');
        let default = defaults.at(&key.path).and_then(read::plain);
        let default = match &key.kind {
            Kind::Alternative(_) => String::new(),
            _ => default.map_or_else(String::new, |it| format!("`{it}`")),
        };
        line(text, &format!("| `{name}` | {} | {default} | {} |", key.kind.describe(), key.doc));
    }
}

/// The JSON Schema `launch_configs/scene.schema.json`.
pub fn json_schema() -> String {
    let mut root = object("A scene of jamgrip.");
    root["$schema"] = json!("http://json-schema.org/draft-07/schema#");
    root["title"] = json!("jamgrip scene");
    let defaults = defaults();
    for key in keys() {
        let default = defaults.at(&key.path).and_then(read::plain);
        let description = match default {
            Some(default) => format!("{} Default: {default}.", key.doc),
            None => key.doc.to_owned(),
        };
        let mut parts: Vec<&str> = key.path.split('.').collect();
        let name = parts.pop().unwrap_or_default();
        let mut at = &mut root;
        for part in parts {
            at = &mut at["properties"][part];
        }
        // An alternative has created an empty section already; its keys follow.
        if !matches!(key.kind, Kind::Section) || at["properties"].get(name).is_none() {
            at["properties"][name] = key.kind.to_json(&description);
        }
        if REQUIRED.contains(&key.path.as_str()) {
            let mut names = at["required"].as_array().cloned().unwrap_or_default();
            names.push(json!(name));
            at["required"] = json!(names);
        }
    }
    serde_json::to_string_pretty(&root).expect("all keys are strings") + "\n"
}

/// Keys that every scene has to give.
const REQUIRED: &[&str] = &["name", "object", "object.shape", "object.position"];

/// What a key accepts.
#[derive(Clone, Debug)]
enum Kind {
    Section,
    Quantity(Quantity, Option<&'static str>),
    /// The length; `None` accepts any.
    Quantities(Quantity, Option<usize>),
    Points(Quantity),
    Number(Range),
    Numbers(Range, Option<usize>),
    Integer(u64, u64, Option<&'static str>),
    Flag,
    Text(Option<&'static str>),
    Choice(Vec<&'static str>),
    Alternative(Vec<&'static str>),
}

/// A key with its description.
#[derive(Clone, Debug)]
struct Key {
    path: String,
    doc: &'static str,
    kind: Kind,
}

impl Key {
    fn dimension(&self) -> Option<&'static Dimension> {
        match &self.kind {
            Kind::Quantity(kind, _) | Kind::Quantities(kind, _) | Kind::Points(kind) => {
                Some(kind.dimension)
            }
            _ => None,
        }
    }

    /// True for sections with a heading of their own.
    fn is_heading(&self) -> bool {
        matches!(self.kind, Kind::Section) && !self.doc.is_empty()
    }

    /// The section whose table lists the key.
    fn heading(&self) -> String {
        let parts: Vec<&str> = self.path.split('.').collect();
        let depth = match parts.as_slice() {
            ["outputs", "ros" | "bag", _, ..] => 2,
            [_, _, ..] => 1,
            _ => 0,
        };
        parts[..depth].join(".")
    }
}

impl Kind {
    /// A description for the documentation.
    fn describe(&self) -> String {
        let or = |word: &Option<&str>| word.map_or_else(String::new, |it| format!(", or `{it}`"));
        let words = |known: &[&str]| -> String {
            let known: Vec<String> = known.iter().map(|it| format!("`{it}`")).collect();
            known.join(", ")
        };
        match self {
            Self::Section => String::new(),
            Self::Quantity(kind, word) => format!("{}{}", kind.describe(), or(word)),
            Self::Quantities(kind, Some(_)) => format!("[x, y, z], {}", kind.describe()),
            Self::Quantities(kind, None) => format!("list of {}", kind.describe()),
            Self::Points(kind) => format!("list of points [x, y, z], {}", kind.describe()),
            Self::Number(range) => numbers("number", *range),
            Self::Numbers(range, Some(n)) => numbers(&format!("{n} numbers"), *range),
            Self::Numbers(range, None) => numbers("list of numbers", *range),
            Self::Integer(min, u64::MAX, word) => format!("integer, at least {min}{}", or(word)),
            Self::Integer(min, max, word) => format!("integer, {min} to {max}{}", or(word)),
            Self::Flag => "`true`, `false`".to_owned(),
            Self::Text(word) => format!("text{}", or(word)),
            Self::Choice(known) => words(known),
            Self::Alternative(known) => format!("one of {}", words(known)),
        }
    }

    /// The JSON Schema.
    fn to_json(&self, description: &str) -> Json {
        let mut schema = match self {
            Self::Section => object(""),
            Self::Quantity(kind, word) => text_schema(kind.dimension, *word),
            Self::Quantities(kind, n) => list(&text_schema(kind.dimension, None), *n),
            Self::Points(kind) => list(&list(&text_schema(kind.dimension, None), Some(3)), None),
            Self::Number(range) => number_schema(*range),
            Self::Numbers(range, n) => list(&number_schema(*range), *n),
            Self::Integer(min, max, word) => {
                let number = json!({"type": "integer", "minimum": min, "maximum": max});
                match word {
                    Some(word) => json!({"anyOf": [number, {"const": word}]}),
                    None => number,
                }
            }
            Self::Flag => json!({"type": "boolean"}),
            Self::Text(_) => json!({"type": "string"}),
            Self::Choice(known) => json!({"enum": known}),
            Self::Alternative(known) => {
                let mut schema = object("");
                for name in known {
                    schema["properties"][*name] = object("");
                }
                schema["minProperties"] = json!(1);
                schema["maxProperties"] = json!(1);
                schema
            }
        };
        schema["description"] = json!(description);
        schema
    }
}

impl Quantity {
    fn describe(self) -> String {
        let limit = self.range.describe(|number| match number {
            0.0 => "0".to_owned(),
            _ => self.dimension.print(number),
        });
        match self.range {
            Range::Any => self.dimension.name.to_owned(),
            _ => format!("{}, {limit}", self.dimension.name),
        }
    }
}

fn numbers(what: &str, range: Range) -> String {
    match range {
        Range::Any => what.to_owned(),
        _ => format!("{what}, {}", range.describe(|number| number.to_string())),
    }
}

fn object(description: &str) -> Json {
    json!({
        "type": "object",
        "description": description,
        "properties": Map::new(),
        "additionalProperties": false,
    })
}

fn list(item: &Json, n_items: Option<usize>) -> Json {
    let mut schema = json!({"type": "array", "items": item});
    if let Some(n) = n_items {
        (schema["minItems"], schema["maxItems"]) = (json!(n), json!(n));
    }
    schema
}

/// A number with one of the units of `dimension`. Limits are checked when the scene is read.
fn text_schema(dimension: &Dimension, word: Option<&str>) -> Json {
    let escape =
        |unit: &str| unit.replace('^', "\\^?").replace(' ', "[ *·]").replace("um", "[uµμ]m");
    let units: Vec<String> = dimension.units.iter().map(|it| escape(it.name)).collect();
    let units = units.join("|").replace("\\^?3", "(\\^3|³)").replace("\\^?2", "(\\^2|²)");
    let number = "[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";
    let word = word.map_or_else(String::new, |it| format!("|{it}"));
    json!({"type": "string", "pattern": format!("^({number} *({units}){word})$")})
}

fn number_schema(range: Range) -> Json {
    let mut schema = json!({"type": "number"});
    match range {
        Range::Any => {}
        Range::Above(min) => schema["exclusiveMinimum"] = json!(min),
        Range::AtLeast(min) => schema["minimum"] = json!(min),
        Range::AtMost(max) => schema["maximum"] = json!(max),
        Range::Between(min, max) => {
            (schema["minimum"], schema["maximum"]) = (json!(min), json!(max));
        }
        Range::AboveUpTo(min, max) => {
            (schema["exclusiveMinimum"], schema["maximum"]) = (json!(min), json!(max));
        }
    }
    schema
}

fn line(text: &mut String, line: &str) {
    writeln!(text, "{line}").expect("writing to a String cannot fail");
}

fn defaults() -> Node {
    yaml::parse(DEFAULTS, DEFAULTS_FILE).expect("the defaults are valid YAML")
}

/// All keys, in the order of the schema.
fn keys() -> Vec<Key> {
    let mut collector = Collector::default();
    // Each walk takes other alternatives; the last one takes the first of each. Keys that a walk
    // adds are inserted before those that earlier walks found at the same position.
    for i in (0..N_WALKS).rev() {
        (collector.i_alternative, collector.next) = (i, 0);
        schema::scene(&mut collector, &mut unset::scene());
    }
    collector.keys
}

/// Collects the keys that it visits.
#[derive(Default)]
struct Collector {
    open: Vec<&'static str>,
    doc: &'static str,
    keys: Vec<Key>,
    /// Where the next key is inserted.
    next: usize,
    i_alternative: usize,
}

impl Collector {
    fn add(&mut self, key: &'static str, kind: Kind) {
        let mut parts = self.open.clone();
        parts.push(key);
        let (path, doc) = (parts.join("."), std::mem::take(&mut self.doc));
        let is_known = self.keys.iter().position(|it| it.path == path);
        let at = is_known.unwrap_or_else(|| {
            self.keys.insert(self.next, Key { path, doc, kind });
            self.next
        });
        self.next = at + 1;
    }
}

impl Visitor for Collector {
    fn doc(&mut self, text: &'static str) {
        self.doc = text;
    }

    fn section(&mut self, key: &'static str, inside: impl FnOnce(&mut Self)) {
        self.add(key, Kind::Section);
        self.open.push(key);
        inside(self);
        self.open.pop();
    }

    fn quantity(&mut self, key: &'static str, kind: Quantity, _value: &mut Real) {
        self.add(key, Kind::Quantity(kind, None));
    }

    fn quantity_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        kind: Quantity,
        _value: &mut Option<Real>,
    ) {
        self.add(key, Kind::Quantity(kind, Some(word)));
    }

    fn vector(&mut self, key: &'static str, kind: Quantity, _value: &mut Vec3) {
        self.add(key, Kind::Quantities(kind, Some(3)));
    }

    fn vectors(&mut self, key: &'static str, kind: Quantity, _value: &mut Vec<Vec3>) {
        self.add(key, Kind::Points(kind));
    }

    fn number(&mut self, key: &'static str, range: Range, _value: &mut Real) {
        self.add(key, Kind::Number(range));
    }

    fn numbers<const N: usize>(&mut self, key: &'static str, _value: &mut [Real; N]) {
        self.add(key, Kind::Numbers(Range::Any, Some(N)));
    }

    fn quantities(&mut self, key: &'static str, kind: Quantity, _value: &mut Vec<Real>) {
        self.add(key, Kind::Quantities(kind, None));
    }

    fn plain_numbers(&mut self, key: &'static str, range: Range, _value: &mut Vec<Real>) {
        self.add(key, Kind::Numbers(range, None));
    }

    fn integer(&mut self, key: &'static str, min: u64, max: u64, _value: &mut u64) {
        self.add(key, Kind::Integer(min, max, None));
    }

    fn integer_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        max: u64,
        _value: &mut Option<u64>,
    ) {
        self.add(key, Kind::Integer(0, max, Some(word)));
    }

    fn flag(&mut self, key: &'static str, _value: &mut bool) {
        self.add(key, Kind::Flag);
    }

    fn text(&mut self, key: &'static str, _value: &mut String) {
        self.add(key, Kind::Text(None));
    }

    fn text_or(&mut self, key: &'static str, word: &'static str, _value: &mut Option<String>) {
        self.add(key, Kind::Text(Some(word)));
    }

    fn choice(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        current: &'static str,
    ) -> &'static str {
        self.add(key, Kind::Choice(known.to_vec()));
        current
    }

    fn alternative(
        &mut self,
        key: &'static str,
        known: &[&'static str],
        _current: &'static str,
    ) -> Option<&'static str> {
        self.add(key, Kind::Alternative(known.to_vec()));
        known.get(self.i_alternative.min(known.len() - 1)).copied()
    }

    fn is_reading(&self) -> bool {
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: `schema::scene` calls `doc` before each key. Sections of alternatives have no
    /// description.
    #[test]
    fn every_key_is_described() {
        let keys = keys();
        let is_silent = |it: &&Key| !matches!(it.kind, Kind::Section) && it.doc.is_empty();
        let silent: Vec<_> = keys.iter().filter(is_silent).map(|it| &it.path).collect();
        assert!(silent.is_empty(), "add `walk.doc` before {silent:?}");
        assert!(
            keys.iter().any(|it| it.path == "object.shape.mesh.unit"),
            "all shapes are visited"
        );
    }

    /// Oracle: the keys of the defaults file, read as plain YAML.
    #[test]
    fn every_default_belongs_to_a_key() {
        fn paths(value: &Json, path: &str, found: &mut Vec<String>) {
            let Json::Object(map) = value else {
                found.push(path.to_owned());
                return;
            };
            for (key, value) in map {
                let below = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                paths(value, &below, found);
            }
        }
        let mut found = Vec::new();
        paths(&super::super::json::parse(DEFAULTS, DEFAULTS_FILE).unwrap(), "", &mut found);
        let keys = keys();
        for path in found {
            assert!(keys.iter().any(|it| it.path == path), "{path}");
        }
    }
}
