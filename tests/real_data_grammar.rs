//! The printed grammar of Wu et al. 2014 against the facade of the data folder (needs
//! `EDIFICE_DATA` or `../shared/data`).

mod common;

use std::path::Path;

use edifice::grammar::{Costs, evaluate};
use edifice::io::{facade_json, grammar_cga};

#[test]
fn the_printed_grammar_derives_facade_i() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let file = "facades/wu2014_fig9.facade.json";
    let Some(data) = common::real_data(file) else {
        return;
    };
    let facade = facade_json::read(&data.join(file)).unwrap();
    let grammar = grammar_cga::read(&here.join("datasets/facade_grammar/wu2014_fig9.cga")).unwrap();
    let found = evaluate(&grammar, &[facade], &Costs::default()).unwrap();
    assert_eq!((found.rules, found.terminals), (10, 50));
    assert!((found.cost - 39.4).abs() < 1e-9);
}
