//! `edifice grammar infer`, `derive` and `show`.

use std::path::PathBuf;

use assert_cmd::Command;
use edifice::io::facade_json;

fn edifice(args: &[&str]) -> (i32, String, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command.arg("grammar").args(args).output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    (
        output.status.code().unwrap(),
        text(output.stdout),
        text(output.stderr),
    )
}

fn fig9() -> String {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    folder
        .join("datasets/facade_grammar/wu2014_fig9.cga")
        .to_str()
        .unwrap()
        .to_owned()
}

#[test]
fn show_prints_rules_and_counts() {
    let (code, out, _) = edifice(&["show", &fig9(), "--json"]);
    assert_eq!(code, 0);
    assert!(out.contains("NT2  → repeat(y){NT5}"), "{out}");
    let last: serde_json::Value = serde_json::from_str(out.lines().last().unwrap()).unwrap();
    assert_eq!(
        (&last["cost"], &last["rules"], &last["terminals"]),
        (&39.4.into(), &10.into(), &50.into())
    );
    let (_, out, _) = edifice(&[
        "show",
        &fig9(),
        "--json",
        "--split-cost",
        "0",
        "--repeat-cost",
        "0",
    ]);
    assert!(out.contains("\"cost\":38.0"), "{out}");
}

#[test]
fn infer_says_when_its_grammar_is_optimal() {
    let facade = fig9().replace(".cga", ".facade.json");
    let (code, out, _) = edifice(&["infer", &facade, "--json"]);
    assert_eq!(code, 0);
    let last: serde_json::Value = serde_json::from_str(out.lines().last().unwrap()).unwrap();
    assert_eq!(
        (&last["cost"], &last["lower_bound"]),
        (&38.1.into(), &38.1.into())
    );
    let (_, _, message) = edifice(&["infer", &facade]);
    assert!(message.contains("cost 38.1 (proven optimal)"), "{message}");
    // The text's method proves nothing.
    let paper = [
        "infer",
        &facade,
        "--method",
        "adp-paper",
        "--iterations",
        "9",
    ];
    let (_, _, message) = edifice(&paper);
    assert!(!message.contains("optimal"), "{message}");
}

#[test]
fn the_default_method_is_read_by_its_name_and_by_its_older_one() {
    let folder = tempfile::tempdir().unwrap();
    let facade = fig9().replace(".cga", ".facade.json");
    let written = |name: &str, method: &[&str]| {
        let path = folder.path().join(name).with_extension("grammar.json");
        let own = ["infer", &facade, "-o", path.to_str().unwrap()];
        let (code, _, err) = edifice(&[&own, method].concat());
        assert_eq!(code, 0, "{err}");
        std::fs::read(path).unwrap()
    };
    let usual = written("usual", &[]);
    assert_eq!(usual, written("new", &["--method", "lagrangian"]));
    assert_eq!(usual, written("old", &["--method", "adp"]));
    assert_ne!(usual, written("greedy", &["--method", "greedy"]));
    // The older name is read and not listed.
    let (code, _, message) = edifice(&["infer", &facade, "--method", "guess"]);
    assert_eq!(code, 2);
    let listed = "[possible values: lagrangian, adp-paper, importance,";
    assert!(message.contains(listed), "{message}");
}

#[test]
fn derive_writes_every_format_at_every_size() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.facade.json", "a.svg", "a.png"] {
        let path = folder.path().join(name);
        let (code, _, err) = edifice(&["derive", &fig9(), "-o", path.to_str().unwrap()]);
        assert_eq!(code, 0, "{err}");
    }
    let path = folder.path().join("a.facade.json");
    let own = facade_json::read(&path).unwrap();
    assert_eq!((own.regions.len(), own.name.as_str()), (50, "wu2014_fig9"));
    let size = ["--width", "400", "--height", "500"];
    let (code, _, err) = edifice(
        &[
            &["derive", &fig9(), "-o", path.to_str().unwrap()],
            &size[..],
        ]
        .concat(),
    );
    assert_eq!(code, 0, "{err}");
    let wide = facade_json::read(&path).unwrap();
    assert_eq!((wide.width, wide.height), (400.0, 500.0));
    assert_eq!(wide.check_tiling(), Ok(()));
    assert!(wide.regions.len() > own.regions.len());
}

#[test]
fn the_seed_picks_the_variation() {
    let folder = tempfile::tempdir().unwrap();
    let grammar = folder.path().join("g.cga");
    let out = folder.path().join("a.facade.json");
    let text = "//@ facade F 8 x 8\nF --> 50% : split(x) { ~1 : A | ~1 : B } else : split(y) { ~1 : A | ~2 : B }";
    std::fs::write(&grammar, text).unwrap();
    let derive = |seed: &str| {
        let (grammar, out) = (grammar.to_str().unwrap(), out.to_str().unwrap());
        let (code, _, err) = edifice(&["derive", grammar, "--seed", seed, "-o", out]);
        assert_eq!(code, 0, "{err}");
        std::fs::read(out).unwrap()
    };
    assert_eq!(derive("3"), derive("3"));
    let first = derive("0");
    assert!((1..20).any(|seed| derive(&seed.to_string()) != first));
}

#[test]
fn bad_input_is_named_and_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let grammar = folder.path().join("g.cga");
    let out = folder.path().join("a.facade.json");
    let (grammar_path, out_path) = (grammar.to_str().unwrap(), out.to_str().unwrap());
    let run = |text: &str| {
        std::fs::write(&grammar, text).unwrap();
        let (code, _, err) = edifice(&["derive", grammar_path, "-o", out_path]);
        assert_eq!(code, 1, "{err}");
        assert!(err.contains("g.cga"), "{err}");
        assert!(!out.exists());
        err
    };
    let err = run("//@ facade F 3 x 3\nF --> split(x) { 3 : G }\nG --> split(x) { 3 : F }");
    assert!(
        err.contains("line 2, column 1: the rules form a cycle: F -> G -> F"),
        "{err}"
    );
    let err = run("//@ facade F 3 x 3\nF --> split(x) { 2 : G }");
    assert!(err.contains("add up to 2, the region has 3"), "{err}");
    let err = run("//@ facade H 3 x 3\nF --> split(x) { 3 : G }");
    assert!(
        err.contains("line 1, column 1: start symbol H is undefined"),
        "{err}"
    );
    std::fs::write(&grammar, "//@ facade F 3 x 3\nF --> split(x) { 3 : G }").unwrap();
    for bad in [["--width", "-3"], ["--height", "nan"], ["--width", "wide"]] {
        let (code, _, err) = edifice(&["derive", grammar_path, "-o", out_path, bad[0], bad[1]]);
        assert_eq!(code, 2, "{err}");
    }
    let (code, _, err) = edifice(&["derive", grammar_path, "-o", out_path, "--facade", "b"]);
    assert_eq!(code, 1);
    assert!(err.contains("--facade: no facade \"b\""), "{err}");
    let missing = folder.path().join("none/a.svg");
    let (code, _, err) = edifice(&["derive", grammar_path, "-o", missing.to_str().unwrap()]);
    assert!(code == 1 && err.contains("none/a.svg"), "{err}");
}

#[test]
fn other_sizes_are_by_bands_by_aligned_rules_or_by_rules_alone() {
    let folder = tempfile::tempdir().unwrap();
    let layouts = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("datasets/facade_grammar/layouts");
    let grammar = layouts.join("terrace_a.grammar.json");
    let own = facade_json::read(&layouts.join("terrace_a.facade.json")).unwrap();
    let out = folder.path().join("a.facade.json");
    let derive = |options: &[&str]| {
        let paths = [grammar.to_str().unwrap(), "-o", out.to_str().unwrap()];
        let (code, _, err) = edifice(&[&["derive"], &paths[..], options].concat());
        assert_eq!(code, 0, "{err}");
        facade_json::read(&out).unwrap()
    };
    let same = derive(&[]);
    assert!(edifice::grammar::same_tiling(&same, &own));
    let (width, height) = (
        (0.8 * own.width).to_string(),
        (1.3 * own.height).to_string(),
    );
    let size = ["--width", &width, "--height", &height];
    let aligned = derive(&[&size[..], &["--rules"]].concat());
    let plain = derive(&[&size[..], &["--no-align"]].concat());
    assert_ne!(aligned, plain);
    let banded = derive(&[&size[..], &["--bands"]].concat());
    banded.check_tiling().unwrap();
    // Rules without relative sizes and choices are not asked unless one says so.
    assert_eq!(derive(&size), banded);
    assert!((banded.width - 0.8 * own.width).abs() < 1e-9);
    assert!(banded != aligned && banded != plain);
    // Each element of one size at the own size has one size.
    let sizes = |facade: &edifice::shape::Facade| {
        let noise = 1e-5 * facade.height;
        let whole = |v: f64| (v / noise).round() as i64;
        let elements = facade.regions.iter();
        let elements = elements.filter(|r| !edifice::shape::is_background(&r.label));
        let sizes = elements.map(|r| (&r.label, whole(r.rect.width), whole(r.rect.height)));
        sizes.collect::<std::collections::BTreeSet<_>>().len()
    };
    assert!(
        sizes(&aligned) <= sizes(&own),
        "{} {}",
        sizes(&aligned),
        sizes(&own)
    );
    assert!(sizes(&plain) > sizes(&own));
}

#[test]
fn absolute_sizes_that_do_not_fit_shrink_with_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let grammar = folder.path().join("g.cga");
    let out = folder.path().join("a.facade.json");
    // One relative size, elsewhere absolute ones.
    let text = "//@ facade F 40 x 40\nF --> split(y) { 10 : Shop | ~30 : Rest }\n\
                Shop --> split(x) { 10 : wall | 20 : door | 10 : wall }\n\
                Rest --> split(x) { 2 : frame | 36 : glass | 2 : frame }";
    std::fs::write(&grammar, text).unwrap();
    let (grammar, out) = (grammar.to_str().unwrap(), out.to_str().unwrap());
    let derive = |width: &str, height: &str| {
        let size = ["--width", width, "--height", height];
        let (code, _, err) = edifice(&[&["derive", grammar, "-o", out], &size[..]].concat());
        assert_eq!(code, 0, "{err}");
        let facade = facade_json::read(out.as_ref()).unwrap();
        assert_eq!(facade.check_tiling(), Ok(()));
        (facade, err)
    };
    let (facade, err) = derive("20", "20");
    // Up to the precision of the solver that aligns.
    assert!((facade.regions[0].rect.height - 10.0).abs() < 1e-6);
    assert!(err.is_empty(), "{err}");
    let (facade, err) = derive("20", "8");
    assert!((facade.regions[0].rect.height - 2.0).abs() < 1e-6);
    assert!(
        err.contains("g.cga: absolute sizes of 1 rule do not fit"),
        "{err}"
    );
}

#[test]
fn combine_names_the_grammar_that_has_choices() {
    let folder = tempfile::tempdir().unwrap();
    let [mixed, out] = ["mixed.cga", "out.cga"].map(|name| folder.path().join(name));
    let text = "//@ facade F 8 x 8\nF --> 50% : split(x) { ~1 : A | ~1 : B } else : split(y) { ~1 : A | ~2 : B }";
    std::fs::write(&mixed, text).unwrap();
    let [mixed, out] = [&mixed, &out].map(|path| path.to_str().unwrap());
    let (code, _, err) = edifice(&["combine", &fig9(), mixed, "-o", out]);
    assert_eq!(code, 1);
    let expected = "mixed.cga: F has 2 weighted rules; combine takes grammars without choices";
    assert!(err.contains(expected), "{err}");
}

#[test]
fn options_that_say_nothing_and_names_of_other_files_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let facade = fig9().replace(".cga", ".facade.json");
    let refused = |arguments: &[&str], output: &str, expected: &str| {
        let output = at(output);
        let (code, _, err) = edifice(&[arguments, &["-o", &output]].concat());
        assert_eq!(code, 1, "{err}");
        assert!(err.contains(expected), "{err}");
        assert!(!std::path::Path::new(&output).exists());
    };
    let free = ["infer", &facade, "--sizes", "free"];
    for option in [
        &["--method", "greedy"][..],
        &["--ops", "split"],
        &["--seed", "0"],
        &["--iterations", "9"],
        &["--no-protection"],
    ] {
        let expected = format!("{}: is not for --sizes free", option[0]);
        refused(&[&free[..], option].concat(), "a.library.json", &expected);
    }
    refused(&free, "a.facade.json", "expected .library.json");
    refused(&free[..2], "a.library.json", "expected .grammar.json");
    refused(&free[..2], "a.facade.json", "expected .grammar.json");
    refused(
        &["derive", &fig9()],
        "a.grammar.json",
        "expected .facade.json",
    );
    let library = at("l.library.json");
    let (code, _, err) = edifice(&[&free[..], &["-o", &library]].concat());
    assert_eq!(code, 0, "{err}");
    for option in [
        &["--width", "3"][..],
        &["--height", "3"],
        &["--seed", "0"],
        &["--facade", "wu"],
        &["--rules"],
        &["--no-align"],
        &["--bands"],
    ] {
        let expected = format!("{}: is not for a library", option[0]);
        refused(
            &[&["derive", &library], option].concat(),
            "l.cga",
            &expected,
        );
    }
    let (code, _, err) = edifice(&["derive", &library, "-o", &at("l.cga")]);
    assert_eq!(code, 0, "{err}");
}

#[test]
fn quiet_leaves_results_and_errors() {
    let facade = fig9().replace(".cga", ".facade.json");
    let (_, out, message) = edifice(&["infer", &facade]);
    assert!(!message.is_empty());
    let (code, quiet, message) = edifice(&["infer", &facade, "--quiet"]);
    assert_eq!((code, message.as_str()), (0, ""));
    assert_eq!(out, quiet);
    let (code, _, message) = edifice(&["infer", "nowhere.facade.json", "-q"]);
    assert_eq!(code, 1);
    assert!(message.starts_with("error: "), "{message}");
}
