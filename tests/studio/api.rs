//! The API by calling its router, without a socket.

use edifice_studio::Settings;
use serde_json::{Value, json};

use crate::client::Api;

fn api() -> Api {
    Api::new(&Settings::default())
}

#[test]
fn every_example_opens_and_lists() {
    let api = api();
    let listing = api.get("/api/documents");
    assert_eq!(listing["documents"], json!([]));
    let examples = listing["examples"].as_array().expect("a list").clone();
    assert!(examples.len() >= 4);
    for (k, example) in examples.iter().enumerate() {
        let opened = api.post("/api/documents", json!({"example": example["id"]}));
        assert_eq!(opened["id"], format!("d{}", k + 1));
        assert_eq!(opened["kind"], example["kind"]);
        assert_eq!(
            (&opened["revision"], &opened["undo"]),
            (&json!(0), &json!(false))
        );
    }
    let all = api.get("/api/documents")["documents"]
        .as_array()
        .expect("a list")
        .len();
    assert_eq!(all, examples.len());
}

#[test]
fn edits_are_undone_and_done_again() {
    let api = api();
    let first = api.post("/api/documents", json!({"example": "sketch"}));
    let made = api.edit(
        "d1",
        json!([{"do": "edit", "edits": ["add window@1,2,1,1.5"]}]),
    );
    assert_eq!(made["view"]["elements"][0]["label"], "window");
    assert_eq!(made["log"][0]["said"], "add window@1,2,1,1.5");
    let undone = api.post("/api/documents/d1/undo", json!({}));
    assert_eq!(undone["view"], first["view"]);
    assert_eq!(
        (&undone["redo"], &undone["log"][0]["done"]),
        (&json!(true), &json!(false))
    );
    let again = api.post("/api/documents/d1/redo", json!({}));
    assert_eq!(again["view"], made["view"]);
    // Neither beyond the first nor beyond the last.
    assert_eq!(
        api.post("/api/documents/d1/redo", json!({}))["view"],
        made["view"]
    );
    // A new edit forgets what was undone.
    api.post("/api/documents/d1/undo", json!({}));
    let other = api.edit("d1", json!([{"do": "edit", "edits": ["add door@5,0,1,2"]}]));
    assert_eq!(other["log"].as_array().map(Vec::len), Some(1));
}

#[test]
fn what_cannot_be_done_changes_nothing() {
    let api = api();
    let first = api.post("/api/documents", json!({"example": "four"}));
    for commands in [
        json!([]),
        json!([{"do": "fly"}]),
        json!([{"do": "edit", "edits": []}]),
        json!([{"do": "edit", "edits": ["move nobody=1,1"]}]),
        json!([{"do": "edit", "edits": ["add window@1,2,1,1"]}, {"do": "choose", "answer": 3}]),
        json!([{"do": "complete", "count": 0}]),
        json!([{"do": "complete", "count": 1, "method": "magic"}]),
        json!([{"do": "complete", "count": 1, "forbid": [[0, 0, -1, 1]]}]),
    ] {
        let body = json!({"commands": commands, "revision": 0});
        let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
        assert_eq!(status, 422, "{commands}: {answer}");
        assert!(answer["error"].as_str().is_some_and(|e| !e.is_empty()));
    }
    assert_eq!(api.get("/api/documents/d1"), first);
    let stale = json!({"commands": [{"do": "edit", "edits": ["remove w1"]}], "revision": 5});
    assert_eq!(api.send("POST", "/api/documents/d1/edit", &stale).0, 409);
    assert_eq!(api.send("GET", "/api/documents/d7", &Value::Null).0, 404);
    assert_eq!(
        api.send("GET", "/api/documents/d1/export/exe", &Value::Null)
            .0,
        422
    );
}

#[test]
fn names_and_labels_stay_text() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder
        .path()
        .join("<img src=x onerror=alert(1)>.facade.json");
    let label = "window<script>alert(1)</script>";
    let text = format!(
        r#"{{ "format": "edifice/facade", "version": 1, "name": "</script>", "unit": "m", "width": 4, "height": 4,
            "regions": [ {{ "label": "{label}", "x": 0, "y": 0, "width": 1, "height": 1 }} ] }}"#
    );
    std::fs::write(&path, text).expect("written");
    let api = Api::new(&Settings {
        files: vec![path],
        ..Settings::default()
    });
    let document = api.get("/api/documents/d1");
    // As JSON strings, under a type that no browser reads as a page; the page makes text nodes of them.
    assert_eq!(document["view"]["elements"][0]["label"], label);
    let source =
        std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/studio/src")).expect("there");
    for file in source {
        let text = std::fs::read_to_string(file.expect("listed").path()).expect("text");
        for word in [
            "innerHTML",
            "outerHTML",
            "insertAdjacentHTML",
            "document.write",
            "eval(",
        ] {
            assert!(!text.contains(word), "{word}");
        }
    }
}

#[test]
fn a_rule_is_edited_and_all_its_regions_follow() {
    let api = api();
    let before = api.post("/api/documents", json!({"example": "fig9"}));
    let rules = before["view"]["rules"].as_array().expect("rules");
    // A rule that stands for several regions, with a border to move.
    let inner = before["view"]["nonTerminals"].as_array().expect("regions");
    let count = |r: usize| inner.iter().filter(|n| n[0] == json!(r)).count();
    let (rule, _) = rules
        .iter()
        .enumerate()
        .filter(|(_, r)| {
            r["operation"] == "split" && r["parts"].as_array().is_some_and(|p| p.len() > 1)
        })
        .max_by_key(|(k, _)| count(*k))
        .expect("a split");
    assert!(count(rule) > 1);
    let size = |part: usize| rules[rule]["parts"][part]["size"].as_f64().expect("a size");
    let edit = format!("border {rule}.0={}", size(0).min(size(1)) / 4.0);
    let after = api.edit("d1", json!([{"do": "edit", "edits": [edit]}]));
    assert_eq!(after["view"]["cost"], before["view"]["cost"]);
    let parts = |view: &Value| -> Vec<f64> {
        let own = view["view"]["terminals"]
            .as_array()
            .expect("terminals")
            .iter();
        let own = own.filter(|t| t[5] == json!([rule, 1]));
        own.map(|t| {
            t[3].as_f64()
                .unwrap_or(0.0)
                .min(t[4].as_f64().unwrap_or(0.0))
        })
        .collect()
    };
    let (old, new) = (parts(&before), parts(&after));
    assert_eq!(old.len(), new.len());
    assert!(
        new.windows(2).all(|w| (w[0] - w[1]).abs() < 1e-6),
        "{new:?}"
    );
    let larger = api.edit("d1", json!([{"do": "derive", "size": [200.0, 100.0]}]));
    assert_eq!(larger["view"]["width"], 200.0);
}
