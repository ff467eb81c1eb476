//! `edifice facade train`, `complete` and `hide` from files to files.

use crate::support::{complaint, edifice, json, messages, output, partial, read, shipped};

#[test]
fn a_hidden_facade_is_completed_and_observed_elements_come_back() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let layout = shipped("tenement_1");
    output(
        at,
        &[
            "facade",
            "hide",
            &layout,
            "--task",
            "side50",
            "--seed",
            "3",
            "-o",
            "p.facade.json",
        ],
    );
    let words = [
        "facade",
        "complete",
        "p.facade.json",
        "--count",
        "5",
        "--seed",
        "4",
        "-o",
        "out",
        "--svg",
        "o.svg",
        "--json",
    ];
    let printed = output(at, &words);
    let about = json(printed.lines().last().expect("a line"));
    let completions = about["completions"].as_array().expect("completions");
    assert!(completions.len() >= 2 && about["seed"] == 4);
    let observed = read(&at.join("p.facade.json"))["regions"]
        .as_array()
        .expect("regions")
        .clone();
    for completion in completions {
        let file = at.join(completion["file"].as_str().expect("a file"));
        let regions = read(&file)["regions"].as_array().expect("regions").clone();
        assert_eq!(completion["elements"], regions.len());
        for (region, given) in regions.iter().zip(&observed) {
            assert_eq!(region["observed"], true);
            for key in ["label", "x", "y", "width", "height"] {
                assert_eq!(region[key], given[key]);
            }
        }
        for added in &regions[observed.len()..] {
            assert_eq!(added["observed"], false);
            assert!(added["probability"].is_number() && added["reason"].is_string());
        }
    }
    assert!(
        std::fs::read_to_string(at.join("o.svg"))
            .expect("a sheet")
            .starts_with("<svg")
    );
    let first = std::fs::read(at.join("out/completion_1.facade.json")).expect("a file");
    std::fs::remove_dir_all(at.join("out")).expect("removed");
    edifice(at, &words)
        .env("RAYON_NUM_THREADS", "1")
        .assert()
        .success();
    assert_eq!(
        std::fs::read(at.join("out/completion_1.facade.json")).expect("a file"),
        first
    );
    output(
        at,
        &[
            "facade",
            "convert",
            "out/completion_1.facade.json",
            "-o",
            "a.svg",
        ],
    );
}

#[test]
fn options_change_what_is_completed() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let half = ", \"unknown\": [ { \"x\": 125, \"y\": 0, \"width\": 115, \"height\": 220 } ]";
    partial(at, "", half);
    output(
        at,
        &["facade", "complete", "p.facade.json", "-o", "a.facade.json"],
    );
    let whole = read(&at.join("a.facade.json"));
    let added: Vec<_> = whole["regions"]
        .as_array()
        .expect("regions")
        .iter()
        .filter(|r| r["observed"] == false)
        .cloned()
        .collect();
    assert!(!added.is_empty());
    // Completed again from its own completion, one of the added ones pinned.
    let id = added[0]["id"].as_str().expect("an id");
    output(
        at,
        &[
            "facade",
            "complete",
            "a.facade.json",
            "--pin",
            id,
            "--seed",
            "9",
            "-o",
            "b.facade.json",
        ],
    );
    let again = read(&at.join("b.facade.json"));
    let pinned = again["regions"]
        .as_array()
        .expect("regions")
        .iter()
        .find(|r| r["id"] == id)
        .cloned();
    assert_eq!(pinned.expect("kept")["x"], added[0]["x"]);
    let message = complaint(
        at,
        &[
            "facade",
            "complete",
            "a.facade.json",
            "--pin",
            "nobody",
            "-o",
            "c.facade.json",
        ],
        1,
    );
    assert!(message.contains("no region has the id"), "{message}");
    let message = complaint(
        at,
        &[
            "facade",
            "complete",
            "a.facade.json",
            "--pin",
            id,
            "--forbid",
            "0,0,240,220",
            "-o",
            "c.facade.json",
        ],
        1,
    );
    assert!(message.contains("cannot stay"), "{message}");
    assert!(!at.join("c.facade.json").exists());
    output(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--forbid",
            "125,0,115,220",
            "-o",
            "d.facade.json",
        ],
    );
    assert_eq!(
        read(&at.join("d.facade.json"))["regions"]
            .as_array()
            .expect("regions")
            .len(),
        9
    );
    output(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--width",
            "400",
            "--height",
            "300",
            "-o",
            "e.facade.json",
        ],
    );
    assert_eq!(read(&at.join("e.facade.json"))["width"], 400.0);
    for method in ["low-rank", "lattice", "lattice-open", "mirror", "nearest"] {
        output(
            at,
            &[
                "facade",
                "complete",
                "p.facade.json",
                "--method",
                method,
                "-o",
                "m.facade.json",
            ],
        );
    }
}

#[test]
fn a_mask_image_says_what_is_unknown() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    partial(at, "", "");
    // The right half is white.
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 24, 22);
    encoder.set_color(png::ColorType::Grayscale);
    let pixels: Vec<u8> = (0..24 * 22)
        .map(|k| if k % 24 >= 13 { 255 } else { 0 })
        .collect();
    encoder
        .write_header()
        .and_then(|mut w| w.write_image_data(&pixels))
        .expect("encoded");
    std::fs::write(at.join("mask.png"), bytes).expect("written");
    output(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--mask",
            "mask.png",
            "-o",
            "a.facade.json",
        ],
    );
    let whole = read(&at.join("a.facade.json"));
    let unknown = whole["unknown"].as_array().expect("unknown");
    assert_eq!(unknown.len(), 1);
    assert_eq!(
        (unknown[0]["x"].as_f64(), unknown[0]["width"].as_f64()),
        (Some(130.0), Some(110.0))
    );
}

#[test]
fn a_model_is_learnt_from_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let layouts = [
        shipped("terrace_a"),
        shipped("terrace_b"),
        shipped("terrace_c"),
    ];
    let train = [
        "facade",
        "train",
        &layouts[0],
        &layouts[1],
        &layouts[2],
        "-o",
        "m.completion.json",
        "--json",
    ];
    let about = json(output(at, &train).lines().last().expect("a line"));
    assert_eq!(about["facades"], 3);
    partial(at, "", "");
    output(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--model",
            "m.completion.json",
            "-o",
            "a.facade.json",
        ],
    );
    assert!(
        messages(
            at,
            &["facade", "train", &layouts[0], "-o", "one.completion.json"]
        )
        .contains("one facade")
    );
}

/// The sketches that the report attaches to Fig. 15 give, by the printed commands, as many elements as its table says.
#[test]
fn the_edits_of_figure_15_are_commands() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    output(
        at,
        &[
            "reproduce",
            "structure_completion",
            "--only",
            "figure_15",
            "--budget",
            "smoke",
            "--out",
            "report",
        ],
    );
    let report = at.join("report/structure_completion");
    let text = std::fs::read_to_string(report.join("figure_15.md")).expect("the artefact");
    let commands: Vec<&str> = text
        .lines()
        .filter_map(|l| l.strip_prefix("edifice "))
        .collect();
    assert_eq!(commands.len(), 4);
    let counts = std::fs::read_to_string(report.join("figure_15.csv")).expect("its numbers");
    for command in commands {
        let words: Vec<&str> = command.split_whitespace().collect();
        output(&report, &words);
        let out = words.last().expect("a file");
        let whole = read(&report.join(out));
        let regions = whole["regions"].as_array().expect("regions");
        for class in ["window", "door", "balcony", "shop"] {
            let found = regions.iter().filter(|r| r["label"] == class).count();
            let row = format!("{}/{class},", &out[..1]);
            let line = counts.lines().find(|l| l.contains(&row)).expect("a row");
            let value: f64 = line
                .split(',')
                .nth(6)
                .expect("a value")
                .parse()
                .expect("a number");
            assert_eq!(value, found as f64, "{line}");
        }
    }
}
