//! `edifice logic` from files to files.

use std::path::Path;

use assert_cmd::Command;
use edifice::grammar::derive;
use edifice::io::{facade_json, grammar_json};
use edifice::methods::procedural_logic::{Model, ModelFile, Parameters};
use edifice::rng::stream;
use edifice::shape::{Facade, LabelGrid, Rect, Region};
use edifice_experiments::layouts;
use edifice_experiments::procedural_logic::corruption::{Corruption, pixels};
use edifice_experiments::procedural_logic::shipped;

fn edifice(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").expect("the program");
    command.current_dir(folder).args(words);
    command
}

fn output(folder: &Path, words: &[&str]) -> String {
    let done = edifice(folder, words).assert().success();
    String::from_utf8_lossy(&done.get_output().stdout).into_owned()
}

fn complaint(folder: &Path, words: &[&str], code: i32) -> String {
    let done = edifice(folder, words).assert().failure().code(code);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

/// The cells of a label image as a layout.
fn layout(grid: &LabelGrid) -> Facade {
    let model = Model::fit(std::slice::from_ref(grid), Parameters::COMPRESSION).expect("fits");
    model.layout(&model.facades[0]).expect("its own facade")
}

/// Shipped layouts of the families named, each as it is and at another size.
fn pictures(families: &[&str]) -> Vec<LabelGrid> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar");
    let layouts = layouts::read_all(&folder).expect("the shipped layouts");
    let chosen = layouts
        .iter()
        .filter(|facade| families.iter().any(|name| facade.name.starts_with(name)));
    let grids = chosen.map(|facade| shipped::picture(facade).expect("a tiling"));
    grids
        .flat_map(|grid| [shipped::resized(&grid, 2), grid])
        .collect()
}

/// A folder with ten facades of houses and four of blocks.
fn facades() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, families) in [
        ("houses", &["terrace", "townhouse_1"][..]),
        ("blocks", &["hotel_3", "tenement_2"]),
    ] {
        let below = folder.path().join(name);
        std::fs::create_dir(&below).expect("a folder");
        for grid in pictures(families) {
            let path = below.join(format!("{}.facade.json", grid.name));
            facade_json::write(&layout(&grid), &path).expect("written");
        }
    }
    folder
}

#[test]
fn from_facades_to_new_facades() {
    let folder = facades();
    let at = folder.path();
    let line = output(at, &["logic", "fit", "houses", "-o", "m.json", "--json"]);
    let fitted: serde_json::Value = serde_json::from_str(&line).expect("one JSON object");
    assert_eq!(fitted["facades"], 10);

    // Parsed facades derive back.
    let input = "houses/terrace_c.facade.json";
    output(
        at,
        &[
            "logic",
            "parse",
            input,
            "--model",
            "m.json",
            "-o",
            "g.grammar.json",
        ],
    );
    let grammar = grammar_json::read(&at.join("g.grammar.json")).expect("a grammar");
    let derived = derive(&grammar, 0).expect("derives");
    let given = facade_json::read(&at.join(input)).expect("the facade");
    assert_eq!((derived.width, derived.height), (given.width, given.height));

    // A facade with labels never seen joins online.
    let mut strange = given.clone();
    strange.name = "strange".into();
    strange.regions[0].label = "graffiti".into();
    facade_json::write(&strange, &at.join("strange.facade.json")).expect("written");
    let words = [
        "logic",
        "fit",
        "strange.facade.json",
        "--into",
        "m.json",
        "-o",
        "n.json",
    ];
    assert!(output(at, &words).starts_with("11 facades"));
    let near = output(
        at,
        &[
            "logic", "compare", "--model", "n.json", "--query", "strange", "--top", "1",
        ],
    );
    assert!(near.starts_with("strange: terrace_c"), "{near}");

    // Two styles fall apart.
    let clusters = output(at, &["logic", "cluster", "houses", "blocks"]);
    let lines = clusters.lines().map(|line| line.split_once('\t'));
    let (houses, blocks): (Vec<_>, Vec<_>) = lines
        .map(|line| line.expect("cluster and name"))
        .partition(|(_, name)| name.starts_with('t') && !name.starts_with("tenement"));
    assert_eq!((houses.len(), blocks.len()), (10, 4));
    let together = |facades: &[(&str, &str)]| facades.iter().all(|f| f.0 == facades[0].0);
    assert!(together(&houses) && together(&blocks), "{clusters}");
    assert_ne!(houses[0].0, blocks[0].0, "{clusters}");

    // The same seed draws the same valid facades.
    let bytes =
        |folder: &str| std::fs::read(at.join(folder).join("virtual_2.facade.json")).expect("drawn");
    for folder in ["a", "b"] {
        output(
            at,
            &[
                "logic",
                "synthesize",
                "m.json",
                "-n",
                "2",
                "--sigma",
                "2",
                "-o",
                folder,
            ],
        );
    }
    assert_eq!(bytes("a"), bytes("b"));
    let drawn = facade_json::read(&at.join("a/virtual_2.facade.json")).expect("a facade");
    drawn.check_tiling().expect("a tiling");
}

#[test]
fn noisy_labels_are_cleaned_when_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    std::fs::create_dir(at.join("noisy")).expect("a folder");
    let faults = Corruption {
        edges: 2,
        specks: 0.01,
        ..Corruption::default()
    };
    for grid in pictures(&["terrace_a", "shophouse_1"]) {
        let image = pixels(&grid, grid.ys[grid.rows()] / 200.0);
        let image = faults.apply(&image, &mut stream(3, &grid.name, 0));
        let path = at.join("noisy").join(format!("{}.facade.json", grid.name));
        facade_json::write(&layout(&image), &path).expect("written");
    }
    let rules = |option: &[&str]| {
        let words = [&["logic", "fit", "noisy", "-o", "m.json", "--json"], option].concat();
        let line = output(at, &words);
        let fitted: serde_json::Value = serde_json::from_str(&line).expect("one JSON object");
        fitted["rules"].as_u64().expect("a number")
    };
    let (given, zero, clean) = (rules(&[]), rules(&["--clean=0"]), rules(&["--clean=2"]));
    assert_eq!(given, zero);
    assert!(5 * clean < given, "{clean} rules cleaned, {given} as given");
    // Without it the program says that it might help; with it, what it did.
    let said = |words: &[&str]| {
        let done = edifice(at, words).assert().success();
        String::from_utf8_lossy(&done.get_output().stderr).into_owned()
    };
    assert!(said(&["logic", "fit", "noisy", "-o", "m.json"]).contains("--clean"));
    let told = said(&["logic", "fit", "noisy", "-o", "m.json", "--clean"]);
    assert!(
        told.contains("cleaned 4 facades by rows and columns"),
        "{told}"
    );
    let wrong = ["logic", "fit", "noisy", "-o", "x", "--clean=-1"];
    assert!(complaint(at, &wrong, 1).contains("--clean"));
    assert!(!at.join("x").exists());

    // New facades, from labels with and without noise.
    for option in [&[][..], &["--clean"]] {
        let words = [&["logic", "fit", "noisy", "-o", "m.json"], option].concat();
        output(at, &words);
        let line = output(at, &["logic", "synthesize", "m.json", "-n", "2", "-o", "v"]);
        assert!(line.starts_with("2 facades from "), "{line}");
        let drawn = facade_json::read(&at.join("v/virtual_2.facade.json")).expect("a facade");
        drawn.check_tiling().expect("a tiling");
    }
}

#[test]
fn ties_and_known_names_are_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let grids = pictures(&["terrace_a"]);
    for copy in 1..=3 {
        let mut facade = layout(&grids[0]);
        facade.name = format!("copy_{copy}");
        let path = at.join(format!("copy_{copy}.facade.json"));
        facade_json::write(&facade, &path).expect("written");
    }
    let mut other = layout(&pictures(&["shophouse_1"])[0]);
    other.name = "other".into();
    facade_json::write(&other, &at.join("other.facade.json")).expect("written");
    let line = output(at, &["logic", "compare", ".", "--query", "copy_1"]);
    let words = "copy_1: copy_2 0.000 = copy_3 0.000, other ";
    assert!(line.starts_with(words), "{line}");
    // Rows and columns differ by whole changes.
    let lattice = [
        "logic",
        "compare",
        ".",
        "--query",
        "copy_1",
        "--measure",
        "lattice",
    ];
    let line = output(at, &lattice);
    let changes = line.trim().strip_prefix(words).map(str::parse);
    assert!(matches!(changes, Some(Ok(1.0_f64..))), "{line}");
    let line = output(
        at,
        &["logic", "compare", ".", "--query", "copy_1", "--top", "1"],
    );
    let words = "copy_1: copy_2 0.000 (= 1 more at the same distance)\n";
    assert_eq!(line, words);
    let line = output(
        at,
        &[
            "logic", "compare", ".", "--query", "other", "--top", "2", "--json",
        ],
    );
    let ranked: serde_json::Value = serde_json::from_str(&line).expect("one JSON object");
    assert_eq!(ranked["nearest"][1]["rank"], 1);
    assert_eq!(ranked["tied_with_last"], 1);

    output(at, &["logic", "fit", ".", "-o", "m.logic"]);
    let words = [
        "logic",
        "fit",
        "other.facade.json",
        "--into",
        "m.logic",
        "-o",
        "m.logic",
    ];
    let done = edifice(at, &words).assert().success();
    let said = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(said.contains("already has a facade called other"), "{said}");
}

/// The example of the README tells two kinds of facades apart.
#[test]
fn the_example_of_clusters_has_two_kinds() {
    let layouts = Path::new(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let mut words = vec!["logic".to_owned(), "cluster".to_owned()];
    for entry in std::fs::read_dir(&layouts).expect("the shipped layouts") {
        let name = entry.expect("an entry").file_name();
        let name = name.to_string_lossy().into_owned();
        let wanted = name.starts_with("terrace") || name.starts_with("hotel");
        if wanted && name.ends_with(".facade.json") {
            words.push(name);
        }
    }
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let clusters = output(&layouts, &words);
    let of = |kind: &str| -> Vec<&str> {
        let lines = clusters.lines().filter_map(|line| line.split_once('\t'));
        let mut found: Vec<&str> = lines
            .filter(|l| l.1.starts_with(kind))
            .map(|l| l.0)
            .collect();
        found.dedup();
        found
    };
    let (terraces, hotels) = (of("terrace"), of("hotel"));
    assert_eq!((terraces.len(), hotels.len()), (1, 1), "{clusters}");
    assert_ne!(terraces, hotels);
}

#[test]
fn says_what_is_wrong() {
    let folder = facades();
    let at = folder.path();
    output(at, &["logic", "fit", "houses", "-o", "m.json"]);
    let text = std::fs::read_to_string(at.join("m.json")).expect("a model");
    let cases: [(&str, &str, &str); 4] = [
        (
            "\"format\":\"edifice/logic-model\"",
            "\"format\":\"edifice/facade\"",
            "format",
        ),
        ("\"version\":1", "\"version\":7", "version"),
        ("\"alpha\":0.6", "\"alpha\":6", "alpha is 6"),
        ("\"parts\":[{\"insert\":", "\"parts\":[{\"rule\":", "rules["),
    ];
    for (from, to, word) in cases {
        std::fs::write(at.join("bad.json"), text.replacen(from, to, 1)).expect("written");
        let said = complaint(at, &["logic", "synthesize", "bad.json", "-o", "v"], 1);
        assert!(said.contains("bad.json") && said.contains(word), "{said}");
    }
    std::fs::create_dir(at.join("empty")).expect("a folder");
    for (words, word) in [
        (&["logic", "fit", "empty", "-o", "x"][..], "empty"),
        (&["logic", "fit", "-o", "x"], "no facades"),
        (
            &["logic", "fit", "houses", "--alpha", "nan", "-o", "x"],
            "--alpha",
        ),
        (
            &["logic", "compare", "houses", "--query", "nobody"],
            "nobody",
        ),
        (
            &["logic", "synthesize", "m.json", "--start", "0", "-o", "v"],
            "--start",
        ),
        (
            &["logic", "synthesize", "m.json", "--sigma", "-1", "-o", "v"],
            "--sigma",
        ),
        (
            &[
                "logic",
                "synthesize",
                "m.json",
                "--sigma",
                "1e308",
                "-o",
                "v",
            ],
            "--sigma",
        ),
        (
            &["logic", "compare", "houses", "--query", "nobody", "-o", "x"],
            "nobody",
        ),
        (
            &["logic", "parse", "houses", "houses", "-o", "v"],
            "two facades are called",
        ),
        (&["logic", "fit", "houses", "-o", "no/x"], "no/x"),
        (&["logic", "parse", "houses", "-o", "m.json"], "m.json"),
        (
            &["logic", "cluster", "houses", "-o", "no/x.svg"],
            "no/x.svg",
        ),
        (&["logic", "synthesize", "m.json", "-o", "m.json"], "m.json"),
    ] {
        let said = complaint(at, words, 1);
        assert!(said.contains(word), "{said}");
        let left = ["x", "v/virtual_1.facade.json", "v/terrace_a.grammar.json"];
        assert!(left.iter().all(|name| !at.join(name).exists()), "{words:?}");
    }
    complaint(
        at,
        &[
            "logic", "fit", "houses", "-o", "x", "--search", "--alpha", "1",
        ],
        2,
    );

    // A layout with a gap is no label picture.
    let rect = Rect::new(0.0, 0.0, 1.0, 1.0);
    let label = "wall".into();
    let gap = Facade::new("gap", "m", 2.0, 1.0, vec![Region { label, rect }]).expect("a layout");
    facade_json::write(&gap, &at.join("gap.facade.json")).expect("written");
    let said = complaint(at, &["logic", "fit", "gap.facade.json", "-o", "x"], 1);
    assert!(
        said.contains("gap.facade.json") && said.contains("no region covers"),
        "{said}"
    );
}

#[test]
fn models_come_back_from_files() {
    let grids = pictures(&["cottage", "shophouse"]);
    let model = Model::fit(&grids, Parameters::RETRIEVAL).expect("fits");
    let text = serde_json::to_string(&ModelFile::from(&model)).expect("JSON");
    let file: ModelFile = serde_json::from_str(&text).expect("a record");
    assert_eq!(Model::try_from(file), Ok(model));
}
