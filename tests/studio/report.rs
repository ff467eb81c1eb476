//! `edifice studio --report`: the documents of kept pictures, as copies that are edited and saved elsewhere.

use std::path::{Path, PathBuf};
use std::process::Command;

use edifice_editing::open;
use edifice_editing::work::Work;
use edifice_experiments::{documents, shown};
use edifice_studio::Settings;
use serde_json::Value;

use crate::client::Api;
use crate::crash::Process;

fn reports() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reports")
}

fn command(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edifice"));
    command.current_dir(folder).args(["studio", "--no-open"]);
    command
}

/// Kinds and names of the documents that a name opens.
fn opened(name: &str) -> Vec<(String, String)> {
    let settings = Settings {
        copies: documents(name, &reports()).expect("documents"),
        ..Settings::default()
    };
    let all = Api::new(&settings).get("/api/documents");
    let text = |v: &Value| v.as_str().expect("text").to_owned();
    let all = all["documents"].as_array().expect("a list").clone();
    let named = all.iter().map(|d| (text(&d["kind"]), text(&d["name"])));
    named.collect()
}

#[test]
fn each_kind_of_picture_opens_in_its_editor() {
    let kinds = |name: &str| -> Vec<String> { opened(name).into_iter().map(|d| d.0).collect() };
    assert_eq!(kinds("facade_grammar/figure_16"), ["grammar"; 3]);
    assert_eq!(kinds("structure_completion/figure_15"), ["completion"; 4]);
    assert_eq!(
        opened("figure_19"),
        [("house".to_owned(), "house_0183".to_owned())]
    );
    assert_eq!(
        opened("facade_grammar/figure_15/townhouse_1"),
        [("grammar".to_owned(), "townhouse_1".to_owned())]
    );
    // The grammar that the paper prints, not one that is inferred.
    assert_eq!(kinds("figure_9/wu2014_fig9"), ["grammar"]);
}

#[test]
fn every_document_of_the_kept_report_is_one_that_an_editor_knows() {
    let all = shown(&reports());
    assert!(all.len() > 64, "{}", all.len());
    for s in all {
        // Facades are inferred anew: one of each artefact is enough, and the largest take long.
        let is_layout = s.file.ends_with(".facade.json") && s.paper == "facade_grammar";
        if is_layout && !["townhouse_1", "terrace_a"].contains(&s.name()) {
            continue;
        }
        let name = format!("{}/{}/{}", s.paper, s.artefact, s.file);
        for (file, bytes) in documents(&name, &reports()).expect("read") {
            let state = open(Path::new(&file), &bytes, &Work::default());
            assert!(state.is_ok(), "{name}: {:?}", state.err());
        }
    }
}

#[test]
fn an_edited_copy_is_saved_in_the_present_folder_and_offered_after_a_kill() {
    let folder = tempfile::tempdir().expect("a folder");
    let state = tempfile::tempdir().expect("a folder");
    let kept = reports().join("structure_completion/figure_15_c.facade.json");
    let before = std::fs::read(&kept).expect("kept");
    let mut asked = command(folder.path());
    asked.args(["--report", "structure_completion/figure_15/figure_15_c"]);
    asked.arg("--in").arg(reports());
    let studio = Process::run(asked, state.path());
    let answer = studio.edit(0, "add window@6,8,1,1.5");
    assert!(answer.starts_with("HTTP/1.1 200"), "{answer}");
    // The kill loses nothing, though no file of the document was ever in this folder.
    drop(studio);
    let again = Process::run(command(folder.path()), state.path());
    let all = again.ask("/api/documents", "");
    let at = all.find("\"unsaved\":[{").expect("an offer");
    let id = all[at..].split("\"id\":\"").nth(1).expect("an id");
    let id = id.split('"').next().expect("an id");
    let answer = again.ask(&format!("/api/unsaved/{id}/open"), "{}");
    assert!(answer.contains("window@6,8,1,1.5"), "{answer}");
    let saved = again.post("save", "{}");
    assert!(saved.starts_with("HTTP/1.1 200"), "{saved}");
    let names = std::fs::read_dir(folder.path()).expect("listed").flatten();
    let mut names: Vec<_> = names.map(|e| e.file_name()).collect();
    names.sort();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(std::fs::read(&kept).expect("kept") == before);
}

#[test]
fn a_wrong_name_is_told_the_names_that_there_are() {
    let folder = tempfile::tempdir().expect("a folder");
    let refused = |words: &[&str]| {
        let output = command(folder.path()).args(words).output().expect("runs");
        assert_eq!(output.status.code(), Some(2), "{words:?}");
        String::from_utf8(output.stderr).expect("text")
    };
    let said = refused(&["--report", "table_3"]);
    assert!(said.contains("keeps no document"), "{said}");
    assert!(said.contains("facade_grammar/figure_15"), "{said}");
    let said = refused(&["--report", "figur_16"]);
    assert!(said.contains("pictures with documents are"), "{said}");
    let said = refused(&["--report", "figure_16/ofice_1"]);
    assert!(said.contains("did you mean `office_1`"), "{said}");
    // A record may not lead out of the report.
    let report = folder.path().join("report/structure_completion");
    std::fs::create_dir_all(&report).expect("a folder");
    std::fs::write(folder.path().join("x.facade.json"), "{}").expect("written");
    let record = reports().join("structure_completion/run.json");
    let record = std::fs::read_to_string(record).expect("kept");
    let record = record.replace("figure_15_c.facade.json", "../../x.facade.json");
    std::fs::write(report.join("run.json"), record).expect("written");
    let said = refused(&[
        "--report",
        "structure_completion/figure_15",
        "--in",
        "report",
    ]);
    assert!(said.contains("keeps no document"), "{said}");
    let missing = command(folder.path())
        .args(["--report", "figure_16", "--in", "nowhere"])
        .output()
        .expect("runs");
    assert!(!missing.status.success());
    let said = String::from_utf8_lossy(&missing.stderr).into_owned();
    assert!(said.contains("nowhere"), "{said}");
}
