//! Layouts and launch files refer to existing topics and fields.

use std::{fs, path::Path};

use jamgrip::wire::topics::topics;

use crate::by_tick::scene;

/// The parts of a text that begin with the node's name, up to the end of the name.
fn names(text: &str) -> Vec<String> {
    let end = |c: char| !(c.is_ascii_alphanumeric() || "/_.".contains(c));
    let starts = text.match_indices("/jamgrip/").map(|(at, _)| &text[at..]);
    starts.map(|rest| rest.split(end).next().unwrap().to_owned()).collect()
}

/// Oracle: the list of topics, and the definition of each type.
#[test]
fn layouts_refer_to_existing_fields() {
    let topics = topics(&scene());
    for (file, separator) in
        [("jamgrip.rviz", '.'), ("foxglove.json", '.'), ("plotjuggler.xml", '/')]
    {
        let path = Path::new("launch_configs/ros").join(file);
        let names = names(&fs::read_to_string(&path).unwrap());
        assert!(4 <= names.len(), "{file} names nothing");
        for name in names {
            // The longest topic name that is a prefix of this one.
            let found = topics.iter().filter(|it| {
                let rest = name.strip_prefix(&it.name);
                rest.is_some_and(|rest| rest.is_empty() || rest.starts_with(separator))
            });
            let topic = found.max_by_key(|it| it.name.len());
            let topic = topic.unwrap_or_else(|| panic!("{file}: no topic `{name}`"));
            let fields = name[topic.name.len()..].split(separator).filter(|it| !it.is_empty());
            for field in fields {
                let exists = topic
                    .message_type
                    .definition
                    .lines()
                    .any(|line| line.split_whitespace().nth(1).is_some_and(|it| it == field));
                assert!(exists, "{file}: `{}` has no `{field}`", topic.message_type.name);
            }
        }
    }
}
