//! The program itself: the sources that it was built from, and the documents of its reports.

use std::path::Path;

use edifice_experiments::{ALL, PROGRAM, documents, shown};

#[test]
fn methods_do_not_share_a_digest() {
    let sources = &PROGRAM.sources;
    let grammar = sources.digest(&["edifice-facade-grammar"], "facade_grammar");
    let logic = sources.digest(&["edifice-procedural-logic"], "procedural_logic");
    assert_ne!(grammar, logic);
    let again = sources.digest(&["edifice-facade-grammar"], "facade_grammar");
    assert_eq!(grammar, again);
    let mut of_papers: Vec<String> = ALL.iter().map(|e| sources.of_paper(e.slug)).collect();
    of_papers.sort();
    of_papers.dedup();
    assert_eq!(of_papers.len(), ALL.len());
}

#[test]
fn a_digest_depends_on_the_experiments_and_the_generator_of_its_part() {
    let sources = &PROGRAM.sources;
    let digest = |part: &str| sources.digest(&["edifice-optim"], part);
    for part in ["generic", "facade_grammar"] {
        assert_ne!(digest(part), digest("nothing"), "{part}");
    }
    assert_ne!(digest("generic"), digest("facade_grammar"));
}

#[test]
fn a_crate_stands_on_what_it_is_built_on() {
    let row = |name: &str| PROGRAM.sources.crates.iter().find(|row| row.0 == name);
    let grammar = row("edifice-facade-grammar").unwrap();
    assert!(grammar.2.contains(&"edifice-grammar"), "{:?}", grammar.2);
    for name in [
        "edifice-experiments-facade-grammar",
        "edifice-experiments-generic",
        "edifice-generators-facade-grammar",
        "Cargo.lock",
    ] {
        assert!(row(name).is_some(), "{name}");
    }
}

#[test]
fn every_shipped_document_of_a_picture_is_there_under_a_name_of_its_own() {
    let nowhere = Path::new("no report");
    let all = shown(nowhere);
    assert!(all.len() > 60, "{}", all.len());
    for s in &all {
        let name = format!("{}/{}/{}", s.paper, s.artefact, s.name());
        let found = documents(&name, nowhere).unwrap();
        assert_eq!(found.len(), 1, "{name}");
        assert!(!found[0].1.is_empty(), "{s:?}");
    }
    // All that an experiment names is found.
    for e in ALL {
        for a in e.artefacts {
            let found = all
                .iter()
                .filter(|s| s.paper == e.slug && s.artefact == a.name);
            assert_eq!(found.count(), (e.documents)(a.name).len(), "{}", a.name);
        }
    }
}
