//! Forbidden names in a source file.

use std::collections::BTreeSet;

use crate::{
    paths::{self, Mention},
    rules::{BANS, Ban, FOREIGN, UNSAFE, is_in},
};

/// Everything in the source `text` of `file` that breaks a rule. `order` lists the modules of
/// `src/lib.rs`: each may use only those before it.
pub(crate) fn violations(file: &str, text: &str, order: &[String]) -> Vec<String> {
    let read = match paths::read(&module(file), text) {
        Ok(read) => read,
        Err(error) => return vec![format!("{file}: {error}")],
    };
    let mut found = Vec::new();
    // Once in each file is enough.
    let mut foreign_found = BTreeSet::new();
    for it in &read.mentions {
        let place = format!("{file}:{}: `{}`", it.line, it.path.join("::"));
        found.extend(against_order(file, it, order).map(|why| format!("{place}: {why}")));
        if let Some((name, why)) = against_foreign(file, it)
            && foreign_found.insert(name)
        {
            found.push(format!("{place}: {why}"));
        }
        for ban in BANS.iter().filter(|ban| !is_in(file, ban.except)) {
            if is_banned(file, it, ban) {
                found.push(format!("{place}: {}", ban.why));
            }
        }
    }
    for line in read.unsafe_lines.iter().filter(|_| !is_in(file, UNSAFE)) {
        found.push(format!("{file}:{line}: unsafe code belongs in {UNSAFE:?}"));
    }
    for line in &read.hidden_lines {
        found.push(format!("{file}:{line}: code that is included is not checked"));
    }
    found
}

/// The names of a file's module below the crate's root.
pub(crate) fn module(file: &str) -> Vec<String> {
    let inside = file.trim_start_matches("src/").trim_end_matches(".rs");
    let inside = inside.strip_suffix("/mod").unwrap_or(inside);
    inside.split('/').filter(|it| *it != "lib").map(str::to_owned).collect()
}

/// True if a file of the ban's modules names one of its paths.
pub(crate) fn is_banned(file: &str, mention: &Mention, ban: &Ban) -> bool {
    let top = module(file).into_iter().next().unwrap_or_default();
    ban.modules.contains(&top.as_str()) && ban.paths.iter().any(|path| mention.reaches(path))
}

fn against_order(file: &str, mention: &Mention, order: &[String]) -> Option<String> {
    let top = module(file).into_iter().next()?;
    let here = order.iter().position(|it| *it == top)?;
    let [first, other, ..] = mention.path.as_slice() else { return None };
    if first != "crate" {
        return None;
    }
    if other == "*" {
        return Some("a glob of the whole crate hides what is used".to_owned());
    }
    let is_below = order.iter().skip(here + 1).any(|it| it == other);
    is_below.then(|| format!("`{top}` may not use `{other}`, which is below it in src/lib.rs"))
}

fn against_foreign(file: &str, mention: &Mention) -> Option<(&'static str, String)> {
    let (path, places) = foreign(mention)?;
    (!is_in(file, places)).then(|| (path, format!("`{path}` belongs in {places:?}")))
}

/// The entry of the table that decides about a path.
pub(crate) fn foreign(mention: &Mention) -> Option<(&'static str, &'static [&'static str])> {
    let path = mention.path.join("::");
    let is_inside = |entry: &str| path == entry || path.starts_with(&format!("{entry}::"));
    let entries = FOREIGN.iter().filter(|it| is_inside(it.0));
    entries.max_by_key(|it| it.0.len()).map(|it| (it.0, it.1))
}
