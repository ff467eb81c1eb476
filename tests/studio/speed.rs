//! Seconds of edits on the server: `cargo test --release --test studio speed -- --ignored --nocapture`.

use std::time::Instant;

use edifice::rng::stream;
use edifice_editing::examples::example;
use edifice_editing::history::Document;
use edifice_editing::work::Work;
use rand::RngExt;
use serde_json::{Value, json};

const EDITS: usize = 200;

/// Does the edits, with the view of each; the 95th percentile and the median in milliseconds.
fn measured(id: &str, mut command: impl FnMut(&Document, usize) -> Value) -> [f64; 2] {
    let mut document = Document::new(example(id, &Work::default()).expect("ships"));
    let mut times = Vec::new();
    let mut refused = 0;
    // The first reads models and data, once for a server.
    for k in 0..=EDITS {
        let commands = command(&document, k).as_array().expect("a list").clone();
        let start = Instant::now();
        let done = document.edit(&commands);
        let text = document.state().view().expect("a view").to_string();
        let time = start.elapsed().as_secs_f64() * 1e3;
        assert!(!text.is_empty());
        match done {
            Ok(()) if k > 0 => times.push(time),
            Ok(()) => {}
            Err(_) => refused += 1,
        }
    }
    times.sort_by(f64::total_cmp);
    let at = |q: f64| times[((times.len() - 1) as f64 * q) as usize];
    println!(
        "{id}: {} edits, {refused} refused, median {:.1} ms, p95 {:.1} ms",
        times.len(),
        at(0.5),
        at(0.95)
    );
    [at(0.95), at(0.5)]
}

#[test]
#[ignore = "a measurement"]
fn speed_of_edits() {
    let mut rng = stream(1, "studio/speed", 0);
    let completion = measured("four", |_, k| {
        let x = 5.5 + 6.0 * rng.random::<f64>();
        json!([{"do": "edit", "edits": [format!("move d1={x:.2},0")]}, {"do": "complete", "count": 3, "seed": k}])
    });
    let mut rng = stream(1, "studio/speed", 1);
    let house = measured("house", |_, k| {
        let height = 2.6 + 0.5 * rng.random::<f64>();
        json!([{"do": "edit", "edits": [format!("resize 0=13.78,6.137,{height:.2}")], "seed": k}])
    });
    let mut rng = stream(1, "studio/speed", 3);
    let suggested = measured("house", |document, k| {
        if k == 0 {
            return json!([{"do": "edit", "edits": ["add garage@15.58,3,3.6,6,2.6"]}]);
        }
        // The garage goes a little up and down, and the model suggests the house around it.
        let view = document.state().view().expect("a view");
        let mut boxes = view["boxes"].as_array().expect("boxes").iter();
        let garage = boxes.position(|b| b["style"] == "garage");
        let garage = garage.expect("it stays");
        let x = &view["boxes"][garage]["x"];
        let y = 3.0 + 2.0 * rng.random::<f64>();
        let edit = format!("move {garage}={x},{y:.2}");
        json!([{"do": "edit", "edits": [edit], "suggest": true, "seed": k}])
    });
    let mut rng = stream(1, "studio/speed", 2);
    let grammar = measured("boulevard", |document, k| {
        let view = document.state().view().expect("a view");
        if k == 0 {
            // So large that there are more than 1,100 terminals.
            let size = |side: &str| 6.0 * view[side].as_f64().unwrap_or(0.0);
            return json!([{"do": "derive", "size": [size("width"), size("height")]}]);
        }
        if k == EDITS {
            println!(
                "boulevard: {} terminals",
                view["terminals"].as_array().map_or(0, Vec::len)
            );
        }
        let rules = view["rules"].as_array().expect("rules");
        let split = rules.iter().position(|r| r["operation"] == "split");
        let split = split.expect("a split");
        let size = rules[split]["parts"][0]["size"].as_f64().unwrap_or(1.0);
        let shift = size * (0.2 * rng.random::<f64>() - 0.1);
        json!([{"do": "edit", "edits": [format!("border {split}.0={shift:.4}")]}])
    });
    for [p95, median] in [completion, house, suggested, grammar] {
        assert!(median <= p95);
    }
}
