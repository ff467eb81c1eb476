//! Cities of the size of a district and of an island, and what is asked of them.

use std::io::Read;
use std::path::Path;
use std::time::Instant;

use edifice::grammar::instance::InstanceGrammar;
use edifice::io::city::{grammar_json, obj};
use edifice::methods::city_proceduralization::synthesis::Shape;
use edifice::unwatched;
use edifice_datasets::shipped_bytes;
use edifice_editing::city_proceduralization::fill;
use edifice_studio::Settings;
use serde_json::{Value, json};

use crate::client::Api;

const TOWN: &str = "city_proceduralization/town.city-grammar.json";

/// A made city of at least `least` buildings: copies of the shipped town in rows.
fn made(least: usize) -> InstanceGrammar {
    let path = Path::new(TOWN);
    let mut grammar =
        grammar_json::parse(shipped_bytes(TOWN).expect("ships"), path).expect("reads");
    let start = grammar
        .rules
        .iter()
        .position(|r| r.symbol == grammar.axiom)
        .expect("a start");
    let derivation = grammar.derive().expect("derives");
    let own = grammar.rules[start].successors.clone();
    let reach = derivation
        .instances
        .iter()
        .map(|i| i.at[0].abs().max(i.at[1].abs()));
    let side = 2.0 * reach.fold(0.0, f64::max) + 60.0;
    let copies = least.div_ceil(derivation.buildings.len());
    let across = (copies as f64).sqrt().ceil() as usize;
    let mut successors = Vec::new();
    for k in 0..copies {
        let shift = [(k % across) as f64 * side, (k / across) as f64 * side];
        for placed in &own {
            let mut copy = placed.clone();
            copy.at = [copy.at[0] + shift[0], copy.at[1] + shift[1], copy.at[2]];
            number(&mut copy, k);
            successors.push(copy);
        }
    }
    grammar.rules[start].successors = successors;
    grammar.name = format!("made_{least}");
    grammar
}

/// Other identifiers for the buildings of a copy.
fn number(placed: &mut edifice::grammar::instance::Placement, copy: usize) {
    if let Some(id) = &mut placed.id {
        id.push_str(&format!("_{copy}"));
    }
    for part in placed.parts.iter_mut().flatten() {
        number(part, copy);
    }
}

/// Opens a city; the seconds from the start to its whole answer, the bytes sent, its buildings.
fn opened(path: &Path) -> (f64, usize, usize) {
    let start = Instant::now();
    let api = Api::new(&Settings {
        files: vec![path.to_path_buf()],
        ..Settings::default()
    });
    let document = api.get("/api/documents/d1");
    let seconds = start.elapsed().as_secs_f64();
    let buildings = document["view"]["buildings"].as_array().map_or(0, Vec::len);
    (seconds, document.to_string().len(), buildings)
}

#[test]
fn a_city_of_five_thousand_buildings_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("made.city-grammar.json");
    grammar_json::write(&made(5000), &path).expect("written");
    let (seconds, bytes, buildings) = opened(&path);
    println!(
        "{buildings} buildings: {seconds:.2} s, {:.2} MB",
        bytes as f64 / 1e6
    );
    assert!(buildings >= 5000);
    assert!(seconds <= 3.0, "{seconds} s");
    assert!(bytes <= 5_000_000, "{bytes} bytes");
}

#[test]
fn a_city_of_twelve_thousand_buildings_opens_in_three_seconds() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("made.city-grammar.json.gz");
    grammar_json::write(&made(12_000), &path).expect("written");
    let (seconds, bytes, buildings) = opened(&path);
    println!(
        "{buildings} buildings: {seconds:.2} s, {:.2} MB",
        bytes as f64 / 1e6
    );
    assert!(buildings >= 12_000);
    assert!(seconds <= 3.0, "{seconds} s");
}

#[test]
fn a_city_of_an_island_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("made.city-grammar.json.gz");
    grammar_json::write(&made(47_815), &path).expect("written");
    let (seconds, bytes, buildings) = opened(&path);
    println!(
        "{buildings} buildings: {seconds:.2} s, {:.2} MB",
        bytes as f64 / 1e6
    );
    assert!(buildings >= 47_815);
}

/// `STUDIO_CITY=FILE cargo test --release --test studio a_city_of_a_file -- --ignored --nocapture`
#[test]
#[ignore = "needs a city"]
fn a_city_of_a_file_opens() {
    let path = std::env::var("STUDIO_CITY").expect("STUDIO_CITY names a file");
    let (seconds, bytes, buildings) = opened(Path::new(&path));
    println!(
        "{path}: {buildings} buildings: {seconds:.2} s, {:.2} MB",
        bytes as f64 / 1e6
    );
}

/// The town as triangles in a file.
fn triangles(folder: &Path) -> std::path::PathBuf {
    let path = Path::new(TOWN);
    let grammar = grammar_json::parse(shipped_bytes(TOWN).expect("ships"), path).expect("reads");
    let corners = vec![[0.0, 0.0], [260.0, 0.0], [260.0, 200.0], [0.0, 200.0]];
    let shape = Shape {
        rings: vec![corners],
    };
    let (grammar, derivation) = fill(&grammar, shape, 1, &unwatched).expect("filled");
    let place = folder.join("town.obj");
    std::fs::write(&place, obj::to_string(&derivation.city(&grammar))).expect("written");
    place
}

#[test]
fn a_city_of_triangles_is_made_a_grammar_of_at_a_level() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = triangles(folder.path());
    let api = Api::new(&Settings {
        files: vec![path],
        ..Settings::default()
    });
    let raw = api.get("/api/documents/d1");
    let count = raw["view"]["original"]["buildings"]
        .as_u64()
        .expect("buildings");
    assert!(count > 5 && raw["view"]["level"].is_null());
    // Without a grammar there is nothing to edit or to save, and that is said.
    let edit = json!({"commands": [{"do": "edit", "edits": ["weight 0=1"]}], "revision": 0});
    let (status, answer) = api.send("POST", "/api/documents/d1/edit", &edit);
    assert!(
        status == 422 && answer.to_string().contains("level"),
        "{answer}"
    );
    let (status, answer) = api.send("POST", "/api/documents/d1/save", &json!({}));
    assert!(
        status == 422 && answer.to_string().contains("level"),
        "{answer}"
    );
    let templates = |level: u32| {
        let made = api.edit("d1", json!([{"do": "proceduralize", "level": level}]));
        assert_eq!(
            made["view"]["buildings"].as_array().map(Vec::len),
            Some(count as usize)
        );
        assert_eq!(made["view"]["level"], level);
        let errors = made["view"]["errors"].as_array().expect("errors").clone();
        assert_eq!(errors.len(), count as usize);
        made["view"]["templates"].as_array().map_or(0, Vec::len)
    };
    let (fine, coarse) = (templates(0), templates(4));
    assert!(fine > coarse && coarse >= 1, "{fine} {coarse}");
    let (status, _) = api.send("GET", "/api/documents/d1/export/original", &Value::Null);
    assert_eq!(status, 200);
    // The script begins with the city beside it, and gives the same bytes as saving.
    let saved = api.post("/api/documents/d1/save", json!({}));
    let script = folder
        .path()
        .join(saved["script"].as_str().expect("a name"));
    let again = folder.path().join("again.city-grammar.json");
    let done = std::process::Command::new("sh")
        .arg(&script)
        .arg(&again)
        .env("EDIFICE", env!("CARGO_BIN_EXE_edifice"))
        .output()
        .expect("sh runs");
    assert!(
        done.status.success(),
        "{}",
        String::from_utf8_lossy(&done.stderr)
    );
    let own = folder.path().join(saved["file"].as_str().expect("a name"));
    assert!(std::fs::read(own).expect("there") == std::fs::read(again).expect("there"));
}

#[test]
fn a_building_knows_its_rules_and_is_found_again() {
    let api = Api::new(&Settings::default());
    let town = api.post("/api/documents", json!({"example": "town"}));
    let ids = town["view"]["buildings"].as_array().expect("buildings");
    let path = "/api/documents/d1/ask";
    for (k, id) in ids.iter().enumerate() {
        let known = api.post(path, json!({"ask": "building", "building": k}));
        assert_eq!(&known["id"], id);
        assert!(known["path"].as_array().is_some_and(|p| !p.is_empty()));
        let siblings = known["siblings"].as_array().expect("siblings");
        assert!(siblings.contains(&json!(k)));
    }
    let picked: Vec<usize> = (0..ids.len().min(4)).collect();
    let found = api.post(path, json!({"ask": "locate", "buildings": picked}));
    assert!(
        found["places"].as_array().is_some_and(|p| !p.is_empty()),
        "{found}"
    );
    assert_eq!(api.get("/api/documents/d1"), town);
    for question in [
        json!({"ask": "age"}),
        json!({"ask": "building", "building": 100_000}),
        json!({"ask": "locate", "buildings": []}),
    ] {
        let (status, answer) = api.send("POST", path, &question);
        assert_eq!(status, 422, "{question}: {answer}");
    }
}

/// An edit of a city that a page shows is told by what changed.
#[test]
fn an_edit_is_told_by_its_difference() {
    let api = Api::new(&Settings::default());
    let opened = api.post("/api/documents", json!({"example": "town"}));
    let id = opened["id"].as_str().expect("an id");
    let rule = &opened["view"]["rules"][0]["rule"];
    let edit = |command: String, revision: u64, shows: Value| {
        let body = json!({"commands": [{"do": "edit", "edits": [command]}], "revision": revision, "shows": shows});
        api.post(&format!("/api/documents/{id}/edit"), body)
    };
    let told = edit(format!("weight {rule}=3"), 0, 0.into());
    assert!(told["view"].is_null(), "the difference stands in its place");
    let (short, long) = (told["difference"].to_string(), opened["view"].to_string());
    assert!(
        5 * short.len() < long.len(),
        "{} of {} bytes",
        short.len(),
        long.len()
    );
    // Who shows another revision, or none, is told the whole.
    for shows in [Value::Null, 0.into(), 7.into()] {
        let revision = api.get(&format!("/api/documents/{id}"))["revision"].as_u64();
        let told = edit(
            format!("weight {rule}=5"),
            revision.expect("a number"),
            shows,
        );
        assert!(told["view"].is_object() && told["difference"].is_null());
    }
}

/// An edit of a city of the size of an island, as the browser gets it: every instance of a template changes, some twice so that
/// their numbers are rounded, and the step back.
#[test]
fn an_edit_of_an_island_is_short() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("made.city-grammar.json.gz");
    grammar_json::write(&made(47_815), &path).expect("written");
    let api = Api::new(&Settings {
        files: vec![path],
        ..Settings::default()
    });
    let opened = api.get("/api/documents/d1");
    let symbol = opened["view"]["templates"][0]["symbol"].as_str();
    let symbol = symbol.expect("a name").to_owned();
    let instances = opened["view"]["instances"].as_array().expect("instances");
    let own = instances.iter().filter(|i| i[0] == 0).count();
    assert!(own > 5000, "{own}");
    let mut shown = 0;
    let told = |way: &str, body: Value| {
        let mut path = format!("/api/documents/d1/{way}");
        let (mut status, mut bytes) = api.bytes("POST", &path, &body, "gzip");
        if status == 202 {
            let job: Value = serde_json::from_slice(&bytes).expect("JSON");
            assert_eq!(api.ended(&job["job"])["state"], "done");
            path = format!("/api/documents/d1?shows={}", body["shows"]);
            (status, bytes) = api.bytes("GET", &path, &Value::Null, "gzip");
        }
        assert_eq!(status, 200);
        assert!(bytes.len() <= 100_000, "{way}: {} bytes", bytes.len());
        println!("{way}: {} bytes", bytes.len());
        let mut text = String::new();
        let long = bytes.starts_with(&[0x1f, 0x8b]);
        let read: Value = match long {
            true => {
                flate2::read::GzDecoder::new(&bytes[..])
                    .read_to_string(&mut text)
                    .expect("gzip");
                serde_json::from_str(&text).expect("JSON")
            }
            false => serde_json::from_slice(&bytes).expect("JSON"),
        };
        assert!(read["view"].is_null());
        read["revision"].as_u64().expect("a number")
    };
    for factors in ["1.1,1.2,0.9", "1.07,0.93,1.3"] {
        let edit = format!("scale {symbol}={factors}");
        let body = json!({"commands": [{"do": "edit", "edits": [edit]}], "revision": shown, "shows": shown});
        shown = told("edit", body);
    }
    told("undo", json!({"shows": shown}));
}
