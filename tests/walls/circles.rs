//! Circles of files: files of one crate that use each other, by their `use` lines and their paths.
//!
//! A file uses another where it names something that is defined there; a name that a module only hands on leads to where it
//! comes from. Handing on (`pub use`) and unit tests at the end of a file do not count.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use super::{has_word, root};

/// Circles that there are, and no more may come: those that `ARCHITECTURE.md` gives the reasons of.
const MOST: usize = 2;

/// A module's path below its crate.
type Module = Vec<String>;

/// A crate's modules with their texts, and what each hands on or imports: a name and its path.
struct Crate {
    texts: BTreeMap<Module, String>,
    names: BTreeMap<Module, Vec<(String, Module, bool)>>,
}

/// Text without comments and without unit tests at its end.
fn code(path: &Path) -> String {
    let text = std::fs::read_to_string(path).expect("a source");
    let text = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or("");
    let line = |line: &str| line.split("//").next().unwrap_or("").to_owned();
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// The rest of a line after a word and what makes it visible, and true if it is.
fn after<'t>(line: &'t str, word: &str) -> Option<(&'t str, bool)> {
    let line = line.trim_start();
    let (bare, visible) = match line.strip_prefix("pub") {
        Some(rest) if rest.starts_with('(') => (rest.split_once(')')?.1.trim_start(), true),
        Some(rest) => (rest.trim_start(), true),
        None => (line, false),
    };
    Some((bare.strip_prefix(word)?.strip_prefix(' ')?, visible))
}

/// Every path of a tree of uses, with the name that it gets.
fn paths(prefix: &[String], tree: &str, into: &mut Vec<(String, Module)>) {
    let tree = tree.trim();
    if let Some((head, body)) = tree.split_once('{') {
        let mut prefix = prefix.to_vec();
        prefix.extend(
            head.split("::")
                .map(str::trim)
                .filter(|s| !s.is_empty())
                .map(String::from),
        );
        let (mut depth, mut start) = (0, 0);
        let body = body.trim_end().strip_suffix('}').unwrap_or(body);
        for (at, c) in body.char_indices() {
            match c {
                '{' => depth += 1,
                '}' => depth -= 1,
                ',' if depth == 0 => {
                    paths(&prefix, &body[start..at], into);
                    start = at + 1;
                }
                _ => {}
            }
        }
        return paths(&prefix, &body[start..], into);
    }
    let (path, name) = tree.split_once(" as ").unwrap_or((tree, ""));
    let mut path: Module = [
        prefix.to_vec(),
        path.split("::").map(|s| s.trim().to_owned()).collect(),
    ]
    .concat();
    if path.last().is_some_and(|last| last == "self") {
        path.pop();
    }
    if let Some(last) = path.last().filter(|last| !last.is_empty()) {
        let name = if name.is_empty() { last } else { name };
        into.push((name.trim().to_owned(), path));
    }
}

impl Crate {
    fn read(folder: &Path) -> Self {
        let mut found = Self {
            texts: BTreeMap::new(),
            names: BTreeMap::new(),
        };
        found.add(&folder.join("mod.rs"), folder, Vec::new());
        found
    }

    fn add(&mut self, file: &Path, folder: &Path, module: Module) {
        let text = code(file);
        let mut names = Vec::new();
        for line in text.lines() {
            let child = after(line, "mod").and_then(|(rest, _)| rest.strip_suffix(';'));
            let Some(child) = child.filter(|child| *child != "tests") else {
                continue;
            };
            let below = folder.join(child);
            let files = [folder.join(format!("{child}.rs")), below.join("mod.rs")];
            if let Some(file) = files.iter().find(|file| file.is_file()) {
                let module = [module.clone(), vec![child.to_owned()]].concat();
                self.add(file, &below, module);
            }
        }
        let mut body = String::new();
        let mut rest = text.as_str();
        while let Some(line) = rest.lines().next() {
            let Some((_, visible)) = after(line, "use") else {
                body.push_str(line);
                body.push('\n');
                rest = rest.get(line.len() + 1..).unwrap_or("");
                continue;
            };
            let end = rest.find(';').unwrap_or(rest.len());
            let tree = rest[..end].split_once("use ").map_or("", |(_, tree)| tree);
            let mut own = Vec::new();
            paths(&[], tree, &mut own);
            names.extend(own.into_iter().map(|(name, path)| (name, path, visible)));
            rest = rest.get(end + 1..).unwrap_or("");
            rest = rest.strip_prefix('\n').unwrap_or(rest);
        }
        self.texts.insert(module.clone(), body);
        self.names.insert(module, names);
    }

    /// A path as it is written in a module, from the root of the crate; `None` for one of another crate.
    fn full(&self, module: &Module, path: &[String]) -> Option<Module> {
        let supers = path.iter().take_while(|part| *part == "super").count();
        let first = path.first()?;
        if first == "crate" {
            return Some(path[1..].to_vec());
        }
        if first == "self" {
            return Some([module, &path[1..]].concat());
        }
        if supers > 0 {
            return Some(
                [
                    module.get(..module.len().checked_sub(supers)?)?,
                    &path[supers..],
                ]
                .concat(),
            );
        }
        let child = [&module[..], &path[..1]].concat();
        self.texts
            .contains_key(&child)
            .then(|| [module, path].concat())
    }

    /// The module in which what a path names is defined.
    fn definer(&self, full: &Module, depth: usize) -> Option<Module> {
        let known = (0..=full.len())
            .rev()
            .find(|&k| self.texts.contains_key(&full[..k]))?;
        let (module, rest) = (full[..known].to_vec(), &full[known..]);
        let Some(name) = rest.first().filter(|_| depth < 10) else {
            return Some(module);
        };
        let text = &self.texts[&module];
        let kinds = [
            "fn",
            "struct",
            "enum",
            "trait",
            "type",
            "const",
            "static",
            "macro_rules!",
        ];
        if kinds
            .iter()
            .any(|kind| has_word(text, &format!("{kind} {name}")))
        {
            return Some(module);
        }
        let from = self.names[&module].iter().find(|(known, ..)| known == name);
        match from {
            Some((_, path, _)) => {
                let full = self.full(&module, path)?;
                self.definer(&[full, rest[1..].to_vec()].concat(), depth + 1)
            }
            None => Some(module),
        }
    }

    /// The modules that each module uses.
    fn edges(&self) -> BTreeMap<&Module, BTreeSet<Module>> {
        let used = |module: &Module| {
            let imported = self.names[module].iter().filter(|(.., on)| !on);
            let mut all: Vec<Module> = imported.map(|(_, path, _)| path.clone()).collect();
            let part = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
            let written = self.texts[module].split(|c: char| !part(c));
            let begins = |path: &&str| {
                ["crate::", "super::", "self::"]
                    .iter()
                    .any(|s| path.starts_with(s))
            };
            all.extend(written.filter(begins).map(|path| {
                path.split("::")
                    .filter(|s| !s.is_empty())
                    .map(String::from)
                    .collect()
            }));
            let definers = all
                .iter()
                .filter_map(|path| self.definer(&self.full(module, path)?, 0));
            definers.filter(|other| other != module).collect()
        };
        self.texts
            .keys()
            .map(|module| (module, used(module)))
            .collect()
    }

    /// The sets of modules each of which uses all others of its set, by way of others perhaps.
    fn circles(&self) -> Vec<Vec<String>> {
        let edges = self.edges();
        let reached = |from: &Module| {
            let (mut seen, mut open) = (BTreeSet::new(), vec![from.clone()]);
            while let Some(module) = open.pop() {
                open.extend(
                    edges[&module]
                        .iter()
                        .filter(|m| seen.insert((*m).clone()))
                        .cloned(),
                );
            }
            seen
        };
        let reached: BTreeMap<&Module, BTreeSet<Module>> =
            edges.keys().map(|m| (*m, reached(m))).collect();
        let mut circles = BTreeSet::new();
        for (module, from) in &reached {
            if from.contains(*module) {
                let own = from.iter().filter(|other| reached[other].contains(*module));
                circles.insert(own.map(|m| m.join("::")).collect::<Vec<_>>());
            }
        }
        circles.into_iter().collect()
    }
}

#[test]
fn files_do_not_use_each_other_in_further_circles() {
    let mut folders: Vec<PathBuf> = ["src", "experiments", "datasets"]
        .iter()
        .map(|f| root().join(f))
        .collect();
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(&folder).expect("listed") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            }
        }
        if folder.join("Cargo.toml").is_file() && folder.join("mod.rs").is_file() {
            let name = folder
                .strip_prefix(root())
                .expect("below")
                .display()
                .to_string();
            let circles = Crate::read(&folder).circles();
            found.extend(circles.into_iter().map(|circle| (name.clone(), circle)));
        }
    }
    found.sort();
    for (name, circle) in &found {
        println!("{name}: {}", circle.join(", "));
    }
    assert!(found.len() <= MOST, "{} circles of files", found.len());
}
