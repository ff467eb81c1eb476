//! Structure completion by commands: bad input is told, and nothing is written.

use crate::support::{complaint, messages, partial, read};

#[test]
fn bad_input_is_told_and_nothing_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    let complete = ["facade", "complete", "p.facade.json", "-o", "a.facade.json"];
    let region = |label: &str, x: i32, width: i32| {
        format!(
            ", {{ \"label\": \"{label}\", \"x\": {x}, \"y\": 5, \"width\": {width}, \"height\": 20 }}"
        )
    };
    let cases = [
        (region("door", 230, 40), "", "reaches outside"),
        (
            region("door", 100, 20),
            ", \"unknown\": [ { \"x\": 90, \"y\": 0, \"width\": 60, \"height\": 40 } ]",
            "lies in unknown[0]",
        ),
        (
            region("door", 100, 20),
            ", \"unknown\": [ { \"x\": 90, \"y\": 0, \"width\": -60, \"height\": 40 } ]",
            "unknown[0]",
        ),
    ];
    for (regions, keys, expected) in &cases {
        partial(at, regions, keys);
        let message = complaint(at, &complete, 1);
        assert!(message.contains(expected), "{message}");
        assert!(!at.join("a.facade.json").exists());
    }
    partial(at, &region("gargoyle", 100, 20), "");
    assert!(messages(at, &complete).contains("kept, but not completed: gargoyle"));
    let twice = format!("{}{}", region("door", 100, 20), region("door", 105, 20));
    partial(at, &twice, "");
    assert!(messages(at, &complete).contains("1 pairs of observed elements overlap"));
    let whole = read(&at.join("a.facade.json"));
    let regions = whole["regions"].as_array().expect("regions");
    let observed = regions.iter().filter(|r| r["observed"] == true).count();
    assert_eq!(observed, 11);
    partial(at, "", ", \"unknown\": []");
    assert!(messages(at, &complete).contains("nothing is unknown"));
    assert_eq!(
        read(&at.join("a.facade.json"))["regions"]
            .as_array()
            .expect("regions")
            .len(),
        9
    );
    let empty = "{ \"format\": \"edifice/facade\", \"version\": 1, \"name\": \"e\", \"unit\": \"m\", \"width\": 12, \"height\": 9, \"regions\": [] }";
    std::fs::write(at.join("p.facade.json"), empty).expect("written");
    assert!(messages(at, &complete).contains("nothing is observed"));
    assert!(
        complaint(
            at,
            &[
                "facade",
                "hide",
                "p.facade.json",
                "--task",
                "r20",
                "-o",
                "h.facade.json"
            ],
            1
        )
        .contains("no elements")
    );
    assert!(
        complaint(
            at,
            &[
                "facade",
                "train",
                "p.facade.json",
                "-o",
                "m.completion.json"
            ],
            1
        )
        .contains("none of the layouts has a window")
    );
    assert!(!at.join("m.completion.json").exists());
    complaint(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--unknown",
            "1,2,3",
            "-o",
            "a.facade.json",
        ],
        2,
    );
    complaint(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--method",
            "magic",
            "-o",
            "a.facade.json",
        ],
        2,
    );
    std::fs::write(at.join("m.completion.json"), "{}").expect("written");
    let message = complaint(
        at,
        &[
            "facade",
            "complete",
            "p.facade.json",
            "--model",
            "m.completion.json",
            "-o",
            "b.facade.json",
        ],
        1,
    );
    assert!(
        message.contains("m.completion.json") && !at.join("b.facade.json").exists(),
        "{message}"
    );
}

#[test]
fn an_impossible_pin_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    // An added window on an observed one, and one on known wall.
    for (x, y) in [(12, 62), (200, 5)] {
        let added = format!(
            ", {{ \"label\": \"window\", \"x\": {x}, \"y\": {y}, \"width\": 20, \"height\": 30, \"id\": \"mine\", \"observed\": false }}"
        );
        let unknown =
            ", \"unknown\": [ { \"x\": 125, \"y\": 60, \"width\": 115, \"height\": 160 } ]";
        partial(at, &added, unknown);
        let words = [
            "facade",
            "complete",
            "p.facade.json",
            "--pin",
            "mine",
            "-o",
            "a.facade.json",
        ];
        let message = complaint(at, &words, 1);
        assert!(message.contains("cannot stay"), "{message}");
        assert!(!at.join("a.facade.json").exists());
    }
}

#[test]
fn nothing_to_learn_from_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = folder.path();
    std::fs::create_dir(at.join("empty")).expect("a folder");
    let train = |input: &str| {
        complaint(
            at,
            &["facade", "train", input, "-o", "m.completion.json"],
            1,
        )
    };
    assert!(train("empty").contains("no .facade.json"));
    assert!(train("nowhere").contains("nowhere"));
    assert!(!at.join("m.completion.json").exists());
    // A mask that is no image, and a folder that cannot be made.
    partial(at, "", "");
    let complete = |words: &[&str]| {
        let all = ["facade", "complete", "p.facade.json"];
        complaint(at, &all.iter().chain(words).copied().collect::<Vec<_>>(), 1)
    };
    complete(&["--mask", "p.facade.json", "-o", "a.facade.json"]);
    complete(&["-o", "p.facade.json/answers"]);
    for extent in ["0", "-5", "nan", "inf"] {
        let width = format!("--width={extent}");
        assert!(complete(&[&width, "-o", "a.facade.json"]).contains("--width"));
    }
    assert!(!at.join("a.facade.json").exists());
}
