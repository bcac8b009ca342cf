//! Writes a scene as YAML with units. Reading the text gives the same scene, bit for bit.

use std::fmt::Write;

use super::{
    Scene, schema,
    visit::{Quantity, Range, Visitor},
};
use crate::base::{Real, Vec3};

/// The complete scene as YAML, defaults included.
pub fn to_yaml(scene: &Scene) -> String {
    let mut printer = Printer { text: String::new(), depth: 0 };
    schema::scene(&mut printer, &mut scene.clone());
    printer.text
}

struct Printer {
    text: String,
    depth: usize,
}

impl Printer {
    fn line(&mut self, key: &str, value: &str) {
        let indent = "  ".repeat(self.depth);
        writeln!(self.text, "{indent}{key}: {value}").expect("writing to a String cannot fail");
    }
}

/// A string in double quotes; JSON strings are valid YAML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn vector_text(kind: Quantity, vector: &Vec3) -> String {
    let parts: Vec<String> = vector.iter().map(|&it| kind.dimension.print(it)).collect();
    format!("[{}]", parts.join(", "))
}

impl Visitor for Printer {
    fn section(&mut self, key: &'static str, inside: impl FnOnce(&mut Self)) {
        let indent = "  ".repeat(self.depth);
        writeln!(self.text, "{indent}{key}:").expect("writing to a String cannot fail");
        self.depth += 1;
        inside(self);
        self.depth -= 1;
    }

    fn quantity(&mut self, key: &'static str, kind: Quantity, value: &mut Real) {
        self.line(key, &kind.dimension.print(*value));
    }

    fn quantity_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        kind: Quantity,
        value: &mut Option<Real>,
    ) {
        let text = value.map_or_else(|| word.to_owned(), |value| kind.dimension.print(value));
        self.line(key, &text);
    }

    fn vector(&mut self, key: &'static str, kind: Quantity, value: &mut Vec3) {
        self.line(key, &vector_text(kind, value));
    }

    fn vectors(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Vec3>) {
        let points: Vec<String> = value.iter().map(|it| vector_text(kind, it)).collect();
        self.line(key, &format!("[{}]", points.join(", ")));
    }

    fn number(&mut self, key: &'static str, _range: Range, value: &mut Real) {
        self.line(key, &value.to_string());
    }

    fn numbers<const N: usize>(&mut self, key: &'static str, value: &mut [Real; N]) {
        let numbers: Vec<String> = value.iter().map(Real::to_string).collect();
        self.line(key, &format!("[{}]", numbers.join(", ")));
    }

    fn quantities(&mut self, key: &'static str, kind: Quantity, value: &mut Vec<Real>) {
        let numbers: Vec<String> = value.iter().map(|&it| kind.dimension.print(it)).collect();
        self.line(key, &format!("[{}]", numbers.join(", ")));
    }

    fn plain_numbers(&mut self, key: &'static str, _range: Range, value: &mut Vec<Real>) {
        let numbers: Vec<String> = value.iter().map(Real::to_string).collect();
        self.line(key, &format!("[{}]", numbers.join(", ")));
    }

    fn integer(&mut self, key: &'static str, _min: u64, _max: u64, value: &mut u64) {
        self.line(key, &value.to_string());
    }

    fn integer_or(
        &mut self,
        key: &'static str,
        word: &'static str,
        _max: u64,
        value: &mut Option<u64>,
    ) {
        self.line(key, &value.map_or_else(|| word.to_owned(), |value| value.to_string()));
    }

    fn flag(&mut self, key: &'static str, value: &mut bool) {
        self.line(key, &value.to_string());
    }

    fn text(&mut self, key: &'static str, value: &mut String) {
        self.line(key, &quoted(value));
    }

    fn text_or(&mut self, key: &'static str, word: &'static str, value: &mut Option<String>) {
        let text = value.as_ref().map_or_else(|| word.to_owned(), |value| quoted(value));
        self.line(key, &text);
    }

    fn choice(
        &mut self,
        key: &'static str,
        _known: &[&'static str],
        current: &'static str,
    ) -> &'static str {
        self.line(key, current);
        current
    }

    fn alternative(
        &mut self,
        _key: &'static str,
        _known: &[&'static str],
        current: &'static str,
    ) -> Option<&'static str> {
        Some(current)
    }

    fn is_reading(&self) -> bool {
        false
    }
}
