//! ROS 2 parameter files: node names, below them `ros__parameters`, below that the keys.

use super::{
    tree::{Node, Value},
    yaml,
};

/// The parameters of a node, in the order written: dotted keys, values as text.
///
/// # Errors
/// If the text is not a parameter file.
pub fn of_node(text: &str, source: &str, node: &str) -> Result<Vec<(String, String)>, String> {
    let tree = yaml::parse(text, source).map_err(|error| error.to_string())?;
    let Value::Map(entries) = &tree.value else {
        return Err("write node names with ros__parameters below them".to_owned());
    };
    let mut found = Vec::new();
    for entry in entries {
        let is_for_node = entry.key == "/**"
            || entry.key == node
            || entry.key.trim_start_matches('/') == node.trim_start_matches('/');
        if is_for_node {
            let parameters = entry.node.get("ros__parameters").ok_or_else(|| {
                format!("`{}` has no ros__parameters: write them below it", entry.key)
            })?;
            flatten(parameters, "", &mut found)?;
        }
    }
    Ok(found)
}

fn flatten(node: &Node, path: &str, found: &mut Vec<(String, String)>) -> Result<(), String> {
    if let Value::Map(entries) = &node.value {
        for entry in entries {
            let path =
                if path.is_empty() { entry.key.clone() } else { format!("{path}.{}", entry.key) };
            flatten(&entry.node, &path, found)?;
        }
        return Ok(());
    }
    found.push((path.to_owned(), plain(node).ok_or_else(|| format!("`{path}` has no value"))?));
    Ok(())
}

fn plain(node: &Node) -> Option<String> {
    Some(match &node.value {
        Value::Null | Value::Map(_) => return None,
        Value::Flag(flag) => flag.to_string(),
        Value::Integer(number) => number.to_string(),
        Value::Real(number) => number.to_string(),
        Value::Text(text) => text.clone(),
        Value::List(items) => {
            let items: Option<Vec<String>> = items.iter().map(plain).collect();
            format!("[{}]", items?.join(", "))
        }
    })
}
