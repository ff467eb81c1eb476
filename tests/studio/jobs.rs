//! Long work: it tells how far it is, every tab sees it, it can be stopped, and then nothing was changed and nothing is computed any
//! more.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use edifice::io::{city, facade_json};
use edifice::methods::city_proceduralization::decompose;
use edifice::methods::facade_grammar::{self, infer};
use edifice::shape::Facade;
use edifice::{Ended, Progress, unwatched};
use edifice_editing::examples::example;
use edifice_editing::open;
use edifice_editing::work::{Told, Work};
use edifice_studio::Settings;
use serde_json::{Value, json};

use crate::client::Api;

/// A facade whose grammar takes long.
fn chequered(unit: &Value) -> Value {
    let mut regions = Vec::new();
    for row in 0..14 {
        for column in 0..17 {
            let label = ["wall", "window", "door", "balcony"]
                [(row * row + 3 * column * column + row * column) % 4];
            regions.push(json!({"label": label, "x": column, "y": row, "width": 1, "height": 1}));
        }
    }
    json!({
        "format": "edifice/facade", "version": 1, "name": "chequered", "unit": unit, "width": 17, "height": 14, "regions": regions,
    })
}

/// A studio with the facade of Fig. 9, and its joint grammar with another one.
fn long() -> (Api, Value) {
    let api = Api::new(&Settings::default());
    api.post("/api/documents", json!({"example": "fig9"}));
    let unit = &api.get("/api/documents/d1")["view"]["unit"];
    let facade = chequered(unit).to_string();
    (api, json!([{"do": "merge", "facades": [facade]}]))
}

/// The last progress of work that was stopped as soon as it told any.
fn stopped_at_once(method: impl FnOnce(&Work) + Send + 'static) -> Told {
    let work = Work::default();
    let own = work.clone();
    let thread = std::thread::spawn(move || method(&own));
    while work.told().step.is_empty() {
        std::thread::sleep(Duration::from_millis(1));
    }
    work.stop();
    thread.join().expect("no panic");
    work.told()
}

#[test]
fn an_inference_that_is_stopped_leaves_its_bound() {
    // The Lagrangian bound comes before the first step that is told of, which has a part of the whole.
    let opened = stopped_at_once(|work| {
        let text = chequered(&json!("m")).to_string();
        let path = Path::new("chequered.facade.json");
        assert!(open(path, text.as_bytes(), work).is_err());
    });
    let joint = stopped_at_once(|work| {
        let grammar = example("fig9", &Work::default()).expect("ships");
        let unit = grammar.view().expect("a view")["unit"].clone();
        let command = json!({"do": "merge", "facades": [chequered(&unit).to_string()]});
        assert!(grammar.apply(&command, work).is_err());
    });
    assert_eq!((opened.part, joint.part), (None, None));
}

#[test]
fn a_stopped_inference_takes_no_further_step() {
    let path = Path::new("chequered.facade.json");
    let read = |name: &str| {
        let mut facade = chequered(&json!("m"));
        facade["name"] = name.into();
        facade_json::parse(facade.to_string().as_bytes(), path).expect("a facade")
    };
    let [one, two] = [read("one"), read("two")];
    // The end of one that is stopped when its watch is asked so often, how often that was, and how many steps were told of.
    let run = |most: usize, facades: &[Facade]| {
        let settings = facade_grammar::Settings {
            iterations: 2_500,
            ..Default::default()
        };
        let (asked, told) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = Work::default();
        let watch = |progress: Progress| {
            told.fetch_add(usize::from(progress.cost.is_some()), Ordering::Relaxed);
            if asked.fetch_add(1, Ordering::Relaxed) + 1 == most {
                work.stop();
            }
            work.go_on()
        };
        let done = infer(facades, &settings, &watch).expect("a grammar");
        (done.ended, asked.into_inner(), told.into_inner())
    };
    let (ended, whole, steps) = run(usize::MAX, std::slice::from_ref(&one));
    assert!(
        ended == Ended::Finished && whole > 20 && steps > 0,
        "{whole} {steps}"
    );
    let stopped = Ended::Interrupted;
    assert_eq!(run(5, std::slice::from_ref(&one)), (stopped, 5, 0));
    // Of several facades first the bound of each, then the joint one.
    let own = whole + 5;
    assert_eq!(run(own, &[one, two]), (stopped, own, 0));
}

#[test]
fn a_stopped_city_is_not_cut_any_further() {
    let town = example("town", &Work::default()).expect("ships");
    let bytes = town.export("obj").expect("a city");
    let city = city::obj::parse(&bytes, Path::new("town.obj")).expect("a city");
    let (begun, work) = (AtomicUsize::new(0), Work::default());
    let count = city.buildings.len();
    assert!(count > 5);
    let cut = decompose(&city, true, &|_: Progress| {
        if begun.fetch_add(1, Ordering::SeqCst) == 2 {
            work.stop();
        }
        work.go_on()
    });
    assert_eq!(cut.ended, Ended::Interrupted);
    // Each thread may have asked once more.
    let most = 3 + rayon::current_num_threads();
    assert!(begun.into_inner() <= most.min(count - 1));
    let whole = decompose(&city, true, &unwatched);
    assert_eq!((whole.ended, whole.faults.len()), (Ended::Finished, count));
    assert!(cut.components.len() < whole.components.len());
}

#[test]
fn long_work_is_told_of_and_stopped() {
    let (api, commands) = long();
    let before = api.get("/api/documents/d1");
    let start = Instant::now();
    let body = json!({"commands": commands, "revision": before["revision"]});
    let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
    assert_eq!(status, 202, "{answer}");
    assert!(start.elapsed() < Duration::from_secs(5));
    let job = &answer["job"];
    assert_eq!(
        (&job["state"], &job["document"]),
        (&json!("running"), &json!("d1"))
    );
    // Another tab sees it, in the list and in the document.
    let listed = api.get("/api/documents")["documents"][0]["job"].clone();
    assert_eq!(listed["id"], job["id"]);
    assert!(
        listed["step"].as_str().is_some_and(|s| !s.is_empty()),
        "{listed}"
    );
    // Meanwhile nothing else is done on the document; it can be read and saved.
    assert_eq!(api.send("POST", "/api/documents/d1/edit", &body).0, 409);
    assert_eq!(
        api.send("POST", "/api/documents/d1/undo", &json!({})).0,
        409
    );
    assert_eq!(api.get("/api/documents/d1")["view"], before["view"]);
    let path = format!("/api/jobs/{}/stop", job["id"].as_str().expect("an id"));
    let stopped = api.post(&path, json!({}))["job"].clone();
    assert_eq!(stopped["state"], "stopped", "{stopped}");
    // At once there is room for other work, and nothing was changed, then or later.
    let after = api.edit("d1", json!([{"do": "derive", "size": [100.0, 60.0]}]));
    assert_eq!(after["revision"], 1);
    std::thread::sleep(Duration::from_millis(1500));
    assert_eq!(api.get("/api/documents/d1"), after);
    assert_eq!(
        api.get(path.trim_end_matches("/stop"))["job"]["state"],
        "stopped"
    );
    assert_eq!(api.send("GET", "/api/jobs/j99", &Value::Null).0, 404);
}

#[test]
fn work_that_fails_says_why() {
    let api = Api::new(&Settings::default());
    api.post("/api/documents", json!({"example": "fig9"}));
    let body = json!({"commands": [{"do": "merge", "facades": ["{}"]}], "revision": 0});
    let (status, answer) = api.send("POST", "/api/documents/d1/edit", &body);
    assert_eq!(status, 422);
    assert!(
        answer["error"]
            .as_str()
            .is_some_and(|e| e.contains("facade 1")),
        "{answer}"
    );
    // There is room for other work at once.
    api.edit("d1", json!([{"do": "derive", "size": [100.0, 60.0]}]));
}

#[test]
fn a_day_without_requests_changes_nothing() {
    let api = Api::new(&Settings::default());
    api.post("/api/documents", json!({"example": "sketch"}));
    let made = api.edit(
        "d1",
        json!([{"do": "edit", "edits": ["add window@1,2,1,1.5"]}]),
    );
    // The server's clock goes on by a day: all its timers would have run out.
    api.runtime().block_on(async {
        tokio::time::pause();
        tokio::time::advance(Duration::from_secs(24 * 3600)).await;
        tokio::time::resume();
    });
    assert_eq!(api.get("/api/documents/d1"), made);
    let again = api.edit("d1", json!([{"do": "edit", "edits": ["add door@5,0,1,2"]}]));
    assert_eq!(again["log"].as_array().map(Vec::len), Some(2));
    assert_eq!(
        api.post("/api/documents/d1/undo", json!({}))["view"],
        made["view"]
    );
}
