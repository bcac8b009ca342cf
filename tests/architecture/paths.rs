//! The paths that a source file names, in `use` declarations and in code, resolved to absolute ones.

use std::collections::BTreeMap;

use proc_macro2::{Delimiter, Spacing, TokenStream, TokenTree};
use syn::UseTree;

/// A path that a file names.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Mention {
    /// Line in the file, from 1.
    pub(crate) line: usize,
    /// From the crate's root (`crate`) or from another crate, and `*` at the end of a glob.
    pub(crate) path: Vec<String>,
}

impl Mention {
    /// True if this is `path`, something inside it, or a glob that brings it in.
    pub(crate) fn reaches(&self, path: &str) -> bool {
        let wanted: Vec<&str> = path.split("::").collect();
        let names: Vec<&str> = self.path.iter().map(String::as_str).collect();
        match names.split_last() {
            Some((&"*", parent)) => parent.starts_with(&wanted) || wanted.starts_with(parent),
            _ => names.starts_with(&wanted),
        }
    }
}

/// Everything that the rules check in a file.
#[derive(Debug, Default)]
pub(crate) struct Paths {
    /// The paths, in the order of the text.
    pub(crate) mentions: Vec<Mention>,
    /// Lines with the keyword `unsafe`.
    pub(crate) unsafe_lines: Vec<usize>,
    /// Lines with `include!` or `#[path]`, which include code from other files.
    pub(crate) hidden_lines: Vec<usize>,
}

/// Reads `text`, the source of the module `module` (the names below the crate's root).
pub(crate) fn read(module: &[String], text: &str) -> Result<Paths, String> {
    let tokens: TokenStream = text.parse().map_err(|error| format!("no Rust: {error}"))?;
    let mut reader = Reader::default();
    let mut here = vec!["crate".to_owned()];
    here.extend_from_slice(module);
    // First the names that imports introduce, then the paths that use them.
    reader.read(&here, tokens.clone());
    reader.paths = Paths::default();
    reader.read(&here, tokens);
    Ok(reader.paths)
}

#[derive(Default)]
struct Reader {
    /// Names that imports and `mod` declarations of the file bring in.
    names: BTreeMap<String, Vec<String>>,
    paths: Paths,
}

impl Reader {
    fn read(&mut self, here: &[String], tokens: TokenStream) {
        let tokens: Vec<TokenTree> = tokens.into_iter().collect();
        let mut i = 0;
        while i < tokens.len() {
            i += match &tokens[i] {
                TokenTree::Group(group) => {
                    let is_attribute = 0 < i && is_punct(&tokens[i - 1], '#');
                    if is_attribute && first_word(group.stream()) == "path" {
                        self.paths.hidden_lines.push(line(&tokens[i]));
                    }
                    self.read(here, group.stream());
                    1
                }
                TokenTree::Ident(_) => self.read_word(here, &tokens, i),
                _ => 1,
            };
        }
    }

    /// Reads the item that begins with the word at `i`. Returns its number of tokens.
    fn read_word(&mut self, here: &[String], tokens: &[TokenTree], i: usize) -> usize {
        let next = tokens.get(i + 1);
        match word(&tokens[i]).as_str() {
            "use" if !next.is_some_and(|it| is_punct(it, '<')) => {
                let rest = &tokens[i + 1..];
                let n = rest.iter().take_while(|it| !is_punct(it, ';')).count();
                self.read_use(here, &rest[..n]);
                return 1 + n;
            }
            "extern" if next.is_some_and(|it| word(it) == "crate") => {
                // `extern crate name as other;`
                let is_renamed = tokens.get(i + 3).is_some_and(|it| word(it) == "as");
                let given = tokens.get(i + 4).filter(|_| is_renamed).map(word).unwrap_or_default();
                if let Some(TokenTree::Ident(name)) = tokens.get(i + 2) {
                    self.add(line(&tokens[i]), vec![name.to_string()], Some(&given));
                }
                return 3;
            }
            "mod" => {
                if let Some(TokenTree::Ident(name)) = next {
                    let inner = joined(here, &[name.to_string()]);
                    self.names.insert(name.to_string(), inner.clone());
                    if let Some(TokenTree::Group(body)) = tokens.get(i + 2) {
                        self.read(&inner, body.stream());
                        return 3;
                    }
                    return 2;
                }
            }
            "unsafe" => self.paths.unsafe_lines.push(line(&tokens[i])),
            "include" if next.is_some_and(|it| is_punct(it, '!')) => {
                self.paths.hidden_lines.push(line(&tokens[i]));
            }
            _ => return self.read_path(here, tokens, i),
        }
        1
    }

    /// Reads a path in code, `a::b::c`, from its first name at `i`. Returns its number of tokens.
    fn read_path(&mut self, here: &[String], tokens: &[TokenTree], i: usize) -> usize {
        let is_global = 2 <= i && is_double_colon(tokens, i - 2);
        let mut path = vec![word(&tokens[i])];
        let mut end = i + 1;
        while is_double_colon(tokens, end)
            && let Some(TokenTree::Ident(name)) = tokens.get(end + 2)
        {
            path.push(unraw(&name.to_string()));
            end += 3;
        }
        if 1 < path.len() {
            let path = if is_global { path } else { self.resolved(here, &path) };
            self.paths.mentions.push(Mention { line: line(&tokens[i]), path });
        }
        end - i
    }

    fn read_use(&mut self, here: &[String], tokens: &[TokenTree]) {
        let is_global = is_double_colon(tokens, 0);
        let tree = tokens.iter().skip(if is_global { 2 } else { 0 }).cloned().collect();
        // Within the patterns of a macro something else may follow the word.
        let Ok(tree) = syn::parse2::<UseTree>(tree) else { return };
        self.read_tree(here, is_global, &[], &tree);
    }

    fn read_tree(&mut self, here: &[String], is_global: bool, before: &[String], tree: &UseTree) {
        let leaf = |ident: &syn::Ident| (ident.span().start().line, unraw(&ident.to_string()));
        let resolved = |reader: &Self, path: Vec<String>| {
            if is_global { path } else { reader.resolved(here, &path) }
        };
        match tree {
            UseTree::Path(it) => {
                let path = joined(before, &[unraw(&it.ident.to_string())]);
                self.read_tree(here, is_global, &path, &it.tree);
            }
            UseTree::Name(it) => {
                let (line, name) = leaf(&it.ident);
                let path = if name == "self" { before.to_vec() } else { joined(before, &[name]) };
                let path = resolved(self, path);
                let given = path.last().cloned();
                self.add(line, path, given.as_deref());
            }
            UseTree::Rename(it) => {
                let (line, name) = leaf(&it.ident);
                let is_parent = name == "self" && !before.is_empty();
                let path = if is_parent { before.to_vec() } else { joined(before, &[name]) };
                let path = resolved(self, path);
                self.add(line, path, Some(&it.rename.to_string()));
            }
            UseTree::Glob(it) => {
                let path = resolved(self, joined(before, &["*".to_owned()]));
                let line = it.star_token.spans[0].start().line;
                self.paths.mentions.push(Mention { line, path });
            }
            UseTree::Group(it) => {
                for tree in &it.items {
                    self.read_tree(here, is_global, before, tree);
                }
            }
        }
    }

    fn add(&mut self, line: usize, path: Vec<String>, given: Option<&str>) {
        if let Some(given) = given.filter(|it| !it.is_empty() && *it != "_") {
            self.names.insert(given.to_owned(), path.clone());
        }
        self.paths.mentions.push(Mention { line, path });
    }

    /// The absolute path of a path used in the module `here`.
    fn resolved(&self, here: &[String], path: &[String]) -> Vec<String> {
        let Some((first, rest)) = path.split_first() else { return Vec::new() };
        match first.as_str() {
            "crate" => path.to_vec(),
            "self" => joined(here, rest),
            "super" => {
                let parent = &here[..here.len().saturating_sub(1).max(1)];
                match rest.first().map(String::as_str) {
                    Some("super") => self.resolved(parent, rest),
                    _ => joined(parent, rest),
                }
            }
            // The same items under other names.
            "core" | "alloc" => joined(&["std".to_owned()], rest),
            name => match self.names.get(name) {
                // A crate imported under its own name resolves to itself.
                Some(known) if known.first() != Some(first) => joined(known, rest),
                _ => path.to_vec(),
            },
        }
    }
}

fn joined(before: &[String], after: &[String]) -> Vec<String> {
    before.iter().chain(after).cloned().collect()
}

fn word(token: &TokenTree) -> String {
    match token {
        TokenTree::Ident(ident) => unraw(&ident.to_string()),
        _ => String::new(),
    }
}

/// `type` for `r#type`.
fn unraw(name: &str) -> String {
    name.trim_start_matches("r#").to_owned()
}

fn line(token: &TokenTree) -> usize {
    token.span().start().line
}

fn is_punct(token: &TokenTree, sign: char) -> bool {
    matches!(token, TokenTree::Punct(it) if it.as_char() == sign)
}

/// True if `::` is at `i`.
fn is_double_colon(tokens: &[TokenTree], i: usize) -> bool {
    let first = matches!(tokens.get(i), Some(TokenTree::Punct(it))
        if it.as_char() == ':' && it.spacing() == Spacing::Joint);
    first && tokens.get(i + 1).is_some_and(|it| is_punct(it, ':'))
}

/// The first word of an attribute, or of what it is conditional on.
fn first_word(tokens: TokenStream) -> String {
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let first = tokens.first().map(word).unwrap_or_default();
    match tokens.get(1) {
        Some(TokenTree::Group(group))
            if first == "cfg_attr" && group.delimiter() == Delimiter::Parenthesis =>
        {
            let inner = group.stream().into_iter().skip_while(|it| !is_punct(it, ','));
            inner.skip(1).map(|it| word(&it)).next().unwrap_or_default()
        }
        _ => first,
    }
}
