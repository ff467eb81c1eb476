//! Tables that meet a model: what is given stays, rows and columns are named as the table has them, and a cell means the same however it
//! is written.

use std::fmt::Write;

use assert_cmd::Command;
use edifice::rng::stream;
use rand::RngExt;

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.path().join(name), text).unwrap();
    }

    fn model(&self, words: &[&str]) -> Command {
        let mut command = Command::cargo_bin("edifice").unwrap();
        command.current_dir(self.0.path()).arg("model").args(words);
        command
    }

    /// Standard output and standard error.
    fn output(&self, words: &[&str]) -> (String, String) {
        let done = self.model(words).assert().success();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        (
            text(&done.get_output().stdout),
            text(&done.get_output().stderr),
        )
    }

    fn json(&self, words: &[&str]) -> serde_json::Value {
        serde_json::from_str(&self.output(words).0).unwrap()
    }

    fn complaint(&self, words: &[&str]) -> String {
        let done = self.model(words).assert().failure().code(1);
        String::from_utf8_lossy(&done.get_output().stderr).into_owned()
    }
}

/// Houses: an area that is 0 for some, a number of rooms, a garage in words of its own, and a type that every other one has.
fn houses(words: [&str; 2]) -> String {
    let mut rng = stream(1, "houses", 0);
    let mut text = "type,area,rooms,garage\n".to_owned();
    for i in 0..60 {
        let area = match i % 4 {
            0 => 0.0,
            _ => 3.0 + 20.0 * rng.random::<f64>(),
        };
        let rooms = 1 + (area as usize) / 4;
        let kind = if i % 2 == 0 { "B" } else { "A" };
        writeln!(text, "{kind},{area:.2},{rooms},{}", words[i / 2 % 2]).unwrap();
    }
    text
}

const ONE_TYPE: &str = r#"{"format": "edifice/attributes", "version": 1, "keep": {"type": ["A"]}, "missing": [""], "groups": [
    {"name": "area", "kind": "continuous", "columns": ["area"]}, {"name": "garage", "kind": "category", "columns": ["garage"]}]}"#;

/// Learns a small model.
fn learned(folder: &Folder, table: &str, more: &[&str]) {
    let words = ["learn", table, "--max-styles", "2", "-o", "m.json"];
    folder.output(&[&words, more].concat());
}

#[test]
fn what_is_given_stays_as_it_is_written() {
    let folder = Folder::new();
    folder.write("houses.csv", &houses(["FALSE", "TRUE"]));
    learned(&folder, "houses.csv", &[]);
    let given = "area,rooms,garage\n3.1,2,TRUE\n0.00,,FALSE\n11.850,3,\n";
    folder.write("given.csv", given);
    let (whole, said) = folder.output(&["complete", "m.json", "given.csv", "-n", "5"]);
    assert!(said.contains("hidden: type"), "{said}");
    let cells: Vec<Vec<&str>> = whole.lines().map(|l| l.split(',').collect()).collect();
    let place = |name| cells[0].iter().position(|cell| *cell == name).unwrap();
    let [area, rooms, garage] = ["area", "rooms", "garage"].map(place);
    for (i, row) in cells[1..].iter().enumerate() {
        assert_eq!(row[area], ["3.1", "0.00", "11.850"][i / 5]);
        match i / 5 {
            0 => assert_eq!((row[rooms], row[garage]), ("2", "TRUE")),
            1 => assert_eq!(row[garage], "FALSE"),
            // What is drawn goes by the words of its column.
            _ => assert!(["TRUE", "FALSE"].contains(&row[garage]), "{row:?}"),
        }
    }
    let line = folder.json(&["complete", "m.json", "given.csv", "--json"]);
    let columns = line["columns"].as_array().unwrap();
    let area = columns.iter().position(|name| name == "area").unwrap();
    for (row, wanted) in [3.1, 0.0, 11.85].into_iter().enumerate() {
        assert_eq!(line["rows"][row][area].as_f64(), Some(wanted));
    }
    let drawn = folder.json(&["sample", "m.json", "--given", "area=3.1", "--json"]);
    assert_eq!(drawn["rows"][9][area].as_f64(), Some(3.1));
}

#[test]
fn rows_are_those_of_the_table_where_a_schema_leaves_some_out() {
    let folder = Folder::new();
    folder.write("houses.csv", &houses(["q", "p"]));
    folder.write("a.schema.json", ONE_TYPE);
    learned(&folder, "houses.csv", &["--schema", "a.schema.json"]);
    let few = |cell: &str| {
        let text = format!("type,area,garage\nB,4,p\nA,5,q\nB,6,p\nA,,{cell}\n");
        folder.write("few.csv", &text);
    };
    few("p");
    let line = folder.json(&["complete", "m.json", "few.csv", "--json", "-n", "2"]);
    assert_eq!(line["of"], serde_json::json!([1, 1, 3, 3]));
    let line = folder.json(&["score", "m.json", "few.csv", "--json"]);
    assert_eq!(line["of"], serde_json::json!([1, 3]));
    let (scores, _) = folder.output(&["score", "m.json", "few.csv"]);
    let rows: Vec<&str> = (scores.lines().skip(1))
        .map(|line| line.split(',').next().unwrap())
        .collect();
    assert_eq!(rows, ["2", "4"]);
    few("z");
    for verb in ["score", "complete"] {
        let said = folder.complaint(&[verb, "m.json", "few.csv"]);
        assert!(
            said.contains("column `garage`, row 4: category `z`"),
            "{said}"
        );
    }
}

const CHAIN: &str = "network n {\n}
variable h { type discrete [ 2 ] { u, v }; }
variable x { type discrete [ 2 ] { a, b }; }
probability ( h ) { table 0.3, 0.7; }
probability ( x | h ) { (u) 0.9, 0.1; (v) 0.0, 1.0; }
";

#[test]
fn rows_count_from_one_and_a_question_has_none() {
    let folder = Folder::new();
    folder.write("n.bif", CHAIN);
    folder.write("t.csv", "h,x\nu,a\nv,zz\n");
    let said = folder.complaint(&["score", "n.bif", "t.csv"]);
    assert!(said.contains("column `x`, row 2: category `zz`"), "{said}");
    folder.write("t.csv", "h,x\nu,a\nv,b\nv,a\n");
    let said = folder.complaint(&["score", "n.bif", "t.csv"]);
    assert!(
        said.contains("row 3: the evidence has probability zero"),
        "{said}"
    );
    for given in [["h=u", "h=v"], ["h=v", "x=a"]] {
        let words = ["query", "n.bif", "--given", given[0], "--given", given[1]];
        let said = folder.complaint(&words);
        assert!(
            said.contains("the evidence has probability zero") && !said.contains("row"),
            "{said}"
        );
    }
}

#[test]
fn columns_that_a_table_lacks_are_said_and_one_that_has_none_is_refused() {
    let folder = Folder::new();
    folder.write("houses.csv", &houses(["0", "1"]));
    learned(&folder, "houses.csv", &[]);
    folder.write("n.bif", CHAIN);
    folder.write("none.csv", "zz,qq\n1,2\n");
    for model in ["m.json", "n.bif"] {
        for verb in ["score", "complete"] {
            let said = folder.complaint(&[verb, model, "none.csv"]);
            assert!(said.contains("columns"), "{said}");
        }
    }
    // Blanks around names are those of cells: nothing.
    folder.write("blank.csv", " x , other\na, 1\n");
    for verb in ["score", "complete"] {
        let (_, said) = folder.output(&[verb, "n.bif", "blank.csv"]);
        assert!(said.contains("hidden: h\n"), "{said}");
    }
    folder.write("blank.csv", "type, area ,rooms,garage\nA, 4,1,0\n");
    let (scores, said) = folder.output(&["score", "m.json", "blank.csv"]);
    assert!(!said.contains("hidden"), "{said}");
    folder.write("plain.csv", "type,area,rooms,garage\nA,4,1,0\n");
    assert_eq!(folder.output(&["score", "m.json", "plain.csv"]).0, scores);
}

#[test]
fn a_network_reads_the_tables_that_it_was_made_from() {
    let folder = Folder::new();
    let mut text = "width,garage,price\n".to_owned();
    for i in 0..80 {
        let (width, price) = (5.0 + 0.1 * f64::from(i), ["1,000", "2,500"][i as usize % 2]);
        writeln!(text, "{width:.2},{},\"{price}\"", i / 40).unwrap();
    }
    folder.write("t.csv", &text);
    folder.write(
        "s.json",
        r#"{"format": "edifice/attributes", "version": 1, "groups": [{"name": "width", "kind": "continuous", "columns": ["width"]},
        {"name": "garage", "kind": "binary", "columns": ["garage"]}, {"name": "price", "kind": "category", "columns": ["price"]}]}"#,
    );
    folder.output(&["structure", "t.csv", "--schema", "s.json", "-o", "n.bif"]);
    let (scores, _) = folder.output(&["score", "n.bif", "t.csv"]);
    assert_eq!(scores.lines().count(), 81);
    let network = std::fs::read_to_string(folder.0.path().join("n.bif")).unwrap();
    assert!(network.contains("\"< "), "{network}");
    // Its own samples have the categories by name, and score as the cells that mean them.
    folder.output(&["fit", "n.bif", "t.csv", "-o", "f.bif"]);
    let drawn = folder.output(&["sample", "f.bif", "-n", "5", "--given", "garage=TRUE"]);
    folder.write("drawn.csv", &drawn.0);
    folder.output(&["score", "n.bif", "drawn.csv"]);
    let asked = |width: &str| {
        let given = format!("width={width}");
        folder.json(&["query", "n.bif", "--json", "--given", &given])["width"].clone()
    };
    assert_eq!(
        asked("5.05")["probabilities"][0].as_f64(),
        Some(1.0),
        "of the lowest bin"
    );
    // A category may be written with a comma of its own.
    let own = CHAIN.replace("{ a, b }", "{ \"1,000\", \"2,500\" }");
    folder.write("own.bif", &own);
    folder.write("own.csv", "x\n\"1,000\"\n\"2,500\"\n");
    let (whole, _) = folder.output(&["complete", "own.bif", "own.csv"]);
    assert!(whole.contains("\"1,000\"\n") && whole.ends_with("\"2,500\"\n"));
}

#[test]
fn categories_below_numbers_are_scored_and_fitted_together_with_them() {
    let folder = Folder::new();
    folder.write(
        "s.json",
        r#"{"format":"edifice/network","version":1,"variables":[
        {"name":"h","categories":[],"dimension":1,"parents":[],"distribution":{"linear":[[[6.0],[1.0]]]}},
        {"name":"l","categories":["no","yes"],"dimension":0,"parents":["h"],"distribution":{"softmax":[0,0,-8,1]}}]}"#,
    );
    folder.write("t.csv", "h,l\n6,no\n7,yes\n5.5,no\n8,yes\n");
    let (scores, _) = folder.output(&["score", "s.json", "t.csv"]);
    let lines: Vec<&str> = scores.lines().collect();
    assert_eq!((lines.len(), lines[0]), (5, "row,log_likelihood"));
    // log N(6; 6, 1) + log 1 / (1 + e^(6 - 8)).
    let wanted = -0.5 * std::f64::consts::TAU.ln() - (-2.0_f64).exp().ln_1p();
    let found: f64 = lines[1].split_once(',').unwrap().1.parse().unwrap();
    assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    let line = folder.json(&["score", "s.json", "t.csv", "--json"]);
    assert_eq!(line["log_likelihood"][0].as_f64(), Some(found));
    folder.output(&["fit", "s.json", "t.csv", "-o", "fitted.json"]);
    // What cannot be scored is not written.
    folder.write("l.csv", "l\nno\nyes\n");
    folder.complaint(&["fit", "s.json", "l.csv", "-o", "none.json"]);
    assert!(!folder.0.path().join("none.json").exists());
}

#[test]
fn explanations_are_for_programs_too() {
    let folder = Folder::new();
    folder.write("n.bif", CHAIN);
    let line = folder.json(&["query", "n.bif", "--explain", "2", "--json"]);
    let best = &line["explanations"][0];
    assert_eq!(best["values"], serde_json::json!({ "h": "v", "x": "b" }));
    assert!((best["log_joint"].as_f64().unwrap() - 0.7_f64.ln()).abs() < 1e-12);
    assert_eq!(line["explanations"].as_array().unwrap().len(), 2);
}

#[test]
fn splits_are_some_and_one_has_no_error() {
    let folder = Folder::new();
    folder.write("houses.csv", &houses(["0", "1"]));
    let evaluate = ["evaluate", "houses.csv", "--models", "gaussian", "--splits"];
    let (_, said) = folder.output(&[&evaluate[..], &["1"]].concat());
    assert!(
        said.contains(" nats a row, +0.000 beside") && !said.contains("NaN"),
        "{said}"
    );
    let said = folder.complaint(&[&evaluate[..], &["0"]].concat());
    assert!(
        said.contains("--splits") && said.contains("at least 1"),
        "{said}"
    );
}

#[test]
fn styles_are_as_many_as_asked_for_and_small_units_are_shown() {
    let folder = Folder::new();
    let mut rng = stream(2, "small", 0);
    let mut text = "a,b\n".to_owned();
    for _ in 0..60 {
        let a = (2.0 * rng.random::<f64>()).exp() * 1e-6;
        writeln!(
            text,
            "{a:.4e},{:.4e}",
            a * (1.0 + 0.1 * rng.random::<f64>())
        )
        .unwrap();
    }
    folder.write("t.csv", &text);
    learned(&folder, "t.csv", &["--min-styles", "2"]);
    let (shown, _) = folder.output(&["show", "m.json"]);
    assert!(shown.starts_with("2 styles"), "{shown}");
    assert!(!shown.contains("0.0000"), "{shown}");
    assert!(shown.contains("log(1 + x / "), "{shown}");
}
