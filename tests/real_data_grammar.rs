//! The printed grammar of Wu et al. 2014 against the facade of the data folder (needs
//! `EDIFICE_DATA` or `../shared/data`).

use std::path::{Path, PathBuf};

use edifice::grammar::{Costs, evaluate};
use edifice::io::{facade_json, grammar_cga};

#[test]
fn the_printed_grammar_derives_facade_i() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder =
        std::env::var_os("EDIFICE_DATA").map_or(here.join("../shared/data"), PathBuf::from);
    let path = folder.join("facades/wu2014_fig9.facade.json");
    if !path.is_file() {
        eprintln!("SKIPPED: no {}; set EDIFICE_DATA", path.display());
        return;
    }
    let facade = facade_json::read(&path).unwrap();
    let grammar = grammar_cga::read(&here.join("datasets/facade_grammar/wu2014_fig9.cga")).unwrap();
    let found = evaluate(&grammar, &[facade], &Costs::default()).unwrap();
    assert_eq!((found.rules, found.terminals), (10, 50));
    assert!((found.cost - 39.4).abs() < 1e-9);
}
