//! Sweeps that are killed, starved or run twice: nothing finished is lost or doubled, and the results are the same bytes.

use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// 2 arms on the 10 knapsacks that ship, 10 seeds: 200 tasks of some milliseconds.
fn sweep(rounds: u32) -> String {
    format!(
        "study = \"optim/annealing\"\ndata = [\"*.knapsack.json\"]\nseeds = 10\n[base]\nrounds = {rounds}\n\
         [[arm]]\nname = \"cold\"\nset.start = 0.1\n[[arm]]\nname = \"hot\"\nset.start = 10.0\n"
    )
}

const TASKS: usize = 200;

fn folder(rounds: u32) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("s.toml"), sweep(rounds)).unwrap();
    folder
}

fn command(folder: &Path, verb: &str, out: &str, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_edifice"));
    command
        .current_dir(folder)
        .args(["sweep", verb, "s.toml", "--out", out])
        .args(more)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn run(folder: &Path, verb: &str, out: &str, more: &[&str]) -> Output {
    command(folder, verb, out, more).output().unwrap()
}

fn good(folder: &Path, verb: &str, out: &str, more: &[&str]) -> Output {
    let output = run(folder, verb, out, more);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{verb} {more:?}: {text}");
    output
}

fn results(folder: &Path, out: &str) -> String {
    good(folder, "collect", out, &[]);
    std::fs::read_to_string(folder.join(out).join("results.csv")).unwrap()
}

/// Results of an undisturbed run on one thread.
fn undisturbed(folder: &Path) -> String {
    good(folder, "run", "whole", &["--threads", "1"]);
    let whole = results(folder, "whole");
    // `left_out`, `optimal` and the bound of each task.
    assert_eq!(whole.lines().count(), 1 + 3 * TASKS);
    assert!(!whole.contains("failure"));
    whole
}

/// Lines of all journals of a sweep, and their distinct keys.
fn entries(folder: &Path, out: &str) -> (usize, usize) {
    let mut keys = Vec::new();
    for entry in std::fs::read_dir(folder.join(out).join("journal")).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        for line in text.lines() {
            let value: serde_json::Value = serde_json::from_str(line).unwrap();
            keys.push(value["key"].as_str().unwrap().to_owned());
        }
    }
    let lines = keys.len();
    keys.sort();
    keys.dedup();
    (lines, keys.len())
}

/// Waits until a journal has something in it.
fn wait_for_results(folder: &Path, out: &str, child: &mut Child) {
    let journal = folder.join(out).join("journal/0-of-1.jsonl");
    let start = Instant::now();
    while std::fs::metadata(&journal).map_or(0, |m| m.len()) == 0 {
        assert!(child.try_wait().unwrap().is_none(), "ended too soon");
        assert!(start.elapsed() < Duration::from_secs(60), "no result");
        std::thread::sleep(Duration::from_millis(2));
    }
}

#[test]
fn seven_shards_in_any_order_and_threads_give_the_same_bytes() {
    let folder = folder(20);
    let folder = folder.path();
    let whole = undisturbed(folder);
    good(folder, "run", "two", &["--threads", "2"]);
    assert!(results(folder, "two") == whole);
    for i in [3, 0, 6, 1, 5, 2, 4] {
        good(folder, "run", "seven", &["--shard", &format!("{i}/7")]);
    }
    assert!(results(folder, "seven") == whole);
    assert_eq!(entries(folder, "seven"), (TASKS, TASKS));
}

#[test]
fn a_runner_that_is_killed_again_and_again_loses_nothing() {
    let folder = folder(400);
    let folder = folder.path();
    let whole = undisturbed(folder);
    // Moments by chance, from a fixed seed; where they fall differs from run to run all the same.
    let mut state = 20_140_521u64;
    let (mut kills, mut known) = (0, 0);
    for round in 0..200 {
        let verb = if round % 2 == 0 { "run" } else { "retry" };
        let mut child = command(folder, verb, "out", &["--threads", "2"])
            .spawn()
            .unwrap();
        state = state * 48_271 % 2_147_483_647;
        let until = Instant::now() + Duration::from_millis(30 + state % 150);
        while Instant::now() < until && child.try_wait().unwrap().is_none() {
            std::thread::sleep(Duration::from_millis(1));
        }
        if let Some(status) = child.try_wait().unwrap() {
            assert!(status.success());
            break;
        }
        // SIGKILL on Unix.
        child.kill().unwrap();
        child.wait().unwrap();
        kills += 1;
        let status = run(folder, "status", "out", &["--json"]);
        if status.status.success() {
            let text = String::from_utf8(status.stdout).unwrap();
            let last: serde_json::Value =
                serde_json::from_str(text.lines().last().unwrap()).unwrap();
            let arms = last["arms"].as_array().unwrap();
            let now: u64 = arms.iter().map(|a| a["finished"].as_u64().unwrap()).sum();
            assert!(now >= known, "{now} after {known}");
            known = now;
        }
    }
    good(folder, "retry", "out", &[]);
    assert!(kills > 1, "{kills}");
    assert!(results(folder, "out") == whole);
    assert_eq!(entries(folder, "out"), (TASKS, TASKS));
}

#[test]
fn two_runners_at_once() {
    let folder = folder(1000);
    let folder = folder.path();
    let whole = undisturbed(folder);
    // On one shard, the second says that another runs it.
    let mut first = command(folder, "run", "out", &["--threads", "1"])
        .spawn()
        .unwrap();
    wait_for_results(folder, "out", &mut first);
    let second = run(folder, "run", "out", &["--threads", "1"]);
    assert!(
        first.try_wait().unwrap().is_none(),
        "the first was too quick to tell"
    );
    let text = String::from_utf8_lossy(&second.stderr);
    assert_eq!(second.status.code(), Some(1), "{text}");
    assert!(text.contains("another process runs this shard"), "{text}");
    assert!(first.wait().unwrap().success());
    assert!(results(folder, "out") == whole);
    assert_eq!(entries(folder, "out"), (TASKS, TASKS));
    // On shards that overlap, and with the plan still to be made, tasks may be run twice, and count once.
    let shards = ["0/1", "0/2", "1/2"];
    let start =
        |shard| command(folder, "run", "over", &["--threads", "1", "--shard", shard]).spawn();
    let children: Vec<Child> = shards.into_iter().map(|s| start(s).unwrap()).collect();
    for child in children {
        let output = child.wait_with_output().unwrap();
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{text}");
    }
    assert!(results(folder, "over") == whole);
    assert_eq!(entries(folder, "over").1, TASKS);
}

/// A file size limit stands in for a full disk: both make a write fail after a part of it.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_nothing_that_was_finished() {
    let folder = folder(20);
    let folder = folder.path();
    let whole = undisturbed(folder);
    good(folder, "plan", "out", &[]);
    let starved = |verb: &str, signal: &str| {
        // 16 blocks of 512 or 1,024 bytes; an ignored signal turns the kill into a failed write.
        let script =
            format!("{signal} ulimit -f 16; exec \"$0\" sweep {verb} s.toml --out out --threads 2");
        let output = Command::new("sh")
            .current_dir(folder)
            .args(["-c", &script, env!("CARGO_BIN_EXE_edifice")])
            .output()
            .unwrap();
        assert!(!output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let text = starved("run", "trap '' XFSZ;");
    assert!(text.contains("0-of-1.jsonl"), "{text}");
    let (kept, distinct) = entries(folder, "out");
    assert!(kept == distinct && 10 < kept && kept < TASKS, "{kept}");
    // Killed in the middle of a write, nothing finished is lost either.
    starved("run", "");
    good(folder, "run", "out", &[]);
    assert!(results(folder, "out") == whole);
    assert_eq!(entries(folder, "out"), (TASKS, TASKS));
    // A table that cannot be written leaves the one that was there.
    starved("collect", "trap '' XFSZ;");
    let table = std::fs::read_to_string(folder.join("out/results.csv")).unwrap();
    assert!(table == whole);
}

#[test]
fn the_clock_decides_nothing() {
    let folder = folder(20);
    let folder = folder.path();
    let whole = undisturbed(folder);
    for (i, years) in [(0, -40i64), (1, 40), (2, -1)] {
        good(folder, "run", "out", &["--shard", &format!("{i}/3")]);
        // What is finished now seems to be of another time, the plan too.
        let shift = Duration::from_secs(365 * 86_400 * i64::unsigned_abs(years));
        let now = SystemTime::now();
        let then = if years < 0 { now - shift } else { now + shift };
        let journal = folder.join(format!("out/journal/{i}-of-3.jsonl"));
        for path in [
            journal,
            folder.join("out/plan.jsonl"),
            folder.join("s.toml"),
        ] {
            let file = std::fs::File::options().append(true).open(path).unwrap();
            file.set_modified(then).unwrap();
        }
    }
    let ran = good(folder, "run", "out", &["--json"]);
    let text = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(text.contains("\"finished\":0"), "{text}");
    assert!(results(folder, "out") == whole);
    // No part of sweeps asks what time it is; processor time is only told.
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/sweep")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // A foreign program has a limit of time, which the sweep sets.
            if path.ends_with("command/process.rs") {
                continue;
            }
            let text = std::fs::read_to_string(&path).unwrap();
            for clock in ["SystemTime", "Instant", ".modified()", ".created()"] {
                assert!(!text.contains(clock), "{}: {clock}", path.display());
            }
        }
    }
}

#[test]
fn a_task_that_fails_is_a_row_and_is_tried_again() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let text = sweep(20).replace("*.knapsack.json", "*.knap.json");
    std::fs::write(folder.join("s.toml"), text).unwrap();
    let problem = |capacity: u64| {
        format!(
            "{{\"format\":\"edifice/knapsack\",\"version\":1,\"capacity\":{capacity},\"items\":[[3,2],[4,3],[5,4]]}}"
        )
    };
    std::fs::write(folder.join("one.knap.json"), problem(5)).unwrap();
    std::fs::write(folder.join("two.knap.json"), problem(9_000_000)).unwrap();
    good(folder, "run", "out", &[]);
    let table = results(folder, "out");
    let failures = table.lines().filter(|line| line.contains(",failure,"));
    assert_eq!(failures.count(), 20, "{table}");
    let report = run(folder, "report", "out", &[]);
    let text = String::from_utf8_lossy(&report.stderr).into_owned();
    assert_eq!(report.status.code(), Some(1));
    assert!(text.contains("20 of 40 tasks have no result"), "{text}");
    // `run` leaves failures; `retry` runs them, and nothing else.
    let ran = String::from_utf8(good(folder, "run", "out", &["--json"]).stdout).unwrap();
    assert!(ran.contains("\"failed\":0,\"finished\":0"), "{ran}");
    let ran = String::from_utf8(good(folder, "retry", "out", &["--json"]).stdout).unwrap();
    assert!(
        ran.contains("\"before\":20") && ran.contains("\"failed\":20"),
        "{ran}"
    );
    // An instance that was mended is another one; the plan says so, and what is finished stays.
    std::fs::write(folder.join("two.knap.json"), problem(6)).unwrap();
    let stale = run(folder, "retry", "out", &[]);
    let text = String::from_utf8_lossy(&stale.stderr).into_owned();
    assert!(
        text.contains("two.knap.json: the file has changed since"),
        "{text}"
    );
    good(folder, "plan", "out", &[]);
    good(folder, "run", "out", &[]);
    good(folder, "report", "out", &[]);
    let table = results(folder, "out");
    assert!(!table.contains("failure"), "{table}");
}
