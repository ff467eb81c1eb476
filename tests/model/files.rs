//! Networks as files: BIF with words in quotation marks, XMLBIF, DOT, drawings; structures learned and models continued by
//! commands.

use std::path::Path;

use assert_cmd::Command;
use edifice::model::network::{Evidence, Network, Variable};
use edifice::rng::stream;
use proptest::prelude::*;

fn edifice(words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.arg("model").args(words);
    command
}

fn said(words: &[&str]) -> (String, String) {
    let done = edifice(words).assert().success();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        text(&done.get_output().stdout),
        text(&done.get_output().stderr),
    )
}

fn complaint(words: &[&str], code: i32) -> String {
    let done = edifice(words).assert().code(code);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

const ASIA: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/model/asia.bif");

/// A network of three variables with the given names and categories.
fn network(words: &[String]) -> Option<Network> {
    let [a, b, c, yes, no] = words else {
        return None;
    };
    let both = [yes.as_str(), no.as_str()];
    Network::new(vec![
        Variable::table(a, &both, &[], &[0.25, 0.75]),
        Variable::table(b, &both, &[a], &[0.1, 0.9, 0.6, 0.4]),
        Variable::table(
            c,
            &both,
            &[a, b],
            &[0.5, 0.5, 1.0, 0.0, 0.3, 0.7, 0.125, 0.875],
        ),
    ])
    .ok()
}

proptest! {
    #[test]
    fn what_is_written_is_read_back(words in prop::collection::vec("[a-z |;,(){}/&<>'.é-]{1,8}", 5)) {
        let words: Vec<String> = words.iter().map(|w| w.trim().to_owned()).collect();
        prop_assume!(words.iter().all(|w| !w.is_empty()));
        if let Some(network) = network(&words) {
            let xml = network.to_xmlbif().unwrap();
            prop_assert_eq!(&Network::from_xmlbif(&xml).unwrap(), &network, "{}", xml);
            // BIF has no sign for a word that is a mark.
            if let Ok(bif) = network.to_bif() {
                prop_assert_eq!(&Network::from_bif(&bif).unwrap(), &network, "{}", bif);
            }
            prop_assert!(network.to_dot().contains("->"));
        }
    }
}

#[test]
fn probabilities_that_sum_to_one_are_read_to_the_bit_and_others_made_to() {
    // Their sum in doubles is not 1.
    let odd = [0.3, 0.35, 0.35];
    assert_ne!(odd.iter().sum::<f64>(), 1.0);
    let categories = ["x", "y", "z"];
    let network = Network::new(vec![Variable::table("a", &categories, &[], &odd)]).unwrap();
    let xml = network.to_xmlbif().unwrap();
    assert_eq!(Network::from_xmlbif(&xml).unwrap(), network);
    assert_eq!(
        Network::from_bif(&network.to_bif().unwrap()).unwrap(),
        network
    );
    // Rounded ones are divided by their sum.
    let rounded = xml.replace("0.3 ", "0.3005 ");
    assert_ne!(rounded, xml);
    let read = Network::from_xmlbif(&rounded).unwrap();
    let whole = odd.map(|p| if p == 0.3 { 0.3005 } else { p });
    let sum: f64 = whole.iter().sum();
    let divided = whole.map(|p| p / sum);
    let expected = Network::new(vec![Variable::table("a", &categories, &[], &divided)]).unwrap();
    assert_eq!(read, expected);
}

#[test]
fn broken_xmlbif_is_refused_by_place() {
    let whole = Network::from_bif(&std::fs::read_to_string(ASIA).unwrap()).unwrap();
    let xml = whole.to_xmlbif().unwrap();
    assert_eq!(Network::from_xmlbif(&xml).unwrap(), whole);
    for cut in 1..xml.len() / 7 {
        let part: String = xml.chars().take(cut * 7).collect();
        if !part.trim_end().ends_with("</NETWORK>") {
            assert!(Network::from_xmlbif(&part).is_err(), "{part}");
        }
    }
    let changed = |from: &str, to: &str| {
        let changed = xml.replacen(from, to, 1);
        assert_ne!(changed, xml);
        Network::from_xmlbif(&changed).unwrap_err().to_string()
    };
    assert!(changed("<TABLE>", "<TABLE>0.5 ").contains("numbers"));
    assert!(changed("<TABLE>0", "<TABLE>x0").contains("no probability"));
    assert!(changed("<FOR>asia", "<FOR>asi").contains("no variable"));
    assert!(changed("<GIVEN>asia", "<GIVEN>tub").contains("tub"));
    assert!(changed("<OUTCOME>yes", "<OUTCOME>&nobody;").contains("nobody"));
    for twice in ["<NAME>asia", "<FOR>asia", "<TABLE>0.01 0.99"] {
        let (element, _) = twice.split_once('>').unwrap();
        let said = changed(twice, &format!("{twice}</{}>{twice}", &element[1..]));
        assert!(said.contains(&format!("a second {element}>")), "{said}");
    }
    // Definitions may come first, and a mark of the order of bytes.
    let (start, variables) = xml.split_at(xml.find("<VARIABLE").unwrap());
    let (variables, definitions) = variables.split_at(variables.find("<DEFINITION").unwrap());
    let (definitions, end) = definitions.split_at(definitions.find("</NETWORK").unwrap());
    let other = format!("\u{feff}{start}{definitions}{variables}{end}");
    assert_eq!(Network::from_xmlbif(&other).unwrap(), whole);
}

#[test]
fn files_are_converted_and_drawn() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    for name in ["asia.xmlbif", "asia.json", "asia.dot", "asia.svg"] {
        said(&["convert", ASIA, "-o", &at(name)]);
    }
    said(&["convert", &at("asia.xmlbif"), "-o", &at("again.bif")]);
    let read = |path: &str| Network::from_bif(&std::fs::read_to_string(path).unwrap()).unwrap();
    assert_eq!(read(&at("again.bif")), read(ASIA));
    let plain = std::fs::read_to_string(at("asia.svg")).unwrap();
    assert!(
        plain.contains(">lung<") && plain.contains("5.5 %"),
        "{plain}"
    );
    said(&[
        "convert",
        ASIA,
        "--given",
        "smoke=yes",
        "-o",
        &at("smoker.svg"),
    ]);
    let given = std::fs::read_to_string(at("smoker.svg")).unwrap();
    assert!(given.contains("10.0 %") && given != plain, "{given}");
    let wrong = complaint(
        &["convert", ASIA, "--given", "smoke=yes", "-o", &at("x.bif")],
        1,
    );
    assert!(wrong.contains("drawing"), "{wrong}");
    let wrong = complaint(&["convert", ASIA, "-o", &at("x.txt")], 1);
    assert!(wrong.contains(".xmlbif"), "{wrong}");
    assert!(!Path::new(&at("x.bif")).exists() && !Path::new(&at("x.txt")).exists());
}

/// Rows of ASIA as CSV.
fn patients(rows: usize) -> String {
    let asia = Network::from_bif(&std::fs::read_to_string(ASIA).unwrap()).unwrap();
    let names: Vec<&str> = asia.names().collect();
    let drawn = asia
        .sample(&Evidence::new(), rows, &mut stream(1, "patients", 0))
        .unwrap();
    let mut text = names.join(",") + "\n";
    for row in 0..rows {
        let cells = names.iter().map(|name| {
            let column = drawn.column(name).unwrap();
            match column.cell(row) {
                edifice::model::Cell::Code(c) => column.categories().unwrap()[c].clone(),
                _ => String::new(),
            }
        });
        text += &(cells.collect::<Vec<_>>().join(",") + "\n");
    }
    text
}

#[test]
fn structures_are_learned_by_command() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    std::fs::write(at("patients.csv"), patients(3000)).unwrap();
    let (line, words) = said(&[
        "structure",
        &at("patients.csv"),
        "-o",
        &at("out.bif"),
        "--json",
    ]);
    assert!(words.contains("8 variables, 3000 rows"), "{words}");
    let line: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert!(line["edges"].as_array().unwrap().len() >= 5, "{line}");
    let network = Network::from_bif(&std::fs::read_to_string(at("out.bif")).unwrap()).unwrap();
    assert_eq!(network.names().count(), 8);
    let (line, _) = said(&[
        "structure",
        &at("patients.csv"),
        "-o",
        &at("two.bif"),
        "--json",
        "--score",
        "bic",
        "--require",
        "asia>smoke",
        "--forbid",
        "smoke>lung",
        "--forbid",
        "lung>smoke",
    ]);
    assert!(
        line.contains("[\"asia\",\"smoke\"]") && !line.contains("[\"smoke\",\"lung\"]"),
        "{line}"
    );
    for (words, expected) in [
        (["--require", "asia-smoke"], "PARENT>CHILD"),
        (["--forbid", "asia>nobody"], "nobody"),
        (["--ess", "0"], "ess"),
    ] {
        let (table, out) = (at("patients.csv"), at("no.bif"));
        let all = [&["structure", &table, "-o", &out][..], &words[..]].concat();
        let done = edifice(&all).assert().failure();
        let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
        assert!(text.contains(expected), "{text}");
    }
    std::fs::write(at("real.csv"), "w\n1.5\n2.25\n3.125\n4.5\n5.5\n6.5\n7.5\n").unwrap();
    assert!(!Path::new(&at("no.bif")).exists());
    // Numbers become categories, and the cuts are said.
    let mut done = edifice(&["structure", &at("real.csv"), "-o", &at("real.bif")]);
    let done = done.assert().success();
    let text = String::from_utf8_lossy(&done.get_output().stderr).into_owned();
    assert!(
        text.contains("w: numbers as 2 categories by description length"),
        "{text}"
    );
    assert!(Path::new(&at("real.bif")).exists());
}

#[test]
fn learning_is_limited_continued_and_fitted_without_search() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let mut text = "width,depth,roof\n".to_owned();
    for i in 0..120 {
        let style = i % 3;
        let noise = (i * 37 % 11) as f64 / 10.0;
        let depth = 5.0 * style as f64 - noise + (i * 13 % 7) as f64 / 5.0;
        text += &format!(
            "{},{depth},{}\n",
            10.0 * style as f64 + noise,
            ["hip", "flat", "shed"][style]
        );
    }
    std::fs::write(at("t.csv"), text).unwrap();
    let (table, first, second) = (
        at("t.csv"),
        at("a.table-model.json"),
        at("b.table-model.json"),
    );
    let few = ["--max-styles", "5"];
    let limited = [
        &[
            "learn",
            &table,
            "-o",
            &first,
            "--time-limit",
            "0.000001",
            "--json",
        ][..],
        &few,
    ]
    .concat();
    let (line, words) = said(&limited);
    assert!(
        line.contains("\"interrupted\":true") && words.contains("--from"),
        "{line} {words}"
    );
    let from = [
        &["learn", &table, "-o", &second, "--from", &first, "--json"][..],
        &few,
    ]
    .concat();
    let (line, _) = said(&from);
    assert!(line.contains("\"interrupted\":false"), "{line}");
    let score = |path: &str| said(&["score", path, &table]).1;
    assert_ne!(score(&first), score(&second));
    let fit = [
        "learn",
        &table,
        "-o",
        &first,
        "--fit-only",
        "--styles",
        "3",
        "--kinds",
        "2",
        "--json",
    ];
    let (line, _) = said(&fit);
    assert!(line.contains("\"styles\":3"), "{line}");
    complaint(&["learn", &table, "-o", &first, "--fit-only"], 2);
    complaint(&["learn", &table, "-o", &first, "--time-limit", "0"], 1);
    complaint(&["learn", &table, "-o", &first, "--searched-rows", "0"], 1);
}
