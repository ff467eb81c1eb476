//! `edifice building` on bad input: the message names variable and row; where an answer is
//! possible, it comes with a warning.

use std::path::Path;

use assert_cmd::Command;

/// Runs a command in `folder`; exit code and messages.
fn run(folder: &Path, args: &[&str]) -> (i32, String) {
    let mut command = Command::cargo_bin("edifice").unwrap();
    let output = command
        .arg("building")
        .args(args)
        .current_dir(folder)
        .output()
        .unwrap();
    let messages = String::from_utf8(output.stderr).unwrap();
    assert!(!messages.contains("panicked"), "{messages}");
    (output.status.code().unwrap(), messages)
}

/// Widths, heights and roofs of some houses; a schema for them; a model learned from them.
fn learned() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "s.schema.json",
        r#"{"format":"edifice/attributes","version":1,"groups":[
            {"name":"size","kind":"continuous","columns":["w"]},
            {"name":"high","kind":"continuous","columns":["h"]},
            {"name":"roof","kind":"category","columns":["roof"]}]}"#,
    );
    let rows = (0..40).map(|i| {
        let w = 8.0 + f64::from(i % 7) + 3.0 * f64::from(i % 2);
        let roof = if i % 2 == 0 { "flat" } else { "hip" };
        format!("{w},{},{roof}\n", 0.5 * w + 0.1 * f64::from(i % 3))
    });
    write(
        "good.csv",
        &format!("w,h,roof\n{}", rows.collect::<String>()),
    );
    let (code, messages) = learn(folder.path(), "good.csv");
    assert_eq!(code, 0, "{messages}");
    folder
}

fn learn(folder: &Path, table: &str) -> (i32, String) {
    let args = [
        "learn",
        table,
        "--schema",
        "s.schema.json",
        "-o",
        "m.houses.json",
        "--max-styles",
        "2",
    ];
    run(folder, &args)
}

/// Learns from this table; the messages, and whether it went well.
fn learn_from(rows: &str) -> (i32, String) {
    let folder = learned();
    std::fs::write(folder.path().join("t.csv"), format!("w,h,roof\n{rows}")).unwrap();
    learn(folder.path(), "t.csv")
}

/// Completes these rows with the learned model.
fn complete(folder: &Path, rows: &str) -> (i32, String) {
    std::fs::write(folder.join("t.csv"), format!("w,h,roof\n{rows}")).unwrap();
    let args = [
        "complete",
        "m.houses.json",
        "t.csv",
        "--schema",
        "s.schema.json",
        "-n",
        "1",
    ];
    run(folder, &args)
}

fn refused((code, messages): (i32, String), parts: &[&str]) {
    assert_eq!(code, 1, "{messages}");
    for part in parts {
        assert!(messages.contains(part), "{part:?} in {messages}");
    }
}

#[test]
fn a_constant_column_and_few_rows_are_warned_of() {
    let (code, messages) = learn_from("3,1,flat\n3,2,hip\n");
    assert_eq!(code, 0, "{messages}");
    assert!(
        messages.contains("warning: column `w` is constant"),
        "{messages}"
    );
    assert!(!messages.contains("`h` is constant"), "{messages}");
    assert!(messages.contains("warning: 2 rows for"), "{messages}");
}

#[test]
fn a_column_without_values_is_refused() {
    refused(
        learn_from(",1,flat\n,2,hip\n"),
        &["`w` has no observed value"],
    );
}

#[test]
fn a_value_that_is_not_finite_is_refused() {
    for text in ["nan", "inf", "-1e999"] {
        let table = format!("3,1,flat\n4,{text},hip\n");
        refused(learn_from(&table), &["row 2", "column `h`", text]);
    }
}

#[test]
fn an_unseen_category_is_refused() {
    let folder = learned();
    refused(
        complete(folder.path(), "9,5,flat\n9,5,dome\n"),
        &["`roof`", "row 2", "`dome`"],
    );
}

#[test]
fn evidence_of_probability_zero_is_refused() {
    let folder = learned();
    refused(
        complete(folder.path(), "9,5,flat\n9,1e200,flat\n"),
        &["row 2", "probability zero", "`h`"],
    );
    let args = ["sample", "m.houses.json", "--given", "w=1e200"];
    refused(run(folder.path(), &args), &["probability zero", "`w`"]);
}

#[test]
fn cyclic_and_corrupt_models_are_refused() {
    let folder = learned();
    let path = folder.path().join("m.houses.json");
    let text = std::fs::read_to_string(&path).unwrap();
    let show = |text: &str| {
        std::fs::write(folder.path().join("x.houses.json"), text).unwrap();
        run(folder.path(), &["show", "x.houses.json"])
    };
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    model["model"]["structure"]["parents"] = serde_json::json!([[1], [0]]);
    refused(show(&model.to_string()), &["cyclic", "`size`"]);
    let mut model: serde_json::Value = serde_json::from_str(&text).unwrap();
    model["model"]["style"] = serde_json::json!([0.5, 0.7]);
    refused(show(&model.to_string()), &["corrupt model", "style"]);
    refused(show(&text[..text.len() / 2]), &["corrupt model"]);
    refused(show(""), &["corrupt model"]);
}
