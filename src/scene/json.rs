//! YAML as JSON values, for texts that are not scenes.

use serde_json::Value as Json;

use super::{
    tree::{Node, Value},
    yaml::{self, SyntaxError},
};

/// Parses one YAML document. `source` is its name in errors.
///
/// # Errors
/// If the text is not YAML.
pub fn parse(text: &str, source: &str) -> Result<Json, SyntaxError> {
    Ok(json(&yaml::parse(text, source)?))
}

fn json(node: &Node) -> Json {
    match &node.value {
        Value::Null => Json::Null,
        Value::Flag(flag) => Json::from(*flag),
        Value::Integer(number) => match (u64::try_from(*number), i64::try_from(*number)) {
            (Ok(number), _) => Json::from(number),
            (_, Ok(number)) => Json::from(number),
            // Beyond the range of 64-bit integers.
            _ => Json::Null,
        },
        Value::Real(number) => Json::from(*number),
        Value::Text(text) => Json::from(text.as_str()),
        Value::List(items) => items.iter().map(json).collect(),
        Value::Map(entries) => entries
            .iter()
            .map(|it| (it.key.clone(), json(&it.node)))
            .collect::<serde_json::Map<_, _>>()
            .into(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: the same in JSON, written by hand.
    #[test]
    fn yaml_is_what_json_would_be() {
        let found = parse("a: { b: [1, -2, 0.5], c: ~ }\nd: \"x\"\n", "x").unwrap();
        assert_eq!(found, serde_json::json!({"a": {"b": [1, -2, 0.5], "c": null}, "d": "x"}));
    }
}
