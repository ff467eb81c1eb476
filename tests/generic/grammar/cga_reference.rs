//! The rules of CityEngine's reference that CGA text keeps to, in the order of the table in
//! `io::grammar_cga`; those of sizes are in `cga_sizes.rs`.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use super::support::{random_grammar, size_independent, stochastic};
use edifice::grammar::{
    Grammar, Operation, Rule, Start, Successor, derive, derive_at, same_tiling,
};
use edifice::io::grammar_cga::{from_str, to_string};
use edifice::io::{facade_json, grammar_json};
use edifice::methods::facade_grammar::{Settings, infer};
use edifice::rng;
use edifice::shape::{Axis, Facade};
use edifice::unwatched;

/// A grammar of one start of 100 x 100.
fn grammar(rules: Vec<Rule>) -> Grammar {
    let symbol = rules[0].symbol.clone();
    Grammar {
        unit: "m".into(),
        starts: vec![Start {
            name: symbol.clone(),
            symbol,
            width: 100.0,
            height: 100.0,
        }],
        rules,
    }
}

fn split(symbol: &str, axis: Axis, parts: &[(&str, f64)]) -> Rule {
    let successors = parts.iter().map(|&(s, size)| Successor::new(s, size));
    Rule {
        symbol: symbol.into(),
        weight: None,
        operation: Operation::Split {
            axis,
            successors: successors.collect(),
        },
    }
}

/// Random grammars of every kind, and the shipped ones.
fn grammars() -> Vec<Grammar> {
    let mut all = Vec::new();
    for seed in 0..40 {
        let absolute = random_grammar(seed);
        all.push(size_independent(&absolute));
        all.push(stochastic(&absolute, seed));
        all.push(absolute);
    }
    all
}

/// Lines without comments.
fn code(text: &str) -> Vec<&str> {
    let lines = text.lines().map(|line| line.split("//").next().unwrap());
    lines.map(str::trim).filter(|l| !l.is_empty()).collect()
}

#[test]
fn the_version_is_the_first_line_of_code() {
    for grammar in grammars() {
        assert_eq!(code(&to_string(&grammar))[0], "version \"2019.0\"");
    }
}

#[test]
fn each_axiom_is_a_start_rule() {
    for grammar in grammars() {
        let text = to_string(&grammar);
        let lines = code(&text);
        let marked: BTreeSet<&str> = lines
            .windows(2)
            .filter(|pair| pair[0] == "@StartRule")
            .map(|pair| pair[1].split(" -->").next().unwrap())
            .collect();
        let starts: BTreeSet<&str> = grammar.starts.iter().map(|s| s.symbol.as_str()).collect();
        // Some are renamed.
        assert_eq!(marked.len(), starts.len(), "{text}");
    }
    let leaf = Grammar {
        rules: vec![],
        ..grammar(vec![split("wall", Axis::X, &[])])
    };
    let text = to_string(&leaf);
    assert!(
        text.ends_with("@StartRule\nwall --> color(\"#ffff00\")\n"),
        "{text}"
    );
    assert_eq!(from_str(&text).unwrap(), leaf);
}

#[test]
fn annotations_change_nothing() {
    let plain = "F --> split(x) { 3 : a | 2 : G }\nG --> split(y) { 4 : b }";
    let noted = "@Group(\"roof\", 2) @Range(1, 5) attr h = 4\n@Hidden const w = 3\n@StartRule @InPolygon\n\
        F --> split(x) { w : a | 2 : G }\n@Description(\"one floor\")\nG --> split(y) { h : b }";
    assert_eq!(from_str(noted).unwrap(), from_str(plain).unwrap());
}

/// Every word that the index of the reference lists, and keywords.
const WORDS: &str = "i extrude envelope taper roofGable roofHip roofPyramid roofRidge roofShed offset primitiveQuad \
    primitiveDisk primitiveCube primitiveSphere primitiveCylinder primitiveCone insertAlongUV footprint split splitArea \
    splitAndSetbackPerimeter comp innerRectangle setback setbackPerEdge setbackToArea shapeL shapeU shapeO scatter \
    cleanupGeometry convexify deleteHoles reverseNormals softenNormals setNormals mirror rectify reduceGeometry \
    resetGeometry trim modify tag deleteTags setTagsFromEdgeAttrs inline union subtract intersect texture setupProjection \
    projectUV translateUV scaleUV normalizeUV tileUV rotateUV deleteUV copyUV t translate s r rotate center \
    alignScopeToAxes alignScopeToGeometry alignScopeToGeometryBBox rotateScope setPivot mirrorScope pop push NIL label set \
    color resetMaterial setMaterial report print initialShape material pivot scope seedian abs acos asin atan atan2 ceil cos \
    exp floor isinf isnan ln log10 pow rint sin sqrt tan p rand bool float sel str count find len substring geometry inside \
    overlaps touches convert attr const extension import start style with version case else true false x y z 2nd Wall.1 a-b \
    Wände _a A. \u{1f3e0}";

#[test]
fn reserved_words_are_renamed_and_come_back() {
    let words: Vec<&str> = WORDS.split_whitespace().chain(["two words", ""]).collect();
    let words = &words[..words.len() - 1];
    let share = 100.0 / words.len() as f64;
    let parts: Vec<(&str, f64)> = words.iter().map(|&w| (w, share)).collect();
    // As terminals, and as non-terminals.
    let mut rules = vec![split("F", Axis::X, &parts)];
    rules.extend(
        words
            .iter()
            .map(|w| split(w, Axis::Y, &[("wall", 60.0), ("door", 40.0)])),
    );
    for rules in [rules[..1].to_vec(), rules] {
        let mut grammar = grammar(rules);
        // A text adds sizes in its own order; the last takes what is left.
        grammar.starts[0].width = parts.iter().map(|p| p.1).sum();
        let text = to_string(&grammar);
        assert_eq!(from_str(&text).unwrap(), grammar, "{text}");
        let declared = code(&text)
            .into_iter()
            .filter_map(|line| line.split_once(" -->"));
        for (name, _) in declared {
            assert!(!words.contains(&name), "{name}");
            assert!(
                name.starts_with(|c: char| c.is_ascii_alphabetic()),
                "{name}"
            );
            assert!(
                name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_'),
                "{name}"
            );
        }
    }
}

#[test]
fn every_symbol_has_one_rule() {
    for grammar in grammars() {
        let text = to_string(&grammar);
        let mut rules: BTreeMap<&str, usize> = BTreeMap::new();
        let mut used = BTreeSet::new();
        for line in code(&text) {
            let body = match line.split_once("-->") {
                Some((name, body)) => {
                    *rules.entry(name.trim()).or_default() += 1;
                    body
                }
                None => line,
            };
            if body.contains('{') {
                for part in body.split(['{', '|', '}', '*']) {
                    if let Some((_, symbol)) = part.rsplit_once(" : ")
                        && !symbol.contains("split(")
                    {
                        used.insert(symbol.trim());
                    }
                }
            }
        }
        assert_eq!(used.is_empty(), grammar.rules.is_empty());
        for symbol in &used {
            assert_eq!(rules.get(symbol), Some(&1), "{symbol}\n{text}");
        }
        assert!(rules.values().all(|&n| n == 1), "{text}");
    }
}

#[test]
fn leaves_are_rules_of_looks_alone() {
    let text = "F --> split(x) { 3 : window | 2 : color(\"#ff0000\") set(a.b, rand(1, 2)) door | 1 : Frame. }\n\
        window --> i(\"window.obj\")\ndoor --> color(1, 0.5, (0)) report(\"area\", 3) extrude(0.2)\nG --> split(x) { 3 : F }";
    let grammar = from_str(&format!("//@ facade F 6 x 2\n{text}")).unwrap();
    let facade = derive(&grammar, 0).unwrap();
    let labels: Vec<&str> = facade.regions.iter().map(|r| r.label.as_str()).collect();
    assert_eq!(labels, ["window", "door", "Frame"]);
    // A label in the colour of its leading word.
    let grammar = self::grammar(vec![split(
        "F",
        Axis::X,
        &[("Window_2", 60.0), ("wall", 40.0)],
    )]);
    assert!(to_string(&grammar).contains("\nWindow_2 --> color(\"#ff0000\")\n"));
}

#[test]
fn stochastic_rules_end_with_else_and_stay_below_a_hundred() {
    for seed in 0..40 {
        let grammar = stochastic(&random_grammar(seed), seed);
        let text = to_string(&grammar);
        let mut sum = 0.0;
        let mut open = false;
        for line in code(&text) {
            if line.contains("-->") {
                assert!(!open, "no else above {line}\n{text}");
                sum = 0.0;
            }
            if let Some((percent, _)) = line.split_once("% :") {
                sum += percent.trim().parse::<f64>().unwrap();
                open = true;
                assert!(sum <= 100.0 + 1e-9, "{sum}\n{text}");
            }
            if line.starts_with("else :") {
                open = false;
            }
        }
        assert!(!open);
    }
    let mut huge = grammar(vec![
        split("F", Axis::X, &[("a", 100.0)]),
        split("F", Axis::X, &[("b", 100.0)]),
    ]);
    huge.rules[0].weight = Some(1e308);
    huge.rules[1].weight = Some(1.5e308);
    let text = to_string(&huge);
    assert!(text.contains("40% :") || text.contains("40.0"), "{text}");
    assert_eq!(from_str(&text).unwrap(), huge);
}

/// The shipped facades, small enough for a test.
fn shipped() -> Vec<Facade> {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder.join("layouts"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.to_string_lossy().ends_with(".facade.json"))
        .collect();
    files.sort();
    files.push(folder.join("wu2014_fig9.facade.json"));
    let facades = files.iter().map(|file| facade_json::read(file).unwrap());
    facades.filter(|f| f.regions.len() <= 150).collect()
}

#[test]
fn shipped_grammars_come_back_and_fill_other_lots() {
    let facades = shipped();
    assert!(facades.len() >= 10, "{}", facades.len());
    for facade in facades {
        let settings = Settings {
            iterations: 20,
            ..Settings::default()
        };
        let grammar = infer(std::slice::from_ref(&facade), &settings, &unwatched)
            .unwrap()
            .grammar;
        let text = to_string(&grammar);
        let back = from_str(&text).unwrap();
        assert_eq!(back, grammar, "{text}");
        let json = grammar_json::to_string(&back);
        assert_eq!(
            grammar_json::parse(json.as_bytes(), "f".as_ref()).unwrap(),
            grammar
        );
        assert!(same_tiling(&derive(&back, 0).unwrap(), &facade));
        // What CityEngine sees: the same text without our comments, so that ~ floats.
        let lines = text.lines().filter(|l| !l.starts_with("//@ sizes"));
        let floating = from_str(&lines.collect::<Vec<_>>().join("\n")).unwrap();
        for factor in [1.0, 1.37, 2.5] {
            let (width, height) = (facade.width * factor, facade.height * factor);
            let mut rng = rng::stream(0, "lot", 0);
            let lot = derive_at(&floating, 0, width, height, &mut rng);
            let lot = lot
                .unwrap_or_else(|e| panic!("{}: {factor}: {e}", facade.name))
                .facade;
            lot.check_tiling()
                .unwrap_or_else(|e| panic!("{}: {factor}: {e}", facade.name));
            if factor == 1.0 {
                assert!(same_tiling(&lot, &facade), "{}", facade.name);
            }
        }
    }
}
