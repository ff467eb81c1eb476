//! The prose of comments: no identifiers outside code font, no sentence that a replacement of words broke, no riddles.
//!
//! Comments are read as Markdown: what stands between backticks, in code blocks, in addresses and in targets of links is no
//! prose. A symbol of a formula, one letter with an index of up to three signs, such as `w_ij`, is no identifier.

use std::path::Path;

/// Names that look like identifiers and are none.
const NAMES: [&str; 33] = [
    "ArviZ",
    "CatBoost",
    "CityEngine",
    "CityGML",
    "CityJSON",
    "CityJSONSeq",
    "CompositeSolid",
    "CompositeSurface",
    "DejaVu",
    "GeNIe",
    "GeoJSON",
    "GeoPackage",
    "GiB",
    "IoU",
    "LabelMe",
    "LaTeX",
    "MacDonald",
    "MultiPolygon",
    "MultiSolid",
    "MultiSurface",
    "NaN",
    "NeuQuant",
    "NumPy",
    "OpenStreetMap",
    "SciPy",
    "SplitMix64",
    "StepMix",
    "WebP",
    "eTRIMS",
    "glTF",
    "pyAgrum",
    "sRGB",
    "softImpute",
];

/// Countable nouns that once replaced verbs: without an article they stand in the place of one.
const NOUNS: [&str; 6] = [
    "candidate",
    "clique",
    "incumbent",
    "multiplier",
    "occurrence",
    "operator",
];

/// Words that open riddles instead of sentences.
const RIDDLES: [&str; 4] = ["What", "Whether", "How", "Where"];

/// A comment: consecutive lines of one kind.
struct Comment {
    /// Number of its first line in the file, from 1.
    line: usize,
    /// True if it documents an item or a module.
    documents: bool,
    /// Its lines without slashes.
    text: Vec<String>,
}

/// The comments of Rust source, which text in quotes has none of.
fn comments(source: &str) -> Vec<Comment> {
    let mut found: Vec<Comment> = Vec::new();
    // Where the last comment ended and with which slashes: a comment that fills the next line goes on with it.
    let (mut last, mut slashes) = (0, "");
    let (mut line, mut fresh) = (1, true);
    let mut rest = source;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            let end = rest.find('\n').unwrap_or(rest.len());
            let kind = ["///", "//!", "//"]
                .into_iter()
                .find(|k| rest.starts_with(k))
                .unwrap_or("//");
            let text = rest[kind.len()..end].to_owned();
            match found.last_mut() {
                Some(comment) if fresh && last + 1 == line && kind == slashes => {
                    comment.text.push(text);
                }
                _ => found.push(Comment {
                    line,
                    documents: kind.len() == 3,
                    text: vec![text],
                }),
            }
            // A comment behind code ends with its line.
            (last, slashes) = (line, if fresh { kind } else { "" });
            end
        } else {
            quoted(rest).unwrap_or(first.len_utf8())
        };
        let (passed, left) = rest.split_at(length);
        line += passed.matches('\n').count();
        fresh = match passed.rfind('\n') {
            Some(at) => passed[at..].trim().is_empty(),
            None => fresh && passed.trim().is_empty(),
        };
        rest = left;
    }
    found
}

/// Length of the text in quotes, the character or the block comment that the source begins with.
fn quoted(source: &str) -> Option<usize> {
    if source.starts_with("/*") {
        return source.find("*/").map(|at| at + 2);
    }
    if let Some(inside) = source.strip_prefix('"') {
        return escaped(inside, '"').map(|end| end + 1);
    }
    if let Some(inside) = source.strip_prefix('\'') {
        // A lifetime has no second quote behind its first character.
        let mut signs = inside.chars();
        return match signs.next()? {
            '\\' => escaped(inside, '\'').map(|end| end + 1),
            sign => (signs.next() == Some('\'')).then(|| sign.len_utf8() + 2),
        };
    }
    let raw = source.strip_prefix('r')?;
    let hashes = raw.len() - raw.trim_start_matches('#').len();
    let inside = raw[hashes..].strip_prefix('"')?;
    let end = format!("\"{}", "#".repeat(hashes));
    let at = inside.find(&end)?;
    Some(1 + hashes + 1 + at + end.len())
}

/// Length of the text up to and with the first such quote that no backslash escapes.
fn escaped(inside: &str, quote: char) -> Option<usize> {
    let mut signs = inside.char_indices();
    while let Some((at, sign)) = signs.next() {
        if sign == '\\' {
            signs.next();
        } else if sign == quote {
            return Some(at + 1);
        }
    }
    None
}

/// The paragraphs of a comment, each as one line and with the number of its first line; code is left out, with a mark in
/// its place.
fn prose(comment: &Comment) -> Vec<(usize, String)> {
    let mut paragraphs = vec![(comment.line, String::new())];
    let mut fenced = false;
    for (i, line) in comment.text.iter().enumerate() {
        let line = line.trim();
        if line.starts_with("```") {
            fenced = !fenced;
        } else if line.is_empty() && !fenced {
            paragraphs.push((comment.line + i + 1, String::new()));
        } else if !fenced && let Some((_, paragraph)) = paragraphs.last_mut() {
            paragraph.push_str(line);
            paragraph.push(' ');
        }
    }
    for (_, paragraph) in &mut paragraphs {
        *paragraph = without_links(&without_code(paragraph));
    }
    paragraphs
}

/// A paragraph with a mark in place of all that stands between backticks.
fn without_code(paragraph: &str) -> String {
    let mut kept = String::new();
    for (i, piece) in paragraph.split('`').enumerate() {
        kept.push_str(if i % 2 == 0 { piece } else { "\u{2026}" });
    }
    kept
}

/// A paragraph without targets of links, addresses and paths.
fn without_links(paragraph: &str) -> String {
    let mut kept = String::new();
    let mut rest = paragraph;
    while let Some((before, target)) = rest.split_once("](") {
        kept.push_str(before);
        kept.push(']');
        rest = target.split_once(')').map_or("", |(_, behind)| behind);
    }
    kept.push_str(rest);
    let mut prose = Vec::new();
    let mut words = kept.split_whitespace();
    while let Some(word) = words.next() {
        if word.ends_with("]:") {
            words.next();
        } else if !word.contains("://") {
            prose.push(word);
        }
    }
    prose.join(" ")
}

/// Everything wrong with a paragraph of prose, in words.
fn faults(paragraph: &str) -> Vec<String> {
    let mut found = Vec::new();
    for word in paragraph.split(|c: char| !c.is_alphanumeric() && c != '_') {
        if !NAMES.contains(&word) && (is_camel(word) || is_snake(word)) {
            found.push(format!("`{word}` is code"));
        }
    }
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    for pair in words.windows(2) {
        if is_wrong_article(pair[0], pair[1]) {
            found.push(format!("\"{} {}\"", pair[0], pair[1]));
        }
    }
    for (i, word) in words.iter().enumerate() {
        let noun = word.trim_end_matches(['.', ',', ';', ':']);
        let before = i.checked_sub(1).map_or("", |before| words[before]);
        let article = matches!(words.get(i + 1), Some(&("a" | "an" | "the" | "no")));
        let is_verb = match before {
            "to" | "may" | "must" | "can" | "cannot" => true,
            "that" | "which" | "and" => article && noun == *word,
            _ => false,
        };
        if is_verb && NOUNS.contains(&noun) {
            found.push(format!("\"{before} {noun}\": a noun in place of a verb"));
        }
    }
    found
}

/// True for `CamelCase` with a capital behind a small letter.
fn is_camel(word: &str) -> bool {
    let signs: Vec<char> = word.chars().collect();
    signs
        .windows(2)
        .any(|pair| pair[0].is_lowercase() && pair[1].is_uppercase() && pair[0].is_ascii())
}

/// True for `snake_case`, but not for a symbol of a formula.
fn is_snake(word: &str) -> bool {
    let Some((name, index)) = word.trim_matches('_').split_once('_') else {
        return false;
    };
    name.chars().count() > 1 || index.chars().count() > 3
}

/// True for an article that does not fit the sound of the next word.
fn is_wrong_article(article: &str, next: &str) -> bool {
    let next = next.trim_end_matches(['.', ',', ';', ':']);
    if next.len() < 4 || !next.chars().all(|c| c.is_ascii_lowercase()) {
        return false;
    }
    match article {
        // A word with u may begin like "unit".
        "a" | "A" => {
            next.starts_with(['a', 'e', 'i', 'o'])
                && !next.starts_with("one")
                && !next.starts_with("once")
                && !next.starts_with("eu")
        }
        "an" | "An" => {
            !next.starts_with(['a', 'e', 'i', 'o', 'u'])
                && !next.starts_with("hour")
                && !next.starts_with("hon")
                && !next.starts_with("heir")
        }
        _ => false,
    }
}

/// Everything wrong with the comments of Rust source: number of the line where the paragraph begins, and the fault.
fn review(source: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for comment in comments(source) {
        let opening = comment.text[0].split_whitespace().next().unwrap_or("");
        if comment.documents && RIDDLES.contains(&opening) {
            found.push((
                comment.line,
                format!("the documentation opens with {opening}"),
            ));
        }
        for (line, paragraph) in prose(&comment) {
            let faults = faults(&paragraph).into_iter();
            found.extend(faults.map(|fault| (line, fault)));
        }
    }
    found
}

/// Reviews all Rust files under a folder of the repository; returns their number.
fn review_folder(root: &Path, folder: &Path, found: &mut Vec<String>) -> usize {
    let mut reviewed = 0;
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths: Vec<_> = entries
        .map(|entry| entry.expect("an entry").path())
        .collect();
    paths.sort();
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        if path.is_dir() && name != "target" && name != "node_modules" && !name.starts_with('.') {
            reviewed += review_folder(root, &path, found);
        } else if name.ends_with(".rs") {
            let source = std::fs::read_to_string(&path).expect("Rust source");
            let place = path.strip_prefix(root).unwrap_or(&path).display();
            let faults = review(&source).into_iter();
            found.extend(faults.map(|(line, fault)| format!("{place}:{line}: {fault}")));
            reviewed += 1;
        }
    }
    reviewed
}

#[test]
fn comments_are_plain_sentences() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut found = Vec::new();
    let reviewed = review_folder(root, root, &mut found);
    assert!(reviewed > 500, "only {reviewed} files");
    assert!(
        found.is_empty(),
        "{} faults; write code in backticks, and say what a thing is:\n{}",
        found.len(),
        found.join("\n")
    );
}

/// Sentences that a replacement of words broke, as they stood in the documentation of proofs.
const BROKEN: [&str; 7] = [
    "    /// PricedCandidates the best grammar over the region types of a derivation.\n",
    "            // An item that costs nothing has nothing to multiplier.\n",
    "/// The largest groups of regions that multiplier a corner of one of them, each by its indices.\n",
    "//! has one, and what all its rules have\n//! in common is item_costs whatever the multipliers.\n",
    "            // A occurrence has two successors and an operation at least.\n",
    "/// Its optimum. What enters a\n/// occurrence leaves it by its operators, each operator's arcs are a flow.\n",
    "    /// NonterminalSet that no rule names leave, and so may those that only they named.\n",
];

/// The same sentences mended.
const MENDED: [&str; 7] = [
    "    /// Offers the best grammar over the region types of a derivation.\n",
    "            // An item that costs nothing has nothing to share.\n",
    "/// The largest groups of regions that share a corner of one of them, each by its indices.\n",
    "//! has one, and what all its rules have\n//! in common is paid whatever the multipliers.\n",
    "            // An occurrence has two successors and an operation at least.\n",
    "/// Its optimum. What enters an\n/// occurrence leaves it by its operators, each operator's arcs are a flow.\n",
    "    /// Members that no rule names leave, and so may those that only they named.\n",
];

#[test]
fn finds_the_broken_sentences() {
    for (broken, mended) in BROKEN.into_iter().zip(MENDED) {
        assert_eq!(review(broken).len(), 1, "{broken}");
        assert_eq!(review(mended), [], "{mended}");
    }
}

#[test]
fn documentation_that_opens_with_a_riddle_is_found() {
    for word in RIDDLES {
        let line = format!("{word} it is\n");
        assert_eq!(review(&format!("/// {line}")).len(), 1);
        assert_eq!(review(&format!("//! {line}")).len(), 1);
        assert_eq!(review(&format!("/// A thing.\n/// {line}")), []);
        assert_eq!(review(&format!("// {line}")), []);
    }
}

#[test]
fn code_is_no_prose() {
    for source in [
        "/// The [`RegionType`] of `item_costs`, see [the type](super::RegionType).\n",
        "/// An example:\n/// ```\n/// let item_costs = RegionType::new();\n/// ```\n",
        "/// See <https://example.org/RegionType/item_costs>.\n",
        "/// See [`Size`].\n///\n/// [`Size`]: item_costs::Size\n",
        "let text = \"// RegionType\"; let raw = r#\"\n// RegionType \"\n\"#; let quote = '\"'; // A quote.\n",
        "fn f<'a>(x: &'a str) -> char { '\\'' } // A glTF file of `w_ij`, and w_ij itself.\n",
    ] {
        assert_eq!(review(source), [], "{source}");
    }
    let found = review("let a = 1; // RegionType\nlet b = 2; // item_costs\n");
    let lines: Vec<usize> = found.iter().map(|(line, _)| *line).collect();
    assert_eq!(lines, [1, 2]);
}
