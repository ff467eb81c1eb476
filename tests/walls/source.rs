//! A source file as the walls see it: where it stands in the tree of modules, and the paths that its code names.

use std::path::{Path, PathBuf};

/// A source file.
pub struct Source {
    /// Its path from the root of the repository.
    pub place: String,
    /// Its module path.
    pub module: Vec<String>,
    /// Its code without comments, text in quotes and the module of tests.
    pub code: String,
}

impl Source {
    /// A source from its path below the root and the whole text.
    pub fn new(place: &str, text: &str) -> Self {
        let inside = place.strip_prefix("src/").unwrap_or(place);
        let mut module: Vec<String> = inside
            .trim_end_matches(".rs")
            .split('/')
            .map(str::to_owned)
            .collect();
        if matches!(module.last().map(String::as_str), Some("mod" | "main")) {
            module.pop();
        }
        Self {
            place: place.to_owned(),
            module,
            code: code(text),
        }
    }

    /// Every path that the code names relative to the crate, the library or a module above, from the root of the crate;
    /// `Error` and `Result` are those of `error`.
    pub fn imports(&self) -> Vec<Vec<String>> {
        let mut found = Vec::new();
        for start in ["crate::", "edifice::", "self::", "super::"] {
            for (at, _) in self.code.match_indices(start) {
                let before = self.code[..at].chars().next_back();
                if before.is_some_and(|c| c.is_alphanumeric() || matches!(c, '_' | '$' | ':')) {
                    continue;
                }
                let mut rest = &self.code[at..];
                let mut base = match start {
                    "crate::" | "edifice::" => Vec::new(),
                    _ => self.module.clone(),
                };
                if start != "super::" {
                    rest = &rest[start.len()..];
                }
                while let Some(above) = rest.strip_prefix("super::") {
                    base.pop();
                    rest = above;
                }
                expand(rest, &base, &mut found);
            }
        }
        for path in &mut found {
            if matches!(path[0].as_str(), "Error" | "Result") {
                *path = vec!["error".to_owned()];
            }
        }
        found.sort();
        found.dedup();
        found
    }

    /// True if the code has this word.
    pub fn names(&self, word: &str) -> bool {
        has_word(&self.code, word)
    }
}

/// True if a text has a word that is no part of a longer one.
pub fn has_word(text: &str, word: &str) -> bool {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    text.match_indices(word)
        .any(|(at, _)| !text[..at].ends_with(part) && !text[at + word.len()..].starts_with(part))
}

/// The paths of a tree of imports, whose braces may nest.
fn expand(text: &str, base: &[String], found: &mut Vec<Vec<String>>) {
    let text = text.trim_start();
    if let Some(list) = text.strip_prefix('{') {
        for entry in entries(list) {
            expand(entry, base, found);
        }
        return;
    }
    let length = text
        .find(|c: char| !c.is_alphanumeric() && c != '_')
        .unwrap_or(text.len());
    let (name, rest) = text.split_at(length);
    let mut path = base.to_vec();
    if !name.is_empty() && name != "self" {
        path.push(name.to_owned());
    }
    match rest.strip_prefix("::") {
        Some(rest) if !name.is_empty() => expand(rest, &path, found),
        _ if path.is_empty() => {}
        _ => found.push(path),
    }
}

/// The entries of a list up to its closing brace.
fn entries(list: &str) -> Vec<&str> {
    let (mut depth, mut start, mut found) = (0, 0, Vec::new());
    for (i, c) in list.char_indices() {
        match c {
            '{' => depth += 1,
            ',' if depth == 0 => {
                found.push(&list[start..i]);
                start = i + 1;
            }
            '}' if depth == 0 => {
                found.push(&list[start..i]);
                break;
            }
            '}' => depth -= 1,
            _ => {}
        }
    }
    found.retain(|entry| !entry.trim().is_empty());
    found
}

/// Code without comments, without text in quotes and without its module of tests.
fn code(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(c) = rest.chars().next() {
        let skipped = match c {
            '/' if rest.starts_with("//") => rest.find('\n').unwrap_or(rest.len()),
            '/' if rest.starts_with("/*") => rest.find("*/").map_or(rest.len(), |i| i + 2),
            '"' => quoted(rest),
            'r' if !out.ends_with(|c: char| c.is_alphanumeric() || c == '_') => raw(rest),
            '\'' => character(rest),
            _ => 0,
        };
        if skipped == 0 {
            out.push(c);
            rest = &rest[c.len_utf8()..];
        } else {
            out.push(' ');
            rest = &rest[skipped..];
        }
    }
    let tests = (out.find("#[cfg(test)]\nmod tests"))
        .or_else(|| out.find("#[cfg(all(test, feature =  ))]\nmod tests"));
    out.truncate(tests.unwrap_or(out.len()));
    out
}

/// Length of a text in quotes.
fn quoted(text: &str) -> usize {
    let mut escaped = false;
    for (i, c) in text.char_indices().skip(1) {
        match c {
            '"' if !escaped => return i + 1,
            _ => escaped = c == '\\' && !escaped,
        }
    }
    text.len()
}

/// Length of a raw text in quotes; 0 where there is none.
fn raw(text: &str) -> usize {
    let hashes = text[1..].chars().take_while(|c| *c == '#').count();
    if !text[1 + hashes..].starts_with('"') {
        return 0;
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let from = 2 + hashes;
    text[from..]
        .find(&end)
        .map_or(text.len(), |i| from + i + end.len())
}

/// Length of a character in quotes; 0 for a lifetime.
fn character(text: &str) -> usize {
    let inside: Vec<char> = text.chars().skip(1).take(2).collect();
    match inside[..] {
        ['\\', escaped] => {
            let from = 2 + escaped.len_utf8();
            text[from..].find('\'').map_or(text.len(), |i| from + i + 1)
        }
        [c, '\''] => 2 + c.len_utf8(),
        _ => 0,
    }
}

/// The sources below a folder of the repository, without modules of tests, which may look over the walls.
pub fn sources(root: &Path, folder: &str) -> Vec<Source> {
    let mut found = Vec::new();
    for path in rust_files(&root.join(folder)) {
        let place = path.strip_prefix(root).expect("below the root");
        let text = std::fs::read_to_string(&path).expect("source is readable");
        found.push(Source::new(&place.display().to_string(), &text));
    }
    found
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let Ok(entries) = std::fs::read_dir(folder) else {
        return files;
    };
    for path in entries.filter_map(|e| e.ok().map(|e| e.path())) {
        let is_tests = path.file_stem().is_some_and(|stem| stem == "tests");
        if path.is_dir() && !is_tests {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|e| e == "rs") && !is_tests {
            files.push(path);
        }
    }
    files.sort();
    files
}
