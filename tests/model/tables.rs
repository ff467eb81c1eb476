//! Any table: schemas guessed, models learned, scored, sampled, completed and compared by commands.

use std::fmt::Write;
use std::path::Path;

use assert_cmd::Command;
use edifice::model::tables::compare::summary;
use edifice::model::tables::schema::{Kind, Schema, SchemaError};
use edifice::model::tables::table_model::TableModel;
use edifice::rng::stream;
use rand::RngExt;

/// Birds of three kinds: two lengths that go with the kind, a category, a yes or no, some cells missing.
fn birds(rows: usize, missing: bool) -> String {
    let mut rng = stream(3, "birds", 0);
    let mut text = "island,bill,flipper,banded\n".to_owned();
    for i in 0..rows {
        let kind = i % 3;
        let island = ["Biscoe", "Dream", "Torgersen"][kind];
        let length = 30.0 + 10.0 * kind as f64 + rng.random::<f64>();
        let bill = match missing && i % 7 == 0 {
            true => "NA".to_owned(),
            false => format!("{length:.2}"),
        };
        let flipper = 2.0 * length + rng.random::<f64>();
        let banded = if (i / 3) % 2 == 0 { "no" } else { "yes" };
        writeln!(text, "{island},{bill},{flipper:.2},{banded}").unwrap();
    }
    text
}

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    fn write(&self, name: &str, text: &str) -> String {
        std::fs::write(self.0.path().join(name), text).unwrap();
        self.path(name)
    }
}

fn edifice(words: &[&str]) -> Command {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command.arg("model").args(words);
    command
}

/// Standard output and standard error.
fn output(words: &[&str]) -> (String, String) {
    let done = edifice(words).assert().success();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    (
        text(&done.get_output().stdout),
        text(&done.get_output().stderr),
    )
}

fn complaint(words: &[&str]) -> String {
    let done = edifice(words).assert().failure().code(1);
    String::from_utf8_lossy(&done.get_output().stderr).into_owned()
}

fn rows(text: &str) -> (Vec<String>, Vec<Vec<String>>) {
    let cells = |line: &str| line.split(',').map(str::to_owned).collect();
    let mut lines = text.lines();
    let header = cells(lines.next().unwrap());
    (header, lines.map(cells).collect())
}

#[test]
fn kinds_are_guessed_and_free_text_is_refused() {
    let (header, cells) = rows(&birds(60, true));
    let schema = Schema::guess(&header, &cells).unwrap();
    let kinds: Vec<Kind> = schema.groups.iter().map(|g| g.kind).collect();
    let expected = [
        Kind::Category,
        Kind::Continuous,
        Kind::Continuous,
        Kind::Binary,
    ];
    assert_eq!(kinds, expected);
    let data = schema.read(&header, &cells).unwrap();
    assert_eq!((data.table.rows(), data.groups.len()), (60, 4));

    let named =
        "name,size\n".to_owned() + &(0..40).map(|i| format!("n{i},{i}\n")).collect::<String>();
    let (header, cells) = rows(&named);
    let refused = Schema::guess(&header, &cells);
    assert!(
        matches!(refused, Err(SchemaError::FreeText { column, different: 40, .. }) if column == "name")
    );
    let (header, cells) = rows("a,b\nNA,1\n?,2\n");
    let refused = Schema::guess(&header, &cells);
    assert!(matches!(refused, Err(SchemaError::NoValues { column }) if column == "a"));
}

#[test]
fn a_table_is_learned_scored_sampled_and_completed() {
    let folder = Folder::new();
    let table = folder.write("birds.csv", &birds(90, true));
    let model = folder.path("birds.table-model.json");
    let (line, said) = output(&["learn", &table, "--max-styles", "4", "-o", &model, "--json"]);
    let line: serde_json::Value = serde_json::from_str(&line).unwrap();
    assert_eq!(line["rows"], 90);
    assert!(
        said.contains("island category") && said.contains("banded binary"),
        "{said}"
    );

    // Written and read back, the model says the same.
    let text = std::fs::read_to_string(&model).unwrap();
    let again = TableModel::from_json(&text).unwrap().to_json().unwrap();
    assert_eq!(text, again);
    assert!(output(&["show", &model]).0.contains("styles"));

    let (scores, _) = output(&["score", &model, &table]);
    assert!(scores.starts_with("row,log_probability_mass,log_density\n"));
    // Of categories and of numbers together.
    let both = |line: &str| -> f64 {
        let parts = line.split(',').skip(1);
        parts.map(|part| part.parse::<f64>().unwrap()).sum()
    };
    let scores: Vec<f64> = scores.lines().skip(1).map(both).collect();
    assert_eq!(scores.len(), 90);
    // A bird of one island with the lengths of another is less likely than any real one.
    let odd = folder.write(
        "odd.csv",
        "island,bill,flipper,banded\nBiscoe,50.5,101.5,no\n",
    );
    let (odd, _) = output(&["score", &model, &odd]);
    let odd = both(odd.lines().nth(1).unwrap());
    assert!(scores.iter().all(|s| *s > odd), "{odd} {scores:?}");

    let sampled = ["sample", &model, "-n", "20", "--given", "island=Dream"];
    let (drawn, _) = output(&sampled);
    let (header, drawn) = rows(&drawn);
    let bill = header.iter().position(|h| h == "bill").unwrap();
    assert_eq!(drawn.len(), 20);
    let near = |row: &Vec<String>| (35.0..46.0).contains(&row[bill].parse::<f64>().unwrap());
    assert!(
        drawn.iter().filter(|row| near(row)).count() >= 18,
        "{drawn:?}"
    );
    assert_eq!(output(&sampled), output(&sampled));

    // A column that a table lacks is completed like an empty cell.
    let partial = folder.write("partial.csv", "flipper,island\n101,\n61,Biscoe\n");
    let (whole, _) = output(&["complete", &model, &partial, "-n", "5"]);
    let (header, whole) = rows(&whole);
    let island = header.iter().position(|h| h == "island").unwrap();
    assert_eq!(whole.len(), 10);
    assert!(
        whole[..5].iter().all(|row| row[island] == "Torgersen"),
        "{whole:?}"
    );
}

#[test]
fn models_are_compared_on_rows_with_missing_cells() {
    let folder = Folder::new();
    let table = folder.write("birds.csv", &birds(90, true));
    let quick = ["--splits", "3", "--max-styles", "4"];
    let words = [
        &["evaluate", &table, "--models", "ours,model_2"][..],
        &quick,
    ]
    .concat();
    let (lines, said) = output(&words);
    assert_eq!(lines.lines().count(), 1 + 3 * 2);
    assert!(
        said.contains("ours: ") && said.contains("+0.000 +- 0.000 beside ours"),
        "{said}"
    );
    // The mixture integrates missing cells out as the others do.
    let words = [&["evaluate", &table, "--models", "gmm"][..], &quick].concat();
    let (lines, _) = output(&words);
    assert_eq!(lines.lines().count(), 4);
    let losses = lines.lines().skip(1).map(|l| l.rsplit(',').next().unwrap());
    assert!(
        losses
            .map(|l| l.parse::<f64>().unwrap())
            .all(f64::is_finite)
    );
}

#[test]
fn summaries_are_those_of_the_definition() {
    let s = summary(&[1.0, 2.0, 6.0], &[1.0, 1.0, 1.0]);
    // Mean 3, squares 4 + 1 + 9 = 14, over 3 * 2.
    assert_eq!((s.mean, s.difference), (3.0, 2.0));
    assert!((s.error - (14.0_f64 / 6.0).sqrt()).abs() < 1e-12);
    assert!((s.difference_error - s.error).abs() < 1e-12);
    assert!(summary(&[1.0], &[1.0]).error.is_nan());
}

#[test]
fn bad_input_is_named_and_nothing_written() {
    let folder = Folder::new();
    let free =
        "name,size\n".to_owned() + &(0..40).map(|i| format!("n{i},{i}\n")).collect::<String>();
    let free = folder.write("free.csv", &free);
    let model = folder.path("m.json");
    let said = complaint(&["learn", &free, "-o", &model]);
    assert!(
        said.contains("free text") && !Path::new(&model).exists(),
        "{said}"
    );
    assert!(complaint(&["score", &free, &free]).contains("free.csv"));

    let table = folder.write("birds.csv", &birds(60, false));
    output(&["learn", &table, "--max-styles", "3", "-o", &model]);
    let unseen = folder.write("unseen.csv", "island,bill\nMars,40\n");
    let said = complaint(&["score", &model, &unseen]);
    assert!(said.contains("Mars") && said.contains("island"), "{said}");
    assert!(complaint(&["sample", &model, "--given", "island=Mars"]).contains("none of"));
    assert!(complaint(&["sample", &model, "--given", "wings=2"]).contains("wings"));
    let words = folder.write("words.csv", "bill\nlong\n");
    assert!(complaint(&["score", &model, &words]).contains("row 1, column `bill`"));
    let text = std::fs::read_to_string(&model).unwrap();
    for cut in (0..text.len()).step_by(text.len() / 50) {
        assert!(TableModel::from_json(&text[..cut]).is_err());
    }
}

#[test]
fn networks_are_asked() {
    let asia = concat!(env!("CARGO_MANIFEST_DIR"), "/datasets/model/asia.bif");
    let posterior = |words: &[&str]| -> f64 {
        let words = [&["query", asia, "--json", "--of", "lung"][..], words].concat();
        let line: serde_json::Value = serde_json::from_str(&output(&words).0).unwrap();
        line["lung"]["probabilities"][0].as_f64().unwrap()
    };
    // Lauritzen and Spiegelhalter 1988: P(lung cancer) and after dyspnoea.
    assert!((posterior(&[]) - 0.055).abs() < 1e-9);
    let exact = posterior(&["--given", "dysp=yes", "--given", "asia=yes"]);
    assert!(exact > 0.09 && exact < 0.11, "{exact}");
    for method in ["likelihood-weighting", "loopy"] {
        let words = [
            "--given", "dysp=yes", "--given", "asia=yes", "--method", method,
        ];
        let near = posterior(&words);
        // Loopy propagation is only near.
        assert!((near - exact).abs() < 0.05, "{method}: {near} {exact}");
    }
    // `either` is deterministic.
    let stuck = ["query", asia, "--given", "dysp=yes", "--method", "gibbs"];
    assert!(complaint(&stuck).contains("`either`: has probabilities of 0"));
    let soft = posterior(&["--likely", "xray=1,0"]);
    assert!((soft - posterior(&["--given", "xray=yes"])).abs() < 1e-12);
    let (explained, _) = output(&["query", asia, "--given", "xray=yes", "--explain", "2"]);
    assert_eq!(explained.lines().count(), 2);
    assert!(complaint(&["query", asia, "--given", "xray=maybe"]).contains("none of yes, no"));
    assert!(complaint(&["query", asia, "--given", "mars=yes"]).contains("mars"));
    assert!(complaint(&["query", asia, "--likely", "xray=1"]).contains("likelihood"));
    let impossible = ["query", asia, "--given", "lung=yes", "--given", "either=no"];
    assert!(complaint(&impossible).contains("`either`"));
}
