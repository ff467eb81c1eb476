//! Sweeps by the command line: the same results however they are run, and mistakes that are named.

use std::path::{Path, PathBuf};

use assert_cmd::Command;

const ABLATION: &str = r#"
study = "facade_grammar/infer"
data = ["*.facade.json"]
seeds = 2
pair = ["facade", "seed"]
[base]
method = "adp-paper"
iterations = 20
[[arm]]
name = "full"
[[arm]]
name = "no repeat"
set.ops = []
[[grid]]
set.method = ["greedy", "importance"]
zip.iterations = [5, 10]
zip.lambda_rule = [1.0, 2.0]
[[exclude]]
method = "importance"
iterations = 10
[report]
metric = "cost"
reference = "full"
"#;

pub(crate) fn edifice(folder: &Path, words: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = Command::cargo_bin("edifice").unwrap();
    command
        .current_dir(folder)
        .arg("sweep")
        .args(words)
        .assert()
}

/// A folder with three small facades and a sweep file.
fn prepared(sweep: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, columns) in [("one", 2), ("two", 3), ("three", 4)] {
        let mut regions = Vec::new();
        for column in 0..2 * columns + 1 {
            for row in 0..5 {
                let window = column % 2 == 1 && row % 2 == 1;
                let label = if window { "window" } else { "wall" };
                regions.push(format!(
                    r#"{{"label":"{label}","x":{column},"y":{row},"width":1,"height":1}}"#
                ));
            }
        }
        let text = format!(
            r#"{{"format":"edifice/facade","version":1,"name":"{name}","unit":"m","width":{},"height":5,"regions":[{}]}}"#,
            2 * columns + 1,
            regions.join(",")
        );
        std::fs::write(folder.path().join(format!("{name}.facade.json")), text).unwrap();
    }
    let path = folder.path().join("ablation.toml");
    std::fs::write(&path, sweep).unwrap();
    (folder, path)
}

fn results(folder: &Path, out: &str) -> String {
    edifice(folder, &["collect", "ablation.toml", "--out", out]).success();
    std::fs::read_to_string(folder.join(out).join("results.csv")).unwrap()
}

#[test]
fn threads_and_shards_give_the_same_bytes() {
    let (folder, _) = prepared(ABLATION);
    let folder = folder.path();
    edifice(
        folder,
        &["run", "ablation.toml", "--out", "one", "--threads", "1"],
    )
    .success();
    edifice(
        folder,
        &["run", "ablation.toml", "--out", "two", "--threads", "2"],
    )
    .success();
    for i in ["2/3", "0/3", "1/3"] {
        edifice(
            folder,
            &["run", "ablation.toml", "--out", "three", "--shard", i],
        )
        .success();
    }
    let whole = results(folder, "one");
    // 5 arms, 3 facades, 2 seeds: cost, rules, and a bound of none of these methods.
    assert_eq!(whole.lines().count(), 1 + 5 * 3 * 2 * 2, "{whole}");
    assert_eq!(whole, results(folder, "two"));
    assert_eq!(whole, results(folder, "three"));
    // A second run has nothing left to do.
    let again = edifice(folder, &["run", "ablation.toml", "--out", "two", "--json"]).success();
    let text = String::from_utf8_lossy(&again.get_output().stdout).into_owned();
    assert!(
        text.contains(r#""finished":0"#) && text.contains(r#""before":30"#),
        "{text}"
    );
}

#[test]
fn report_bundle_and_verify() {
    let (folder, _) = prepared(ABLATION);
    let folder = folder.path();
    edifice(
        folder,
        &["run", "ablation.toml", "--out", "out", "--shard", "0/2"],
    )
    .success();
    let refused = edifice(folder, &["report", "ablation.toml", "--out", "out"])
        .failure()
        .code(1);
    let text = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    assert!(
        text.contains("15 of 30 tasks have no result") && text.contains("--allow-missing"),
        "{text}"
    );
    // What has not run has not failed.
    let some = ["report", "ablation.toml", "--out", "out", "--allow-missing"];
    edifice(folder, &some).success();
    let counts = || -> Vec<(String, Vec<usize>)> {
        let csv = std::fs::read_to_string(folder.join("out/report/report.csv")).unwrap();
        let (header, lines) = csv.split_once('\n').unwrap();
        let last: Vec<&str> = header.split(',').skip(14).collect();
        let own = |line: &str| {
            let cells = line.rsplit(',').take(last.len());
            cells.map(|cell| cell.parse().unwrap()).collect()
        };
        let own = lines.lines().map(|line| (last.join(","), own(line)));
        own.collect()
    };
    let of = |place: usize| counts().iter().map(|(_, own)| own[place]).sum::<usize>();
    assert_eq!(counts()[0].0, "failed,missing");
    assert_eq!((of(0), of(1)), (15, 0), "missing and failed");
    edifice(folder, &["retry", "ablation.toml", "--out", "out"]).success();
    edifice(folder, &["report", "ablation.toml", "--out", "out"]).success();
    assert_eq!((counts()[0].0.as_str(), of(0)), ("failed", 0));
    for name in [
        "report.md",
        "report.tex",
        "report.csv",
        "report.html",
        "ranks.png",
        "profiles.svg",
    ] {
        assert!(folder.join("out/report").join(name).is_file(), "{name}");
    }
    let tex = std::fs::read_to_string(folder.join("out/report/report.tex")).unwrap();
    assert!(
        tex.contains("\\toprule") && tex.contains("no repeat &"),
        "{tex}"
    );
    edifice(
        folder,
        &["bundle", "ablation.toml", "--out", "out", "-o", "b.zip"],
    )
    .success();
    let good = edifice(folder, &["verify", "b.zip", "--sample", "4", "--json"]).success();
    let text = String::from_utf8_lossy(&good.get_output().stdout).into_owned();
    assert!(text.contains(r#""rerun":4,"different":[]"#), "{text}");
    super::research_objects::crates(folder);
}

#[test]
fn a_changed_arm_is_run_alone_and_damage_is_named() {
    let (folder, sweep) = prepared(ABLATION);
    let folder = folder.path();
    edifice(folder, &["run", "ablation.toml", "--out", "out"]).success();
    std::fs::write(
        &sweep,
        ABLATION.replace("set.ops = []", "set.ops = [\"sym_split\"]"),
    )
    .unwrap();
    let stale = edifice(folder, &["run", "ablation.toml", "--out", "out"])
        .failure()
        .code(1);
    let text = String::from_utf8_lossy(&stale.get_output().stderr).into_owned();
    assert!(text.contains("has changed since the plan"), "{text}");
    let planned = edifice(folder, &["plan", "ablation.toml", "--out", "out", "--json"]).success();
    let text = String::from_utf8_lossy(&planned.get_output().stdout).into_owned();
    assert!(text.contains(r#""finished":24"#), "{text}");
    // A damaged line in the middle costs its own task and no other; half a line at the end is cut off.
    let journal = folder.join("out/journal/0-of-1.jsonl");
    let mut bytes = std::fs::read(&journal).unwrap();
    let second = bytes.iter().position(|b| *b == b'\n').unwrap() + 1;
    bytes[second] = b'#';
    bytes.extend_from_slice(b"{\"key\":\"ha");
    std::fs::write(&journal, &bytes).unwrap();
    let status = edifice(folder, &["status", "ablation.toml", "--out", "out"]).success();
    let text = String::from_utf8_lossy(&status.get_output().stderr).into_owned();
    assert!(text.contains("line 2 cannot be read"), "{text}");
    edifice(folder, &["run", "ablation.toml", "--out", "out"]).success();
    let done = edifice(folder, &["status", "ablation.toml", "--out", "out"]).success();
    let text = String::from_utf8_lossy(&done.get_output().stdout).into_owned();
    assert!(
        text.lines()
            .skip(1)
            .all(|line| line.split_whitespace().nth(2) == Some("0")),
        "{text}"
    );
}

#[test]
fn mistakes_are_named_with_their_place_and_what_was_meant() {
    let cases: &[(&str, &str, &[&str])] = &[
        (
            "facade_grammar/infer",
            "facade_grammer/infer",
            &["line 2, column 9", "did you mean `facade_grammar/infer`?"],
        ),
        (
            "iterations = 20",
            "iteratons = 20",
            &["line 8, column 1", "did you mean `iterations`?"],
        ),
        (
            "iterations = 20",
            "iterations = \"many\"",
            &["line 8, column 14", "invalid type"],
        ),
        (
            "method = \"adp-paper\"",
            "method = \"adp-papr\"",
            &["line 7, column 10", "did you mean `adp-paper`?"],
        ),
        (
            "seeds = 2",
            "seds = 2",
            &["line 4, column 1", "did you mean `seeds`?"],
        ),
        (
            "seeds = 2",
            "seeds = [1, 1]",
            &["line 4, column 9", "without repetition"],
        ),
        (
            "name = \"no repeat\"",
            "name = \"full\"",
            &["two arms are called `full`"],
        ),
        (
            "set.ops = []",
            "",
            &["`full` and `no repeat` differ in nothing"],
        ),
        (
            "reference = \"full\"",
            "reference = \"ful\"",
            &["did you mean `full`?"],
        ),
        (
            "metric = \"cost\"",
            "metric = \"coast\"",
            &["did you mean `cost`?"],
        ),
        (
            "zip.iterations = [5, 10]",
            "zip.iterations = [5]",
            &["equally long"],
        ),
        (
            "set.method = [\"greedy\", \"importance\"]",
            "set.method = []",
            &["`method` has no value"],
        ),
        (
            "data = [\"*.facade.json\"]",
            "data = [\"no.json\"]",
            &["no file is called so"],
        ),
        (
            "data = [\"*.facade.json\"]",
            "data = [\"*.facade.json\"",
            &["line 4"],
        ),
    ];
    for (before, after, wanted) in cases {
        let (folder, _) = prepared(&ABLATION.replace(before, after));
        let failed = edifice(folder.path(), &["plan", "ablation.toml", "--out", "out"])
            .failure()
            .code(1);
        let text = String::from_utf8_lossy(&failed.get_output().stderr).into_owned();
        assert!(
            wanted.iter().all(|part| text.contains(part)),
            "{after}: {text}"
        );
        assert!(!folder.path().join("out/plan.jsonl").exists());
    }
    let (folder, _) = prepared(ABLATION);
    for bad in ["3/3", "1", "a/b", "-1/2"] {
        edifice(
            folder.path(),
            &[
                "run",
                "ablation.toml",
                "--out",
                "out",
                &format!("--shard={bad}"),
            ],
        )
        .failure()
        .code(1);
    }
}

#[test]
fn cluster_scripts_cover_every_shard_once() {
    let (folder, _) = prepared(&format!("{ABLATION}[task]\npack = \"30s\"\nmem = \"2G\"\n"));
    let folder = folder.path();
    edifice(
        folder,
        &[
            "submit",
            "ablation.toml",
            "--out",
            "out",
            "--engine",
            "slurm",
            "--dry-run",
        ],
    )
    .success();
    let array = std::fs::read_to_string(folder.join("out/array_0.sh")).unwrap();
    // 30 tasks, guessed at 10 s each, 3 in a job.
    assert!(
        array.contains("--array=0-9\n") && array.contains("--mem=2G") && array.contains("+ 0))/10"),
        "{array}"
    );
    assert!(
        std::fs::read_to_string(folder.join("out/collect.sh"))
            .unwrap()
            .contains("sweep collect")
    );
    edifice(
        folder,
        &[
            "submit",
            "ablation.toml",
            "--out",
            "out",
            "--engine",
            "snakemake",
            "--dry-run",
        ],
    )
    .success();
    let file = std::fs::read_to_string(folder.join("out/Snakefile")).unwrap();
    assert!(
        file.contains("shards = range(10)") && file.contains("rule collect"),
        "{file}"
    );
}
