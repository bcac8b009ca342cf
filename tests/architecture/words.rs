//! Words that must not come back; `tests/golden/words_not_used.txt` lists them.
//!
//! The test searches code, names, comments, help texts, documents and tests. A name
//! counts as the words it is made of, so `n_foo_bars` and `FooBar` are both found by `foo bars?`. A
//! phrase is found across line ends too.

use std::path::Path;

use regex::{Regex, RegexBuilder};

use crate::{assert_none, files_in, read, rules::GENERATED};

const LIST: &str = "tests/golden/words_not_used.txt";
/// Quotes phrases that were replaced, so it is not searched.
const REVIEW: &str = "docs/language_review.md";

/// A line of the list: `pattern => replacement`, and `=> path path` where the word is allowed.
struct Entry {
    line: usize,
    is_on: bool,
    pattern: Regex,
    replacement: String,
    allowed_in: Vec<String>,
}

#[test]
fn words_do_not_come_back() {
    let entries = entries(&read(Path::new(LIST)));
    let texts: Vec<(String, Text)> = texts();
    assert!(100 < texts.len(), "{} texts", texts.len());
    let mut violations = Vec::new();
    for entry in entries.iter().filter(|it| it.is_on) {
        for (file, text) in &texts {
            if entry.allowed_in.iter().any(|it| file == it) {
                continue;
            }
            for (line, word) in text.find(&entry.pattern) {
                let better = &entry.replacement;
                violations.push(format!("{file}:{line}: `{word}`; the usual word: {better}"));
            }
        }
        for place in &entry.allowed_in {
            let is_there = texts
                .iter()
                .any(|(file, text)| file == place && text.find(&entry.pattern).next().is_some());
            if !is_there {
                violations.push(format!("{LIST}:{}: nothing to allow in {place}", entry.line));
            }
        }
    }
    assert_none(&violations);
}

#[test]
fn words_of_the_list_are_found() {
    let list = "# A comment.\n\nfoo bars? => baz\n#off quux => corge\nis told => is printed => a.rs b.rs\n";
    let entries = entries(list);
    assert_eq!(entries.iter().map(|it| it.is_on).collect::<Vec<_>>(), [true, false, true]);
    assert_eq!(entries[2].allowed_in, ["a.rs", "b.rs"]);
    let find = |text: &str| {
        let text = Text::of("src/a.rs", text);
        let found = entries.iter().flat_map(|it| text.find(&it.pattern).collect::<Vec<_>>());
        found.map(|it| (it.0, it.1.to_owned())).collect::<Vec<_>>()
    };
    let one = |line: usize, word: &str| vec![(line, word.to_owned())];
    assert_eq!(find("let n_foo_bars = 1;"), one(1, "foo bars"));
    assert_eq!(find("\nstruct MyFooBar;"), one(2, "foo bar"));
    assert_eq!(find("const FOO_BAR: u8 = 1;"), one(1, "foo bar"));
    assert_eq!(find("/// What is\n    /// told here."), one(1, "is told"));
    assert_eq!(find("text\nwhat \"is \\\n    told\""), one(2, "is told"));
    assert_eq!(find("Quux42 in a text."), one(1, "quux"));
    assert_eq!(find("food bars, is toldest, foo, bar, quuxes"), []);
    let named = Text::of("src/foo_bar.rs", "");
    assert_eq!(named.find(&entries[0].pattern).count(), 1, "names of files are read too");
}

#[test]
fn only_the_newest_part_of_the_changelog_is_read() {
    let text = "# Changelog\n\n## Unreleased\nnew\n### Added\nmore\n\n## 0.1.0\nold\n";
    assert_eq!(unreleased(text), "\n\n\nnew\n### Added\nmore\n");
}

/// Reads the list; panics where a line is wrong, whether it is on or off.
fn entries(list: &str) -> Vec<Entry> {
    let mut entries = Vec::new();
    for (number, text) in list.lines().enumerate() {
        let (is_on, text) = match text.strip_prefix("#off ") {
            Some(rest) => (false, rest),
            None if text.trim().is_empty() || text.starts_with('#') => continue,
            None => (true, text),
        };
        let line = number + 1;
        let mut columns = text.split(" => ").map(str::trim);
        let (Some(pattern), Some(replacement)) = (columns.next(), columns.next()) else {
            panic!("{LIST}:{line}: `pattern => replacement` is missing: {text}");
        };
        let allowed_in = columns.next().unwrap_or("").split_whitespace().map(str::to_owned);
        let pattern = RegexBuilder::new(&format!(r"\b(?:{pattern})\b"))
            .case_insensitive(true)
            .build()
            .unwrap_or_else(|error| panic!("{LIST}:{line}: {error}"));
        let replacement = replacement.to_owned();
        entries.push(Entry { line, is_on, pattern, replacement, allowed_in: allowed_in.collect() });
    }
    entries
}

/// A text as words on one line.
struct Text {
    words: String,
    /// Where each line of the file begins in `words`; the name of the file comes first.
    starts: Vec<usize>,
}

impl Text {
    fn of(file: &str, text: &str) -> Self {
        let mut words = split_into_words(file);
        let mut starts = Vec::new();
        for line in text.lines() {
            words.push(' ');
            starts.push(words.len());
            let line = line.trim().trim_start_matches(['/', '!', '#', '>', '*', '-']);
            let line = line.trim_end_matches('\\');
            words.push_str(split_into_words(line).trim());
        }
        Self { words, starts }
    }

    /// Lines (0 for the name of the file) and the words found in them.
    fn find<'a>(&'a self, pattern: &'a Regex) -> impl Iterator<Item = (usize, &'a str)> {
        pattern.find_iter(&self.words).map(|it| {
            let line = self.starts.partition_point(|start| *start <= it.start());
            (line, it.as_str())
        })
    }
}

/// Lower case; names such as `n_foo` and `FooBar2` as the words they are made of.
fn split_into_words(text: &str) -> String {
    let mut words = String::with_capacity(text.len() + text.len() / 8);
    let mut before = ' ';
    for c in text.chars() {
        let begins = c.is_uppercase() && before.is_lowercase()
            || c.is_ascii_digit() && before.is_alphabetic();
        if begins {
            words.push(' ');
        }
        if c == '_' || c.is_whitespace() {
            if !words.ends_with(' ') {
                words.push(' ');
            }
        } else {
            words.extend(c.to_lowercase());
        }
        before = c;
    }
    words
}

/// The searched texts, with the names of the files.
fn texts() -> Vec<(String, Text)> {
    let code = ["src", "tests", "benches", "examples"];
    let mut files: Vec<_> =
        code.iter().flat_map(|it| files_in(it, &["rs", "py", "md", "sh", "cpp"])).collect();
    for folder in ["docs", "launch_configs", "bags", ".ci", ".github"] {
        files.extend(files_in(folder, &["md", "yaml", "yml", "py", "xml", "json", ""]));
    }
    let root = std::fs::read_dir(".").unwrap().map(|it| it.unwrap().path());
    files.extend(root.filter(|it| it.extension().is_some_and(|it| it == "md" || it == "toml")));
    let mut texts = Vec::new();
    for path in files {
        let file = path.to_str().unwrap().trim_start_matches("./").to_owned();
        if GENERATED.contains(&file.as_str()) || file == REVIEW {
            continue;
        }
        let mut text = read(&path);
        if file == "CHANGELOG.md" {
            text = unreleased(&text);
        }
        texts.push((file.clone(), Text::of(&file, &text)));
    }
    texts
}

/// The newest part of a changelog; the lines before it are left empty.
fn unreleased(text: &str) -> String {
    let mut is_inside = false;
    let mut part = String::new();
    for line in text.lines() {
        if line.starts_with("## ") {
            if is_inside {
                break;
            }
            is_inside = line.to_lowercase().contains("unreleased");
            part.push('\n');
            continue;
        }
        if is_inside {
            part.push_str(line);
        }
        part.push('\n');
    }
    part.trim_end_matches('\n').to_owned() + "\n"
}
